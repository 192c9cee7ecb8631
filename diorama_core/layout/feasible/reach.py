"""How far objects reach beyond what the picture shows of them: supporters as far as what was seen on them, lamps that
the picture's border cuts up to the ceiling.

A retrieved table is shorter than the true one, or its far end was a guess. A load that was seen beyond its edge would
have to leave the place where it was seen, and for a small thing that is all of its outline; with one side of the table
farther out, only that side of the table changes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.surfaces import RestingSurface
from diorama_core.layout.feasible.photo_observations import PhotoObservations
from diorama_core.layout.feasible.rest import INSET_M
from diorama_core.layout.feasible.structure import Structure
from diorama_core.layout.problem.problem import Problem, reach_of


def reaching_loads(problem: Problem, structure: Structure, eye: Float[np.ndarray, "3"] | None) -> Problem:
    """The problem with sides of supporters farther out, to where their loads were seen; by `max_stretch` at most.

    Sides against walls stay.

    Args:
        problem: the observed poses and the graph.
        structure: the same with every object on its support.
        eye: the camera's position where sizes follow distances; a load is then seen where its line of sight meets its
            place, in the size that it has there. None where distances were measured.
    """
    scale, p = problem.scale.copy(), problem.p.copy()
    for j in range(problem.count):
        loads = [i for i in np.flatnonzero(problem.parent == j) if _stands(problem, structure, int(i))]
        if not problem.free[j] or not loads:
            continue
        for axis in range(3):
            outward = structure.R[j][:, axis]
            if abs(float(outward[2])) > 1.0 - problem.settings.upward:
                continue
            for sign in (-1.0, 1.0):
                if any(k == j and sign * float(face[axis]) > 0.5 for k, _, face in problem.adheres):
                    continue
                factor = max(_extent_factor(problem, structure, int(i), sign * outward, axis, eye) for i in loads)
                extent = float(problem.shape_size[j, axis] * scale[j, axis])
                farther = extent * (min(factor, problem.settings.max_stretch) - 1.0)
                scale[j, axis] *= 1.0 + farther / extent
                p[j] = p[j] + 0.5 * farther * sign * problem.R[j][:, axis]
    return replace(problem, scale=scale, p=p)


def _stands(problem: Problem, structure: Structure, i: int) -> bool:
    """Whether an object keeps its form on an upward place."""
    place = structure.surface[i]
    return place is not None and float(place.normal[2]) > problem.settings.upward and float(problem.firm[i]) == 1.0


def _extent_factor(
    problem: Problem, structure: Structure, i: int, outward: np.ndarray, axis: int, eye: np.ndarray | None
) -> float:
    """What the extent of a load's supporter must be multiplied by for its side to reach the load; 1 where it does.

    A load that is larger than its supporter says more about its own size, and hangs over.
    """
    j = int(problem.parent[i])
    surface = structure.surface[i]
    assert surface is not None, "it stands on something"
    place: RestingSurface = surface.transform(structure.R[j], structure.p[j], structure.scale[j])
    centre, grown = _locate_along_sight(problem, i, place.level, eye)
    reach = float(reach_of(problem.footing[i], structure.R[i], grown * problem.scale[i], outward[None])[0])
    edge = float((place.polygon @ outward).max())
    beyond = float(outward @ centre) + reach + INSET_M - edge
    half = 0.5 * float(problem.shape_size[j, axis] * structure.scale[j, axis])
    back = float(outward @ structure.p[j]) - half
    settings = problem.settings
    within = back + 2.0 * half - edge > settings.inner_share * 2.0 * half
    if beyond <= settings.min_beyond_m or within or 2.0 * reach > edge - back or not _is_near(place, outward, centre):
        return 1.0
    return 1.0 + beyond / max(edge - back, 1e-6)


def _is_near(place: RestingSurface, outward: np.ndarray, centre: np.ndarray) -> bool:
    """Whether a point is beside a place only in one direction."""
    across = np.array([-outward[1], outward[0], 0.0])
    along = place.polygon @ across
    return bool(along.min() <= float(across @ centre) <= along.max())


def _locate_along_sight(
    problem: Problem, i: int, level_m: float, eye: np.ndarray | None
) -> tuple[Float[np.ndarray, "3"], float]:
    """Where an object with its foot at a height is seen, and how many times as far away as it was observed."""
    p = problem.p[i]
    if eye is None:
        return p, 1.0
    sight = p - np.array([0.0, 0.0, 0.5 * float(problem.shape_size[i, 2] * problem.scale[i, 2])]) - eye
    if abs(float(sight[2])) < problem.settings.min_slant * float(np.linalg.norm(sight)):
        return p, 1.0
    grown = (level_m - float(eye[2])) / float(sight[2])
    if not 1.0 / problem.settings.max_growth <= grown <= problem.settings.max_growth:
        return p, 1.0
    return eye + grown * (p - eye), grown


def reaching_ceilings(problem: Problem, observations: PhotoObservations) -> Problem:
    """The problem with lamps whose upper end was not seen going on up to the ceiling that they hang from.

    The lower end stays.
    """
    scale, p, slope = problem.scale.copy(), problem.p.copy(), problem.settings.ceiling_slope
    for i in map(int, np.flatnonzero(problem.free & observations.hidden[:, 1])):
        ceiling = problem.surface[i]
        if problem.on_plane[i] is None or ceiling is None or ceiling.normal[2] > -slope or problem.contact[i][2] < 0.5:
            continue
        up = problem.R[i][:, 2]
        height = float(problem.shape_size[i, 2] * scale[i, 2])
        gap = (float(ceiling.normal @ p[i]) - ceiling.level) / max(-float(ceiling.normal @ up), slope) - height / 2
        if 0.0 < gap <= problem.settings.max_cord_m:
            scale[i, 2] *= 1.0 + gap / height
            p[i] = p[i] + 0.5 * gap * up
    return replace(problem, scale=scale, p=p)
