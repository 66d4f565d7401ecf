"""Draws a simulated depth frame beside what its pixels were taken for: python matplotlib_segments.py [PNG]"""

import sys

import matplotlib.pyplot as plt

import partsight

frame = partsight.simulate_frame("front_door", seed=5)
found = partsight.inspect(frame.scene(), partsight.Library.open())

figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4))
depth = frame.depth * frame.metres_per_unit
image = left.imshow(depth, cmap="viridis_r", vmin=depth[depth > 0].min())
figure.colorbar(image, ax=left, label="depth, m")
right.imshow(found.segments == partsight.Segment.PART, cmap="gray")
right.set_title(f"{found.part}: {'accepted' if found.accepted else found.reason}")
if len(sys.argv) > 1:
    figure.savefig(sys.argv[1])
else:
    plt.show()
