"""Arrays and files become scenes and come back."""

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import partsight

Camera = tuple[float, float, float, float]
KINECT: Camera = (525.0, 525.0, 319.5, 239.5)


def test_depths_become_points_on_the_rays_of_their_pixels(frame: partsight.SimulatedFrame) -> None:
    fx, fy, cx, cy = frame.intrinsics
    scene = partsight.Scene.from_depth(frame.depth, *frame.intrinsics, frame.metres_per_unit)
    z = frame.depth * frame.metres_per_unit
    v, u = np.indices(z.shape)
    expected = np.stack([(u - cx) / fx * z, (v - cy) / fy * z, z], axis=-1)
    expected[frame.depth == 0] = np.nan
    assert scene.points.dtype == np.float32
    assert scene.intrinsics == frame.intrinsics
    np.testing.assert_allclose(scene.points, expected, atol=1e-6)
    assert not scene.is_simulated and frame.scene().is_simulated
    np.testing.assert_array_equal(scene.points, frame.scene().points)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_float_depths_give_the_same_points(frame: partsight.SimulatedFrame, dtype: type) -> None:
    metres: npt.NDArray[Any] = (frame.depth * frame.metres_per_unit).astype(dtype)
    metres[frame.depth == 0] = np.nan
    metres[0, :4] = [0, -1, np.inf, np.nan]
    scene = partsight.Scene.from_depth(metres, *frame.intrinsics, 1.0)
    expected = frame.scene().points
    expected[0, :4] = np.nan
    np.testing.assert_allclose(scene.points, expected, atol=1e-6)
    assert scene.intrinsics == frame.intrinsics


def test_a_large_image_keeps_its_camera_when_it_is_reduced() -> None:
    depth = np.full((1440, 1920), 2.0, np.float32)
    of_floats = partsight.Scene.from_depth(depth, 1575, 1575, 959.5, 719.5, 1.0)
    of_units = partsight.Scene.from_depth((depth * 1000).astype(np.uint16), 1575, 1575, 959.5, 719.5, 0.001)
    assert of_floats.points.shape == of_units.points.shape != (1440, 1920, 3)
    assert of_floats.intrinsics == of_units.intrinsics
    np.testing.assert_allclose(of_floats.points, of_units.points, atol=1e-5)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_points_come_back_as_they_went_in(dtype: type) -> None:
    points: npt.NDArray[Any] = np.random.default_rng(1).normal(size=(500, 3)).astype(dtype)
    points[7] = np.nan
    back = partsight.Scene.from_points(points).points
    np.testing.assert_array_equal(back, np.delete(points, 7, axis=0).astype(np.float32))


def test_organised_points_keep_rows_and_columns(frame: partsight.SimulatedFrame) -> None:
    points = frame.scene().points
    np.testing.assert_array_equal(partsight.Scene.from_points(points).points, points)
    half_a_point = points.copy()
    half_a_point[5, 6, 0] = np.inf
    assert np.isnan(partsight.Scene.from_points(half_a_point).points[5, 6]).all()


def test_any_memory_layout_is_read(frame: partsight.SimulatedFrame) -> None:
    depth = frame.depth
    expected = partsight.Scene.from_depth(depth, *frame.intrinsics, 0.001).points
    packed = np.zeros(depth.shape, np.dtype([("flag", "u1"), ("depth", "u2")], align=False))
    packed["depth"] = depth
    for other in [np.asfortranarray(depth), depth[::-1][::-1], packed["depth"], depth.tolist()]:
        array: npt.NDArray[np.uint16] = np.asarray(other, np.uint16) if isinstance(other, list) else other
        found = partsight.Scene.from_depth(array, *frame.intrinsics, 0.001).points
        np.testing.assert_array_equal(found, expected)


def test_a_later_change_of_an_array_changes_nothing(frame: partsight.SimulatedFrame) -> None:
    depth = frame.depth
    scene = partsight.Scene.from_depth(depth, *frame.intrinsics, 0.001)
    before = scene.points
    depth[:] = 0
    scene.points[:] = 0
    np.testing.assert_array_equal(scene.points, before)


@pytest.mark.parametrize(
    ("depth", "camera", "metres_per_unit", "expected"),
    [
        (np.zeros((4, 4), np.int32), KINECT, 0.001, "int32, not uint16"),
        (np.zeros((4, 4), ">u2"), KINECT, 0.001, "not uint16"),
        (np.zeros((4, 4, 1), np.uint16), KINECT, 0.001, "[4, 4, 1], not (H, W)"),
        (np.zeros((0, 4), np.uint16), KINECT, 0.001, "[0, 4], not (H, W)"),
        (np.zeros((4, 4), np.uint16), (0.0, 525.0, 2.0, 2.0), 0.001, "fx is 0"),
        (np.zeros((4, 4), np.uint16), (525.0, np.nan, 2.0, 2.0), 0.001, "fy is NaN"),
        (np.zeros((4, 4), np.uint16), (525.0, 525.0, np.inf, 2.0), 0.001, "principal point"),
        (np.zeros((4, 4), np.uint16), KINECT, -0.001, "metres_per_unit is -0.001"),
    ],
)
def test_what_is_no_depth_image_is_refused_with_advice(
    depth: npt.NDArray[np.uint16], camera: Camera, metres_per_unit: float, expected: str
) -> None:
    with pytest.raises(partsight.PartsightError) as refused:
        partsight.Scene.from_depth(depth, *camera, metres_per_unit)
    assert expected in str(refused.value)
    assert "\n  to do: " in str(refused.value)


@pytest.mark.parametrize("points", [np.zeros((4, 2)), np.zeros(3), np.zeros((4, 3), complex), np.zeros((4, 3), int), "points"])
def test_what_are_no_points_is_refused_with_advice(points: npt.ArrayLike) -> None:
    with pytest.raises(partsight.PartsightError, match="the points .*\n  to do: "):
        partsight.Scene.from_points(points)
    with pytest.raises(partsight.PartsightError, match="the points .*\n  to do: "):
        partsight.align(np.zeros((9, 3)), points)


@pytest.mark.parametrize("values", [0.0, np.nan, np.inf, 1e30, -1.0, 1e6])
def test_points_that_no_camera_saw_are_inspected_and_not_accepted(library: partsight.Library, values: float) -> None:
    for shape in [(0, 3), (1, 3), (5000, 3), (40, 50, 3)]:
        scene = partsight.Scene.from_points(np.full(shape, values))
        found = partsight.inspect(scene, library)
        assert not found.accepted and found.reason and found.advice


def test_a_file_that_cannot_be_read_says_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(partsight.PartsightError, match="no such file\n  to do: "):
        partsight.Scene.open(tmp_path / "missing.pcd")
    garbage = tmp_path / "garbage.pcd"
    garbage.write_bytes(b"\0\1\2garbage")
    for read in [partsight.Scene.open, partsight.read_points]:
        with pytest.raises(partsight.PartsightError, match="garbage.pcd: found .*\n  to do: "):
            read(garbage)


def test_a_cloud_in_millimetres_is_read_with_a_warning_or_by_its_unit(tmp_path: Path) -> None:
    points = partsight.simulate_frame().scene().points.reshape(-1, 3)
    points = points[np.isfinite(points).all(axis=1)]
    path = tmp_path / "scan.xyz"
    np.savetxt(path, points * 1000, fmt="%.3f")
    with pytest.warns(UserWarning, match="\n  to do: "):
        partsight.read_points(path)
    found = partsight.read_points(f"{path}#units=mm")
    np.testing.assert_allclose(found, points, atol=1e-5)


def test_an_unknown_simulated_part_is_refused_with_the_names() -> None:
    with pytest.raises(partsight.PartsightError, match="'?bonnet'?|\"bonnet\"") as refused:
        partsight.simulate_frame("bonnet")
    assert "trunk_lid" in str(refused.value)
    with pytest.raises(partsight.PartsightError, match="left, right"):
        partsight.simulate_frame(side="top")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("camera", "message"),
    [
        ((525.0, 525.0, 379.5, 239.5), "lies 60 pixels from the middle"),
        ((525.0, 580.0, 319.5, 239.5), "focal lengths differ"),
        ((100.0, 100.0, 319.5, 239.5), "would see 145° of its surroundings"),
    ],
)
def test_a_camera_that_cannot_be_is_warned_of(camera: Camera, message: str) -> None:
    for dtype in (np.uint16, np.float32):
        depth = np.full((480, 640), 1500, dtype)
        with pytest.warns(UserWarning, match=message) as warned:
            scene = partsight.Scene.from_depth(depth, *camera, 0.001, name="frame 7")
        (warning,) = warned
        assert str(warning.message).startswith("frame 7: ") and "Check" in str(warning.message)
        # The numbers stay as they are.
        assert scene.intrinsics == camera
    with pytest.warns(UserWarning, match=message):
        partsight.Scene.from_points(scene.points)


def test_a_camera_that_exists_is_not_warned_of(recwarn: pytest.WarningsRecorder) -> None:
    depth = np.full((480, 640), 1500, np.uint16)
    scene = partsight.Scene.from_depth(depth, *KINECT, 0.001)
    partsight.Scene.from_points(scene.points)
    assert not recwarn.list
