"""How well readings of things whose backs stand at walls agree with the walls of the room.

A narrow box is as well a case that is seen from the front as a long one that is seen along its length: of readings
that project alike, the one whose back is at a wall is the likelier.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from diorama_core.perception.metrology.problem import Cuboids
from diorama_core.perception.metrology.settings import SETTINGS, PlacementSettings
from diorama_core.scene.types import Plane

_SQUARE = float(np.cos(np.deg2rad(15.0)))
"""Cosine from which on a back counts as parallel to a wall."""


def back_costs(
    boxes: Cuboids,
    walls: Sequence[Plane],
    foot: Float[np.ndarray, "3"],
    settings: PlacementSettings = SETTINGS.placement,
) -> Float[np.ndarray, "n"]:
    """What speaks against every reading by the distance of its back from the nearest wall, in squared sigmas.

    Either end of a cuboid's depth may be its back. 0 at a wall; bounded, since not all stand there.

    Args:
        boxes: Readings, about the camera's foot.
        walls: Of the room; their normals point into it.
        foot: Of the camera, in the room.
    """
    front = np.stack([np.cos(boxes.yaw_rad), np.sin(boxes.yaw_rad)], axis=-1)
    spread = settings.gap_m + settings.gap_share * np.linalg.norm(boxes.centre[:, :2], axis=1)
    density = np.zeros(len(boxes.centre))
    for wall in walls:
        normal = wall.normal[:2]
        along = np.array([-normal[1], normal[0]])
        ends, place = (wall.polygon - foot)[:, :2] @ along, boxes.centre[:, :2] @ along
        beside = np.maximum(np.maximum(ends.min() - place, place - ends.max()), 0.0) < boxes.size_m[:, 1] / 2
        square = np.abs(front @ normal) > _SQUARE
        away = (boxes.centre + foot) @ wall.normal - wall.offset - boxes.size_m[:, 0] / 2
        near = np.exp(-0.5 * (away / spread) ** 2) / (np.sqrt(2 * np.pi) * spread)
        density = np.maximum(density, np.where(beside & square, near, 0.0))
    at_wall, elsewhere = settings.at_walls * density, (1.0 - settings.at_walls) / settings.reach_m
    most = settings.at_walls / (np.sqrt(2 * np.pi) * spread) + elsewhere
    return np.asarray(-2.0 * np.log((at_wall + elsewhere) / most))
