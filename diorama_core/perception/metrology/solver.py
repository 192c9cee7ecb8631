"""Levenberg-Marquardt over a batch of small problems, each with its own damping."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.perception.metrology.problem import UNKNOWNS, Problems, Values, View, concatenate_problems, values
from diorama_core.perception.metrology.settings import SETTINGS, CuboidFitSettings

_STEP = 1e-5
_LOW = np.array([-8.0, np.log(0.15), np.log(0.005), np.log(0.01), np.log(0.005), -8.0])
_HIGH = np.array([8.0, np.log(25.0), np.log(8.0), np.log(8.0), np.log(5.0), 8.0])


@dataclass(frozen=True, eq=False)
class Solutions:
    """Where the rows ended."""

    problems: Problems
    unknowns: Float[np.ndarray, "n 6"]
    cost: Float[np.ndarray, "n"]
    """Sum of squared residuals plus the constant cost of the row's assumptions."""

    def rows(self, chosen: np.ndarray) -> Solutions:
        """The chosen rows."""
        return Solutions(self.problems.rows(chosen), self.unknowns[chosen], self.cost[chosen])

    def dearer(self, by: Float[np.ndarray, "n"]) -> Solutions:
        """These rows with more against each."""
        return Solutions(self.problems.with_columns(extra=self.problems.extra + by), self.unknowns, self.cost + by)


def concatenate_solutions(a: Solutions, b: Solutions) -> Solutions:
    """The rows of both."""
    return Solutions(
        concatenate_problems([a.problems, b.problems]),
        np.concatenate([a.unknowns, b.unknowns]),
        np.concatenate([a.cost, b.cost]),
    )


def solve(
    problems: Problems,
    start: Float[np.ndarray, "n 6"],
    view: View,
    iterations: int = 14,
    settings: CuboidFitSettings = SETTINGS.fit,
) -> Solutions:
    """Minimise every row's cost from its start; rows that have settled are left alone.

    Args:
        problems: n rows.
        start: unknowns of every row; they are brought within their bounds.
        view: intrinsics, and rotation from camera to world.
        iterations: at most.
        settings: of the fit.
    """
    low, high = _bounds(problems, settings)
    unknowns = np.clip(start, low, high)
    at = values(unknowns, problems, view, settings=settings)
    cost = _cost(at)
    damping = np.full(len(problems), 1e-2)
    active, moved = np.arange(len(problems)), np.arange(len(problems))
    gradient, normal = np.empty((len(problems), UNKNOWNS)), np.empty((len(problems), UNKNOWNS, UNKNOWNS))
    plain = replace(problems, outline=problems.outline[:, :0])  # the largest column, of no use where insets are known
    for _ in range(iterations):
        if not len(active):
            break
        anew = np.intersect1d(active, moved, assume_unique=True)  # a row that stayed has the slopes that it had
        if len(anew):
            here = Values(at.residuals[anew], at.inset_px[anew])
            gradient[anew], normal[anew] = _slopes(plain.rows(anew), unknowns[anew], here, view, settings)
        start, bounds = unknowns[active], (low[active], high[active])
        step = _step((gradient[active], normal[active]), start, damping[active], bounds, settings)
        trial = np.clip(start + step, *bounds)
        at_there = values(trial, problems.rows(active), view, settings=settings)
        reached = _cost(at_there)
        gain = cost[active] - reached
        better = gain > 0
        moved = active[better]
        unknowns[moved], cost[moved] = trial[better], reached[better]
        at.residuals[moved], at.inset_px[moved] = at_there.residuals[better], at_there.inset_px[better]
        damping[active] = np.where(better, damping[active] * 0.3, damping[active] * 6.0)
        active = active[(~better & (damping[active] < 1e5)) | (gain > settings.min_gain)]
    return Solutions(problems, unknowns, cost + problems.extra)


def _bounds(
    problems: Problems, settings: CuboidFitSettings
) -> tuple[Float[np.ndarray, "n 6"], Float[np.ndarray, "n 6"]]:
    """Sizes stay within what the category allows, whatever the box says."""
    low, high = np.tile(_LOW, (len(problems), 1)), np.tile(_HIGH, (len(problems), 1))
    reach = settings.max_sigmas * problems.log_size_sigma
    low[:, 2:5] = np.maximum(low[:, 2:5], problems.log_size - reach)
    high[:, 2:5] = np.minimum(high[:, 2:5], problems.log_size + reach)
    return low, high


def _cost(at: Values) -> Float[np.ndarray, "n"]:
    return np.asarray((at.residuals**2).sum(axis=1))


def _slopes(
    problems: Problems, unknowns: Float[np.ndarray, "n 6"], here: Values, view: View, settings: CuboidFitSettings
) -> tuple[Float[np.ndarray, "n 6"], Float[np.ndarray, "n 6 6"]]:
    """Gradients and normal matrices, by forward differences; insets of outlines are taken to stay."""
    probes = (unknowns[None] + _STEP * np.eye(UNKNOWNS)[:, None]).reshape(-1, UNKNOWNS)
    repeated = problems.rows(np.tile(np.arange(len(problems)), UNKNOWNS))
    inset = np.tile(here.inset_px, (UNKNOWNS, 1))
    there = values(probes, repeated, view, inset, settings).residuals.reshape(UNKNOWNS, *here.residuals.shape)
    derivatives = ((there - here.residuals) / _STEP).transpose(1, 2, 0)
    turned = derivatives.transpose(0, 2, 1)
    return (turned @ here.residuals[..., None])[..., 0], turned @ derivatives


def _step(
    slopes: tuple[Float[np.ndarray, "n 6"], Float[np.ndarray, "n 6 6"]],
    unknowns: Float[np.ndarray, "n 6"],
    damping: Float[np.ndarray, "n"],
    bounds: tuple[Float[np.ndarray, "n 6"], Float[np.ndarray, "n 6"]],
    settings: CuboidFitSettings,
) -> Float[np.ndarray, "n 6"]:
    """The damped Gauss-Newton step of the unknowns that no bound stops."""
    (low, high), (gradient, normal) = bounds, slopes
    free = ~(((unknowns <= low) & (gradient > 0)) | ((unknowns >= high) & (gradient < 0)))
    gradient = gradient * free
    normal = normal * free[:, :, None] * free[:, None, :]
    diagonal = np.where(free, np.einsum("nii->ni", normal), 1.0)
    normal = normal + np.eye(UNKNOWNS) * (damping[:, None] * (diagonal + 1e-2))[:, None]
    step = -np.linalg.solve(normal, gradient[..., None])[..., 0]
    longest = np.abs(step).max(axis=1, keepdims=True)
    return step * np.minimum(1.0, settings.longest_step / np.maximum(longest, 1e-12))
