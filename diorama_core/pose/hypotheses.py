"""The poses worth trying for one shape in one cuboid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from diorama_core.artefacts import Cuboid
from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.library.record import ROUND, SymmetryFold
from diorama_core.library.taxonomy import category
from diorama_core.pose.limits import SizeLimits
from diorama_core.pose.settings import SETTINGS, PoseSearchSettings
from diorama_core.scene.types import yaw_rotation

_FINE_STEP_RAD = np.deg2rad(15.0)
_TURNS = np.arange(-1, 2) * _FINE_STEP_RAD
"""Turns tried of things in their own proportions, against their cuboid's axes."""
_SAME_TURN_RAD = np.deg2rad(20.0)


@dataclass(frozen=True, eq=False)
class Anchor:
    """What stays where it is when a shape's size changes."""

    axis_world: Float[np.ndarray, "3"]
    """Unit direction from the anchored face into the object: up for standing objects, into the room on walls."""
    point_world: Float[np.ndarray, "3"]
    """A point of the anchored face."""

    def place_centres(
        self, centres: Float[np.ndarray, "p 3"], R: Float[np.ndarray, "p 3 3"], sizes_m: Float[np.ndarray, "p 3"]
    ) -> Float[np.ndarray, "p 3"]:
        """The centres moved along the axis so that boxes of these sizes touch the anchored face.

        Args:
            centres: (p, 3) in the world (m).
            R: (p, 3, 3), from the object frame to the world.
            sizes_m: (p, 3), along the object's axes.
        """
        half = 0.5 * (np.abs(np.einsum("pij,i->pj", R, self.axis_world)) * sizes_m).sum(axis=1)
        height = (centres - self.point_world) @ self.axis_world
        return centres + (half - height)[:, None] * self.axis_world


def anchor_of(cuboid: Cuboid, on_wall: bool, toward_camera_xy: Float[np.ndarray, "2"]) -> Anchor:
    """The face of the cuboid in contact with its supporter: the bottom, or its back for objects on a wall."""
    axis = np.array([0.0, 0.0, 1.0])
    if on_wall:
        sides = [sign * cuboid.R_world_object[:, k] for k in (0, 1) for sign in (1.0, -1.0)]
        thin = int(np.argmin(cuboid.size_m[:2]))
        normal = max(sides[2 * thin : 2 * thin + 2], key=lambda n: float(n[:2] @ toward_camera_xy))
        axis = np.array([normal[0], normal[1], 0.0]) / max(float(np.linalg.norm(normal[:2])), 1e-9)
    corners = cuboid.corners_world
    return Anchor(axis, corners[int(np.argmin(corners @ axis))])


@dataclass(frozen=True, eq=False)
class Hypotheses:
    """Poses of one shape, with how far each turns away from the cuboid's own axes."""

    poses: PoseBatch
    off_axis_rad: Float[np.ndarray, "p"]
    misfit: Float[np.ndarray, "p"]
    """How far the limits keep the shape from filling the cuboid that way round: root mean square of log extents."""

    def __getitem__(self, chosen: np.ndarray) -> Hypotheses:
        return Hypotheses(self.poses[chosen], self.off_axis_rad[chosen], self.misfit[chosen])

    def and_also(self, other: Hypotheses) -> Hypotheses:
        """These and then those."""
        return Hypotheses(
            self.poses.and_also(other.poses),
            np.concatenate([self.off_axis_rad, other.off_axis_rad]),
            np.concatenate([self.misfit, other.misfit]),
        )


def hypotheses_for(
    cuboid: Cuboid,
    category_name: str,
    symmetry: SymmetryFold,
    limits: SizeLimits,
    anchor: Anchor,
    *,
    sides_known: bool,
    settings: PoseSearchSettings = SETTINGS.search,
) -> Hypotheses:
    """Turns of the shape about its up axis that its symmetry tells apart, each scaled toward the cuboid.

    Quarter turns of the cuboid for all; finer ones for categories that often stand at odd angles. The whole cuboid may
    be turned by a quarter where its front is not known, and no measured depth says which side is the long one: of a
    thing seen at an angle one picture hardly tells.

    Args:
        cuboid: of the object, in the world (m).
        category_name: of the object.
        symmetry: number of turns about the up axis that leave the shape as it is.
        limits: of the shape's scale.
        anchor: the face that stays where it is when the size changes.
        sides_known: whether it is known which side is the long one.
        settings: of the search.
    """
    quarters = np.arange(4) * (np.pi / 2)
    fine = np.arange(-2, 4) * _FINE_STEP_RAD if category(category_name).quarter_turns_free else np.zeros(1)
    turns, off_axis = (grid.ravel() for grid in np.meshgrid(quarters, fine, indexing="ij"))
    total = turns + off_axis
    if symmetry == ROUND:
        total, turns, off_axis = total[:1] * 0, turns[:1] * 0, off_axis[:1] * 0
    else:
        distinct = np.mod(total + 1e-6, 2 * np.pi) < 2 * np.pi / symmetry
        total, turns, off_axis = total[distinct], turns[distinct], off_axis[distinct]
    odd = np.round(turns / (np.pi / 2)).astype(int) % 2 == 1
    long = float(cuboid.size_m[:2].max()) > settings.long_ratio * max(float(cuboid.size_m[:2].min()), 1e-6)
    again = np.flatnonzero(odd) if long and not (sides_known or cuboid.front_known) else np.zeros(0, dtype=int)
    turned = np.concatenate([np.zeros(len(total), dtype=bool), np.ones(len(again), dtype=bool)])
    total, off_axis, odd = (np.concatenate([values, values[again]]) for values in (total, off_axis, odd))
    wanted = np.where((odd & ~turned)[:, None], cuboid.size_m[[1, 0, 2]], cuboid.size_m)
    filled = wanted
    if np.isfinite(limits.sides_log) and long:  # it is as wide as one of the cuboid's sides, not something between
        total, off_axis, turned = np.tile(total, 2), np.tile(off_axis, 2), np.tile(turned, 2)
        filled = np.concatenate([wanted[:, [side, side, 2]] for side in (0, 1)])
        wanted = np.tile(wanted, (2, 1))
    R = np.array([cuboid.R_world_object @ yaw_rotation(angle) for angle in total])
    scale = limits.scale_for(filled)
    sizes = scale * limits.shape_size_m
    position = anchor.place_centres(np.tile(cuboid.centre, (len(total), 1)), R, sizes)
    thick = np.maximum(cuboid.size_m.min(), settings.thin_m)
    misfit = np.sqrt((np.log(np.maximum(sizes, thick) / np.maximum(wanted, thick)) ** 2).mean(axis=1))
    hypotheses = Hypotheses(
        PoseBatch(R, position, scale), np.abs(off_axis), np.hypot(misfit, settings.turned_misfit * turned)
    )
    if sides_known or symmetry == ROUND:
        return hypotheses
    return hypotheses.and_also(_as_made(hypotheses[~turned], cuboid, limits, anchor, settings))


def _as_made(
    hypotheses: Hypotheses, cuboid: Cuboid, limits: SizeLimits, anchor: Anchor, settings: PoseSearchSettings
) -> Hypotheses:
    """The shape in its own proportions, as high as the cuboid, and turned a little too.

    From a picture alone the cuboid has the proportions that its kind usually has where the outline was seen to end.
    """
    growth = float(cuboid.size_m[2]) / max(float(limits.shape_size_m[2]), 1e-6)
    scale = np.tile(limits.scale_for(growth * limits.shape_size_m), (len(_TURNS) * len(hypotheses.poses), 1))
    turns = np.repeat(_TURNS, len(hypotheses.poses))
    R = np.tile(hypotheses.poses.R, (len(_TURNS), 1, 1)) @ np.array([yaw_rotation(angle) for angle in turns])
    sizes = scale * limits.shape_size_m
    position = anchor.place_centres(np.tile(cuboid.centre, (len(R), 1)), R, sizes)
    wanted = np.tile(hypotheses.poses.scale * limits.shape_size_m, (len(_TURNS), 1))
    thick = np.maximum(cuboid.size_m.min(), settings.thin_m)
    misfit = np.sqrt((np.log(np.maximum(sizes, thick) / np.maximum(wanted, thick)) ** 2).mean(axis=1))
    return Hypotheses(
        PoseBatch(R, position, scale),
        np.tile(hypotheses.off_axis_rad, len(_TURNS)) + np.abs(turns),
        np.hypot(misfit, np.tile(hypotheses.misfit, len(_TURNS))),
    )


def unlike_best(
    poses: PoseBatch,
    scores: Float[np.ndarray, "p"],
    symmetry: SymmetryFold,
    shape_size_m: Float[np.ndarray, "3"],
    count: int,
    settings: PoseSearchSettings = SETTINGS.search,
) -> Int[np.ndarray, "k"]:
    """Indices of up to `count` good poses, best first, none nearly the same as a better one.

    Neighbours of one good pose are all drawn to the same optimum; another mode may be the right one.

    Args:
        poses: p poses of one shape.
        scores: higher is better.
        symmetry: number of turns about the up axis that leave the shape as it is.
        shape_size_m: unscaled.
        count: at most.
        settings: what counts as nearly the same.
    """
    order = np.argsort(-scores, kind="stable")
    yaw = np.arctan2(poses.R[:, 1, 0], poses.R[:, 0, 0])
    reach = settings.same_place * (poses.scale * shape_size_m).max(axis=1)
    fold = 2 * np.pi / symmetry
    indices: list[int] = []
    for index in order:
        turn = np.abs(np.mod(yaw[indices] - yaw[index] + fold / 2, fold) - fold / 2)
        away = np.linalg.norm(poses.position[indices] - poses.position[index], axis=1)
        if not ((turn < _SAME_TURN_RAD) & (away < reach[index])).any():
            indices.append(int(index))
        if len(indices) == count:
            break
    return np.array(indices)
