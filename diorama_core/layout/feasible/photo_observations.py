"""The picture's say: an object that its support moved is put back under the outline that the camera saw.

The observed pose is where masks and depth put an object, so the bounds of its parts in the picture and its distance
along the viewing ray are the evidence. What structure leaves free (two coordinates on the support, three scales within
limits) is fitted to them by Gauss-Newton, in metres at the object's distance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.projection import box_iou
from diorama_core.layout.problem.problem import Problem
from diorama_core.scene.types import Camera

MOVED_M = 2e-3
"""Objects that structure moved less than this already agree: a settled layout stays as it is, and so does what a person
arranged."""
MAX_STRETCH = 1.2
"""Sizes change by at most this factor either way."""
FAR_M = 0.2
"""Objects that a layout moves farther are named,"""
SHARED_OUTLINE = 0.6
"""and those whose outline shares less than this with the observed one (intersection over union of bounds)."""
_NEAREST_M = 0.1
_STEPS = 4
_KEEP_PLACE = 0.1
"""Weight of staying where structure put an object, against one metre of disagreement with the picture."""
_KEEP_SIZE = 0.4
"""Weight of a relative change of size, times the extent."""
_KEEP_SHAPE = 0.4
"""Weight of a relative change of one extent against the others, times the extent."""


@dataclass(frozen=True, eq=False)
class PhotoObservations:
    """What the camera saw of every object, in its own frame's terms."""

    camera: Camera
    bounds_px: Float[np.ndarray, "n 4"]
    """x1, y1, x2, y2 of each object's parts in the picture, not cut at its border; NaN for those behind the camera."""
    observed: Float[np.ndarray, "n 3"]
    """Observed centres, world."""
    least: Float[np.ndarray, "n 3"]
    most: Float[np.ndarray, "n 3"]
    """Limits of the scales."""
    depth_weight: float
    """How much a metre along the viewing ray counts against a metre across: high where depth was measured."""
    size: Float[np.ndarray, "n 3"]
    """Extents at scale 1."""
    points: tuple[Float[np.ndarray, "_ 3"], ...]
    """Outline points of each shape at scale 1, object frame."""

    def limited(self, scale: Float[np.ndarray, "n 3"]) -> PhotoObservations:
        """The same with nothing larger than it is now where it has been made smaller."""
        smaller = scale < 0.999 * self.most / MAX_STRETCH
        return replace(self, most=np.where(smaller, scale, self.most), least=np.minimum(self.least, scale))

    def fitted(
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
        if not np.isfinite(self.bounds_px[i]).all() or np.linalg.norm(p - self.observed[i]) < MOVED_M:
            return p, scale
        fit = self.fit(i, R, p, scale, basis, pinned, grown)
        low, high = np.log(grown * self.least[i] / scale), np.log(grown * self.most[i] / scale)
        x = np.zeros(5)
        for _ in range(_STEPS):
            system = fit.linearised(x)
            if system is None:
                return p, scale
            x = x + _bounded_step(*system, low - x[2:], high - x[2:])
        return fit.centre(x), fit.scale * np.exp(x[2:])

    def fit(
        self,
        i: int,
        R: np.ndarray,
        p: np.ndarray,
        scale: np.ndarray,
        basis: np.ndarray,
        pinned: np.ndarray,
        grown: float = 1.0,
    ) -> ObjectFit:
        """The least-squares problem of one object; arguments as in `fitted`."""
        local = pinned * self.size[i] / 2
        observed = self.camera.position + grown * (self.observed[i] - self.camera.position)
        return ObjectFit(
            camera=self.camera,
            bounds_px=self.bounds_px[i],
            observed=observed,
            depth_weight=self.depth_weight,
            R=R,
            anchor=p + R @ (local * scale),
            anchor_local=local,
            arms=self.points[i] - local,
            scale=scale,
            basis=basis,
            metres=float(self.camera.to_camera(observed)[2]) / self.camera.intrinsics.fx,
            extent=float((self.size[i] * scale).max()),
        )


@dataclass(frozen=True, eq=False)
class ObjectFit:
    """One object's outline and distance as a function of x: its two coordinates and the logarithms of three scales."""

    camera: Camera
    bounds_px: Float[np.ndarray, "4"]
    observed: Float[np.ndarray, "3"]
    depth_weight: float
    R: Float[np.ndarray, "3 3"]
    anchor: Float[np.ndarray, "3"]
    """World point that stays put when the object is resized."""
    anchor_local: Float[np.ndarray, "3"]
    """The same at scale 1, object frame."""
    arms: Float[np.ndarray, "v 3"]
    """Outline points from the anchor, at scale 1."""
    scale: Float[np.ndarray, "3"]
    basis: Float[np.ndarray, "3 2"]
    metres: float
    """What a pixel is at the object's distance."""
    extent: float

    def centre(self, x: Float[np.ndarray, "5"]) -> Float[np.ndarray, "3"]:
        """Where the object's centre is."""
        return self.anchor + self.basis @ x[:2] - self.R @ (self.anchor_local * self.scale * np.exp(x[2:]))

    def linearised(self, x: Float[np.ndarray, "5"]) -> tuple[Float[np.ndarray, "r 5"], Float[np.ndarray, " r"]] | None:
        """Derivatives and residuals in metres: four outline bounds, distance, and what holds place, shape and size.

        None when the object reaches the camera.
        """
        arms = self.arms * (self.scale * np.exp(x[2:]))
        seen = self.camera.to_camera(self.anchor + self.basis @ x[:2] + arms @ self.R.T)
        if seen[:, 2].min() < _NEAREST_M:
            return None
        k = self.camera.intrinsics
        flat = seen[:, :2] / seen[:, 2:] * [k.fx, k.fy] + [k.cx, k.cy]
        extreme = np.array([*flat.argmin(axis=0), *flat.argmax(axis=0)])
        axis = np.array([0, 1, 0, 1])
        depth, focal = seen[extreme, 2], np.array([k.fx, k.fy])[axis]
        outline = (flat[extreme, axis] - self.bounds_px) * self.metres
        pixel = np.zeros((4, 3))
        pixel[np.arange(4), axis] = focal / depth
        pixel[:, 2] = -focal * seen[extreme, axis] / depth**2
        to_metres = pixel @ self.camera.T_camera_world[:3, :3] * self.metres
        J = np.column_stack([to_metres @ self.basis, (to_metres @ self.R) * arms[extreme]])

        ray = self.observed - self.camera.position
        ray = self.depth_weight * ray / np.linalg.norm(ray)
        moved = -self.anchor_local * self.scale * np.exp(x[2:]) * (ray @ self.R)
        distance = np.concatenate([ray @ self.basis, moved])
        clamped = self._clamped()
        residual = np.concatenate([outline, [float(ray @ (self.centre(x) - self.observed))], clamped @ x])
        return np.vstack([J, distance, clamped]), residual

    def _clamped(self) -> Float[np.ndarray, "6 5"]:
        clamped = np.zeros((6, 5))
        clamped[0, 0] = clamped[1, 1] = _KEEP_PLACE
        clamped[2:5, 2:] = _KEEP_SHAPE * self.extent * (np.eye(3) - 1 / 3)
        clamped[5, 2:] = _KEEP_SIZE * self.extent / 3
        return clamped


def _bounded_step(J: np.ndarray, residual: np.ndarray, low: np.ndarray, high: np.ndarray) -> Float[np.ndarray, "5"]:
    """The least-squares step whose sizes stay within limits: sizes that reach one are held there, and the rest solved
    again."""
    step, clamped = np.zeros(5), np.zeros(5, dtype=bool)
    for _ in range(4):
        step[~clamped] = np.linalg.lstsq(J[:, ~clamped], -(residual + J[:, clamped] @ step[clamped]), rcond=None)[0]
        beyond = ~clamped[2:] & ((step[2:] < low) | (step[2:] > high))
        if not beyond.any():
            break
        step[2:] = np.where(beyond, np.clip(step[2:], low, high), step[2:])
        clamped[2:] |= beyond
    return step


def photo_observations(problem: Problem, camera: Camera, *, depth_weight: float) -> PhotoObservations:
    """What the camera sees of the observed layout."""
    packed = problem.packed
    points = tuple(np.unique(packed.vertices[packed.owner == i].reshape(-1, 3), axis=0) for i in range(problem.count))
    bounds = np.full((problem.count, 4), np.nan)
    for i, own in enumerate(points):
        world = (own * problem.scale[i]) @ problem.R[i].T + problem.p[i]
        if camera.to_camera(world)[:, 2].min() >= _NEAREST_M:
            flat = camera.project(world)
            bounds[i] = [*flat.min(axis=0), *flat.max(axis=0)]
    return PhotoObservations(
        camera=camera,
        bounds_px=bounds,
        observed=problem.p,
        least=problem.scale / MAX_STRETCH,
        most=problem.scale * MAX_STRETCH,
        depth_weight=depth_weight,
        size=problem.shape_size,
        points=points,
    )


def disagreements(
    problem: Problem,
    camera: Camera,
    R: Float[np.ndarray, "n 3 3"],
    p: Float[np.ndarray, "n 3"],
    scale: Float[np.ndarray, "n 3"],
) -> tuple[str, ...]:
    """A line for each free object that a layout took clearly away from where the camera saw it."""
    seen = photo_observations(problem, camera, depth_weight=1.0).bounds_px
    now = photo_observations(replace(problem, R=R, p=p, scale=scale), camera, depth_weight=1.0).bounds_px
    lines = []
    for i in np.flatnonzero(problem.free):
        moved = float(np.linalg.norm(p[i] - problem.p[i]))
        shared = float(box_iou(seen[i], now[i])) if np.isfinite([seen[i], now[i]]).all() else 1.0
        if moved > FAR_M or shared < SHARED_OUTLINE:
            lines.append(
                f"agrees less with the photo: {problem.labels[i]} moved {100 * moved:.0f} cm; its outline still covers "
                f"{100 * shared:.0f} % of where it was seen"
            )
    return tuple(lines)
