"""The least-squares problem of putting one object back where the camera saw it.

What structure leaves free (two coordinates on the support, three scales within limits) is fitted to the bounds of its
outline, to the points of its surface that were seen and to its distance, in metres at the object's distance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.layout.feasible.visible_points import TrackedPoints
from diorama_core.layout.settings import LayoutSettings
from diorama_core.scene.types import Camera

_OUTWARD = np.array([-1.0, -1.0, 1.0, 1.0])


@dataclass(frozen=True, eq=False)
class ObjectFit:
    """One object's outline and distance as a function of x: its two coordinates and the logarithms of three scales."""

    camera: Camera
    bounds_px: Float[np.ndarray, "4"]
    """NaN for an object that reaches behind the camera: it has no outline, but points of it are tracked."""
    hidden: Bool[np.ndarray, "4"]
    loads: Float[np.ndarray, "m 2"]
    observed: Float[np.ndarray, "3"]
    depth_weight: float
    R: Float[np.ndarray, "3 3"]
    anchor: Float[np.ndarray, "3"]
    """World point that stays put when the object is resized."""
    anchor_local: Float[np.ndarray, "3"]
    """The anchor at scale 1, object frame."""
    arms: Float[np.ndarray, "v 3"]
    """Outline points from the anchor, at scale 1."""
    tracked: TrackedPoints
    tracked_arms: Float[np.ndarray, "t 3"]
    """The tracked points from the anchor, at scale 1."""
    surface_measured: bool
    """Whether it is the tracked points' distances that were measured, rather than the centre's that was reasoned."""
    scale: Float[np.ndarray, "3"]
    basis: Float[np.ndarray, "3 2"]
    metres: float
    """What a pixel is at the object's distance."""
    extents: Float[np.ndarray, "3"]
    """The object's own, metres."""
    settings: LayoutSettings

    def centre(self, x: Float[np.ndarray, "5"]) -> Float[np.ndarray, "3"]:
        """Where the object's centre is."""
        return self.anchor + self.basis @ x[:2] - self.R @ (self.anchor_local * self.scale * np.exp(x[2:]))

    def linearise(self, x: Float[np.ndarray, "5"]) -> tuple[Float[np.ndarray, "r 5"], Float[np.ndarray, " r"]] | None:
        """Derivatives and residuals in metres: four outline bounds, tracked points, distance, and what holds
        place, shape and size.

        None when the object reaches the camera.
        """
        outline = self._outline(x)
        if outline is None:
            return None
        sight = self._sight(x)
        if sight is None:
            return None
        distance = self._surface(x) if self.surface_measured else self._centre(x)
        clamped = self._prior_rows()
        fixed_rows, gaps = self._rows_of_loads(x)
        rows = [outline[0], sight[0], distance[0], fixed_rows, clamped]
        return np.vstack(rows), np.concatenate([outline[1], sight[1], distance[1], gaps, clamped @ x])

    def _outline(self, x: Float[np.ndarray, "5"]) -> tuple[Float[np.ndarray, "r 5"], Float[np.ndarray, " r"]] | None:
        """How the bounds of the outline leave where they were seen; None when the object reaches the camera."""
        if not np.isfinite(self.bounds_px).all():
            return np.zeros((0, 5)), np.zeros(0)
        arms = self.arms * (self.scale * np.exp(x[2:]))
        seen = self.camera.to_camera(self.anchor + self.basis @ x[:2] + arms @ self.R.T)
        if seen[:, 2].min() < self.settings.nearest_m:
            return None
        k = self.camera.intrinsics
        flat = seen[:, :2] / seen[:, 2:] * [k.fx, k.fy] + [k.cx, k.cy]
        extreme = np.array([*flat.argmin(axis=0), *flat.argmax(axis=0)])
        axis = np.array([0, 1, 0, 1])
        depth, focal = seen[extreme, 2], np.array([k.fx, k.fy])[axis]
        outline = (flat[extreme, axis] - self.bounds_px) * self.metres
        counts = ~self.hidden | (outline * _OUTWARD < 0.0)
        pixel = np.zeros((4, 3))
        pixel[np.arange(4), axis] = focal / depth
        pixel[:, 2] = -focal * seen[extreme, axis] / depth**2
        outline, pixel = np.where(counts, outline, 0.0), np.where(counts[:, None], pixel, 0.0)
        to_metres = pixel @ self.camera.T_camera_world[:3, :3] * self.metres
        return np.column_stack([to_metres @ self.basis, (to_metres @ self.R) * arms[extreme]]), outline

    def _place_tracked_points(
        self, x: Float[np.ndarray, "5"]
    ) -> tuple[Float[np.ndarray, "t 3"], Float[np.ndarray, "t 3"]]:
        """Arms of the tracked points at their sizes, and where they are before the camera."""
        arms = self.tracked_arms * (self.scale * np.exp(x[2:]))
        return arms, self.camera.to_camera(self.anchor + self.basis @ x[:2] + arms @ self.R.T)

    def _centre(self, x: Float[np.ndarray, "5"]) -> tuple[Float[np.ndarray, "1 5"], Float[np.ndarray, "1"]]:
        """How far the centre leaves the distance at which it was observed."""
        ray = self.observed - self.camera.position
        ray = self.depth_weight * ray / np.linalg.norm(ray)
        moved = -self.anchor_local * self.scale * np.exp(x[2:]) * (ray @ self.R)
        along = np.array([float(ray @ (self.centre(x) - self.observed))])
        return np.concatenate([ray @ self.basis, moved])[None], along

    def _surface(self, x: Float[np.ndarray, "5"]) -> tuple[Float[np.ndarray, "t 5"], Float[np.ndarray, " t"]]:
        """How far the surface that was seen leaves its measured distance."""
        arms, placed = self._place_tracked_points(x)
        axis = self.depth_weight / np.sqrt(len(arms)) * self.camera.T_camera_world[2, :3]
        rows = np.column_stack([np.tile(axis @ self.basis, (len(arms), 1)), (axis @ self.R) * arms])
        return rows, self.depth_weight / np.sqrt(len(arms)) * (placed[:, 2] - self.tracked.depth_m)

    def _sight(self, x: Float[np.ndarray, "5"]) -> tuple[Float[np.ndarray, "r 5"], Float[np.ndarray, " r"]] | None:
        """How the tracked points leave where they were seen, in metres at their distance."""
        arms, placed = self._place_tracked_points(x)
        if placed[:, 2].min() < self.settings.nearest_m:
            return None
        k = self.camera.intrinsics
        sight = (self.tracked.pixels - [k.cx, k.cy]) / [k.fx, k.fy]
        # What is left of a point across its observed line of sight: linear in the point.
        residual = placed[:, :2] - sight * placed[:, 2:]
        pixel = np.concatenate([np.tile(np.eye(2), (len(arms), 1, 1)), -sight[..., None]], axis=2).reshape(-1, 3)
        across = pixel @ self.camera.T_camera_world[:3, :3]
        J = np.column_stack([across @ self.basis, (across @ self.R) * np.repeat(arms, 2, axis=0)])
        weight = self.settings.tracked / np.sqrt(len(arms))
        return weight * J, weight * residual.ravel()

    def _rows_of_loads(self, x: Float[np.ndarray, "5"]) -> tuple[Float[np.ndarray, "m 5"], Float[np.ndarray, " m"]]:
        """How the places of an upright object miss what was observed on them."""
        arm = (self.loads[:, 0] - self.anchor_local[2]) * self.scale[2] * np.exp(x[4])
        rows = np.zeros((len(arm), 5))
        rows[:, :2] = self.basis[2]
        rows[:, 4] = arm
        height = self.anchor[2] + self.basis[2] @ x[:2] + arm
        return self.settings.load * rows, self.settings.load * (height - self.loads[:, 1])

    def _prior_rows(self) -> Float[np.ndarray, "6 5"]:
        clamped = np.zeros((6, 5))
        clamped[0, 0] = clamped[1, 1] = self.settings.keep_place
        # Measured shares of a thin extent are as sure as those of a long one; in a photo metres are.
        lengths = self.extents.max() if self.surface_measured else self.extents[:, None]
        clamped[2:5, 2:] = self.settings.keep_size * lengths * (np.eye(3) - 1 / 3)
        clamped[5, 2:] = self.settings.keep_size * self.extents.max() / 3
        return clamped


def solve_bounded_step(
    J: np.ndarray, residual: np.ndarray, low: np.ndarray, high: np.ndarray
) -> Float[np.ndarray, "5"]:
    """The least-squares step whose sizes stay within limits: sizes that reach one are held there, and the rest solved
    again.

    Args:
        J: derivatives, one row a residual.
        residual: what is left now.
        low: least steps of the sizes.
        high: largest steps of the sizes.
    """
    step, clamped = np.zeros(5), np.zeros(5, dtype=bool)
    for _ in range(4):
        step[~clamped] = np.linalg.lstsq(J[:, ~clamped], -(residual + J[:, clamped] @ step[clamped]), rcond=None)[0]
        beyond = ~clamped[2:] & ((step[2:] < low) | (step[2:] > high))
        if not beyond.any():
            break
        step[2:] = np.where(beyond, np.clip(step[2:], low, high), step[2:])
        clamped[2:] |= beyond
    return step
