"""Upright oriented boxes around an object's measured points, completed where it is hidden."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float

from diorama_core.artefacts import Cuboid
from diorama_core.library.taxonomy import Category
from diorama_core.scene.types import yaw_rotation

MIN_SIZE_M = 0.02


@dataclass(frozen=True)
class MeasuredBoxSettings:
    """How boxes are fitted to measured points."""

    manhattan_gain: float = 0.85
    """A box turned away from the room's axes must have less than this share of the straight box's area."""
    free_gain: float = 0.93
    """For objects that often stand askew."""
    short_of_usual: float = 0.6
    """A depth below this share of the usual one means that only the front was seen."""
    top_layer_m: float = 0.03
    edge_quantile: float = 0.01


SETTINGS = MeasuredBoxSettings()


@dataclass(frozen=True)
class TurnedExtent:
    """A box before its front is chosen: axes turned by `yaw_rad`, bounds along them in the world's origin."""

    yaw_rad: float
    low: Float[np.ndarray, "3"]
    high: Float[np.ndarray, "3"]

    @property
    def size(self) -> Float[np.ndarray, "3"]:
        """Along the turned x and y, and up."""
        return np.maximum(self.high - self.low, MIN_SIZE_M)

    @property
    def centre_world(self) -> Float[np.ndarray, "3"]:
        """Middle of the box."""
        return yaw_rotation(self.yaw_rad) @ (0.5 * (self.low + self.high))


def fit_extent(points: Float[np.ndarray, "n 3"], category: Category) -> TurnedExtent:
    """The box around the points: along the room's axes unless a turned one is clearly tighter."""
    flat = points[:, :2].astype(np.float32)
    angle = float(np.deg2rad(cv2.minAreaRect(flat)[2]))
    turned = (angle + np.pi / 4) % (np.pi / 2) - np.pi / 4
    straight, other = _bounds(points, 0.0), _bounds(points, turned)
    gain = SETTINGS.free_gain if category.quarter_turns_free else SETTINGS.manhattan_gain
    area, other_area = float(np.prod(straight.size[:2])), float(np.prod(other.size[:2]))
    return other if other_area < gain * area else straight


def _bounds(points: Float[np.ndarray, "n 3"], yaw_rad: float) -> TurnedExtent:
    local = points @ yaw_rotation(yaw_rad)
    low, high = np.quantile(local, [SETTINGS.edge_quantile, 1.0 - SETTINGS.edge_quantile], axis=0)
    return TurnedExtent(yaw_rad, low, high)


def complete_extent(
    extent: TurnedExtent,
    category: Category,
    camera_position: Float[np.ndarray, "3"],
    cut_off: Bool[np.ndarray, "3"],
    background: Float[np.ndarray, "m 3"],
    points: Float[np.ndarray, "n 3"],
) -> TurnedExtent:
    """The box with its unseen back, and what the picture's sides cut off, added from the category's usual size.

    Args:
        extent: Around what was seen.
        category: Its usual sizes.
        camera_position: World.
        cut_off: Whether the mask touches the picture's left, right and upper side.
        background: World points seen around the object; it does not reach through them.
        points: World points of the object; a top that is seen tells the extents.
    """
    R = yaw_rotation(extent.yaw_rad)
    eye = camera_position @ R
    low, high = extent.low.copy(), extent.high.copy()
    away = 0.5 * (low + high)[:2] - eye[:2]
    usual = usual_plan(extent.size, category)
    behind = background @ R
    top_seen = _top_seen(points @ R, extent)
    for axis in (0, 1):
        facing = abs(away[axis]) / max(float(np.linalg.norm(away)), 1e-9)
        unseen_back = bool(
            facing > 0.5 and not top_seen[axis] and extent.size[axis] < SETTINGS.short_of_usual * usual[axis]
        )
        side_cut = facing <= 0.7 and cut_off[:2].any() and extent.size[axis] < usual[axis]
        if not unseen_back and not side_cut:
            continue
        outward = _outward(axis, away, cut_off, R, unseen_back)
        missing = usual[axis] - extent.size[axis]
        room = _free_room(behind, low, high, axis, outward) if unseen_back else missing
        if outward > 0:
            high[axis] += min(missing, room)
        else:
            low[axis] -= min(missing, room)
    if cut_off[2]:
        high[2] = max(high[2], category.priors[0].height_m)
    return TurnedExtent(extent.yaw_rad, low, high)


def _top_seen(local: Float[np.ndarray, "n 3"], extent: TurnedExtent) -> Bool[np.ndarray, "2"]:
    """Along which axes the object's flat top is seen nearly from end to end."""
    top = local[local[:, 2] > extent.high[2] - SETTINGS.top_layer_m]
    if len(top) < 20:
        return np.zeros(2, dtype=bool)
    span = np.ptp(np.quantile(top[:, :2], [0.02, 0.98], axis=0), axis=0)
    return (span > 0.7 * extent.size[:2]) & (span > 3.0 * SETTINGS.top_layer_m)


def _outward(
    axis: int, away: Float[np.ndarray, "2"], cut_off: Bool[np.ndarray, "3"], R: Float[np.ndarray, "3 3"], back: bool
) -> float:
    """Which way along an axis the hidden part lies: away from the camera, or out of the picture."""
    if back:
        return float(np.sign(away[axis]))
    line_of_sight = R[:2, :2] @ away
    right = np.array([line_of_sight[1], -line_of_sight[0]])
    leans_right = float(np.sign(R[:2, axis] @ right)) or 1.0
    return leans_right if cut_off[1] else -leans_right


def _free_room(
    behind: Float[np.ndarray, "m 3"], low: Float[np.ndarray, "3"], high: Float[np.ndarray, "3"], axis: int, way: float
) -> float:
    """How far a box may grow along an axis before it meets what is seen around the object."""
    if len(behind) == 0:
        return np.inf
    gaps = behind[:, axis] - high[axis] if way > 0 else low[axis] - behind[:, axis]
    upper = behind[:, 2] > low[2] + 0.1
    gaps = gaps[(gaps > 0) & upper]
    return float(np.quantile(gaps, 0.5)) if len(gaps) >= 20 else np.inf


def usual_plan(size: Float[np.ndarray, "3"], category: Category) -> Float[np.ndarray, "2"]:
    """Usual extents along the box's x and y: depth and width in the order that fits what was seen better."""
    prior = category.priors[0]
    plans = np.array([[prior.depth_m, prior.width_m], [prior.width_m, prior.depth_m]])
    shortfall = np.log(np.maximum(size[:2], MIN_SIZE_M) / plans)
    misfit = np.where(shortfall > 0, 3.0 * shortfall, -shortfall).sum(axis=1)
    return plans[int(misfit.argmin())]


def to_cuboid(
    object_id: str, extent: TurnedExtent, category: Category, camera_position: Float[np.ndarray, "3"], confidence: float
) -> Cuboid:
    """The cuboid with +X its likely front: the wide side that looks to the camera, where width and depth tell.

    Args:
        object_id: of the result.
        extent: the measured box, turned about the world's up axis (m).
        category: whose usual sizes tell width from depth.
        camera_position: in the world (m).
        confidence: of the result, 0 to 1.
    """
    prior = category.priors[0]
    size = extent.size
    usual, sigma = np.array([prior.depth_m, prior.width_m]), np.array([prior.sigma_depth, prior.sigma_width])
    fits = [float((np.abs(np.log(plan / usual)) / sigma).sum()) for plan in (size[:2], size[1::-1])]
    toward = camera_position[:2] - extent.centre_world[:2]
    toward /= max(float(np.linalg.norm(toward)), 1e-9)
    best, best_cost = 0, np.inf
    for quarter in range(4):
        front = yaw_rotation(extent.yaw_rad + quarter * np.pi / 2)[:2, 0]
        cost = min(fits[quarter % 2], 4.0) - 1.5 * float(front @ toward)
        if cost < best_cost - 1e-9:
            best, best_cost = quarter, cost
    turned = size if best % 2 == 0 else size[[1, 0, 2]]
    R = yaw_rotation(extent.yaw_rad + best * np.pi / 2)
    return Cuboid(object_id, R, extent.centre_world, turned, confidence)
