"""Fitting a shape to measured depth: where it stands, how it is turned and how large it is, all at once.

A damped Gauss-Newton iteration over seven numbers (centre, yaw, three log scales), for many starting poses together.
What is seen of the object pulls on it in three ways: the surface that each ray meets should lie where the depth was
measured (point to plane, as in projective ICP), the outline should reach as far as the mask does in every direction of
the picture, and the supporting face should touch what the object stands on. Sizes prefer the shape's own proportions,
because much of an object is always hidden.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.geometry.observed import Observed
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.pose.hypotheses import Anchor
from diorama_core.pose.limits import SizeLimits
from diorama_core.pose.settings import SETTINGS, PoseSearchSettings
from diorama_core.scene.types import Camera, yaw_rotation

INNER_CELL = 0.9
"""Cells that a mask covers by less lie on its edge, where depth belongs to either side."""
PARAMETERS = 7
_YAW_SIGMA_RAD = float(np.deg2rad(10.0))


@dataclass(frozen=True, eq=False)
class SeenPoints:
    """Rays through the inside of the mask and the points that were measured along them."""

    directions_world: Float[np.ndarray, "r 3"]
    points_world: Float[np.ndarray, "r 3"]
    depth_m: Float[np.ndarray, " r"]
    spread_m: Float[np.ndarray, " r"]
    """Standard deviation of the noise in it."""
    settings: PoseSearchSettings = SETTINGS.search

    @classmethod
    def of(
        cls,
        seen: Observed,
        depth_m: Float[np.ndarray, " n"],
        weight: Float[np.ndarray, " n"],
        spread_m: Float[np.ndarray, " n"],
        settings: PoseSearchSettings,
    ) -> SeenPoints:
        """The measured cells inside the mask, evenly thinned; all that are covered at all where few are covered whole.

        Args:
            seen: the object's window.
            depth_m: measured at the cells' centres.
            weight: 0 where nothing was measured.
            spread_m: standard deviation of the noise in the depth.
        """
        chosen = np.flatnonzero((seen.covered >= INNER_CELL) & (weight > 0))
        if len(chosen) < 12:
            chosen = np.flatnonzero(weight > 0)
        chosen = chosen[:: max(1, -(-len(chosen) // settings.max_rays))]
        directions, depth = seen.directions_world[chosen], depth_m[chosen]
        return cls(directions, seen.origin_world + depth[:, None] * directions, depth, spread_m[chosen], settings)

    def span(self, axes_world: Float[np.ndarray, "p 3 3"]) -> tuple[Float[np.ndarray, "p 3"], Float[np.ndarray, "p 3"]]:
        """Where the points begin and end along the columns of rotations, less what noise adds."""
        local = np.einsum("pji,rj->pri", axes_world, self.points_world)
        low, high = np.quantile(local, [0.01, 0.99], axis=1)
        along = np.abs(np.einsum("pji,j->pi", axes_world, self.directions_world.mean(axis=0)))
        inflated = np.minimum(self.settings.noise_reach * float(np.median(self.spread_m)) * along, 0.4 * (high - low))
        return low + inflated, high - inflated


@dataclass(frozen=True, eq=False)
class SeenOutline:
    """How far a mask reaches in each direction of the picture."""

    directions: Float[np.ndarray, "k 2"]
    reach_px: Float[np.ndarray, " k"]
    known: Bool[np.ndarray, " k"]
    """False where the picture's border or something nearer may hide more."""
    settings: PoseSearchSettings

    @property
    def lower_end_seen(self) -> bool:
        """Whether nothing hides or cuts the lower end."""
        return bool(self.known[self.settings.directions // 4])

    @property
    def height_seen(self) -> bool:
        """Whether nothing hides or cuts the lower or the upper end."""
        return self.lower_end_seen and self.upper_end_seen

    @property
    def upper_end_seen(self) -> bool:
        """Whether nothing hides or cuts the upper end."""
        return bool(self.known[3 * self.settings.directions // 4])

    @classmethod
    def of(
        cls, seen: Observed, mask: Bool[np.ndarray, "h w"], settings: PoseSearchSettings = SETTINGS.search
    ) -> SeenOutline | None:
        """The outline of a mask; None when it is empty."""
        rows, columns = np.nonzero(mask)
        if len(rows) == 0:
            return None
        angle = 2 * np.pi * np.arange(settings.directions) / settings.directions
        directions = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        points = np.stack([columns + 0.5, rows + 0.5], axis=1)
        along = points @ directions.T
        # A pixel's half width in the direction, so that the reach is that of its edge.
        reach = along.max(axis=0) + 0.5 * np.abs(directions).sum(axis=1)
        tips = points[along.argmax(axis=0)]
        x1, y1, x2, y2 = seen.box
        beyond = tips + directions * max(0.06 * max(x2 - x1, y2 - y1), 2.0)
        cells = _nearest_cells(seen, beyond)
        is_inside = ((beyond >= 1) & (beyond < np.array(mask.shape[::-1]) - 1)).all(axis=1)
        known = (seen.weight[cells] > 0.6) & is_inside
        return cls(directions, reach, known, settings)


def _nearest_cells(seen: Observed, pixels: Float[np.ndarray, "k 2"]) -> np.ndarray:
    x1, y1, x2, y2 = seen.window.bounds_px
    n = seen.window.cells
    column = np.clip(((pixels[:, 0] - x1) / (x2 - x1) * n).astype(int), 0, n - 1)
    row = np.clip(((pixels[:, 1] - y1) / (y2 - y1) * n).astype(int), 0, n - 1)
    return row * n + column


@dataclass(frozen=True, eq=False)
class Contact:
    """Where the object touches what holds it."""

    anchor: Anchor
    sigma_m: float
    """How far from there its face may be: small where that end of it is seen."""
    settings: PoseSearchSettings

    def gap_m(self, poses: PoseBatch, shape_size_m: Float[np.ndarray, "3"]) -> Float[np.ndarray, " p"]:
        """How far poses are from touching, along the contact's axis; negative where they reach through."""
        lever = 0.5 * np.abs(np.einsum("pij,i->pj", poses.R, self.anchor.axis_world)) * poses.scale * shape_size_m
        return (poses.position - self.anchor.point_world) @ self.anchor.axis_world - lever.sum(axis=1)

    def log_likelihood(self, poses: PoseBatch, shape_size_m: Float[np.ndarray, "3"]) -> Float[np.ndarray, " p"]:
        """What the gap says of poses: the layout will close it, and they will agree less with the picture."""
        sigma = np.hypot(self.sigma_m, self.settings.shape_foot_m)
        return -0.5 * np.minimum(np.abs(self.gap_m(poses, shape_size_m)) / sigma, self.settings.max_sigmas) ** 2


@dataclass(frozen=True, eq=False)
class DepthFit:
    """The fit of one object."""

    camera: Camera
    seen: Observed
    points: SeenPoints
    outline: SeenOutline | None
    contact: Contact
    limits: SizeLimits
    yaw_sigma_rad: float = _YAW_SIGMA_RAD
    settings: PoseSearchSettings = SETTINGS.search

    def starts(self, rotations: Float[np.ndarray, "p 3 3"], far: tuple[bool, bool] = (False, False)) -> PoseBatch:
        """Poses with these rotations whose near faces (or far ones, along x or y) touch what was measured.

        The height decides the size where all of it is seen; then width and depth follow the shape's own proportions,
        and are stretched to hold what was measured.
        """
        low, high = self.points.span(rotations)
        eye = np.einsum("pji,j->pi", rotations, self.camera.position)
        spans = np.maximum(high - low, 1e-3)
        shape_size_m = self.limits.shape_size_m
        stands = self.contact.anchor.axis_world[2] > 0.5
        sure = self.contact.sigma_m <= self.settings.sure_contact_m
        whole = (self.outline is not None and self.outline.height_seen) or (stands and sure and self._top_seen)
        bottom = self.contact.anchor.point_world[2]
        height = np.maximum(high[:, 2] - bottom, spans[:, 2]) if stands and sure else spans[:, 2]
        growth = np.clip(height / max(float(shape_size_m[2]), 1e-3), 0.5, 2.0) if whole else np.ones(len(rotations))
        wanted = np.where(self.limits.thin, shape_size_m, np.maximum(shape_size_m * growth[:, None], spans))
        scale = self.limits.scale_for(wanted)
        size = scale * shape_size_m
        from_high = (eye > 0.5 * (low + high)) ^ np.array([*far, False])
        centre = np.where(from_high, high - size / 2, low + size / 2)
        position = np.einsum("pij,pj->pi", rotations, centre)
        if sure:
            position = self.contact.anchor.place_centres(position, rotations, size)
        elif self._top_seen:
            position[:, 2] = high[:, 2] - size[:, 2] / 2
        return PoseBatch(rotations, position, scale)

    @property
    def _top_seen(self) -> bool:
        return self.outline is not None and self.outline.upper_end_seen

    def refine(self, caster: ShapeCaster, start: PoseBatch) -> PoseBatch:
        """The poses after the iteration."""
        x = np.zeros((len(start), PARAMETERS))
        for looseness in self.settings.looseness:
            normal, gradient = self._system(caster, start, x, looseness)
            diagonal = np.einsum("pii->pi", normal)
            damped = normal + np.einsum("pi,ij->pij", self.settings.damping * diagonal + 1e-9, np.eye(PARAMETERS))
            x = self._limit_steps(start, x - np.linalg.solve(damped, gradient[..., None])[..., 0])
        return self._apply_steps(start, x)

    def _limit_steps(self, start: PoseBatch, x: np.ndarray) -> np.ndarray:
        """Steps of the sizes kept within the limits, so that the solution and the pose do not drift apart."""
        wanted = start.scale * np.exp(np.clip(x[:, 4:], -1.5, 1.5)) * self.limits.shape_size_m
        x = x.copy()
        x[:, 4:] = np.log(self.limits.scale_for(wanted) / start.scale)
        x[:, 3] = np.clip(x[:, 3], -0.6, 0.6)
        most = self.settings.max_shift * (start.scale * self.limits.shape_size_m).max(axis=1)
        length = np.linalg.norm(x[:, :3], axis=1)
        x[:, :3] *= np.minimum(1.0, most / np.maximum(length, 1e-9))[:, None]
        return np.nan_to_num(x)

    def _apply_steps(self, start: PoseBatch, x: np.ndarray) -> PoseBatch:
        turns = np.array([yaw_rotation(angle) for angle in x[:, 3]])
        return PoseBatch(turns @ start.R, start.position + x[:, :3], start.scale * np.exp(x[:, 4:]))

    def _system(
        self, caster: ShapeCaster, start: PoseBatch, x: np.ndarray, looseness: float
    ) -> tuple[Float[np.ndarray, "p 7 7"], Float[np.ndarray, "p 7"]]:
        """Normal matrices and gradients of all poses."""
        poses = self._apply_steps(start, x)
        parts = [self._surface(caster, poses, looseness), self._priors(poses, x)]
        if self.outline is not None:
            parts.append(self._reaches(caster, poses, looseness))
        J = np.concatenate([j for j, _, _ in parts], axis=1)
        r = np.concatenate([r for _, r, _ in parts], axis=1)
        w = np.concatenate([w for _, _, w in parts], axis=1)
        weighted = J * w[..., None]
        return np.einsum("pri,prj->pij", weighted, J), np.einsum("pri,pr->pi", weighted, r)

    def _surface(
        self, caster: ShapeCaster, poses: PoseBatch, looseness: float
    ) -> tuple[Float[np.ndarray, "p r 7"], Float[np.ndarray, "p r"], Float[np.ndarray, "p r"]]:
        """Point to plane along the rays that meet the shape."""
        hits = caster.cast(self.seen.origin_world, self.points.directions_world, poses)
        depth = np.where(hits.is_hit, hits.depth_m, 0.0)
        met = self.seen.origin_world + depth[..., None] * self.points.directions_world
        normals = hits.normals_world
        # Many rays see one surface; together they should not outvote the outline. Noise is each ray's own.
        alike = max(len(self.points.depth_m) / 40.0, 1.0)
        sigma = np.hypot(looseness * (0.008 + 0.006 * self.points.depth_m), self.points.spread_m / np.sqrt(alike))
        r = (normals * (met - self.points.points_world)).sum(axis=-1) / sigma
        facing = np.abs((normals * self.points.directions_world).sum(axis=-1))
        w = np.where(hits.is_hit & (facing > self.settings.grazing), 1.0 / (1.0 + (r / 2.0) ** 2), 0.0)
        J = self._slopes(poses, met, normals) / sigma[:, None]
        return J, r, w * (40.0 / max(len(sigma), 1))

    def _reaches(
        self, caster: ShapeCaster, poses: PoseBatch, looseness: float
    ) -> tuple[Float[np.ndarray, "p k 7"], Float[np.ndarray, "p k"], Float[np.ndarray, "p k"]]:
        """How far the shape reaches in the picture against how far its mask does."""
        assert self.outline is not None
        world = poses.apply(caster.hull[0])
        in_camera = self.camera.to_camera(world)
        k = self.camera.intrinsics
        z = np.maximum(in_camera[..., 2], 0.05)
        focal = np.array([k.fx, k.fy])
        flat = in_camera[..., :2] / z[..., None] * focal + [k.cx, k.cy]
        along = flat @ self.outline.directions.T
        tip = along.argmax(axis=1)
        count = np.arange(len(poses))[:, None]
        x1, y1, x2, y2 = self.seen.box
        sigma = looseness * (1.0 + 0.012 * max(x2 - x1, y2 - y1))
        r = (np.take_along_axis(along, tip[:, None], axis=1)[:, 0] - self.outline.reach_px) / sigma
        # A hidden side may reach farther, but not less far.
        w = np.where(self.outline.known | (r < 0), 1.0 / (1.0 + (r / 3.0) ** 2), 0.0)
        points, at = world[count, tip], in_camera[count, tip]
        d = self.outline.directions * focal
        toward = np.concatenate([d / z[count, tip][..., None], np.zeros((*tip.shape, 1))], axis=-1)
        toward[..., 2] = -(d * at[..., :2]).sum(axis=-1) / z[count, tip] ** 2
        J = self._slopes(poses, points, toward @ self.camera.T_camera_world[:3, :3]) / sigma
        return J, r, w

    def _priors(
        self, poses: PoseBatch, x: np.ndarray
    ) -> tuple[Float[np.ndarray, "p m 7"], Float[np.ndarray, "p m"], Float[np.ndarray, "p m"]]:
        """Contact with what holds the object, the shape's own proportions and size, and the starting yaw."""
        count = len(poses)
        axis, sigma = self.contact.anchor.axis_world, self.contact.sigma_m
        shape_size_m = self.limits.shape_size_m
        lever = 0.5 * np.abs(np.einsum("pij,i->pj", poses.R, axis)) * poses.scale * shape_size_m
        gap = self.contact.gap_m(poses, shape_size_m)
        J, r = np.zeros((count, 6, PARAMETERS)), np.zeros((count, 6))
        J[:, 0, :3], J[:, 0, 4:] = axis, -lever
        J[:, 0], r[:, 0] = J[:, 0] / sigma, gap / sigma
        logs, thin = np.log(poses.scale), self.limits.thin
        of_mean = np.full(3, 1 / 3) if thin.all() else ~thin / (~thin).sum()
        centring = (np.eye(3) - of_mean) / np.where(thin, self.settings.thin_shape_sigma, self.settings.shape_sigma)[
            :, None
        ]
        J[:, 1:4, 4:], r[:, 1:4] = centring, logs @ centring.T
        J[:, 4, 4:], r[:, 4] = of_mean / self.settings.size_sigma, logs @ of_mean / self.settings.size_sigma
        J[:, 5, 3], r[:, 5] = 1 / self.yaw_sigma_rad, x[:, 3] / self.yaw_sigma_rad
        return J, r, np.ones((count, 6))

    def _slopes(
        self, poses: PoseBatch, points: Float[np.ndarray, "p r 3"], along: Float[np.ndarray, "p r 3"]
    ) -> Float[np.ndarray, "p r 7"]:
        """How much points fixed on the shape move along given directions with each of the seven numbers."""
        arm = points - poses.position[:, None]
        turned = np.stack([-arm[..., 1], arm[..., 0], np.zeros_like(arm[..., 0])], axis=-1)
        J = np.empty((*points.shape[:2], PARAMETERS))
        J[..., :3] = along
        J[..., 3] = (along * turned).sum(axis=-1)
        J[..., 4:] = np.einsum("prk,pki->pri", along, poses.R) * np.einsum("prk,pki->pri", arm, poses.R)
        return J
