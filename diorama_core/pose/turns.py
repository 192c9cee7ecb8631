"""Which way round a shape stands that is almost where it belongs: its turns, compared closely."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.shape_appearance import ShapeAppearance
from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.library.record import SymmetryFold
from diorama_core.pose.appearance_likelihood import AppearanceLikelihood
from diorama_core.pose.hypotheses import unlike_best
from diorama_core.pose.limits import SizeLimits
from diorama_core.pose.mask_observations import Evidence
from diorama_core.pose.measured import MeasuredObject
from diorama_core.pose.settings import SETTINGS, PoseSearchSettings
from diorama_core.scene.types import yaw_rotation

_RIVAL_RAD = float(np.deg2rad(45.0))
"""A pose turned farther than this is another reading of the picture, not a correction."""
_NEARBY_RAD = np.deg2rad(np.arange(-60.0, 61.0, 12.0))
_RIGHT_RAD = float(np.deg2rad(20.0))
"""Headings this near are as good as right."""
_FIXED_YAW_RAD = float(np.deg2rad(1.0))


@dataclass(frozen=True, eq=False)
class TurnSearch:
    """Turns of one shape against one object's pixels."""

    close: AppearanceLikelihood
    observations: Evidence
    measured: MeasuredObject
    appearance: ShapeAppearance
    limits: SizeLimits
    fold: SymmetryFold
    believed: float = 1.0
    """How much its pixels say: less where the shape fits badly whichever way it is turned."""
    settings: PoseSearchSettings = SETTINGS.search

    @classmethod
    def of(
        cls,
        close: AppearanceLikelihood,
        observations: Evidence,
        measured: MeasuredObject,
        appearance: ShapeAppearance,
        limits: SizeLimits,
        fold: SymmetryFold,
        start: PoseBatch,
        settings: PoseSearchSettings,
    ) -> TurnSearch:
        """The search around one pose, believing pixels as far as they fit it.

        Args:
            close: compares the shape's appearance with the photo.
            observations: the object's mask.
            measured: its measured surface, if any.
            appearance: colours of the shape's surface.
            limits: of the shape's scale.
            fold: number of turns about the up axis that leave the shape as it is.
            start: one pose.
            settings: of the search.
        """
        badly = max(close.misfit(appearance, start) - settings.usual_misfit, 0.0)
        return cls(
            close,
            observations,
            measured,
            appearance,
            limits,
            fold,
            1.0 / (1.0 + badly / settings.misfit_scale),
            settings,
        )

    def best(self, start: PoseBatch) -> tuple[PoseBatch, float]:
        """The likeliest turn of a pose in its place, and how nearly as likely another one is, 0 to 1."""
        turns = np.arange(max(round(self.settings.turn_steps / self.fold), 2)) * 2 * np.pi
        grid = self._turned(start, turns / (self.fold * len(turns)))
        modes = unlike_best(
            grid,
            self._compared_closely(grid, exact=False),
            self.fold,
            self.limits.shape_size_m,
            self.settings.turns_refined,
            self.settings,
        )
        tried = start.and_also(grid[modes]).and_also(
            self.measured.fit(self.limits).refined(self.appearance.caster, grid[modes])
        )
        scores = self._scores(tried)
        chosen = 0 if scores[0] + self.settings.margin >= scores.max() else int(np.argmax(scores))
        rivals = self._away_rad(tried, chosen) > min(_RIVAL_RAD, 0.8 * np.pi / self.fold)
        doubt = min(float(np.exp(scores[rivals].max() - scores[chosen])), 1.0) if rivals.any() else 0.0
        best = tried[chosen : chosen + 1]
        return (self._central_heading(best) if self.believed > self.settings.well_believed else best), doubt

    def _central_heading(self, best: PoseBatch) -> PoseBatch:
        """The heading with most likelihood near it: a handle that is out of sight may be anywhere behind its mug."""
        turns = _NEARBY_RAD[np.abs(_NEARBY_RAD) <= np.pi / self.fold]
        turned = self._turned(best, turns)
        fit = replace(self.measured.fit(self.limits), yaw_sigma_rad=_FIXED_YAW_RAD)
        both = turned.and_also(fit.refined(self.appearance.caster, turned))
        scores = self._compared_closely(both, exact=True) + self.measured.log_likelihood(both, self.limits)
        count = len(turns)
        better = np.where(scores[count:] > scores[:count], np.arange(count) + count, np.arange(count))
        likely = np.exp(scores[better] - scores[better].max())
        near = np.abs(turns[:, None] - turns) <= _RIGHT_RAD + 1e-6
        mass = near @ likely
        middle = int(np.argmax(mass - self.settings.stays * mass.max() * np.abs(turns)))
        return both[better[middle : middle + 1]] if likely[middle] > self.settings.min_likely else best

    def _turned(self, start: PoseBatch, turns_rad: Float[np.ndarray, "k"]) -> PoseBatch:
        """One pose turned about the axis of the shape's body."""
        R = np.array([start.R[0] @ yaw_rotation(angle) for angle in turns_rad])
        axis = np.array([*self.appearance.axis_xy, 0.0]) * start.scale[0]
        position = start.position + start.R[0] @ axis - R @ axis
        return PoseBatch(R, position, np.tile(start.scale, (len(R), 1)))

    def _away_rad(self, poses: PoseBatch, index: int) -> Float[np.ndarray, "p"]:
        """Differences of headings from one of them, up to symmetry."""
        yaw = np.arctan2(poses.R[:, 1, 0], poses.R[:, 0, 0])
        half = np.pi / self.fold
        return np.abs(np.mod(yaw - yaw[index] + half, 2 * half) - half)

    def _compared_closely(self, poses: PoseBatch, exact: bool) -> Float[np.ndarray, "p"]:
        """By pixels, habit and stretch alone: cheap."""
        return self.close.log_likelihoods(self.appearance, poses, exact) - self.observations.habit_cost(
            poses, self.limits
        )

    def _scores(self, poses: PoseBatch) -> Float[np.ndarray, "p"]:
        """Ranked by all observations."""
        errors, nothing = self.observations.errors(self.appearance.caster, poses), np.zeros(len(poses))
        usual = self.observations.log_scores(errors, poses, nothing, nothing, self.limits)
        more_habit = self.settings.habit_strength * self.observations.facing.cost(poses.R)
        stands = self.measured.log_likelihood(poses, self.limits)
        stands = stands - self.measured.elsewhere_cost(poses, self.limits, errors)
        return usual + stands + self.believed * self.close.log_likelihoods(self.appearance, poses) - more_habit
