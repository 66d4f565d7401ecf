"""Enrolled parts and parameters."""

from pathlib import Path

import numpy as np
import pytest

import partsight


def test_the_shipped_parts_are_there_without_a_path(home: Path, library: partsight.Library) -> None:
    own = partsight.Library.open()
    assert own.path and Path(own.path).is_relative_to(home)
    assert own.titles == library.titles
    assert len(own) == len(own.parts) == 8
    assert own.titles["fender"] == "Fender, left"
    points = own.points("fender")
    assert points.shape[1] == 3 and np.isfinite(points).all()


def test_an_enrolled_part_is_recognised_and_the_former_one_kept(tmp_path: Path) -> None:
    library = partsight.Library.create(tmp_path / "parts")
    assert len(library) == 0
    scene = partsight.simulate_frame("front_door", side="right", seed=1).scene()
    library.enrol(scene, "door_right", title="Front door, right")
    assert (library.parts, library.titles) == (["door_right"], {"door_right": "Front door, right"})
    again = partsight.simulate_frame("front_door", side="right", seed=2).scene()
    assert partsight.inspect(again, library).part == "door_right"
    library.enrol(scene, "door_right")
    assert len(list((tmp_path / "parts" / ".trash").iterdir())) == 1
    with pytest.warns(UserWarning, match="door_right.*\n  to do: "):
        library.enrol(scene, "door_left")


def test_errors_of_the_library_say_what_to_do(tmp_path: Path, library: partsight.Library) -> None:
    with pytest.raises(partsight.PartsightError, match="\n  to do: "):
        partsight.Library.open(tmp_path / "none")
    assert not (tmp_path / "none").exists()
    with pytest.raises(partsight.PartsightError, match="fenders?.*\n  to do: "):
        library.points("fenders")
    own = partsight.Library.create(tmp_path / "own")
    scene = partsight.simulate_frame().scene()
    with pytest.raises(partsight.PartsightError, match="not a valid name"):
        own.enrol(scene, "../fender")
    with pytest.raises(partsight.PartsightError, match="81 characters"):
        own.enrol(scene, "fender", title="x" * 81)
    with pytest.raises(partsight.PartsightError, match="readings"):
        own.enrol(partsight.Scene.from_points(np.zeros((0, 3))), "nothing")
    assert len(own) == 0


def test_a_damaged_part_is_left_out_with_a_warning(tmp_path: Path) -> None:
    library = partsight.Library.create(tmp_path)
    library.enrol(partsight.simulate_frame("grille", seed=1).scene(), "grille")
    (tmp_path / "grille" / "cloud.ply").write_bytes(b"ply\n")
    with pytest.warns(UserWarning, match="grille.*\n  to do: "):
        damaged = partsight.Library.open(tmp_path)
    assert len(damaged) == 0


def test_settings_change_what_is_accepted(library: partsight.Library, frame: partsight.SimulatedFrame) -> None:
    recipe = partsight.Recipe({"accept.min_score": 1, "segment.plane_distance": "9 mm", "pose": "global"})
    assert recipe["accept.min_score"] == 1.0 and recipe["segment.plane_distance"] == 9.0
    assert recipe.name == "built-in (modified)"
    assert partsight.inspect(frame.scene(), library, recipe).reason_kind == "low_score"


def test_a_recipe_lists_its_parameters() -> None:
    recipe = partsight.Recipe()
    listed = dict(recipe)
    assert len(listed) > 40 and listed["accept.min_score"] == 0.9
    assert partsight.Recipe(listed).identity == recipe.identity
    assert recipe.name == "built-in"
    with pytest.raises(KeyError, match="accept.min_score"):
        recipe["accept.min_scor"]


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ({"accept.min_scor": 0.5}, "nearest is accept.min_score"),
        ({"accept.min_score": 1.5}, "from 0 to 1"),
        ({"accept.min_score": float("nan")}, "from 0 to 1"),
        ({"accept.min_score": "high"}, "not a value of accept.min_score"),
        ({"icp.max_iterations": 1.5}, "whole numbers"),
    ],
)
def test_a_bad_setting_is_refused_with_advice(settings: dict[str, float | str], expected: str) -> None:
    with pytest.raises(partsight.PartsightError) as refused:
        partsight.Recipe(settings)
    assert expected in str(refused.value) and "\n  to do: " in str(refused.value)


def test_a_recipe_file_is_read_and_settings_go_over_it(tmp_path: Path) -> None:
    file = tmp_path / "glossy.toml"
    file.write_text('schema = 1\nname = "glossy"\n[parameters]\naccept.min_score = 0.8\naccept.min_margin = 0.5\n')
    recipe = partsight.Recipe(file=file)
    assert (recipe.name, recipe["accept.min_score"]) == ("glossy", 0.8)
    recipe = partsight.Recipe({"accept.min_score": 0.7}, file=file)
    assert (recipe.name, recipe["accept.min_score"], recipe["accept.min_margin"]) == ("glossy (modified)", 0.7, 0.5)
    file.write_text("schema = 1")
    with pytest.raises(partsight.PartsightError, match="glossy.toml.*\n  to do: "):
        partsight.Recipe(file=file)


def test_a_library_of_other_parameters_is_refused(library: partsight.Library, frame: partsight.SimulatedFrame) -> None:
    # The references are outlined by it, so the scene has to be outlined alike.
    recipe = partsight.Recipe({"project.pixel": 6})
    with pytest.raises(partsight.PartsightError, match="Open the library with the recipe"):
        partsight.inspect(frame.scene(), library, recipe)
    alike = partsight.Library.open(library.path, recipe=recipe)
    assert partsight.inspect(frame.scene(), alike).part == "fender"
