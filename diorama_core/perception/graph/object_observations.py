"""Observations of the support graph: where each object ends and what is below it; their settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float, Int32

from diorama_core.artefacts import Cuboid, DetectedObject, Inputs, ObjectGeometry
from diorama_core.geometry.depth_grid import points_camera
from diorama_core.library.taxonomy import Category, resolve
from diorama_core.perception.measured.cloud import MIN_POINTS, object_points


@dataclass(frozen=True)
class GeometricGraphSettings:
    """Costs of supporters by measured geometry, and what is seen around objects."""

    unnamed_prior: tuple[float, float, float, float] = (1.0, 0.5, 2.0, 5.0)
    carries_nothing_cost: float = 5.0
    larger_cost: float = 4.0
    """Cost of lying on something whose footprint is much smaller."""
    floor_gap_m: float = 0.10
    top_gap_m: float = 0.06
    inner_gap_m: float = 0.10
    """Usual errors of an underside's height above the floor, a top, a shelf."""
    max_gap_cost: float = 8.0
    below_weight: float = 3.0
    """Weight of what is seen just below the object."""
    belief_cost: float = 1.5
    """Cost of contradicting the geometry stage."""
    within_rug: float = 3.0
    """What standing within a rug speaks for being on it, against the floor."""
    rim_px: float = 0.012
    """How far below an object's lower rim to look, as a share of the picture's height."""
    nearer_m: float = 0.08
    """Something this much nearer below the rim hides the object's end."""
    level_m: float = 0.12
    """Two seen points whose heights differ by less are at one level."""
    contact_m: float = 0.12
    """Farther than this behind the rim, what is seen below is background, not the carrier."""


SETTINGS = GeometricGraphSettings()


@dataclass(frozen=True, eq=False)
class ObjectSurroundings:
    """One object, as far as the graph is concerned. World frame: floor at z = 0."""

    id: str
    category: Category
    bottom_m: float
    top_m: float
    footprint: Float[np.ndarray, "2 2"]
    """Lower and upper corner along the world's x and y."""
    below: Mapping[str, float]
    """Share of the lower rim below which another object, or the "floor" (anything of the room), is seen."""
    hidden_below: float
    """Share of the lower rim that something nearer hides."""
    behind_m: float
    """Distance to the room's surface seen just around the object, along the line of sight; 0 where unknown."""

    @property
    def rim_share_on_objects(self) -> float:
        """Share of the lower rim that ends on other objects."""
        return 1.0 - self.below.get("floor", 0.0)


def observed(
    inputs: Inputs,
    objects: tuple[DetectedObject, ...],
    geometry: ObjectGeometry,
    settings: GeometricGraphSettings = SETTINGS,
) -> tuple[ObjectSurroundings, ...]:
    """Every object that has a cuboid, in the order given.

    Args:
        inputs: photo, and depth where there is some.
        objects: with masks of shape (h, w).
        geometry: camera and cuboids in the world.
        settings: of the graph.
    """
    cuboids = {c.object_id: c for c in geometry.cuboids}
    present = [o for o in objects if o.id in cuboids]
    owners = owner_map(present, (inputs.photo.height, inputs.photo.width))
    depth = inputs.depth_m
    camera = geometry.camera
    world = None
    if depth is not None:
        world = points_camera(depth, camera.intrinsics) @ camera.T_world_camera[:3, :3].T + camera.position
    surroundings = []
    for index, item in enumerate(present):
        below, hidden = _rim_contacts(index, item, present, owners, depth, world, settings)
        low, high = _extent(item, cuboids[item.id], world, depth)
        behind = _depth_behind_m(index, item, owners, depth)
        category = resolve(item.category).category
        surroundings.append(
            ObjectSurroundings(
                item.id, category, float(low[2]), float(high[2]), np.stack([low[:2], high[:2]]), below, hidden, behind
            )
        )
    return tuple(surroundings)


def owner_map(objects: list[DetectedObject], shape: tuple[int, int]) -> Int32[np.ndarray, "h w"]:
    """Index of the object at every pixel, -1 for the room; smaller objects lie over larger ones."""
    owners = np.full(shape, -1, np.int32)
    for index in sorted(range(len(objects)), key=lambda i: -objects[i].pixels):
        owners[objects[index].mask] = index
    return owners


def _extent(
    item: DetectedObject, cuboid: Cuboid, world: Float[np.ndarray, "h w 3"] | None, depth_m: np.ndarray | None
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """Lower and upper corner along the world's axes: of the points themselves where there are some."""
    corners = cuboid.corners_world
    low, high = corners.min(axis=0), corners.max(axis=0)
    if world is None or depth_m is None:
        return low, high
    points = object_points(item, world, depth_m)
    if len(points) < MIN_POINTS:
        return low, high
    seen_low, seen_high = np.quantile(points, [0.02, 0.98], axis=0)
    # The cuboid knows what is hidden sideways; the points know the undersides and tops that are seen.
    low, high = np.minimum(low, seen_low), np.maximum(high, seen_high)
    low[2], high[2] = seen_low[2], seen_high[2]
    return low, high


def _rim_contacts(
    index: int,
    item: DetectedObject,
    objects: list[DetectedObject],
    owners: Int32[np.ndarray, "h w"],
    depth_m: np.ndarray | None,
    world: Float[np.ndarray, "h w 3"] | None,
    settings: GeometricGraphSettings,
) -> tuple[dict[str, float], float]:
    """Shares of the object's lower rim that end on others, and the share that something nearer hides."""
    mine = owners == index
    height = mine.shape[0]
    columns = np.flatnonzero(mine.any(axis=0))
    if not len(columns):
        return {}, 1.0
    lowest = height - 1 - mine[::-1, columns].argmax(axis=0)
    # Only the part of the rim near the object's own lower end: the underside of a table top is no end.
    near_end = lowest >= np.quantile(lowest, 0.5) - 0.25 * max(np.ptp(lowest), 1)
    columns, lowest = columns[near_end], lowest[near_end]
    step = max(2, round(settings.rim_px * height))
    under = lowest + step
    inside = under < height
    total = len(columns)
    if not inside.any():
        return {}, 1.0
    columns, lowest, under = columns[inside], lowest[inside], under[inside]
    who = owners[under, columns]
    nearer = np.zeros(len(who), dtype=bool)
    farther = np.zeros(len(who), dtype=bool)
    if depth_m is not None:
        depth_above = depth_m[np.maximum(lowest - 1, 0), columns]
        depth_below = depth_m[under, columns]
        known = (depth_above > 0) & (depth_below > 0)
        nearer = known & (depth_below < depth_above - settings.nearer_m - 0.02 * depth_above) & (who >= 0)
        if world is not None:  # the front edge of what carries it is nearer too, but as high as the object ends
            level = np.abs(world[under, columns, 2] - world[np.maximum(lowest - 1, 0), columns, 2]) < settings.level_m
            nearer &= ~level
        farther = known & (depth_below > depth_above + settings.contact_m + 0.02 * depth_above)
    hidden = float((nearer.sum() + (total - len(who))) / total)
    below: dict[str, float] = {}
    carrying = ~nearer & ~farther
    for other in np.unique(who[carrying]):
        name = "floor" if other < 0 else objects[other].id
        below[name] = float((who[carrying] == other).sum() / total)
    return below, hidden


def _depth_behind_m(
    index: int, item: DetectedObject, owners: Int32[np.ndarray, "h w"], depth_m: np.ndarray | None
) -> float:
    """Distance from the object to the room just around it, along the view."""
    if depth_m is None:
        return 0.0
    mine = (owners == index).astype(np.uint8)
    ring = (cv2.dilate(mine, np.ones((7, 7), np.uint8)) > 0) & (owners < 0) & (depth_m > 0)
    object_depth = depth_m[(mine > 0) & (depth_m > 0)]
    if not ring.any() or not len(object_depth):
        return 0.0
    return float(max(np.median(depth_m[ring]) - np.quantile(object_depth, 0.9), 0.0))
