"""Things that are not on the floor: on other things, on walls, below the ceiling."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import (
    AGAINST_WALLS,
    PORTABLE,
    SELDOM_CARRIED,
    UNKNOWN,
    WITH_BOARDS,
    column,
    often_carried,
)
from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.priors import modes_held, standing_costs
from diorama_core.perception.metrology.problem import UNTOLD, Cuboids, Problems
from diorama_core.perception.metrology.rows import row
from diorama_core.perception.metrology.settings import SETTINGS, PlacementSettings

FLOOR_OBJECT_COST = 4.0
"""Cost of a thing that usually stands on the floor and stands on another; portable things pay by their size instead."""
_BACK_SHARE = {("bed", "pillow"): 0.45}
"""Pillows lie at the head of a bed: in this share of its depth."""
_USUAL_MIDDLE_M: Mapping[str, float] = column("middle_height_m")


@dataclass(frozen=True)
class RoomExtent:
    """How far the things on the floor reach, seen from below the camera: the room is at least as large."""

    left_m: float
    right_m: float
    back_m: float
    left_sigma: float
    right_sigma: float
    back_sigma: float
    """Deviations of the logarithms: small where something stands far out, large where nothing is known."""

    @property
    def footprint(self) -> Float[np.ndarray, "5"]:
        """Centre, heading and half sizes of the floor, as `Problems.footprint`."""
        middle_x, half_x = (self.right_m - self.left_m) / 2, (self.right_m + self.left_m) / 2
        return np.array([middle_x, self.back_m / 2, 0.0, half_x, self.back_m / 2])


def extent_of(
    corners_world: Float[np.ndarray, "n 8 3"], names: tuple[str, ...], settings: PlacementSettings = SETTINGS.placement
) -> RoomExtent:
    """The extent of cuboids of named categories; of an ordinary room where there are none.

    Where a thing that usually stands against a wall is the farthest, or a door in that wall, the wall is right there.
    """
    if not len(corners_world):
        return RoomExtent(2.0, 2.0, 3.5, 0.4, 0.4, 0.4)
    sides = (-corners_world[..., 0].min(axis=1), corners_world[..., 0].max(axis=1), corners_world[..., 1].max(axis=1))
    reach, sigmas = [], []
    for side, least, axis in zip(sides, (1.0, 1.0, 1.5), (0, 0, 1), strict=True):
        farthest = int(np.argmax(side))
        flat = np.ptp(corners_world[farthest, :, axis]) < settings.flat_m
        against = names[farthest] in AGAINST_WALLS or (names[farthest] == "door" and flat)
        reach.append((max(float(side[farthest]), least) + 0.05) * (1.0 if against else 1.1))
        sigmas.append(0.12 if against else 0.3)
    return RoomExtent(reach[0], reach[1], reach[2], sigmas[0], sigmas[1], sigmas[2])


def supporters_of(observations: BoxObservations, index: int, candidates: list[int]) -> list[int]:
    """Candidates whose boxes an object may rest in: most of its width lies within, and its bottom not below.

    Both boxes' edges are drawn by people or detectors; the bottom may be above the candidate by as much as that leaves
    open, or by a share of the candidate's height.
    """
    settings, box = observations.settings.placement, observations.box_px[index]
    supporters = []
    for other in candidates:
        theirs = observations.box_px[other]
        shared = min(box[2], theirs[2]) - max(box[0], theirs[0])
        drawn = settings.drawn_sigmas * float(
            np.hypot(observations.edge_sigma_px[index, 3], observations.edge_sigma_px[other, 1])
        )
        reach = max(settings.above_share * (theirs[3] - theirs[1]), drawn)
        within = theirs[1] - reach < box[3] <= theirs[3] + 0.1 * settings.above_share * (theirs[3] - theirs[1])
        if other != index and shared >= settings.above_parent * (box[2] - box[0]) and within:
            supporters.append(other)
    return supporters


def place_on(
    observations: BoxObservations,
    index: int,
    parent: int,
    parent_cuboid: Cuboids,
    height_m: float,
    cost: float,
) -> list[Problems]:
    """Rows for an object on another's top, seat or shelves; `parent_cuboid` is a batch of one.

    Args:
        observations: of all objects.
        index: of the object.
        parent: index of its supporter.
        parent_cuboid: the supporter's, in the world (m).
        height_m: of the camera above the floor.
        cost: of resting there, in nats.
    """
    settings = observations.settings.placement
    bottom = float(parent_cuboid.base_m[0])
    names = (observations.categories[parent].name, observations.categories[index].name)
    footprint = _resting_place(parent_cuboid, _BACK_SHARE.get(names, 1.0))
    odd = observations.categories[parent].seat_height_m is not None and often_carried(*names[::-1]) <= SELDOM_CARRIED
    odd_cost = settings.odd_on_seat_cost if odd else 0.0
    usual_cost = FLOOR_OBJECT_COST if names[1] in PORTABLE else 0.0
    return [
        row(
            observations,
            index,
            mode,
            camera_height_m=height_m,
            yaw_rad=float(parent_cuboid.yaw_rad[0]) + turn,
            parent=parent,
            base_m=bottom + base,
            base_sigma_m=sigma,
            footprint=footprint,
            footprint_sigma_m=settings.footprint_sigma_m,
            extra=mode.cost + (standing_costs(names[1], mode, settings)[1] - usual_cost) + level_cost + cost + odd_cost,
        )
        for base, sigma, level_cost in _levels(observations, parent, float(parent_cuboid.size_m[0, 2]), odd)
        for mode in modes_held(names[1], observations.meanings[index], "surface", settings)
        for turn in ((0.0,) if mode.square else (0.0, np.pi / 2))
    ]


def _resting_place(parent_cuboid: Cuboids, back_share: float) -> Float[np.ndarray, "5"]:
    """The parent's footprint, or the share of it that is farthest from its front, which faces the camera."""
    depth, width, _ = parent_cuboid.size_m[0]
    yaw, centre = float(parent_cuboid.yaw_rad[0]), parent_cuboid.centre[0, :2]
    front = np.array([np.cos(yaw), np.sin(yaw)])
    toward = -np.sign(front @ centre) or 1.0
    moved = centre - toward * front * depth * (1.0 - back_share) / 2
    return np.array([*moved, yaw, depth * back_share / 2, width / 2])


def _levels(observations: BoxObservations, parent: int, tall: float, odd: bool) -> list[tuple[float, float, float]]:
    """Heights above the supporter's base at which things lie on it, odd ones on seats or not: (height, sigma, cost)."""
    category, settings = observations.categories[parent], observations.settings.placement
    top = (tall, settings.top_sigma_m, 0.0)
    if category.seat_height_m is not None:
        seat = min(category.seat_height_m, 0.95 * tall)
        cost = 0.0 if category.supports_objects else settings.seats_without_support_flag_cost
        return [
            (seat, settings.seat_sigma_m, cost),
            (seat + 0.15, settings.seat_sigma_m, cost + settings.inner_level_cost),  # leaning
            (tall, settings.seat_sigma_m, cost + (settings.odd_on_back_cost if odd else settings.back_cost)),
        ]
    if category.name in WITH_BOARDS:
        return [top, *((share * tall, 0.06 * tall, settings.inner_level_cost) for share in (0.15, 0.4, 0.65))]
    if category is UNKNOWN:
        return [top, (0.55 * tall, 0.05, settings.inner_level_cost)]
    return [top]


def place_on_wall(
    observations: BoxObservations, index: int, height_m: float, room: RoomExtent, cost: float
) -> list[Problems]:
    """Rows for an object on the wall ahead, on the left and on the right.

    A door stands on the floor, so that its foot tells where its wall is; of other things their walls tell how far they
    are.

    Args:
        observations: of all objects.
        index: of the object.
        height_m: of the camera above the floor.
        room: where the walls are, in the world (m).
        cost: of hanging there, in nats.
    """
    name, settings = observations.categories[index].name, observations.settings.placement
    door, middle = name == "door", _USUAL_MIDDLE_M.get(name, settings.middle_m)
    walls = (
        (-np.pi / 2, room.back_m, room.back_sigma, 0.0),
        (0.0, room.left_m, room.left_sigma, 0.5),
        (np.pi, room.right_m, room.right_sigma, 0.5),
    )
    return [
        row(
            observations,
            index,
            mode,
            camera_height_m=height_m,
            yaw_rad=yaw,
            base_m=0.0 if door else max(0.05, middle - float(np.exp(mode.log_size[2])) / 2),
            base_sigma_m=0.0 if door else settings.middle_sigma_m,
            top_m=settings.wall_top_m,
            top_sigma_m=settings.wall_top_sigma_m,
            wall_m=wall,
            wall_sigma=UNTOLD if door else sigma,
            footprint=room.footprint,
            footprint_sigma_m=UNTOLD if door else 0.4,
            extra=mode.cost + side_cost + cost,
        )
        for mode in modes_held(name, observations.meanings[index], "wall", settings)
        for yaw, wall, sigma, side_cost in walls
    ]


def place_below_ceiling(
    observations: BoxObservations, index: int, height_m: float, room: RoomExtent, cost: float
) -> list[Problems]:
    """Rows for an object hanging from the ceiling, over the things on the floor.

    Args:
        observations: of all objects.
        index: of the object.
        height_m: of the camera above the floor.
        room: how far it reaches, in the world (m).
        cost: of hanging there, in nats.
    """
    name, settings = observations.categories[index].name, observations.settings.placement
    return [
        row(
            observations,
            index,
            mode,
            camera_height_m=height_m,
            yaw_rad=yaw,
            base_m=settings.ceiling_m - float(np.exp(mode.log_size[2])),
            base_sigma_m=0.4,
            top_m=settings.ceiling_m,
            top_sigma_m=settings.ceiling_sigma_m,
            footprint=room.footprint,
            footprint_sigma_m=0.4,
            extra=mode.cost + cost,
        )
        for mode in modes_held(name, observations.meanings[index], "ceiling", settings)
        for yaw in ((0.0,) if mode.square else (0.0, np.pi / 2))
    ]
