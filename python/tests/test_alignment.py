"""One cloud laid over another."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import partsight


def rotation(angle: float) -> npt.NDArray[np.float64]:
    c, s = np.cos(angle), np.sin(angle)
    product: npt.NDArray[np.float64] = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ np.array(
        [[c, -s, 0], [s, c, 0], [0, 0, 1]]
    )
    return product


@pytest.mark.parametrize("method", ["global", "icp-ga"])
def test_a_moved_cloud_is_moved_back(library: partsight.Library, method: str) -> None:
    target = library.points("fender").astype(float)
    angle = 1.9 if method == "global" else 0.1
    target_from_source = np.eye(4)
    target_from_source[:3, :3] = rotation(angle)
    target_from_source[:3, 3] = [0.05, -0.04, 0.1]
    source_from_target = np.linalg.inv(target_from_source)
    source = target @ source_from_target[:3, :3].T + source_from_target[:3, 3]
    found = partsight.align(source, target, method=method)  # type: ignore[arg-type]
    np.testing.assert_allclose(found.target_from_source, target_from_source, atol=2e-3)
    assert found.rms_m < 0.002 and found.overlap > 0.95
    assert (found.reason is None) == (found.advice is None)
    again = partsight.align(source, target, method=method)  # type: ignore[arg-type]
    np.testing.assert_array_equal(again.target_from_source, found.target_from_source)


def test_a_start_is_used(library: partsight.Library) -> None:
    target = library.points("fender").astype(float)
    start = np.eye(4)
    start[:3, :3] = rotation(2.0)
    source = target @ rotation(2.0)
    found = partsight.align(source, target, method="icp", initial=start)
    np.testing.assert_allclose(found.target_from_source, start, atol=1e-3)


def test_clouds_that_fix_no_pose_are_refused_with_advice() -> None:
    line = np.linspace(0, 1, 300)[:, None] * [1.0, 0, 0]
    for bad in [np.zeros((0, 3)), np.zeros((9, 3)), np.full((300, 3), np.nan), line]:
        with pytest.raises(partsight.PartsightError, match="\n  to do: "):
            partsight.align(bad, np.random.default_rng(1).normal(size=(500, 3)))


@pytest.mark.parametrize(
    "initial", [np.eye(3), 2 * np.eye(4), np.diag([1.0, 1, -1, 1]), np.full((4, 4), np.nan), np.eye(4, dtype=int)]
)
def test_a_start_that_is_no_rigid_transform_is_refused(initial: npt.ArrayLike) -> None:
    points = np.random.default_rng(1).normal(size=(500, 3))
    with pytest.raises(partsight.PartsightError, match="transform.*\n  to do: "):
        partsight.align(points, points, initial=initial)
    with pytest.raises(partsight.PartsightError, match="global"):
        partsight.align(points, points, method="best")  # type: ignore[arg-type]


def test_a_mesh_is_sampled(tmp_path: Path) -> None:
    mesh = tmp_path / "square.obj"
    mesh.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    points = partsight.read_points(mesh)
    assert len(points) > 1000
    np.testing.assert_allclose(points.min(axis=0), [0, 0, 0], atol=0.05)
    np.testing.assert_allclose(points.max(axis=0), [1, 1, 0], atol=0.05)
