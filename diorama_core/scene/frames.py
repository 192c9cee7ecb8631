"""Axes, units and the names of transforms, stated once.

Units are metres and radians; pixels where a name ends in `_px`. All frames are right-handed.

====== ====================================== ========================================
frame  origin                                 axes
====== ====================================== ========================================
world  on the floor, below the photo's camera +Z up; +Y the room axis the camera faces
camera optical centre                         OpenCV: x right, y down, z forward
object centre of the shape's bounding box     +X front, +Z up, +Y its left
image  top-left corner of the top-left pixel  x right, y down, in pixels
====== ====================================== ========================================

`T_a_b` maps points of frame b into frame a: `p_a = T_a_b @ p_b` (homogeneous 4x4). `R_a_b` is its rotation.
Pixel (row i, column j) is the square [j, j+1] x [i, i+1]; its centre is (j + 0.5, i + 0.5).
Quaternions are (w, x, y, z).
"""

from __future__ import annotations

import numpy as np

UP_WORLD = np.array([0.0, 0.0, 1.0])
FRONT_OBJECT = np.array([1.0, 0.0, 0.0])
UP_OBJECT = np.array([0.0, 0.0, 1.0])

FACE_NORMALS_OBJECT: dict[str, tuple[float, float, float]] = {
    "bottom": (0.0, 0.0, -1.0),
    "top": (0.0, 0.0, 1.0),
    "front": (1.0, 0.0, 0.0),
    "back": (-1.0, 0.0, 0.0),
    "left": (0.0, 1.0, 0.0),
    "right": (0.0, -1.0, 0.0),
}
"""Outward normals of an object's bounding box, by the names used in support edges."""
