"""Verdicts, poses and what lies behind them."""

import json
import os
import time
from pathlib import Path

import numpy as np
import pytest

import partsight


@pytest.fixture(scope="module")
def found(library: partsight.Library, frame: partsight.SimulatedFrame) -> partsight.Inspection:
    return partsight.inspect(frame.scene(), library)


def test_a_shipped_part_is_accepted_at_its_true_pose(
    found: partsight.Inspection, frame: partsight.SimulatedFrame
) -> None:
    assert (found.accepted, found.status, found.part) == (True, "ok", "fender")
    assert found.reason is found.reason_kind is found.advice is None
    assert found.score and found.score > 0.9
    assert found.is_simulated and not found.touches_edge
    pose = found.pose
    assert pose and pose.reference == "fender" and pose.method == "global"
    # The shipped parts were enrolled square-on, 1.3 m before the camera.
    model_from_part = np.eye(4)
    model_from_part[2, 3] = -1.3
    truth = frame.camera_from_model @ model_from_part
    middle = np.array([0, 0, 1.3, 1])
    assert pose.shift_bound_m and pose.turn_bound_rad
    off = np.linalg.norm((pose.camera_from_part - truth) @ middle)
    assert off < 0.005
    turned = pose.camera_from_part[:3, :3].T @ truth[:3, :3]
    assert np.degrees(np.arccos(np.clip((np.trace(turned) - 1) / 2, -1, 1))) < 1.0


def test_segments_mark_the_points_of_the_part(
    found: partsight.Inspection, frame: partsight.SimulatedFrame
) -> None:
    segments = found.segments
    assert segments.shape == frame.depth.shape == found.cloud.shape[:2]
    assert segments.dtype == np.uint8
    np.testing.assert_array_equal(segments == partsight.Segment.NO_READING, np.isnan(found.cloud[..., 2]))
    part = found.cloud[segments == partsight.Segment.PART]
    behind = found.cloud[segments >= partsight.Segment.BACKGROUND]
    assert len(part) > 1000 and len(behind) > 1000
    assert np.median(part[:, 2]) < np.median(behind[:, 2])


def test_the_json_line_says_the_same(found: partsight.Inspection) -> None:
    line = json.loads(found.to_json())
    assert line["scene"] == "simulated" and line["simulated"] is True
    for name in ["accepted", "status", "part", "score", "margin", "reason", "reason_kind", "touches_edge"]:
        assert line[name] == getattr(found, name), name
    pose = found.pose
    assert pose
    np.testing.assert_array_equal(np.reshape(line["pose"].pop("camera_from_part"), (4, 4)), pose.camera_from_part)
    for name, value in line["pose"].items():
        assert value == getattr(pose, name), name
    assert list(line["timings_ms"]) == ["segment", "project", "contour", "signature", "rank", "pose", "total"]
    assert set(line["timings_ms"]) == set(found.timings_ms)
    assert line["recipe"]["name"] == "built-in"


def test_a_robot_must_not_act_on_what_is_old_or_not_accepted(
    found: partsight.Inspection, library: partsight.Library, frame: partsight.SimulatedFrame, tmp_path: Path
) -> None:
    assert found.accepted and found.robot_doubts == []
    path = tmp_path / "frame.xyz"
    points = frame.scene().points
    np.savetxt(path, points[np.isfinite(points[..., 2])])
    of_file = partsight.inspect(partsight.Scene.open(path), library)
    assert of_file.accepted and of_file.robot_doubts == []
    os.utime(path, (time.time() - 3600,) * 2)
    of_file = partsight.inspect(partsight.Scene.open(path), library)
    assert of_file.accepted and of_file.pose and of_file.robot_doubts == ["old"]
    nothing = partsight.inspect(partsight.Scene.from_points(np.zeros((0, 3))), library)
    assert nothing.robot_doubts == ["not_accepted", "no_pose"]


def test_float_depths_give_the_same_verdict(
    found: partsight.Inspection, library: partsight.Library, frame: partsight.SimulatedFrame
) -> None:
    metres = (frame.depth * frame.metres_per_unit).astype(np.float32)
    of_floats = partsight.inspect(partsight.Scene.from_depth(metres, *frame.intrinsics, 1.0), library)
    assert of_floats.accepted and of_floats.part == found.part
    assert of_floats.pose and found.pose
    np.testing.assert_allclose(of_floats.pose.camera_from_part, found.pose.camera_from_part, atol=1e-4)
    # Of the arrays nobody said that they are simulated, but the fender was enrolled from a simulation.
    assert "simulated" not in json.loads(of_floats.to_json())
    assert of_floats.is_simulated


def test_what_is_not_enrolled_is_refused_with_reason_and_advice(library: partsight.Library) -> None:
    found = partsight.inspect(partsight.simulate_frame("fender", side="right", seed=4).scene(), library)
    assert (found.accepted, found.status, found.part) == (False, "unknown", None)
    assert found.reason_kind == "mirrored"
    assert found.reason and "mirror image" in found.reason
    assert "mirror image of fender, not accepted" in repr(found)
    assert found.advice


def test_an_empty_scene_is_no_part(library: partsight.Library) -> None:
    found = partsight.inspect(partsight.Scene.from_points(np.zeros((0, 3))), library)
    assert (found.accepted, found.status, found.part, found.pose) == (False, "no_part", None, None)
    assert found.reason_kind == "too_few_points" and "none, not accepted" in repr(found)
    assert found.segments.shape == (0,) and found.cloud.shape == (0, 3)
