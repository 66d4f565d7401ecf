"""Recognises car body parts in depth captures and estimates their pose.

Lengths are in metres, angles in radians. In camera space x points right, y down and z forward. A transform `b_from_a` takes
points of `a` to `b`: a pose is `camera_from_part`.
"""

from enum import IntEnum

from ._partsight import (
    Alignment,
    Inspection,
    Library,
    PartsightError,
    Pose,
    Recipe,
    Scene,
    SimulatedFrame,
    align,
    inspect,
    inspect_all,
    read_points,
    simulate_frame,
)


class Segment(IntEnum):
    """What a point was taken for, in `Inspection.segments`."""

    NO_READING = 0
    REST = 1
    PART = 2
    BACKGROUND = 3


__all__ = [
    "Alignment",
    "Inspection",
    "Library",
    "PartsightError",
    "Pose",
    "Recipe",
    "Scene",
    "Segment",
    "SimulatedFrame",
    "align",
    "inspect",
    "inspect_all",
    "read_points",
    "simulate_frame",
]
