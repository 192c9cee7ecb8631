"""The small problem each object poses: which upright cuboid of plausible size projects to the observed box?

All hypotheses about all objects (camera heights, headings, supporters, starts) are rows of one batch, so that they
are solved together. A row's unknowns are

| index | unknown                                        |
|-------|------------------------------------------------|
| 0     | sideways tangent of the centre, x / y in the world |
| 1     | logarithm of the centre's distance ahead, y    |
| 2..4  | logarithms of depth (x), width (y), height (z) |
| 5     | height of the base above its expected value, in units of its sigma |

"Ahead" is measured along the camera's heading on the floor, so that a centre is always in front of the camera.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.geometry.projection import NEAR_M, cuboid_corners, visible_bounds
from diorama_core.perception.metrology.settings import SETTINGS, CuboidFitSettings
from diorama_core.scene.types import Intrinsics

UNKNOWNS = 6
EDGES, CUT, SIZES, BASE, TOP, FOOTPRINT, WALL, FAR, DEPTH = (
    slice(0, 4), slice(4, 6), slice(6, 9), 9, 10, slice(11, 13), 13, 14, 15,
)  # fmt: skip
"""Columns of `Values.residuals`."""
UNTOLD = 1e6
"""A sigma that means that nothing is known."""


@dataclass(frozen=True, eq=False)
class View:
    """How the camera is held: intrinsics and orientation, with its heading on the floor."""

    intrinsics: Intrinsics
    R_world_camera: Float[np.ndarray, "3 3"]

    @property
    def heading(self) -> Float[np.ndarray, "2"]:
        """Unit direction on the floor that the camera faces."""
        ahead = self.R_world_camera[:2, 2]
        length = np.linalg.norm(ahead)
        return ahead / length if length > 1e-6 else np.array([0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Problems:
    """A batch of rows; every array's first axis is the row."""

    item: Float[np.ndarray, "n"]
    """Index of the object the row is about."""
    camera_height_m: Float[np.ndarray, "n"]
    yaw_rad: Float[np.ndarray, "n"]
    box_px: Float[np.ndarray, "n 4"]
    edge_sigma_px: Float[np.ndarray, "n 4"]
    hidden_px: Float[np.ndarray, "n 4"]
    """How far beyond each edge the object may go on, hidden by something in front; 0 where nothing is in front."""
    hidden_odds: Float[np.ndarray, "n 4"]
    """Odds that it does go on beyond each edge, unseen; 0 where it surely ends there."""
    log_size: Float[np.ndarray, "n 3"]
    """Prior of the logarithms of depth, width, height."""
    log_size_sigma: Float[np.ndarray, "n 3"]
    """Deviation of each by itself."""
    whitening: Float[np.ndarray, "n 3 3"]
    """Turns a difference from the prior into independent sigmas."""
    base_m: Float[np.ndarray, "n"]
    """Expected height of the base."""
    base_sigma_m: Float[np.ndarray, "n"]
    """0 where the base is certain."""
    top_m: Float[np.ndarray, "n"]
    top_sigma_m: Float[np.ndarray, "n"]
    footprint: Float[np.ndarray, "n 5"]
    """Where the base must stay: centre x, y, yaw, half depth, half width; in the world."""
    footprint_sigma_m: Float[np.ndarray, "n"]
    wall_m: Float[np.ndarray, "n"]
    """Coordinate of the object's back along its front axis (negative: a wall faces the camera)."""
    wall_sigma: Float[np.ndarray, "n"]
    """Deviation of the logarithm of that coordinate's ratio."""
    cut_sigma: Float[np.ndarray, "n"]
    """How readily the cuboid may reach beyond the picture (of a logarithm of box sizes)."""
    log_depth: Float[np.ndarray, "n"]
    """Logarithm of the depth (m) at which a network sees the object."""
    depth_sigma: Float[np.ndarray, "n"]
    """Deviation of that logarithm."""
    outline: Float[np.ndarray, "n p 3"]
    """Points in a unit box that bound what the object fills of its cuboid (`library.kinds`): 40 points, or none."""
    extra: Float[np.ndarray, "n"]
    """Constant cost of the row's assumptions."""

    def __len__(self) -> int:
        return len(self.item)

    def rows(self, chosen: np.ndarray) -> Problems:
        """The chosen rows, by index or by mask."""
        return Problems(**{f.name: getattr(self, f.name)[chosen] for f in fields(self)})

    def with_columns(self, **columns: object) -> Problems:
        """A copy with some columns replaced (broadcast to the rows)."""
        whole = {k: np.broadcast_to(np.asarray(v), getattr(self, k).shape) for k, v in columns.items()}
        return replace(self, **whole)


def concatenate_problems(parts: list[Problems]) -> Problems:
    """One batch of several."""
    return Problems(**{f.name: np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Problems)})


@dataclass(frozen=True, eq=False)
class Cuboids:
    """The cuboids that a batch of unknowns stands for."""

    centre: Float[np.ndarray, "n 3"]
    yaw_rad: Float[np.ndarray, "n"]
    size_m: Float[np.ndarray, "n 3"]

    def rows(self, chosen: np.ndarray) -> Cuboids:
        """The chosen ones, by index or by mask."""
        return Cuboids(self.centre[chosen], self.yaw_rad[chosen], self.size_m[chosen])

    @property
    def base_m(self) -> Float[np.ndarray, "n"]:
        """Heights of the undersides."""
        return self.centre[:, 2] - self.size_m[:, 2] / 2

    @property
    def top_m(self) -> Float[np.ndarray, "n"]:
        """Heights of the upper sides."""
        return self.centre[:, 2] + self.size_m[:, 2] / 2


def cuboids(unknowns: Float[np.ndarray, "n 6"], problems: Problems, view: View) -> Cuboids:
    """Centres, headings and sizes in the world."""
    forward = np.exp(unknowns[:, 1])
    ahead, right = view.heading, np.array([view.heading[1], -view.heading[0]])
    plan = forward[:, None] * (ahead + unknowns[:, :1] * right)
    size = np.exp(unknowns[:, 2:5])
    base = problems.base_m + unknowns[:, 5] * problems.base_sigma_m
    return Cuboids(np.column_stack([plan, base + size[:, 2] / 2]), problems.yaw_rad, size)


def corners_camera(boxes: Cuboids, camera_height_m: Float[np.ndarray, "n"], view: View) -> Float[np.ndarray, "n 8 3"]:
    """The cuboids' corners in the camera frame."""
    corners = cuboid_corners(boxes.centre, boxes.yaw_rad, boxes.size_m)
    corners[..., 2] -= camera_height_m[:, None]
    return corners @ view.R_world_camera


@dataclass(frozen=True, eq=False)
class Values:
    """What the rows' cuboids come to."""

    residuals: Float[np.ndarray, "n r"]
    """Everything that speaks against them, in sigmas: their squares sum to a row's cost."""
    inset_px: Float[np.ndarray, "n 4"]
    """By how much the objects' outlines stay within their cuboids."""


def values(
    unknowns: Float[np.ndarray, "n 6"],
    problems: Problems,
    view: View,
    inset_px: Float[np.ndarray, "n 4"] | None = None,
    settings: CuboidFitSettings = SETTINGS.fit,
) -> Values:
    """What the rows come to at these unknowns.

    `inset_px` is by how much the objects' outlines stay within their cuboids here or nearby, where it is known: it
    hardly changes with small steps.

    Args:
        unknowns: of every row's cuboid.
        problems: what was seen of every row's object, and what is expected.
        view: intrinsics, and rotation from camera to world.
        inset_px: left, top, right and bottom; None computes it.
        settings: of the fit.
    """
    boxes = cuboids(unknowns, problems, view)
    corners = corners_camera(boxes, problems.camera_height_m, view)
    if inset_px is None:
        inset_px = _outline_inset(boxes, corners, problems, view, settings)
    bounds, visible = visible_bounds(corners, view.intrinsics)
    residuals = np.concatenate(
        [
            _edge_residuals(bounds, visible, inset_px, problems, view, settings),
            _cut_off(corners, problems, view, settings),
            np.einsum("nij,nj->ni", problems.whitening, unknowns[:, 2:5] - problems.log_size),
            unknowns[:, 5:6],
            ((boxes.top_m - problems.top_m) / problems.top_sigma_m)[:, None],
            _footprint_overhang(boxes, problems, settings),
            _off_wall(boxes, problems, settings),
            _too_far(boxes, settings),
            _off_depth(boxes, corners, problems, view, settings),
        ],
        axis=1,
    )
    return Values(residuals, inset_px)


def _cut_off(
    corners: Float[np.ndarray, "n 8 3"], problems: Problems, view: View, settings: CuboidFitSettings
) -> Float[np.ndarray, "n 2"]:
    """How much of the cuboid lies outside the picture, against the box: of readings that fit, the least cut one."""
    k = view.intrinsics
    x, y, z = np.ascontiguousarray(corners.transpose(2, 1, 0))
    depth = np.maximum(z, settings.cut_near_m)
    u, v = x / depth * k.fx + k.cx, y / depth * k.fy + k.cy
    beside, above = np.maximum(-u, u - k.width).max(axis=0), np.maximum(-v, v - k.height).max(axis=0)
    outside = np.stack([beside, above], axis=-1)
    extent = problems.box_px[:, 2:] - problems.box_px[:, :2]
    return np.log1p(np.maximum(outside, 0.0) / extent) / problems.cut_sigma[:, None]


def _outline_inset(
    boxes: Cuboids, corners: Float[np.ndarray, "n 8 3"], problems: Problems, view: View, settings: CuboidFitSettings
) -> Float[np.ndarray, "n 4"]:
    """By how many pixels the object's own outline stays within its cuboid's, at each edge of the box.

    0 where the cuboid reaches behind the camera: there nothing is known of the outline's ends.
    """
    k = view.intrinsics
    inset = np.zeros((len(boxes.centre), 4))
    ahead = (corners[..., 2] > settings.cut_near_m).all(axis=1)
    x, y, z = (problems.outline[ahead, :, axis] * boxes.size_m[ahead, axis, None] for axis in range(3))
    c, s = np.cos(boxes.yaw_rad[ahead])[:, None], np.sin(boxes.yaw_rad[ahead])[:, None]
    corners = corners[ahead]
    R, centre = view.R_world_camera, corners.mean(axis=1)
    wx, wy = c * x - s * y, s * x + c * y
    depth = np.maximum(wx * R[0, 2] + wy * R[1, 2] + z * R[2, 2] + centre[:, 2, None], NEAR_M)
    outline, whole = [], []
    for axis, f in ((0, k.fx), (1, k.fy)):
        across = wx * R[0, axis] + wy * R[1, axis] + z * R[2, axis] + centre[:, axis, None]
        outline.append(f * across / depth)
        whole.append(f * corners[..., axis] / corners[..., 2])
    low = [o.min(axis=1) - w.min(axis=1) for o, w in zip(outline, whole, strict=True)]
    high = [w.max(axis=1) - o.max(axis=1) for o, w in zip(outline, whole, strict=True)]
    inset[ahead] = np.maximum(np.stack([*low, *high], axis=-1), 0.0)
    return inset


def _edge_residuals(
    bounds: Float[np.ndarray, "n 4"],
    visible: Bool[np.ndarray, "n"],
    unfilled: Float[np.ndarray, "n 4"],
    problems: Problems,
    view: View,
    settings: CuboidFitSettings,
) -> Float[np.ndarray, "n 4"]:
    """How far the projected box is from the observed one, edge by edge; lenient as far as something hides the rest."""
    k = view.intrinsics
    border = np.abs(bounds - [0.0, 0.0, k.width, k.height]) < 1e-6
    inward = np.array([1.0, 1.0, -1.0, -1.0])
    bounds = bounds + np.where(border, 0.0, unfilled) * inward
    outward = (bounds - problems.box_px) * -inward
    robust = _robust(outward / problems.edge_sigma_px, settings)
    robust = np.where(outward > 0, _residuals_beyond(robust, outward, problems, settings), robust)
    return robust + np.where(visible, 0.0, settings.invisible_penalty)[:, None]


def _robust(off: Float[np.ndarray, "*n"], settings: CuboidFitSettings) -> Float[np.ndarray, "*n"]:
    """Residuals whose squares grow linearly beyond some sigmas (Huber)."""
    beyond = settings.robust_beyond
    linear = np.sign(off) * np.sqrt(np.maximum(2 * beyond * np.abs(off) - beyond**2, 0.0))
    return np.where(np.abs(off) > beyond, linear, off)


def _residuals_beyond(
    seen: Float[np.ndarray, "n 4"],
    outward_px: Float[np.ndarray, "n 4"],
    problems: Problems,
    settings: CuboidFitSettings,
) -> Float[np.ndarray, "n 4"]:
    """Residuals of cuboids that go on beyond their boxes: either the edge is measured badly, or the rest is hidden.

    The likelihood is a mixture: of a measured edge's, and of an even one over as far as something may hide the rest.
    """
    extent = np.tile(problems.box_px[:, 2:] - problems.box_px[:, :2], 2)
    reach = np.maximum(problems.hidden_px, settings.hidden_reach * extent)
    even = problems.hidden_odds * settings.hidden_density
    beyond = np.maximum(outward_px - reach, 0.0) / problems.edge_sigma_px
    cost = -2.0 * np.log((np.exp(-0.5 * seen**2) + even) / (1.0 + even))
    return np.sqrt(np.minimum(np.maximum(cost, 0.0) + 2 * settings.robust_beyond * beyond, seen**2))


def _footprint_overhang(boxes: Cuboids, problems: Problems, settings: CuboidFitSettings) -> Float[np.ndarray, "n 2"]:
    """Overhang of the base beyond its supporter, along the supporter's axes; its centre where it is larger."""
    x, y, yaw, half_depth, half_width = problems.footprint.T
    c, s = np.cos(yaw), np.sin(yaw)
    dx, dy = boxes.centre[:, 0] - x, boxes.centre[:, 1] - y
    offset = np.stack([c * dx + s * dy, -s * dx + c * dy], axis=-1)
    turn = boxes.yaw_rad - yaw
    along, across = np.abs(np.cos(turn)), np.abs(np.sin(turn))
    depth, width = boxes.size_m[:, 0], boxes.size_m[:, 1]
    reach = 0.5 * np.stack([along * depth + across * width, across * depth + along * width], axis=-1)
    room = np.maximum(np.stack([half_depth, half_width], axis=-1) - reach, settings.min_room_m)
    return np.maximum(np.abs(offset) - room, 0.0) / problems.footprint_sigma_m[:, None]


def _too_far(boxes: Cuboids, settings: CuboidFitSettings) -> Float[np.ndarray, "n 1"]:
    """Rooms rarely reach farther than `FAR_M`."""
    away = np.linalg.norm(boxes.centre[:, :2], axis=1)
    return (np.maximum(np.log(np.maximum(away, 1e-6) / settings.far_m), 0.0) / settings.far_log_sigma)[:, None]


def _off_depth(
    boxes: Cuboids, corners: Float[np.ndarray, "n 8 3"], problems: Problems, view: View, settings: CuboidFitSettings
) -> Float[np.ndarray, "n 1"]:
    """How far what is seen of the cuboid is from where a network sees it: before its centre, by how it is turned."""
    turn = boxes.yaw_rad - np.arctan2(view.heading[1], view.heading[0])
    shares = settings.seen_before_centre * np.abs(np.stack([np.cos(turn), np.sin(turn)], axis=-1))
    surface = corners[..., 2].mean(axis=1) - (shares * boxes.size_m[:, :2]).sum(axis=1)
    depth = np.maximum(surface, settings.cut_near_m)
    return _robust((np.log(depth) - problems.log_depth) / problems.depth_sigma, settings)[:, None]


def _off_wall(boxes: Cuboids, problems: Problems, settings: CuboidFitSettings) -> Float[np.ndarray, "n 1"]:
    """Whether the object's back lies in its wall, which is no nearer than the things that stand before it.

    A back that is nearer than its wall deviates by fewer sigmas than one behind.
    """
    front = np.stack([np.cos(boxes.yaw_rad), np.sin(boxes.yaw_rad)], axis=-1)
    back = (boxes.centre[:, :2] * front).sum(axis=1) - boxes.size_m[:, 0] / 2
    off, sigma = np.log(np.maximum(-back, settings.min_back_m) / problems.wall_m), problems.wall_sigma
    nearer = np.minimum(sigma, np.maximum(settings.wall_nearer_log_sigma, sigma / 5))
    return (off / np.where((off < 0) & (sigma < UNTOLD), nearer, sigma))[:, None]
