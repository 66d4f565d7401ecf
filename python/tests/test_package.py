"""The types that the package promises, and its examples."""

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import require

import partsight

ROOT = Path(__file__).resolve().parents[1]


def run(*command: object) -> str:
    ran = subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True, check=False, cwd=ROOT)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    return ran.stdout


def test_the_types_are_those_of_the_package() -> None:
    require("mypy")
    run("-m", "mypy.stubtest", "partsight")


def test_examples_and_tests_keep_the_types() -> None:
    require("mypy")
    run("-m", "mypy", "tests", "examples/inspect_frame.py", "examples/evaluate_on_ray.py")
    run("-m", "mypy", "package/partsight/evaluate.py")


def test_everything_has_a_text_for_help() -> None:
    for name in partsight.__all__:
        named = getattr(partsight, name)
        assert named.__doc__, name
        if isinstance(named, type) and not issubclass(named, Exception):
            members = [getattr(named, member) for member in dir(named) if not member.startswith("_")]
            assert all(member.__doc__ for member in members), name


def test_the_lines_of_the_readme_run() -> None:
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    assert blocks
    for block in blocks:
        exec(compile(block, "README.md", "exec"), {})


def test_a_simulated_frame_is_inspected() -> None:
    assert "fender, score" in run("examples/inspect_frame.py")


def test_segments_are_drawn(tmp_path: Path) -> None:
    require("matplotlib")
    run("examples/matplotlib_segments.py", tmp_path / "segments.png")
    assert (tmp_path / "segments.png").stat().st_size > 10_000


def test_the_reference_is_laid_over_the_scene(tmp_path: Path) -> None:
    if importlib.util.find_spec("open3d") is None:
        pytest.skip("open3d is not installed")
    run("examples/open3d_overlay.py", tmp_path / "overlay.ply")
    assert len(partsight.read_points(tmp_path / "overlay.ply")) > 10_000
