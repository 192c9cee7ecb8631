"""Where a photo was taken in a room that was measured without pictures: a scan of boxes.

There is nothing to match pixels with. But boxes of known places and kinds look alike from one place only: the camera
is the one from which they cover the boxes that are marked in the photo. Gravity and the focal length are read from the
photo; places and headings are tried all over the floor, and the best are refined.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.optimize import least_squares, linear_sum_assignment
from scipy.spatial.transform import Rotation
from shapely import contains_xy
from shapely.geometry import Polygon

from diorama_core.artefacts import CameraEstimate, CameraHypothesis
from diorama_core.geometry.projection import box_iou, cuboid_corners, visible_bounds
from diorama_core.library.taxonomy import UNKNOWN, broad
from diorama_core.multiview.joint_fit import NEAREST_M
from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.types import Camera, rigid, yaw_rotation


@dataclass(frozen=True)
class CameraInRoomSettings:
    """Where a camera is looked for, and what speaks for and against it."""

    step_m: float = 0.25
    """Distance of the places that are tried."""
    heights_m: tuple[float, ...] = (1.2, 1.6)
    headings: int = 24
    outside_m: float = 0.3
    """Distance beyond the walls at which a camera may be: in a doorway."""
    finalists: int = 16
    rounds: int = 3
    apart_m: float = 0.4
    """Hypotheses nearer than this, and turned by less than the next, are one."""
    apart_rad: float = 0.3
    height_m: float = 1.5
    """People hold cameras so high."""
    height_sigma_m: float = 0.35
    """Deviation of that height."""
    up_sigma: float = 0.03
    """Deviation of gravity as the photo tells it."""
    heading_sigma: float = 0.05
    """Deviation of the turn against the room's axes as the photo tells it (rad)."""
    focal_log_sigma: float = 0.05
    given_focal_log_sigma: float = 0.01
    cuboid_sigma: float = 0.05
    """Deviation of a thing's outline from its box's, as a share of its extent."""
    nameless: float = 0.5
    """Weight of a box that says nothing of its kind."""
    same: float = 0.35
    """Intersection over union of a box with a thing that is taken for it."""
    odd_cost: float = 8.0
    """Squared sigmas for a box without its thing, and for a thing in view without a box."""
    in_view: float = 0.03
    """Share of the picture from which a thing in it should have been marked."""
    min_same: int = 3
    """Things that must be met."""
    max_cost: float = 8.0
    """Most that a camera may cost for each of them: what costs more is another room."""


SETTINGS = CameraInRoomSettings()


@dataclass(frozen=True, eq=False)
class MeasuredThing:
    """A box of the room with a thing in it."""

    kinds: frozenset[str]
    """Categories that it may be of."""
    centre: Float[np.ndarray, "3"]
    """In the room: +Z up, the floor at 0."""
    yaw_rad: float
    size_m: Float[np.ndarray, "3"]


@dataclass(frozen=True, eq=False)
class FoundCamera:
    """A camera, and what speaks for and against it."""

    camera: Camera
    cost: float
    """Everything that speaks against it, in squared sigmas."""
    met: tuple[tuple[int, int], ...]
    """Things, by number, with the boxes that they are seen in."""


def camera_in_room(
    measured: Sequence[MeasuredThing],
    floor: Polygon,
    estimate: CameraEstimate,
    boxes: BoxObservations,
    progress: Progress = SILENT,
    *,
    focal_known: bool = False,
) -> FoundCamera | None:
    """The camera from which the things of a room cover the boxes of a photo; None where none does.

    Args:
        measured: with their places.
        floor: seen from above.
        estimate: gravity and intrinsics, as the photo tells them.
        boxes: marked in the photo.
        progress: reports and cancellation.
        focal_known: whether the focal length was given.
    """
    if min(len(measured), len(boxes)) < SETTINGS.min_same:
        return None
    search = _Search(measured, boxes, estimate.best, focal_known)
    finalists = search.finalists(floor, progress)
    cameras = []
    for number, camera in enumerate(finalists):
        progress.report(0.4 + 0.6 * number / len(finalists), "finding where the photo was taken")
        cameras.append(search.fit(camera, floor.buffer(SETTINGS.outside_m)))
    best = min(cameras, key=lambda fit: fit.cost)
    return best if len(best.met) >= SETTINGS.min_same and best.cost <= SETTINGS.max_cost * len(best.met) else None


class _Search:
    """Boxes of a photo against the things of a room."""

    def __init__(
        self,
        measured: Sequence[MeasuredThing],
        boxes: BoxObservations,
        reading: CameraHypothesis,
        focal_known: bool,
    ) -> None:
        self._boxes, self._k = boxes, reading.intrinsics
        self._focal_sigma = SETTINGS.given_focal_log_sigma if focal_known else SETTINGS.focal_log_sigma
        self._R_level = reading.R_world_camera
        self._corners = cuboid_corners(
            np.array([t.centre for t in measured]),
            np.array([t.yaw_rad for t in measured]),
            np.array([t.size_m for t in measured]),
        )
        kinds = [frozenset(broad(kind) for kind in t.kinds) for t in measured]
        same = np.array([[broad(c.name) in of_thing for c in boxes.categories] for of_thing in kinds])
        nameless = np.array([c is UNKNOWN for c in boxes.categories])
        self._could_be_met = int(same.any(axis=0).sum())
        self._weight = np.where(same, 1.0, np.where(nameless, SETTINGS.nameless, 0.0))
        self._things = measured
        extent = np.tile(boxes.box_px[:, 2:] - boxes.box_px[:, :2], 2)
        self._sigma = np.hypot(boxes.edge_sigma_px, SETTINGS.cuboid_sigma * extent)
        self._short = np.array([boxes.is_hidden(i) for i in range(len(boxes))]).reshape(-1, 4) | boxes.truncated

    def finalists(self, floor: Polygon, progress: Progress) -> list[Camera]:
        """The best of all places on the floor and all headings, no two of them alike."""
        x0, y0, x1, y1 = floor.buffer(SETTINGS.outside_m).bounds
        x, y = (np.arange(*ends, SETTINGS.step_m) for ends in ((x0, x1), (y0, y1)))
        plan = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        plan = plan[contains_xy(floor.buffer(SETTINGS.outside_m), plan[:, 0], plan[:, 1])]
        places = np.vstack([np.column_stack([plan, np.full(len(plan), z)]) for z in SETTINGS.heights_m])
        rows: list[tuple[float, int, int]] = []
        count = SETTINGS.headings
        for heading in range(count):
            progress.report(0.4 * heading / count, "looking for where the photo was taken")
            score = self._scores(places, self._heading_rotation(heading))
            best = np.argsort(-score, kind="stable")[: 4 * SETTINGS.finalists]
            rows += [(float(score[k]), heading, int(k)) for k in best]
        chosen: list[tuple[int, int]] = []
        for _, heading, k in sorted(rows, key=lambda row: (-row[0], row[1:])):
            if not any(self._alike(places, (heading, k), other) for other in chosen):
                chosen.append((heading, k))
            if len(chosen) == SETTINGS.finalists:
                break
        return [Camera(self._k, rigid(self._heading_rotation(heading), places[k])) for heading, k in chosen]

    def _alike(self, places: Float[np.ndarray, "p 3"], a: tuple[int, int], b: tuple[int, int]) -> bool:
        count = SETTINGS.headings
        turn = abs((a[0] - b[0] + count // 2) % count - count // 2) * 2 * np.pi / count
        apart = np.linalg.norm(places[a[1], :2] - places[b[1], :2])
        return bool(apart < SETTINGS.apart_m and turn < SETTINGS.apart_rad)

    def _heading_rotation(self, heading: int) -> Float[np.ndarray, "3 3"]:
        return yaw_rotation(2 * np.pi * heading / SETTINGS.headings) @ self._R_level

    def _scores(self, places: Float[np.ndarray, "p 3"], R: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "p"]:
        """How well boxes are covered from each place, roughly: what is behind the camera counts as very near."""
        local = (self._corners[None] - places[:, None, None]) @ R
        z = np.maximum(local[..., 2], NEAREST_M)
        k = self._k
        u = np.clip(local[..., 0] / z * k.fx + k.cx, 0, k.width)
        v = np.clip(local[..., 1] / z * k.fy + k.cy, 0, k.height)
        bounds = np.stack([u.min(-1), v.min(-1), u.max(-1), v.max(-1)], axis=-1)
        bounds[(local[..., 2] < NEAREST_M).all(axis=-1)] = 0.0
        shared = self._weight * box_iou(bounds[:, :, None], self._boxes.box_px[None, None])
        return np.minimum(shared.max(axis=1).sum(axis=1), shared.max(axis=2).sum(axis=1))

    def fit(self, camera: Camera, room: Polygon) -> FoundCamera:
        """Fit the camera so that its things fill the boxes that are theirs."""
        pairs, cost = self._pairs(camera), np.inf
        for _ in range(SETTINGS.rounds):
            if len(pairs) < SETTINGS.min_same:
                break
            camera, cost = self._refine(camera, pairs)
            before, pairs = pairs, self._pairs(camera)
            if pairs == before:
                break
        shared = self._cuboid_box_iou(camera)
        met = tuple((thing, box) for thing, box in pairs if shared[thing, box] >= SETTINGS.same)
        odd = max(self._could_be_met - len(met), 0) + self._count_unmarked(camera, {thing for thing, _ in pairs})
        if not contains_xy(room, *camera.position[:2]) or self._is_inside_object(camera):
            cost = np.inf
        return FoundCamera(camera, cost + SETTINGS.odd_cost * odd, met)

    def _count_unmarked(self, camera: Camera, marked: set[int]) -> int:
        """How many things that nothing hides are in view without a box."""
        bounds, visible = self._bounds(camera)
        area = (bounds[:, 2:] - bounds[:, :2]).prod(axis=1)
        away = np.array([np.linalg.norm(t.centre - camera.position) for t in self._things])
        count = 0
        for k in np.flatnonzero(visible & (area > SETTINGS.in_view * self._k.width * self._k.height)):
            nearer = bounds[visible & (away < away[k])]
            common = np.clip(
                np.minimum(nearer[:, 2:], bounds[k, 2:]) - np.maximum(nearer[:, :2], bounds[k, :2]), 0.0, None
            ).prod(axis=1)
            count += int(k not in marked and common.max(initial=0.0) < area[k] / 2)
        return count

    def _is_inside_object(self, camera: Camera) -> bool:
        away = [yaw_rotation(-t.yaw_rad) @ (camera.position - t.centre) for t in self._things]
        return any((np.abs(a) < t.size_m / 2).all() for a, t in zip(away, self._things, strict=True))

    def _pairs(self, camera: Camera) -> list[tuple[int, int]]:
        shared = self._cuboid_box_iou(camera)
        rows, columns = linear_sum_assignment(-shared)
        return [(int(r), int(c)) for r, c in zip(rows, columns, strict=True) if shared[r, c] > 0.1]

    def _cuboid_box_iou(self, camera: Camera) -> Float[np.ndarray, "t b"]:
        bounds, visible = self._bounds(camera)
        seen = self._boxes.box_px
        low, high = np.maximum(bounds[:, None], seen), np.minimum(bounds[:, None], seen)
        cut = np.where([True, True, False, False], low, high)
        shown = np.where(self._short[None], cut, bounds[:, None])
        shown[..., 2:] = np.maximum(shown[..., 2:], shown[..., :2])
        iou = box_iou(shown, np.broadcast_to(seen, shown.shape))
        return np.where(visible[:, None], self._weight * iou, 0.0)

    def _bounds(self, camera: Camera) -> tuple[Float[np.ndarray, "t 4"], Bool[np.ndarray, "t"]]:
        return visible_bounds(camera.to_camera(self._corners), camera.intrinsics)

    def _refine(self, camera: Camera, pairs: Sequence[tuple[int, int]]) -> tuple[Camera, float]:
        """Least squares over turn, place and focal length, robust against boxes that are of something else."""
        cuboids, boxes = (np.array(side) for side in zip(*pairs, strict=True))
        seen, sigma, short = self._boxes.box_px[boxes], self._sigma[boxes], self._short[boxes]
        outward = np.array([-1.0, -1.0, 1.0, 1.0])

        def move(unknowns: Float[np.ndarray, "7"]) -> Camera:
            T = camera.T_world_camera.copy()
            T[:3, :3] = T[:3, :3] @ Rotation.from_rotvec(unknowns[:3]).as_matrix()
            T[:3, 3] += unknowns[3:6]
            k, factor = self._k, float(np.exp(unknowns[6]))
            return Camera(replace(k, fx=k.fx * factor, fy=k.fy * factor), T)

        def off(unknowns: Float[np.ndarray, "7"]) -> Float[np.ndarray, "r"]:
            moved_camera = move(unknowns)
            bounds, _ = visible_bounds(moved_camera.to_camera(self._corners[cuboids]), moved_camera.intrinsics)
            beyond = (bounds - seen) * outward / sigma
            edges = np.where(short, np.minimum(beyond, 0.0), beyond)
            tilt = (moved_camera.T_world_camera[2, :3] - self._R_level[2]) / SETTINGS.up_sigma
            turn = moved_camera.T_world_camera[:3, :3] @ self._R_level.T
            # 0 at every quarter turn.
            heading = np.sin(2 * np.arctan2(turn[1, 0], turn[0, 0])) / 2 / SETTINGS.heading_sigma
            height = (moved_camera.position[2] - SETTINGS.height_m) / SETTINGS.height_sigma_m
            return np.concatenate([edges.ravel(), tilt, [heading, height, unknowns[6] / self._focal_sigma]])

        start = np.zeros(7)
        start[6] = float(np.log(camera.intrinsics.fx / self._k.fx))
        best = least_squares(off, start, loss="soft_l1", max_nfev=25)
        return move(best.x), 2.0 * float(best.cost)
