"""Shows the part's reference at its pose in the scene with Open3D: python open3d_overlay.py [PLY]

With a path the two clouds are written into one file instead of being shown.
"""

import sys

import numpy as np
import open3d as o3d

import partsight

library = partsight.Library.open()
found = partsight.inspect(partsight.simulate_frame("trunk_lid", seed=3).scene(), library)
if not found.accepted or found.pose is None or found.pose.reference is None:
    sys.exit(f"not accepted: {found.reason}\n  to do: {found.advice}")

points = found.cloud.reshape(-1, 3)
seen = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points[np.isfinite(points).all(axis=1)].astype(float)))
seen.paint_uniform_color([0.6, 0.6, 0.6])
reference = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(library.points(found.pose.reference).astype(float)))
reference.transform(found.pose.camera_from_part)
reference.paint_uniform_color([0.9, 0.3, 0.1])
if len(sys.argv) > 1:
    o3d.io.write_point_cloud(sys.argv[1], seen + reference)
else:
    o3d.visualization.draw_geometries([seen, reference])
