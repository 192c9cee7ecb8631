"""What lets shapes stand: feet that end at the floor, and undersides that are flat where they touch it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.solids import Solid


def lowered(solid: Solid) -> Solid:
    """Moved so that its lowest point lies at z = 0."""
    return solid.moved(z=-float(solid.vertices[:, 2].min()))


def seated(solid: Solid) -> Solid:
    """With what lies below z = 0 pressed flat, as soft things are where they sit."""
    below = solid.vertices[:, 2] <= 0.0
    vertices = np.where(below[:, None], solid.vertices * (1.0, 1.0, 0.0), solid.vertices)
    return replace(solid, vertices=vertices, normals=np.where(below[:, None], (0.0, 0.0, -1.0), solid.normals))
