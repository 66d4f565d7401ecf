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


def test_real_captures_give_the_programs_line(library: partsight.Library) -> None:
    for path in real_frames():
        check(path, library)


def test_a_capture_of_a_covered_camera_gives_the_programs_line(library: partsight.Library, tmp_path: Path) -> None:
    path = tmp_path / "covered.pcd"
    header = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n"
    path.write_text(header + "nan nan nan\nnan nan nan\n")
    assert check(path, library)["status"] == "no_part"
