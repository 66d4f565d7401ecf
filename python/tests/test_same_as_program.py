"""A file gives the same line as `partsight inspect --json`, to the bit."""

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import CHECKOUT, skip

import partsight


def program() -> str:
    """The built program: PARTSIGHT_PROGRAM, or the newest in the target folder, or that on the path."""
    named = os.environ.get("PARTSIGHT_PROGRAM")
    if named:
        return named
    target = Path(os.environ.get("CARGO_TARGET_DIR", CHECKOUT / "target"))
    built = [target / profile / "partsight" for profile in ("debug", "release")]
    built = [path for path in built if path.is_file()]
    found = max(built, key=lambda path: path.stat().st_mtime) if built else shutil.which("partsight")
    if not found:
        skip("PARTSIGHT_REQUIRE_PROGRAM", "the program is not built: cargo build")
    return str(found)


def real_frames() -> list[Path]:
    """Captures of real cameras: PARTSIGHT_DATA, or ../shared/data beside the checkout."""
    shared = Path(os.environ.get("PARTSIGHT_DATA", CHECKOUT.parent / "shared" / "data"))
    frames = [*sorted((shared / "booth").glob("*.png"))[:4], *sorted((shared / "frames_labelled").glob("*.pcd"))]
    if not frames:
        skip("PARTSIGHT_REQUIRE_DATA", f"{shared} holds no captures")
    return frames


def line_of_program(path: Path) -> dict[str, Any]:
    parts = CHECKOUT / "reference_parts"
    command: list[str | Path] = [program(), "inspect", path, "--json", "--library", parts, "--recipe", "built-in"]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ran.returncode in (0, 1), ran.stderr
    line: dict[str, Any] = json.loads(ran.stdout)
    return line


def check(path: Path, library: partsight.Library) -> dict[str, Any]:
    expected = line_of_program(path)
    found = json.loads(partsight.inspect(partsight.Scene.open(path), library).to_json())
    for line in (expected, found):
        del line["timings_ms"]
    assert found == expected
    return expected


def test_a_simulated_file_gives_the_programs_line(library: partsight.Library, tmp_path: Path) -> None:
    for part, side in [("grille", "left"), ("back_door", "left"), ("fender", "right")]:
        path = tmp_path / f"{part}.pcd"
        command: list[str | Path] = [program(), "simulate", "--part", part, "--side", side, "--seed", "7", "--out", path]
        subprocess.run(command, check=True, capture_output=True)
        line = check(path, library)
        assert line["accepted"] == (side == "left")
        # The file's points are those of the frame that is simulated here.
        simulated = partsight.simulate_frame(part, side=side, seed=7)  # type: ignore[arg-type]
        np.testing.assert_array_equal(simulated.scene().points, partsight.read_points(path))


def test_a_rack_gives_the_programs_parts(library: partsight.Library, tmp_path: Path) -> None:
    path, truth = tmp_path / "rack.png", tmp_path / "truth.json"
    rack: list[str | Path] = ["--rack", "3", "--seed", "2", "--out", path, "--truth", truth]
    subprocess.run([program(), "simulate", *rack], check=True, capture_output=True)
    hung = [part["subject"]["part"]["kind"] for part in json.loads(truth.read_text())["parts"]]
    parts = CHECKOUT / "reference_parts"
    options: list[str | Path] = ["--json", "--library", parts, "--recipe", "built-in", "--expect", ",".join(hung)]
    ran = subprocess.run([program(), "inspect", path, *options], capture_output=True, text=True, check=True)
    line = json.loads(ran.stdout)
    assert line["as_expected"] and line["missing"] == []
    found = partsight.inspect_all(partsight.Scene.open(path), library, expected=hung)
    assert [part.part for part in found] == hung
    for part, expected in zip(found, line["parts"], strict=True):
        own = json.loads(part.to_json())
        assert {name: own[name] for name in expected if name != "timings_ms"} == {
            name: value for name, value in expected.items() if name != "timings_ms"
        }
    wrong = partsight.inspect_all(partsight.Scene.open(path), library, expected=["grille"])
    assert not wrong[0].accepted and not any(part.accepted for part in wrong)
    with pytest.raises(partsight.PartsightError, match="hood is expected, but not enrolled"):
        partsight.inspect_all(partsight.Scene.open(path), library, expected=["hood"])


def test_a_rack_file_gives_the_programs_places(library: partsight.Library, tmp_path: Path) -> None:
    path, rack = tmp_path / "rack.png", tmp_path / "rack.toml"
    simulate: list[str | Path] = [program(), "simulate", "--rack", "3", "--seed", "2", "--out", path]
    subprocess.run(simulate, check=True, capture_output=True)
    own: list[str | Path] = ["--library", CHECKOUT / "reference_parts", "--recipe", "built-in"]
    subprocess.run([program(), "rack", "add", rack, path, "--each", *own], check=True, capture_output=True)
    text = rack.read_text() + "[[place]]\nname = 'far'\ncentre_mm = [9000, 0, 2000]\nsize_mm = [99, 99, 99]\n"
    rack.write_text(text)
    scene = partsight.Scene.open(path)
    parts = [part.part for part in partsight.inspect_all(scene, library, rack=rack)]
    assert len(parts) == 3
    expected = [f"1={parts[0]}", f"2={parts[2]}", f"far={parts[2]}"]
    options: list[str | Path] = ["--json", *own, "--rack", rack, "--expect", ",".join(expected)]
    ran = subprocess.run([program(), "inspect", path, *options], capture_output=True, text=True)
    line = json.loads(ran.stdout)
    for given in (rack, text):
        found = partsight.inspect_all(scene, library, expected=expected, rack=given)
        assert [part.place for part in found] == [part["place"] for part in line["parts"]]
        assert found[0].empty_places == line["empty_places"] == ["far"]
        kinds = [part.reason_kind for part in found]
        assert kinds == [part["reason_kind"] for part in line["parts"]]
        assert sorted(map(str, kinds)) == ["None", "expected_elsewhere", "wrong_part"]
    for wrong, why in [("place = [", "is not a rack"), (rack.name, "rack.toml")]:
        with pytest.raises(partsight.PartsightError, match=why):
            partsight.inspect_all(scene, library, rack=f"{wrong}\n" if "[" in wrong else wrong)
    with pytest.raises(partsight.PartsightError, match="which the rack does not have"):
        partsight.inspect_all(scene, library, expected=["4=fender"], rack=rack)


def test_real_captures_give_the_programs_line(library: partsight.Library) -> None:
    for path in real_frames():
        check(path, library)


def test_a_capture_of_a_covered_camera_gives_the_programs_line(library: partsight.Library, tmp_path: Path) -> None:
    path = tmp_path / "covered.pcd"
    header = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n"
    path.write_text(header + "nan nan nan\nnan nan nan\n")
    assert check(path, library)["status"] == "no_part"
