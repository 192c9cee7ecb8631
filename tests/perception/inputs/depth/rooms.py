"""Depth of a box-shaped room, exact, and named things that stand in it."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import LabelledBox

WIDTH, HEIGHT, FOCAL = 160, 160, 0.6
"""Pixels, and focal length over the width."""
CAMERA_M, CEILING_M, SIDE_M, BACK_M = 1.6, 1.0, 2.2, 5.0
"""Of the camera from the floor, the ceiling, the side walls and the back wall."""
THINGS = (("sofa", -1.2, 3.4), ("chair", 0.6, 2.6), ("chair", 1.5, 3.8), ("wardrobe", 0.2, 4.6), ("table", -0.4, 2.4))
"""Kind, across and away, metres."""
SIZES = {"sofa": (2.0, 0.85), "chair": (0.5, 0.9), "wardrobe": (1.2, 2.0), "table": (1.4, 0.75)}
"""Width and height."""


def room() -> tuple[Float[np.ndarray, "h w"], tuple[LabelledBox, ...]]:
    """Depth along the optical axis in metres, and things' boxes in shares of the width."""
    x = (np.arange(WIDTH) + 0.5 - WIDTH / 2) / WIDTH / FOCAL
    y = (np.arange(HEIGHT) + 0.5 - HEIGHT / 2) / WIDTH / FOCAL
    inverse = np.maximum(np.maximum(y / CAMERA_M, -y / CEILING_M)[:, None], np.abs(x)[None, :] / SIDE_M)
    depth = 1.0 / np.maximum(inverse, 1.0 / BACK_M)
    boxes = []
    for kind, across, away in sorted(THINGS, key=lambda t: -t[2]):
        wide, tall = SIZES[kind]
        left, right = (WIDTH * (0.5 + FOCAL * (across + s * wide / 2) / away) for s in (-1, 1))
        top, bottom = (HEIGHT / 2 + WIDTH * FOCAL * (CAMERA_M - h) / away for h in (tall, 0.0))
        part = np.s_[max(0, round(top)) : round(bottom), max(0, round(left)) : round(right)]
        depth[part] = np.minimum(depth[part], away)
        boxes.append(LabelledBox((left / WIDTH, top / WIDTH, right / WIDTH, bottom / WIDTH), kind, kind))
    return depth.astype(np.float32), tuple(boxes)
