"""How far objects may be from where they are shown, and from where another photo would tell it best."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float

from diorama_core.arrangement.support_hypotheses import REASONED
from diorama_core.scene.room_edits import floor_height
from diorama_core.scene.types import Scene, SceneObject

SPACING_M = 0.5
"""Between the places where a camera is tried."""
CLEAR_M = 0.4
"""Between a camera and walls and furniture: a person stands there."""
HALF_VIEW_RAD = float(np.deg2rad(32.0))
"""Half of the horizontal field of view of a phone's main camera (64 degrees)."""
REACH_M = (0.8, 6.0)
"""How near and how far an object is seen well by a further photo."""
HEADROOM_M, STEPPED_OVER_M = 1.9, 0.05
"""What hangs higher or is flatter is in nobody's way."""
MIN_GAIN_M = 0.3
"""Metres of deviation, of all objects together, below which nobody is sent for another photo."""
ROUND = np.linspace(0.0, 2.0 * np.pi, 33)[:-1]


@dataclass(frozen=True)
class NextPhoto:
    """From where another photo helps most."""

    position: tuple[float, float]
    """On the floor, world (m)."""
    look_at: tuple[float, float]
    objects: int
    """Whose places it would tell."""


def place_outline(scene: Scene, item: SceneObject) -> Float[np.ndarray, "32 2"] | None:
    """An ellipse on the floor, one standard deviation around an object's place; None where nothing is known of it."""
    if scene.camera is None or item.belief is None or item.belief.place_sigma_m <= 0.0:
        return None
    along = _direction(item.pose.position[:2] - scene.camera.position[:2])
    across = np.array([-along[1], along[0]])
    sigma = max(item.belief.place_sigma_m, REASONED.across_m)
    return (
        item.pose.position[:2]
        + np.outer(np.cos(ROUND), along) * sigma
        + np.outer(np.sin(ROUND), across) * REASONED.across_m
    )


def next_photo(scene: Scene) -> NextPhoto | None:
    """From where another photo would tell most of what the scene's own leaves open; None where little is open.

    A photo tells little of distances along its rays, and much across them: seen from the side, an object's place is as
    good as it is across.
    """
    floor = scene.architecture.floor
    known = [o for o in scene.objects if o.belief is not None and o.belief.place_sigma_m > 0.0 and not o.by_hand]
    if scene.camera is None or floor is None or not known:
        return None
    stands = _standing_places(scene, floor.polygon[:, :2])
    if not len(stands):
        return None
    at = np.array([o.pose.position[:2] for o in known])
    sigma = np.array([o.belief.place_sigma_m for o in known if o.belief is not None])
    seen_along = _direction(at - scene.camera.position[:2])
    way = at[None] - stands[:, None]
    far, along = np.linalg.norm(way, axis=-1), _direction(way)
    sine = seen_along[None, :, 0] * along[..., 1] - seen_along[None, :, 1] * along[..., 0]
    after = 1.0 / np.sqrt(1.0 / sigma**2 + sine**2 / REASONED.across_m**2)
    gain = np.where((far >= REACH_M[0]) & (far <= REACH_M[1]), sigma - after, 0.0)
    heading = np.arctan2(along[..., 1], along[..., 0])
    apart = (heading[:, :, None] - ROUND[None, None] + np.pi) % (2 * np.pi) - np.pi
    inside = np.abs(apart) <= HALF_VIEW_RAD
    total = (gain[..., None] * inside).sum(axis=1)
    place, turn = np.unravel_index(int(total.argmax()), total.shape)
    if total[place, turn] < MIN_GAIN_M:
        return None
    is_decided = (gain[place] > 0.5 * sigma) & inside[place, :, turn]
    x, y = stands[place].tolist()
    return NextPhoto((x, y), (x + float(np.cos(ROUND[turn])), y + float(np.sin(ROUND[turn]))), int(is_decided.sum()))


def _standing_places(scene: Scene, floor: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "m 2"]:
    """Places on the floor where a person can stand."""
    low, high = floor.min(axis=0), floor.max(axis=0)
    grid = np.stack(np.meshgrid(*(np.arange(a, b, SPACING_M) for a, b in zip(low, high, strict=True))), -1)
    points = grid.reshape(-1, 2)
    clear = shapely.buffer(shapely.make_valid(shapely.Polygon(floor)), -CLEAR_M)
    points, ground = points[shapely.contains_xy(clear, points)], floor_height(scene)
    for item in scene.objects:
        if item.corners_world[:, 2].min() > ground + HEADROOM_M or item.size_m[2] < STEPPED_OVER_M:
            continue
        R = item.pose.R_world_object
        local = np.abs((points - item.pose.position[:2]) @ R[:2, :2])
        points = points[(local > item.size_m[:2] / 2 + CLEAR_M).any(axis=1)]
    return points


def _direction(way: Float[np.ndarray, "*n 2"]) -> Float[np.ndarray, "*n 2"]:
    return way / np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), 1e-9)
