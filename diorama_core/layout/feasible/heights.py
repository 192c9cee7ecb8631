"""Heights of what stands on one another, found together: contact that needs no moves.

With measured depth the foot and the top of every object are observations, and a retrieved table is not as high as the
true one. Settled one after another, everything on it would go up or down with it. Found together, the table becomes as
high as its loads say: one least-squares problem over the heights of all objects, in which each foot is where its
supporter's place is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.optimize import lsq_linear

from diorama_core.arrangement.surfaces import RestingSurface, is_wall_like
from diorama_core.layout.feasible.photo_observations import PhotoObservations
from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.settings import LayoutSettings


@dataclass(frozen=True, eq=False)
class _Chains:
    """Feet as a linear function of the unknowns: foot_i = constant_i + rows_i @ (heights, feet of what hangs)."""

    members: tuple[int, ...]
    rows: Float[np.ndarray, "n v"]
    constant: Float[np.ndarray, " n"]


def joint_heights(problem: Problem, observations: PhotoObservations) -> tuple[Problem, PhotoObservations]:
    """The problem and what was observed of it, at heights at which supporters and loads agree best with what was seen.

    Each end of an object counts relative to how high the object looks in the picture: a centimetre is much for a cup
    and little for the table below it. Objects that are exact already stay as they are, since nothing disagrees.
    """
    chains = _chains(problem, observations)
    if not chains.members:
        return problem, observations
    height = problem.shape_size[:, 2] * problem.scale[:, 2]
    foot = problem.p[:, 2] - height / 2
    x = _solve_heights(problem, observations, chains, height, foot)
    members = np.array(chains.members)
    heights = x[: len(members)]
    feet = chains.constant[members] + chains.rows[members] @ x
    moved = np.maximum(np.abs(heights - height[members]), np.abs(feet - foot[members]))
    changed = moved > problem.settings.height_rounding_m
    scale, p = problem.scale.copy(), problem.p.copy()
    chosen = members[changed]
    scale[chosen, 2] *= heights[changed] / height[chosen]
    p[chosen, 2] = (feet + heights / 2)[changed]
    holds = np.isin(members, problem.parent)
    fixed = members[holds | ~observations.contradicted[members]]
    return replace(problem, scale=scale, p=p), observations.fix_heights(fixed, scale[:, 2])


def _chains(problem: Problem, observations: PhotoObservations) -> _Chains:
    """The objects whose heights are sought: upright ones at measured places, on a floor, on another or on a wall."""
    members = [i for i in problem.top_down if _is_sought(problem, observations, i)]
    hanging = [i for i in members if is_wall_like(problem.surface[i])]
    column = {i: k for k, i in enumerate(members)}
    own_foot = {i: len(members) + k for k, i in enumerate(hanging)}
    rows = np.zeros((problem.count, len(members) + len(hanging)))
    constant = np.zeros(problem.count)
    for i in members:
        if i in own_foot:
            rows[i, own_foot[i]] = 1.0
            continue
        j, place = int(problem.parent[i]), _place(problem, i)
        if j in column:
            rows[i], constant[i] = rows[j], constant[j]
            rows[i, column[j]] += place.level / problem.shape_size[j, 2] + 0.5
        else:
            constant[i] = problem.to_world(i, place).level
    return _Chains(tuple(members), rows, constant)


def _is_sought(problem: Problem, observations: PhotoObservations, i: int) -> bool:
    surface = problem.surface[i]
    if surface is None or not problem.free[i] or not observations.measured[i] or problem.firm[i] < 1.0:
        return False
    if is_wall_like(surface):
        return bool((problem.parent == i).any()) and not problem.grounded[i]
    upright = problem.contact[i][2] == -1.0 and float(problem.R[i][2, 2]) > problem.settings.upward
    return upright and float(surface.normal[2]) > problem.settings.upward


def _place(problem: Problem, i: int) -> RestingSurface:
    place = problem.place_of(i, problem)
    assert place is not None, "it rests on something"
    return place


def _solve_heights(
    problem: Problem,
    observations: PhotoObservations,
    chains: _Chains,
    height: Float[np.ndarray, " n"],
    foot: Float[np.ndarray, " n"],
) -> Float[np.ndarray, " v"]:
    """Heights of the members, and feet of those that hang, that agree best with both ends of every object."""
    count, unknowns = len(chains.members), chains.rows.shape[1]
    hanging = [i for i in chains.members if is_wall_like(problem.surface[i])]
    start = np.concatenate([height[list(chains.members)], foot[hanging]])
    # From below nobody sees where on a refrigerator a box stands.
    from_below = (problem.parent >= 0) & (foot > float(observations.camera.position[2]))
    foot_hidden = observations.hidden[:, 3] | from_below
    lines, wanted = [], []
    for k, i in enumerate(chains.members):
        is_unknown = np.arange(unknowns) == k
        level = problem.to_world(i, _place(problem, i)).level
        fits = int(problem.parent[i]) < 0 or abs(level - foot[i]) <= problem.settings.load_m
        hidden = [foot_hidden[i], observations.hidden[i, 1]]
        weight = np.where(hidden, problem.settings.hidden, 1.0) / _apparent_height_m(observations, i)
        if fits:
            lines += [weight[0] * chains.rows[i], weight[1] * (chains.rows[i] + is_unknown)]
            wanted += list(weight * (np.array([foot[i], foot[i] + height[i]]) - chains.constant[i]))
        else:  # it does not stand there as observed, and says nothing about that place
            lines.append(weight[1] * is_unknown)
            wanted.append(weight[1] * height[i])
    # A hidden foot says nothing against a height: the top was measured, and the foot is on the floor. A board of a
    # retrieved shelf is not where that of the true one is.
    whole = [foot[i] + height[i] - (chains.constant[i] + chains.rows[i] @ start) for i in chains.members]
    members = list(chains.members)
    tall = np.where(foot_hidden[members] & (problem.parent[members] < 0), whole, 0.0)
    stretch = problem.settings.max_stretch
    least = np.concatenate([start[:count] / stretch, np.full(unknowns - count, -np.inf)])
    most = np.concatenate([stretch * np.maximum(start[:count], tall), np.full(unknowns - count, np.inf)])
    return _robust(np.array(lines), np.array(wanted), (least, most), problem.settings)


def _robust(
    A: Float[np.ndarray, "r v"],
    b: Float[np.ndarray, " r"],
    bounds: tuple[Float[np.ndarray, " v"], Float[np.ndarray, " v"]],
    settings: LayoutSettings,
) -> Float[np.ndarray, " v"]:
    """The bounded least-squares solution in which large disagreements count by their size, not its square (Huber)."""
    weight = np.ones(len(b))
    for _ in range(settings.height_rounds):
        x = np.asarray(lsq_linear(weight[:, None] * A, weight * b, bounds).x)
        weight = np.sqrt(1.0 / np.maximum(np.abs(A @ x - b) / settings.usual, 1.0))
    return x


def _apparent_height_m(observations: PhotoObservations, i: int) -> float:
    """How high an object looks in the picture, in metres at its distance."""
    camera = observations.camera
    pixels = float(observations.bounds_px[i, 3] - observations.bounds_px[i, 1])
    metres = pixels * float(camera.to_camera(observations.observed[i : i + 1])[0, 2]) / camera.intrinsics.fy
    return max(metres, observations.settings.min_extent_m) if np.isfinite(metres) else 1.0
