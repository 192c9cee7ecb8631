"""How well posed shapes agree with the picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.arrangement.facing.evidence import NO_COSTS, HeadingCosts
from diorama_core.geometry.observed import Observed
from diorama_core.geometry.projection import box_iou
from diorama_core.geometry.see_through import SeeThrough
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster, ShapeHits
from diorama_core.geometry.window import soft_iou
from diorama_core.pose.limits import SizeLimits
from diorama_core.pose.settings import SETTINGS, PoseEvidenceSettings
from diorama_core.pose.surface import ObjectSurface
from diorama_core.scene.types import Camera, Pose

_OFF_AXIS_SIGMA_RAD = float(np.deg2rad(35.0))


@dataclass(frozen=True, eq=False)
class Evidence:
    """All observations that score a pose of one object."""

    camera: Camera
    seen: Observed
    surface: ObjectSurface | None
    """None where depth was not measured."""
    see_through: SeeThrough | None = None
    """Where one looks past the object; None where its mask tells."""
    facing: HeadingCosts = NO_COSTS
    """What the room says of its headings, once that is known."""
    settings: PoseEvidenceSettings = SETTINGS.evidence

    def errors(self, caster: ShapeCaster, poses: PoseBatch) -> Float[np.ndarray, "p"]:
        """0 (agrees entirely) to 1: weighted disagreement of silhouette, box, depth and normals."""
        if self.surface is None:  # how far away it is would not count
            return self._outline_errors(caster, poses, self.seen.silhouettes(caster, poses))
        return self.errors_of(caster, self.seen.hits(caster, poses))

    def error(self, caster: ShapeCaster, pose: Pose) -> float:
        """As `errors`, of one pose."""
        return float(self.errors(caster, PoseBatch.single(pose))[0])

    def errors_of(self, caster: ShapeCaster, hits: ShapeHits) -> Float[np.ndarray, "p"]:
        """As `errors`, of a shape that the rays have met."""
        if self.surface is None:
            return self._outline_errors(caster, hits.poses, hits.is_hit)
        weights = [
            self.settings.silhouette_weight_with_depth * (0.3 + 0.7 * self.seen.mask_trust),
            self.settings.depth_weight,
        ]
        return _disagreement(weights, [self._outline_with_depth(self.surface, hits), self.surface.agreement(hits)])

    def _outline_errors(
        self, caster: ShapeCaster, poses: PoseBatch, covered: Bool[np.ndarray, "p r"]
    ) -> Float[np.ndarray, "p"]:
        boxes = box_iou(caster.bounds_px(self.camera, poses), np.asarray(self.seen.box))
        weights = [self.settings.silhouette_weight * self.seen.mask_trust, self.settings.box_weight]
        return _disagreement(weights, [self._outline(covered), np.nan_to_num(boxes)])

    def _outline(self, silhouettes: Bool[np.ndarray, "p n"]) -> Float[np.ndarray, "p"]:
        """Agreement with the mask as far as the picture's colours confirm it, and with where they look past the object.

        Without colours that tell, the mask is trusted less where a shape is open below (`Observed.agreement`).
        """
        if self.see_through is None:
            return self.seen.agreement(silhouettes)
        share, weight = self.see_through.share, self.seen.weight * self._mask_weight
        of_mask = soft_iou(self.seen.covered, silhouettes.astype(np.float64), weight)
        return (1 - share) * of_mask + share * self.see_through.agreement(silhouettes)

    @cached_property
    def _mask_weight(self) -> Float[np.ndarray, "n"]:
        """What cells of the mask count: less where the colours contradict it."""
        assert self.see_through is not None
        boxed = self.see_through.weight > 0
        return 1 - self.settings.of_contradicted * boxed * np.abs(self.seen.covered - self.see_through.shown)

    def _outline_with_depth(self, surface: ObjectSurface, hits: ShapeHits) -> Float[np.ndarray, "p"]:
        """Intersection over union with the mask where nothing that was measured is in front of the shape."""
        k = self.camera.intrinsics
        inside = self.seen.window.is_in_photo(k.width, k.height).astype(np.float64)
        before = np.where(surface.known, inside, self.seen.weight)
        weight = np.where(surface.hides(hits), 0.0, before)
        return soft_iou(self.seen.covered, hits.is_hit.astype(np.float64), weight)

    def log_scores(
        self,
        errors: Float[np.ndarray, "p"],
        poses: PoseBatch,
        off_axis_rad: Float[np.ndarray, "p"],
        misfit: Float[np.ndarray, "p"],
        limits: SizeLimits,
    ) -> Float[np.ndarray, "p"]:
        """Scores of poses of this object; higher is better.

        The logarithm lets a nearly perfect silhouette overrule what objects usually do, and lets habit decide
        between silhouettes that fit equally badly.

        Args:
            errors: share of the silhouette that disagrees with the mask, one a pose.
            poses: p of them.
            off_axis_rad: angle from the nearest axis of the cuboid.
            misfit: of the cuboid, in logarithms of its sides.
            limits: of the shape's scale.
        """
        cost = self.habit_cost(poses, limits)
        cost = cost + 0.5 * (misfit / self.settings.misfit_sigma) ** 2
        cost = cost + 0.5 * (off_axis_rad / _OFF_AXIS_SIGMA_RAD) ** 2
        strength = (
            1.0 + self.settings.of_sure_mask * self.seen.mask_trust**4
            if self.surface is None
            else self.settings.strength_with_depth
        )
        return -strength * np.log(errors + self.settings.noise_floor) - cost

    def habit_cost(self, poses: PoseBatch, limits: SizeLimits) -> Float[np.ndarray, "p"]:
        """What speaks against poses whatever the picture shows: unusual headings and uneven stretching."""
        sigma = self.settings.stretch_sigma_of_flat if limits.any_proportions else self.settings.stretch_sigma
        stretched = 0.5 * (limits.stretch(poses.scale) / sigma) ** 2
        return self.facing.cost(poses.R) + stretched

    def enlargement_cost(self, scale: Float[np.ndarray, "3"], limits: SizeLimits) -> float:
        """What speaks against a shape that had to become much larger or smaller than it was made, from a photo alone.

        A folded blanket that is twice as large in every direction is another thing. A sure outline tells that better.
        """
        logs = np.log(scale[~limits.thin]) if not limits.thin.all() else np.log(scale)
        return 0.5 * (1.0 - self.seen.mask_trust**4) * (float(logs.mean()) / self.settings.enlarged_sigma_reasoned) ** 2

    def sure_outline_cost(self, error: float) -> float:
        """What a sure mask says of a shape's disagreement beyond its score, from a photo alone."""
        return (
            self.settings.of_sure_outline * self.seen.mask_trust**4 * float(np.log(error + self.settings.noise_floor))
        )

    def see_through_score(self, caster: ShapeCaster, poses: PoseBatch) -> float:
        """What colours say of one posed shape by where one looks past it, beyond its score: a logarithm, at most 0."""
        if self.see_through is None:
            return 0.0
        alike = float(self.see_through.agreement(self.seen.silhouettes(caster, poses))[0])
        return self.see_through.share * float(np.log(np.clip(alike, self.settings.seen_past_floor, 1.0)))

    def log_likelihood(self, error: float, scale: Float[np.ndarray, "3"], limits: SizeLimits) -> float:
        """How well one shape at its best pose explains the object, to compare shapes where depth was measured.

        Shapes are made in metres: the very one fits without being enlarged or stretched much. Where the library has
        none of that size, how much exactly one that is like it was changed says little: the tails are those of a Cauchy
        distribution.

        Args:
            error: share of the silhouette that disagrees with the mask.
            scale: of the shape, an axis each.
            limits: of the shape's scale.
        """
        logs = np.log(scale[~limits.thin]) if not limits.thin.all() else np.log(scale)
        deviations = np.array(
            [float(logs.mean()) / self.settings.enlarged_sigma, float(logs.std()) / self.settings.likelihood_sigma]
        )
        cost = 0.5 * float(np.log1p(deviations**2).sum())
        return -self.settings.strength_of_shapes * float(np.log(error + self.settings.likelihood_floor)) - cost

    def confidence(self, error: float, cuboid_confidence: float) -> float:
        """0 to 1: lower for cut, hidden, tiny or badly masked objects and for poses that fit badly."""
        x1, y1, x2, y2 = self.seen.box
        large_enough = min(max((x2 - x1) * (y2 - y1), 0.0) ** 0.5 / 24.0, 1.0)
        visible = (1.0 - 0.6 * self.seen.border_share) * (1.0 - 0.7 * self.seen.hidden_share)
        believed = (0.3 + 0.7 * self.seen.mask_trust) * (0.5 + 0.5 * float(np.clip(cuboid_confidence, 0.0, 1.0)))
        value = (1.0 - error) * large_enough * visible * believed
        return float(np.clip(np.nan_to_num(value), 0.0, 1.0))


def _disagreement(weights: Sequence[float], agreements: Sequence[Float[np.ndarray, "p"]]) -> Float[np.ndarray, "p"]:
    """1 less the weighted mean of agreements."""
    agreement = sum(w * t for w, t in zip(weights, agreements, strict=True)) / sum(weights)
    return np.clip(1.0 - np.nan_to_num(agreement), 0.0, 1.0)
