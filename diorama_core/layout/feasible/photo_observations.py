"""The picture's say: an object that its support moved is put back under the outline that the camera saw.

The observed pose is where masks and depth put an object, so the bounds of its parts in the picture and its distance
along the viewing ray are the evidence. What structure leaves free (two coordinates on the support, three scales within
limits) is fitted to them by Gauss-Newton, in metres at the object's distance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.arrangement.surfaces import box_misfit
from diorama_core.artefacts import PhotoDisagreement
from diorama_core.geometry.projection import box_iou
from diorama_core.layout.feasible.object_fit import ObjectFit, solve_bounded_step
from diorama_core.layout.feasible.visible_points import (
    TrackedPoints,
    VisiblePoints,
    select_tracked_points,
    turn_points,
)
from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.settings import LayoutSettings
from diorama_core.scene.types import Camera, box_corners


@dataclass(frozen=True, eq=False)
class PhotoObservations:
    """What the camera saw of every object, in its own frame's terms."""

    camera: Camera
    bounds_px: Float[np.ndarray, "n 4"]
    """x1, y1, x2, y2 of each object in the picture, not cut at its border; NaN for those behind the camera."""
    hidden: Bool[np.ndarray, "n 4"]
    """Bounds beyond which the object may go on, because something hides the rest or the picture ends."""
    observed: Float[np.ndarray, "n 3"]
    """Observed centres, world."""
    least: Float[np.ndarray, "n 3"]
    most: Float[np.ndarray, "n 3"]
    """Limits of the scales."""
    depth_weight: float
    """How much a metre along the viewing ray counts against a metre across: high where depth was measured."""
    loads: tuple[Float[np.ndarray, "_ 2"], ...]
    """What was observed on each object: height of its place at scale 1 (object frame), and of its foot (world)."""
    size: Float[np.ndarray, "n 3"]
    """Extents at scale 1."""
    points: tuple[Float[np.ndarray, "_ 3"], ...]
    """Outline points of each shape at scale 1, object frame."""
    tracked: tuple[TrackedPoints, ...]
    """Points of each object and where the camera saw them."""
    R: Float[np.ndarray, "n 3 3"]
    """Observed rotations."""
    contradicted: Bool[np.ndarray, " n"]
    """Objects whose posed shape is not where the photo's box is."""
    measured: Bool[np.ndarray, " n"]
    """Objects at measured places that are still where the photo shows them; a person may have put others anywhere."""
    settings: LayoutSettings

    def limit_sizes(self, scale: Float[np.ndarray, "n 3"]) -> PhotoObservations:
        """These observations with nothing larger than it is now where it has been made smaller."""
        smaller = scale < 0.999 * self.most / self.settings.max_stretch
        return replace(self, most=np.where(smaller, scale, self.most), least=np.minimum(self.least, scale))

    def no_larger(self, i: int, scale: Float[np.ndarray, "3"]) -> PhotoObservations:
        """These observations with one object no larger than this."""
        if not np.isfinite(scale).any():
            return self
        most, least = self.most.copy(), self.least.copy()
        most[i] = np.minimum(most[i], scale)
        least[i] = np.minimum(least[i], most[i])
        return replace(self, most=most, least=least)

    def fix_heights(self, members: Int[np.ndarray, " m"], scale: Float[np.ndarray, " n"]) -> PhotoObservations:
        """These observations with the heights of some objects decided: the scales of all along their own up axes."""
        least, most = self.least.copy(), self.most.copy()
        least[members, 2] = most[members, 2] = scale[members]
        return replace(self, least=least, most=most)

    def no_smaller(self, scale: Float[np.ndarray, "n 3"], extents: Bool[np.ndarray, "n 3"]) -> PhotoObservations:
        """These observations with some extents no smaller than they are."""
        least = np.where(extents, np.maximum(self.least, scale), self.least)
        return replace(self, least=least, most=np.maximum(self.most, least))

    def replace_objects(self, members: Int[np.ndarray, " m"], other: PhotoObservations) -> PhotoObservations:
        """These observations with some objects as others have them, but for what decided their heights."""

        def rows(values: np.ndarray, theirs: np.ndarray) -> np.ndarray:
            changed = values.copy()
            changed[members] = theirs[members]
            return changed

        least, most = rows(self.least, other.least), rows(self.most, other.most)
        least[:, 2], most[:, 2] = self.least[:, 2], self.most[:, 2]
        return replace(
            self,
            bounds_px=rows(self.bounds_px, other.bounds_px),
            hidden=rows(self.hidden, other.hidden),
            observed=rows(self.observed, other.observed),
            least=least,
            most=most,
            loads=tuple(other.loads[i] if i in members else tracked for i, tracked in enumerate(self.loads)),
            tracked=tuple(other.tracked[i] if i in members else tracked for i, tracked in enumerate(self.tracked)),
            contradicted=rows(self.contradicted, other.contradicted),
        )

    def fit_centre_and_scale(
        self,
        i: int,
        R: Float[np.ndarray, "3 3"],
        p: Float[np.ndarray, "3"],
        scale: Float[np.ndarray, "3"],
        basis: Float[np.ndarray, "3 2"],
        pinned: Float[np.ndarray, "3"],
        grown: float = 1.0,
    ) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
        """Centre and scale of object i that agree best with the picture.

        Args:
            i: index of the object.
            R: its settled rotation.
            p: its settled centre.
            scale: its settled scale.
            basis: world directions in which it may still move.
            pinned: point of its box, in half extents, that touches supports and walls and stays put when it is resized.
            grown: what its distance and its size were multiplied by already.
        """
        settled = not self.contradicted[i] and np.linalg.norm(p - self.observed[i]) < self.settings.moved_m
        if settled or not len(self.tracked[i].points):
            return p, scale
        fit = self._object_fit(i, R, p, scale, basis, pinned, grown)
        low, high = np.log(grown * self.least[i] / scale), np.log(grown * self.most[i] / scale)
        x = np.zeros(5)
        for _ in range(self.settings.fit_steps):
            system = fit.linearise(x)
            if system is None:
                return p, scale
            x = x + solve_bounded_step(*system, low - x[2:], high - x[2:])
        return fit.centre(x), fit.scale * np.exp(x[2:])

    def _object_fit(
        self,
        i: int,
        R: np.ndarray,
        p: np.ndarray,
        scale: np.ndarray,
        basis: np.ndarray,
        pinned: np.ndarray,
        grown: float = 1.0,
    ) -> ObjectFit:
        """The least-squares problem of one object; arguments as in `fit_centre_and_scale`."""
        local = pinned * self.size[i] / 2
        observed = self.camera.position + grown * (self.observed[i] - self.camera.position)
        tracked = self.tracked[i]
        return ObjectFit(
            camera=self.camera,
            bounds_px=self.bounds_px[i],
            hidden=self.hidden[i],
            loads=self._scale_loads(i, grown),
            observed=observed,
            depth_weight=self.depth_weight,
            R=R,
            anchor=p + R @ (local * scale),
            anchor_local=local,
            arms=self.points[i] - local,
            tracked=tracked,
            tracked_arms=turn_points(tracked.points, self.size[i], self.R[i], R) - local,
            surface_measured=bool(self.measured[i]) and tracked.seen,
            scale=scale,
            basis=basis,
            metres=float(self.camera.to_camera(observed)[2]) / self.camera.intrinsics.fx,
            extents=self.size[i] * scale,
            settings=self.settings,
        )

    def _scale_loads(self, i: int, grown: float) -> Float[np.ndarray, "m 2"]:
        level, foot = self.loads[i].T
        eye = float(self.camera.position[2])
        return np.column_stack([level, eye + grown * (foot - eye)])


def photo_observations(
    problem: Problem,
    camera: Camera,
    *,
    depth_weight: float,
    measured: bool = False,
    boxes: bool = True,
    visible: VisiblePoints = MappingProxyType({}),
) -> PhotoObservations:
    """What the camera sees of the observed layout.

    Args:
        problem: the observed layout.
        camera: what looks at it.
        depth_weight: how much a metre along the viewing ray counts against a metre across.
        measured: whether distances were measured, or only reasoned.
        boxes: whether the photo's boxes say more of where objects are than their poses; not of a scene that a person
            or a layout has left as it is.
        visible: points of the objects that are seen.
    """
    points = _outline_points(problem)
    posed = _project_all_bounds_px(problem, camera)
    bounds, hidden = _select_bounds_px(problem, camera, posed)
    if measured or not boxes:  # masks and depth, to which shapes were fitted, say more than boxes
        bounds = posed
    return PhotoObservations(
        camera=camera,
        bounds_px=bounds,
        hidden=hidden,
        observed=problem.p,
        least=problem.scale / problem.settings.max_stretch,
        most=problem.scale * problem.settings.max_stretch,
        depth_weight=depth_weight,
        loads=tuple(_loads(problem, i) for i in range(problem.count)),
        size=problem.shape_size,
        points=points,
        tracked=select_tracked_points(problem, camera, posed, bounds, visible),
        R=problem.R,
        contradicted=(np.abs(posed - bounds) > 0.0).any(axis=1),
        measured=_agrees(problem, camera) & measured,
        settings=problem.settings,
    )


def _loads(problem: Problem, i: int) -> Float[np.ndarray, "m 2"]:
    """Height of the place (at scale 1) and of the foot of everything that was observed on a place of an object."""
    loads = []
    for k in np.flatnonzero(problem.parent == i):
        size = problem.shape_size[k] * problem.scale[k]
        corners = problem.p[k] + box_corners(size) @ problem.R[k].T
        flat = [s for s in problem.levels[k] if float(s.normal[2]) > problem.settings.upward]
        posed = [s.transform(problem.R[i], problem.p[i], problem.scale[i]) for s in flat]
        if posed and problem.firm[k] == 1.0:
            nearest = int(np.argmin([box_misfit(corners, size, s) for s in posed]))
            foot = float(corners[:, 2].min())
            if abs(foot - posed[nearest].level) <= problem.settings.load_m:
                loads.append((flat[nearest].level, foot))
    return np.array(loads).reshape(-1, 2)


def _outline_points(problem: Problem) -> tuple[Float[np.ndarray, "_ 3"], ...]:
    packed = problem.packed
    return tuple(np.unique(packed.vertices[packed.owner == i].reshape(-1, 3), axis=0) for i in range(problem.count))


def _outlines_world(problem: Problem) -> list[Float[np.ndarray, "_ 3"]]:
    points, poses = _outline_points(problem), zip(problem.R, problem.p, problem.scale, strict=True)
    return [(own * scale) @ R.T + p for own, (R, p, scale) in zip(points, poses, strict=True)]


def _project_all_bounds_px(problem: Problem, camera: Camera) -> Float[np.ndarray, "n 4"]:
    """Bounds of each posed shape in the picture, not cut at its border; NaN for those behind the camera."""
    bounds = np.full((problem.count, 4), np.nan)
    for i, world in enumerate(_outlines_world(problem)):
        if camera.to_camera(world)[:, 2].min() >= problem.settings.nearest_m:
            flat = camera.project(world)
            bounds[i] = [*flat.min(axis=0), *flat.max(axis=0)]
    return bounds


def _bounds_in_picture_px(problem: Problem, camera: Camera) -> Float[np.ndarray, "n 4"]:
    """Bounds of what the picture shows of each posed shape, cut at its border; NaN for those outside it."""
    k, bounds = camera.intrinsics, np.full((problem.count, 4), np.nan)
    for i, world in enumerate(_outlines_world(problem)):
        flat = camera.project(world[camera.to_camera(world)[:, 2] >= problem.settings.nearest_m])
        if len(flat):
            bounds[i] = np.clip([*flat.min(axis=0), *flat.max(axis=0)], 0, [k.width, k.height] * 2)
    return bounds


def _select_bounds_px(
    problem: Problem, camera: Camera, posed: Float[np.ndarray, "n 4"]
) -> tuple[Float[np.ndarray, "n 4"], Bool[np.ndarray, "n 4"]]:
    """The bounds of every object in the picture, and which of them are least bounds because the rest is hidden.

    The photo's boxes count for poses that agree with them; elsewhere, where a person may have put the object, the posed
    shape says where it is.
    """
    boxes = problem.box_px
    agrees = _agrees(problem, camera)
    hidden = _find_hidden_sides(problem, camera) & agrees[:, None]
    extent = np.tile(boxes[:, 2:] - boxes[:, :2], (1, 2))
    contradicted = np.abs(posed - boxes) > problem.settings.different * extent + problem.settings.border_px
    return np.where(agrees[:, None] & contradicted & ~hidden, boxes, posed), hidden


def _agrees(problem: Problem, camera: Camera) -> Bool[np.ndarray, " n"]:
    posed, least = _bounds_in_picture_px(problem, camera), problem.settings.same_place
    return np.array([bool(box_iou(a, b) >= least) for a, b in zip(posed, problem.box_px)], dtype=bool).reshape(-1)


def _find_hidden_sides(problem: Problem, camera: Camera) -> Bool[np.ndarray, "n 4"]:
    """Which sides of the photo's boxes are on its border or behind the boxes of nearer objects.

    What an object stands on does not hide its foot, what stands on it does not hide its top, and a rug hides nothing.
    """
    k, boxes = camera.intrinsics, problem.box_px
    border = problem.settings.border_px
    hidden = np.column_stack([boxes[:, :2] <= border, boxes[:, 2:] >= np.array([k.width, k.height]) - border])
    depth = camera.to_camera(problem.p)[:, 2]
    for i in range(problem.count):
        nearer = (depth < depth[i]) & ~problem.yielding[i]
        nearer[problem.chain(i)] = False
        loads = np.isin(np.arange(problem.count), problem.rides(i))
        ends = boxes[i].reshape(2, 2)
        for side in range(4):
            axis, along = side % 2, 1 - side % 2
            before = boxes[nearer & ~loads] if side == 1 else boxes[nearer]
            across = (before[:, axis] <= boxes[i, side]) & (boxes[i, side] <= before[:, axis + 2])
            low = np.maximum(before[:, along], ends[0, along])
            high = np.minimum(before[:, along + 2], ends[1, along])
            covered = np.where(across, np.maximum(high - low, 0.0), 0.0).max(initial=0.0)
            hidden[i, side] |= bool(covered > problem.settings.covered * (ends[1, along] - ends[0, along]))
    return hidden


def disagreements(observed: Problem, now: Problem, camera: Camera) -> tuple[PhotoDisagreement, ...]:
    """The free objects that a layout took clearly away from where the camera saw them."""
    before, after = (_project_all_bounds_px(layout, camera) for layout in (observed, now))
    rows = []
    for i in np.flatnonzero(now.free):
        moved = float(np.linalg.norm(now.p[i] - observed.p[i]))
        shared = float(box_iou(before[i], after[i])) if np.isfinite([before[i], after[i]]).all() else 1.0
        if moved > now.settings.named_move_m or shared < now.settings.named_outline:
            rows.append(PhotoDisagreement(now.ids[i], now.labels[i], moved, shared))
    return tuple(rows)
