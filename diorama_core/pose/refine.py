"""Small corrections of a posed shape so that its outline meets the observed box.

A shape does not touch every side of its cuboid's projection, so a shape that fills the cuboid is often a little too
small in the picture. Position along the supporting face, size and yaw are corrected by damped least squares.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.geometry.observed import Observed
from diorama_core.geometry.rotations import yaw_rotations
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.pose.hypotheses import Anchor
from diorama_core.pose.limits import SizeLimits
from diorama_core.pose.settings import SETTINGS, PoseSearchSettings
from diorama_core.scene.types import Camera

_PARAMETERS = 6


@dataclass(frozen=True, eq=False)
class BoxFit:
    """The least-squares problem of one object: four sides of its box against small changes of a pose."""

    camera: Camera
    seen: Observed
    anchor: Anchor
    limits: SizeLimits
    yaw_sigma_rad: float
    foot_seen: bool = True
    """Where it is not, the box hardly tells how far away the object is: its cuboid, placed among all others, does."""
    iterations: int = 4
    settings: PoseSearchSettings = SETTINGS.search

    def refine(self, caster: ShapeCaster, start: PoseBatch) -> PoseBatch:
        """The poses corrected toward the box; unchanged where no correction helps."""
        x = np.zeros((len(start), _PARAMETERS))
        cost, residual = self._residuals(caster, start, x)
        damping = np.full(len(start), 0.05)
        jacobian = self._jacobian(caster, start, x, residual)
        better = np.zeros(len(start), dtype=bool)
        for _ in range(self.iterations):
            if better.any():
                jacobian = self._jacobian(caster, start, x, residual)
            step = _damped_step(jacobian, residual, damping)
            trial = np.clip(x + step, -3.0, 3.0)
            trial_cost, trial_residual = self._residuals(caster, start, trial)
            better = trial_cost < cost
            x[better], cost[better], residual[better] = trial[better], trial_cost[better], trial_residual[better]
            damping = np.where(better, damping * 0.3, damping * 8.0)
        return self._apply_steps(start, x)

    @cached_property
    def _tangents(self) -> Float[np.ndarray, "2 3"]:
        """Along the anchored face: away from the camera, and across."""
        axis = self.anchor.axis_world
        away = self.anchor.point_world - self.camera.position
        first = away - (away @ axis) * axis
        if np.linalg.norm(first) < 1e-6:
            first = np.cross(axis, [1.0, 0.0, 0.0]) if abs(axis[0]) < 0.9 else np.cross(axis, [0.0, 1.0, 0.0])
        if abs(axis[2]) < 0.5:
            first = np.array([0.0, 0.0, 1.0])
        first = first / np.linalg.norm(first)
        return np.stack([first, np.cross(axis, first)])

    def _sigma(self, start: PoseBatch) -> Float[np.ndarray, "p 6"]:
        """How far each parameter may be expected to move: two offsets in metres, three log scales, yaw."""
        distance = np.linalg.norm(start.position - self.camera.position, axis=1)
        sigma = np.empty((len(start), _PARAMETERS))
        away = self.settings.away_share if self.foot_seen else self.settings.away_share_unseen
        sigma[:, 0], sigma[:, 1] = away * distance, 0.03 * distance
        sigma[:, 2:5], sigma[:, 5] = 0.12, self.yaw_sigma_rad
        return sigma

    def _apply_steps(self, start: PoseBatch, x: np.ndarray) -> PoseBatch:
        """The starting poses after steps of x sigmas."""
        change = x * self._sigma(start)
        R = np.einsum("pij,pjk->pik", start.R, yaw_rotations(change[:, 5]))
        scale = self.limits.scale_for(start.scale * np.exp(change[:, 2:5]) * self.limits.shape_size_m)
        centres = start.position + change[:, :2] @ self._tangents
        return PoseBatch(R, self.anchor.place_centres(centres, R, scale * self.limits.shape_size_m), scale)

    def _residuals(
        self, caster: ShapeCaster, start: PoseBatch, x: np.ndarray
    ) -> tuple[Float[np.ndarray, "p"], Float[np.ndarray, "p 10"]]:
        bounds = caster.bounds_px(self.camera, self._apply_steps(start, x))
        box = np.asarray(self.seen.box, dtype=np.float64)
        extent = np.maximum(np.tile(box[2:] - box[:2], 2), 1.0)
        outward = (bounds - box) * np.array([-1.0, -1.0, 1.0, 1.0]) / (0.015 * extent + 1.5)
        outward = np.where(np.isnan(outward), 20.0, outward)
        outward = np.where(self._sides_hidden & (outward > 0), self.settings.hidden_side * outward, outward)
        robust = np.sign(outward) * _huber_residuals(np.abs(outward), self.settings)
        residual = np.concatenate([robust, x], axis=1)
        return (residual**2).sum(axis=1), residual

    def _jacobian(
        self, caster: ShapeCaster, start: PoseBatch, x: np.ndarray, residual: np.ndarray
    ) -> Float[np.ndarray, "p 10 6"]:
        """Forward differences; all poses and parameters in one projection."""
        count = len(start)
        repeat = np.repeat(np.arange(count), _PARAMETERS)
        shifted = x[repeat] + self.settings.slope_step * np.tile(np.eye(_PARAMETERS), (count, 1))
        _, moved = self._residuals(caster, start[repeat], shifted)
        slopes = (moved.reshape(count, _PARAMETERS, -1) - residual[:, None]) / self.settings.slope_step
        return slopes.transpose(0, 2, 1)

    @cached_property
    def _sides_hidden(self) -> Bool[np.ndarray, "4"]:
        """Sides of the box beside which nearer objects may hide more of the object."""
        x, y = self.seen.window.centres_px.T
        x1, y1, x2, y2 = self.seen.box
        dx, dy = 0.12 * (x2 - x1), 0.12 * (y2 - y1)
        inside = (x >= x1) & (x < x2) & (y >= y1) & (y < y2)
        strips = (x < x1 + dx, y < y1 + dy, x >= x2 - dx, y >= y2 - dy)
        return np.array([bool((inside & s).any() and self.seen.weight[inside & s].mean() < 0.6) for s in strips])


def _huber_residuals(magnitude: np.ndarray, settings: PoseSearchSettings) -> np.ndarray:
    """Grows like a square root beyond a few sigmas (Huber's loss as a residual)."""
    beyond = np.maximum(2 * settings.beyond_sigma * magnitude - settings.beyond_sigma**2, 0.0)
    return np.where(magnitude <= settings.beyond_sigma, magnitude, np.sqrt(beyond))


def _damped_step(jacobian: np.ndarray, residual: np.ndarray, damping: np.ndarray) -> Float[np.ndarray, "p 6"]:
    normal = np.einsum("pri,prj->pij", jacobian, jacobian)
    normal = normal + damping[:, None, None] * np.eye(_PARAMETERS) * (1.0 + np.einsum("pii->pi", normal))[:, None]
    gradient = np.einsum("pri,pr->pi", jacobian, residual)
    return -np.linalg.solve(normal, gradient[..., None])[..., 0]
