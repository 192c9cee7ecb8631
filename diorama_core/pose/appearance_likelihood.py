"""Appearance likelihood of one object at high resolution, to distinguish similar rotations of one shape.

Mugs, jars and stacks of books look much the same whichever way they are turned. What tells their turns apart is a small
part of their pixels: a handle, a label, the spines of books. Here the disagreements of single cells are summed, not
averaged, with tolerances as small as the object, and the colours of the picture count, up to the colour, strength and
direction of the light, which are fitted to every pose. A cell that disagrees a little says nothing: small misplacements
would otherwise speak for the shape with the fewest details.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Float32, Int, UInt8

from diorama_core.geometry.observed import Observed
from diorama_core.geometry.shape_appearance import ShapeAppearance
from diorama_core.geometry.silhouette import PoseBatch, ShapeHits
from diorama_core.io.srgb import srgb_to_linear
from diorama_core.pose.depth_fit import INNER_CELL
from diorama_core.pose.settings import SETTINGS, PoseEvidenceSettings
from diorama_core.pose.surface import ObjectSurface


@dataclass(frozen=True, eq=False)
class AppearanceLikelihood:
    """One object's window in cells of about a pixel."""

    seen: Observed
    surface: ObjectSurface
    """With tolerances as small as the object."""
    log_rgb: Float32[np.ndarray, "n 3"]
    """Logarithms of the linear light of the object's pixels."""
    settings: PoseEvidenceSettings

    @classmethod
    def of(
        cls,
        rgb: UInt8[np.ndarray, "h w 3"],
        mask: Bool[np.ndarray, "h w"],
        seen: Observed,
        surface: ObjectSurface,
        size_m: Float[np.ndarray, "3"],
        settings: PoseEvidenceSettings = SETTINGS.evidence,
    ) -> AppearanceLikelihood:
        """Look at one object.

        Args:
            rgb: the photo.
            mask: the object's visible pixels.
            seen: its window, in `cells_for` its box.
            surface: what was measured there.
            size_m: about how large it is.
        """
        small = settings.tolerance_m + settings.tolerance_share * float(np.median(size_m)) + 1.5 * surface.spread_m
        close = replace(surface, tolerance_m=np.minimum(surface.tolerance_m, small))
        colours = seen.window.means(rgb * mask[..., None]) / np.maximum(seen.covered, 1e-6)[:, None] / 255.0
        light = srgb_to_linear(np.clip(colours, 0.0, 1.0))
        return cls(seen, close, np.log(light + settings.darkest).astype(np.float32), settings)

    def log_likelihoods(
        self, appearance: ShapeAppearance, poses: PoseBatch, exact: bool = True
    ) -> Float[np.ndarray, "p"]:
        """Logarithms of how likely the picture is under poses of one shape, to compare poses in about one place.

        Args:
            appearance: the shape.
            poses: poses of it.
            exact: whether details may lie a cell off; without that it takes half the time.
        """
        hits = appearance.caster.cast(self.seen.origin_world, self.seen.directions_world, poses)
        return -self._weight * (
            self._place_mismatch(hits, exact)
            + self.settings.colour_share * self._colour_mismatch(appearance, hits, exact)
        )

    def misfit(self, appearance: ShapeAppearance, pose: PoseBatch) -> float:
        """How unlikely one pose is by its outline and depth: high where the shape or its size are wrong."""
        hits = appearance.caster.cast(self.seen.origin_world, self.seen.directions_world, pose)
        return self._weight * float(self._place_mismatch(hits, True)[0])

    @property
    def _weight(self) -> float:
        return self.settings.max_cost * min(1.0, self.settings.counted_cells / max(float(self.seen.covered.sum()), 1.0))

    @cached_property
    def _neighbours(self) -> Int[np.ndarray, "5 n"]:
        """Indices of every cell itself and the four beside it: details may lie a cell off."""
        n = self.seen.window.cells
        padded = np.pad(np.arange(n * n).reshape(n, n), 1, mode="edge")
        offsets = ((0, 0), (0, 1), (0, -1), (1, 0), (-1, 0))
        return np.array([padded[1 + y : 1 + y + n, 1 + x : 1 + x + n].ravel() for y, x in offsets])

    @cached_property
    def _own(self) -> Bool[np.ndarray, "n"]:
        """Cells whose colour is the object's alone."""
        return self.seen.covered * self.seen.weight > INNER_CELL

    def _place_mismatch(self, hits: ShapeHits, exact: bool) -> Float[np.ndarray, "p"]:
        """Number of cells that disagree: covered where the mask is not, or the other way round, or at another depth."""
        s, covered = self.surface, self.seen.covered
        weight = np.where(s.known & (s.weight == 0), 1.0, self.seen.weight)
        weight = np.where(s.hides(hits), 0.0, weight)
        missed = np.clip(2 * np.abs(covered - hits.is_hit) - 1, 0.0, 1.0) * weight
        depth = np.where(hits.is_hit, hits.depth_m, 0.0)
        off = np.full(depth.shape, np.inf)
        for beside in self._neighbours[: None if exact else 1]:
            gap = np.abs(depth - s.depth_m[beside])
            off = np.minimum(off, np.where(s.weight[beside] > 0, gap, np.inf))
        inside = np.where(hits.is_hit, _softly(off / (self.settings.half_depth * s.tolerance_m), 4), 0.0)
        return missed.sum(axis=1) + inside @ (s.weight * np.clip(2 * covered - 1, 0.0, 1.0))

    def _colour_mismatch(self, appearance: ShapeAppearance, hits: ShapeHits, exact: bool) -> Float[np.ndarray, "p"]:
        """Number of cells of another colour than the light explains; 0 for shapes of one colour."""
        light, variance = _light_of(appearance, self.settings)
        indices = np.flatnonzero(self._own)
        if not len(light) or not len(indices) or (light.std(axis=0) < self.settings.one_colour).all():
            return np.zeros(len(hits.poses))
        if appearance.opaque_caster is appearance.caster:
            hits = hits.select_rays(indices)
        else:
            hits = appearance.opaque_caster.cast(
                self.seen.origin_world, self.seen.directions_world[indices], hits.poses
            )
        face = np.where(hits.is_hit, hits.triangles, 0)
        fit = _LightFit(hits.normals_world.astype(np.float32), light[face], variance[face], self.settings)
        strength, tint = fit.fitted(self.log_rgb[indices], hits.is_hit)
        lit = fit.lit(strength, tint)
        off = np.full(face.shape, np.inf, np.float32)
        for beside in self._neighbours[: None if exact else 1, indices]:
            cost = fit.disagreement(self.log_rgb[beside] - lit)
            off = np.minimum(off, np.where(self._own[beside], cost, np.inf))
        cost = np.where(hits.is_hit, _softly(off / self.settings.half_colour, 2), 0.0).sum(axis=1)
        share = (cost + self.settings.familiar_cells * self.settings.familiar_share) / (
            hits.is_hit.sum(axis=1) + self.settings.familiar_cells
        )
        unlikely = (tint**2).sum(axis=1) / self.settings.tint_sigma**2 + (strength[:, 1:] ** 2).sum(
            axis=1
        ) / self.settings.slope_sigma**2
        return share * len(indices) + unlikely / (2 * self.settings.robust)


def cells_for(box: tuple[float, float, float, float], settings: PoseEvidenceSettings = SETTINGS.evidence) -> int:
    """How many cells a window around a box needs for cells of about a pixel, within reason."""
    longest = max(box[2] - box[0], box[3] - box[1])
    return int(np.clip(settings.cells_per_px * longest, settings.min_side_cells, settings.max_side_cells))


@dataclass(frozen=True, eq=False)
class _LightFit:
    """What light makes of the colours of faces: one tint, and a strength that changes with the direction they face."""

    normals: Float32[np.ndarray, "p n 3"]
    log_albedo: Float32[np.ndarray, "p n 3"]
    variance: Float32[np.ndarray, "p n"]
    """Variance within a face's own picture."""
    settings: PoseEvidenceSettings

    @cached_property
    def _design(self) -> Float32[np.ndarray, "p n 4"]:
        return np.concatenate([np.ones((*self.normals.shape[:2], 1), np.float32), self.normals], axis=2)

    def fitted(
        self, log_rgb: Float[np.ndarray, "n 3"], used: Bool[np.ndarray, "p n"]
    ) -> tuple[Float[np.ndarray, "p 4"], Float[np.ndarray, "p 3"]]:
        """Strength (a constant and a slope along each axis) and tint that explain most of the used cells."""
        shown = np.where(used[..., None], log_rgb - self.log_albedo, 0.0)
        lightness = shown.mean(axis=2)
        hue = shown - lightness[..., None]
        expected = np.diag([1e-3, *[self.settings.light_sigma**2 / self.settings.slope_sigma**2] * 3]).astype(
            np.float32
        )
        weight = used.astype(np.float32)
        strength, tint = np.zeros((len(used), 4), np.float32), np.zeros((len(used), 3), np.float32)
        for _ in range(self.settings.fitting_rounds):
            weighted = self._design * weight[..., None]
            normal = weighted.transpose(0, 2, 1) @ self._design + expected
            strength = np.linalg.solve(normal, (weighted * lightness[..., None]).sum(axis=1)[..., None])[..., 0]
            counted = weight.sum(axis=1)[:, None] + self.settings.hue_sigma**2 / self.settings.tint_sigma**2
            tint = ((hue * weight[..., None]).sum(axis=1) / counted).astype(np.float32)
            left = self.disagreement(log_rgb - self.lit(strength, tint))
            weight = (used / (1 + left / self.settings.robust) ** 2).astype(np.float32)
        return strength, tint

    def lit(self, strength: Float[np.ndarray, "p 4"], tint: Float[np.ndarray, "p 3"]) -> Float[np.ndarray, "p n 3"]:
        """The faces' colours in this light, as logarithms."""
        return self.log_albedo + (self._design @ strength[..., None]) + tint[:, None]

    def disagreement(self, difference: Float[np.ndarray, "p n 3"]) -> Float[np.ndarray, "p n"]:
        """Half the squared deviation in units of what is expected."""
        r, g, b = difference[..., 0], difference[..., 1], difference[..., 2]
        lightness = (r + g + b) / 3
        hue = (r - lightness) ** 2 + (g - lightness) ** 2 + (b - lightness) ** 2
        return 0.5 * (
            lightness**2 / (self.settings.light_sigma**2 + self.variance)
            + hue / (self.settings.hue_sigma**2 + self.variance)
        )


def _softly(off: Float[np.ndarray, "p n"], power: int) -> Float[np.ndarray, "p n"]:
    """0 for what hardly differs, a half at 1, 1 for what differs much."""
    with np.errstate(over="ignore"):
        raised = np.minimum(off, 1e4) ** power
    return raised / (1.0 + raised)


def _light_of(
    appearance: ShapeAppearance, settings: PoseEvidenceSettings
) -> tuple[Float32[np.ndarray, "o 3"], Float32[np.ndarray, "o"]]:
    """Logarithms of the opaque faces' colours as linear light, and the variance of their pictures in that measure."""
    srgb = appearance.face_rgba[appearance.opaque_faces, :3] / 255.0
    light = srgb_to_linear(srgb)
    slope = 2.2 * srgb.mean(axis=1) ** 1.2 / (light.mean(axis=1) + settings.darkest)
    variance = (slope * appearance.face_spread[appearance.opaque_faces] / 255.0) ** 2
    return np.log(light + settings.darkest).astype(np.float32), variance.astype(np.float32)
