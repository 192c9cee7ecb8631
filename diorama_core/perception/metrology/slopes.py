"""How the residuals of `problem` change with the unknowns, in closed form as far as the picture is concerned."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.geometry.extreme_points import extreme_points
from diorama_core.perception.metrology.problem import (
    BASE,
    CUT,
    DEPTH,
    EDGES,
    FAR,
    FOOTPRINT,
    SIZES,
    TOP,
    UNKNOWNS,
    WALL,
    Cuboids,
    Problems,
    Values,
    View,
    corners_camera,
    cuboids,
    edge_residuals,
    seen_surface,
    values,
    wall_sigmas,
)
from diorama_core.perception.metrology.settings import SETTINGS, CuboidFitSettings
from diorama_core.scene.types import box_corners

_STEP = 1e-5


def jacobian(
    problems: Problems,
    unknowns: Float[np.ndarray, "n 6"],
    here: Values,
    view: View,
    settings: CuboidFitSettings = SETTINGS.fit,
) -> Float[np.ndarray, "n r 6"]:
    """Derivatives of every residual; outlines are not needed, insets are taken to stay.

    Where the near plane cuts a cuboid, or where nothing of it is seen, they are forward differences.

    Args:
        problems: n rows.
        unknowns: where derivatives are taken.
        here: the values there.
        view: intrinsics, and rotation from camera to world.
        settings: of the fit.
    """
    boxes = cuboids(unknowns, problems, view)
    corners = corners_camera(boxes, problems.camera_height_m, view)
    frame = _Frame.of(boxes, problems, view)
    edges, is_informative = _edges(corners, frame, here, problems, view, settings)
    slopes = np.zeros((len(problems), here.residuals.shape[1], UNKNOWNS))
    plan = _plan_slopes(boxes, view)
    slopes[:, EDGES] = edges
    slopes[:, CUT] = _cut_off(corners, frame, problems, view, settings)
    slopes[:, SIZES, 2:5] = problems.whitening
    slopes[:, BASE, 5] = 1.0
    slopes[:, TOP, 4] = boxes.size_m[:, 2] / problems.top_sigma_m
    slopes[:, TOP, 5] = problems.base_sigma_m / problems.top_sigma_m
    slopes[:, FOOTPRINT, :4] = _overhang_slopes(boxes, plan, here.residuals[:, FOOTPRINT], problems, settings)
    slopes[:, WALL, :3] = _off_wall(boxes, plan, here.residuals[:, WALL], problems, settings)
    slopes[:, FAR, :2] = _too_far(boxes, plan, here.residuals[:, FAR], settings)
    slopes[:, DEPTH] = _off_depth(boxes, corners, frame, here.residuals[:, DEPTH], problems, view, settings)
    rest = np.flatnonzero(~is_informative)
    if len(rest):
        slopes[rest] = _finite_differences(problems.rows(rest), unknowns[rest], here.rows(rest), view, settings)
    return slopes


@dataclass(frozen=True, eq=False)
class _Frame:
    """How points that are fixed to the cuboids move in the camera frame."""

    aside: Float[np.ndarray, "3 n"]
    """With the sideways tangent."""
    away: Float[np.ndarray, "3 n"]
    """With the logarithm of the distance."""
    axes: Float[np.ndarray, "3 3 n"]
    """With the logarithms of depth, width and height: each for a point one extent from the axis' origin."""
    up: Float[np.ndarray, "3 n"]
    """With the height of the base in sigmas."""

    @classmethod
    def of(cls, boxes: Cuboids, problems: Problems, view: View) -> _Frame:
        """The frame of every row.

        Args:
            boxes: of n rows, in the world (m).
            problems: of the same rows.
            view: intrinsics, and rotation from camera to world.
        """
        R, heading = view.R_world_camera, view.heading
        plan = boxes.centre[:, :2]
        forward = plan @ heading
        right = R[0] * heading[1] - R[1] * heading[0]
        c, s = np.cos(boxes.yaw_rad), np.sin(boxes.yaw_rad)
        x, y, z = R[..., None]
        depth, width, height = boxes.size_m.T
        axes = np.stack([(c * x + s * y) * depth, (c * y - s * x) * width, z * height])
        return cls(right[:, None] * forward, (plan @ R[:2]).T, axes, z * problems.base_sigma_m)

    def rows(self, chosen: np.ndarray) -> _Frame:
        """The frame of the chosen rows."""
        return _Frame(*(v[..., chosen] for v in (self.aside, self.away, self.axes, self.up)))

    def moved(self, unit: Float[np.ndarray, "3 p n"]) -> Float[np.ndarray, "6 3 p n"]:
        """Derivatives by every unknown of points of a unit box; the heights of boxes do not move their bases."""
        slopes = np.empty((UNKNOWNS, 3, *unit.shape[1:]))
        slopes[0], slopes[1], slopes[5] = self.aside[:, None], self.away[:, None], self.up[:, None]
        slopes[2], slopes[3] = unit[0] * self.axes[0, :, None], unit[1] * self.axes[1, :, None]
        slopes[4] = (unit[2] + 0.5) * self.axes[2, :, None]
        return slopes


def _edges(
    corners: Float[np.ndarray, "n 8 3"],
    frame: _Frame,
    here: Values,
    problems: Problems,
    view: View,
    settings: CuboidFitSettings,
) -> tuple[Float[np.ndarray, "n 4 6"], Bool[np.ndarray, "n"]]:
    """Slopes of the four sides of the projected box, and where they are told."""
    at = extreme_points(corners, here.bounds_px, here.visible, view.intrinsics)
    of_bounds = at.slopes(frame.moved(at.unit), view.intrinsics)
    stepped = edge_residuals(here.bounds_px + _STEP, here.visible, here.inset_px, problems, view, settings)
    by_bound = (stepped - here.residuals[:, EDGES]) / _STEP
    return (by_bound.T * of_bounds).transpose(2, 1, 0), at.told


def _cut_off(
    corners: Float[np.ndarray, "n 8 3"], frame: _Frame, problems: Problems, view: View, settings: CuboidFitSettings
) -> Float[np.ndarray, "n 2 6"]:
    """Slopes of how much lies outside the picture: that goes with the corner that lies farthest out."""
    k = view.intrinsics
    extent = problems.box_px[:, 2:] - problems.box_px[:, :2]
    x, y, z = np.ascontiguousarray(corners.transpose(2, 1, 0))
    near = z <= settings.cut_near_m
    depth = np.maximum(z, settings.cut_near_m)
    slopes = np.zeros((len(corners), 2, UNKNOWNS))
    unit = box_corners((1.0, 1.0, 1.0)).T
    for axis, (across, f, c, size) in enumerate(((x, k.fx, k.cx, k.width), (y, k.fy, k.cy, k.height))):
        pixel = across / depth * f + c
        outside = np.maximum(-pixel, pixel - size)
        corner = outside.argmax(axis=0)[None]
        out = np.take_along_axis(outside, corner, axis=0)[0]
        over = np.flatnonzero(out > 0.0)
        if not len(over):
            continue
        chosen = corner[:, over]
        dx, dz = frame.rows(over).moved(unit[:, chosen])[:, [axis, 2], 0].transpose(1, 0, 2)
        at = [np.take_along_axis(v[:, over], chosen, axis=0)[0] for v in (across, depth, pixel, near)]
        slope = f * (dx - np.where(at[3], 0.0, at[0] / at[1] * dz)) / at[1] * np.where(at[2] < 0, -1.0, 1.0)
        slopes[over, axis] = (slope / (extent[over, axis] + out[over]) / problems.cut_sigma[over]).T
    return slopes


def _plan_slopes(boxes: Cuboids, view: View) -> Float[np.ndarray, "n 2 2"]:
    """Slopes of the centres on the floor: x and y by the sideways tangent and by the logarithm of the distance."""
    plan, right = boxes.centre[:, :2], np.array([view.heading[1], -view.heading[0]])
    return np.stack([(plan @ view.heading)[:, None] * right, plan], axis=-1)


def _overhang_slopes(
    boxes: Cuboids,
    plan: Float[np.ndarray, "n 2 2"],
    here: Float[np.ndarray, "n 2"],
    problems: Problems,
    settings: CuboidFitSettings,
) -> Float[np.ndarray, "n 2 4"]:
    """Slopes of the base's place on its supporter, by place, depth and width."""
    depth, width = boxes.size_m[:, :2].T
    x, y, yaw, half_depth, half_width = problems.footprint.T
    c, s = np.cos(yaw), np.sin(yaw)
    turn = boxes.yaw_rad - yaw
    along, across = np.abs(np.cos(turn)), np.abs(np.sin(turn))
    off = boxes.centre[:, :2] - np.stack([x, y], axis=-1)
    slopes = np.zeros((len(depth), 2, 4))
    for axis, (u, v, half, by_depth, by_width) in enumerate(
        ((c, s, half_depth, along * depth, across * width), (-s, c, half_width, across * depth, along * width))
    ):
        fits = half - 0.5 * (by_depth + by_width) > settings.min_room_m
        outward = np.sign(u * off[:, 0] + v * off[:, 1])
        slopes[:, axis, :2] = outward[:, None] * (u[:, None] * plan[:, 0] + v[:, None] * plan[:, 1])
        slopes[:, axis, 2:] = np.where(fits[:, None], 0.5 * np.stack([by_depth, by_width], axis=-1), 0.0)
    return slopes * ((here > 0.0) / problems.footprint_sigma_m[:, None])[..., None]


def _off_wall(
    boxes: Cuboids,
    plan: Float[np.ndarray, "n 2 2"],
    here: Float[np.ndarray, "n"],
    problems: Problems,
    settings: CuboidFitSettings,
) -> Float[np.ndarray, "n 3"]:
    """Slopes of the back's distance from its wall, by place and depth."""
    front = np.stack([np.cos(boxes.yaw_rad), np.sin(boxes.yaw_rad)], axis=-1)
    ahead = 0.5 * boxes.size_m[:, 0] - (boxes.centre[:, :2] * front).sum(axis=1)
    moved = np.column_stack([-(front[:, :, None] * plan).sum(axis=1), 0.5 * boxes.size_m[:, 0]])
    return (
        moved
        * (
            (ahead > settings.min_back_m)
            / (np.maximum(ahead, settings.min_back_m) * wall_sigmas(here, problems, settings))
        )[:, None]
    )


def _too_far(
    boxes: Cuboids, plan: Float[np.ndarray, "n 2 2"], here: Float[np.ndarray, "n"], settings: CuboidFitSettings
) -> Float[np.ndarray, "n 2"]:
    """Slopes of the distance, by place."""
    centre = boxes.centre[:, :2]
    outward = (centre[:, :, None] * plan).sum(axis=1)
    return outward * ((here > 0.0) / ((centre**2).sum(axis=1) * settings.far_log_sigma))[:, None]


def _off_depth(
    boxes: Cuboids,
    corners: Float[np.ndarray, "n 8 3"],
    frame: _Frame,
    here: Float[np.ndarray, "n"],
    problems: Problems,
    view: View,
    settings: CuboidFitSettings,
) -> Float[np.ndarray, "n 6"]:
    """Slopes of the seen surface's depth; beyond `robust_beyond` sigmas they fall as the residual grows."""
    depth, shares = seen_surface(boxes, corners, view, settings)
    slopes = frame.moved(np.zeros((3, 1, len(depth))))[:, 2, 0].T.copy()
    slopes[:, 2:4] -= shares * boxes.size_m[:, :2]
    slopes *= np.minimum(1.0, settings.robust_beyond / np.maximum(np.abs(here), 1e-9))[:, None]
    near = depth <= settings.cut_near_m
    return np.where(near[:, None], 0.0, slopes / (np.where(near, 1.0, depth) * problems.depth_sigma)[:, None])


def _finite_differences(
    problems: Problems, unknowns: Float[np.ndarray, "n 6"], here: Values, view: View, settings: CuboidFitSettings
) -> Float[np.ndarray, "n r 6"]:
    count = len(problems)
    probes = (unknowns[None] + _STEP * np.eye(UNKNOWNS)[:, None]).reshape(-1, UNKNOWNS)
    repeated = problems.rows(np.tile(np.arange(count), UNKNOWNS))
    inset = np.tile(here.inset_px, (UNKNOWNS, 1))
    stepped = values(probes, repeated, view, inset, settings).residuals.reshape(UNKNOWNS, count, -1)
    return np.asarray(((stepped - here.residuals) / _STEP).transpose(1, 2, 0))
