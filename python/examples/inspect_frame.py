"""Inspects a file, or a simulated frame if none is given: python inspect_frame.py [FILE]"""

import sys

import partsight

scene = partsight.Scene.open(sys.argv[1]) if len(sys.argv) > 1 else partsight.simulate_frame("fender").scene()
found = partsight.inspect(scene, partsight.Library.open())
if found.accepted and found.pose:
    print(f"{found.part}, score {found.score:.2f}, camera_from_part:\n{found.pose.camera_from_part}")
else:
    print(f"not accepted: {found.reason}\n  to do: {found.advice}")
