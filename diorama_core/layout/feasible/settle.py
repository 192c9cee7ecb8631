"""One object brought onto what holds it up: turned, stretched or moved there, within its edge and before the walls."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.surfaces import RestingSurface, is_wall_like
from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.vectors import cross
from diorama_core.layout.feasible.photo_observations import PhotoObservations
from diorama_core.layout.feasible.quadratic import HARD, least_distance
from diorama_core.layout.feasible.rest import INSET_M, align, largest_share
from diorama_core.layout.problem.problem import Problem, reach_of


@dataclass
class Walk:
    """The structure while it grows."""

    R: np.ndarray
    p: np.ndarray
    scale: np.ndarray
    basis: np.ndarray
    surface: list[RestingSurface | None]
    owners: list[int] = field(default_factory=list)
    normals: list[np.ndarray] = field(default_factory=list)
    slacks: list[float] = field(default_factory=list)
    reasons: list[str] = field(default_factory=list)


def settle(
    problem: Problem,
    walk: Walk,
    i: int,
    surface: RestingSurface,
    against: list[tuple[int, np.ndarray]],
    ray: np.ndarray | None,
    observations: PhotoObservations | None,
    eye: np.ndarray | None,
) -> None:
    """Fix what the supporter of object i determines, in `walk`: rotation, size and height, and what bounds the rest.

    Args:
        problem: the observed poses and the graph.
        walk: the structure so far; its supporters are settled.
        i: index of the object.
        surface: where it rests, in the world.
        against: walls against which it stands, by index, and its faces there (object frame).
        ray: unit viewing directions per object, as in `exact_structure`.
        observations: what the camera saw.
        eye: the camera's position where sizes follow distances, as in `exact_structure`.
    """
    n = surface.normal
    walk.R[i] = align(walk.R[i], problem.contact[i], surface, [(problem.walls[w].normal, f) for w, f in against])
    u, v = plane_axes(n)
    _shorten_before_walls(problem, walk, i)
    if observations is not None:
        observations = observations.no_larger(i, np.where(walk.scale[i] < problem.scale[i], walk.scale[i], np.inf))
    grown = 1.0 if eye is None else _from_the_eye(problem, walk, i, surface, eye)
    if observations is not None and observations.measured[i]:
        _reach_support(problem, walk, i, surface)
    _set_on_support(problem, walk, i, surface, None if ray is None else ray[i])
    grounded = problem.grounded[i] and is_wall_like(surface)
    walk.basis[i] = np.column_stack([u, np.zeros(3) if grounded else v])
    _against_walls(problem, walk, i, against)
    if grounded:
        _reach_floor(problem, walk, i)
    if observations is not None:
        pinned = problem.contact[i] + sum((face for _, face in against), np.zeros(3))
        pinned[2] -= float(grounded)
        walk.p[i], walk.scale[i] = observations.fit_centre_and_scale(
            i, walk.R[i], walk.p[i], walk.scale[i], walk.basis[i], pinned, grown
        )
    m, slack = _fit_on_support(problem, walk, i, surface)
    if (slack < 0).any():
        _move_onto_support(problem, walk, i, surface, slack, m)
        if observations is not None:
            _move_along_edge(problem, walk, i, surface, observations, pinned, eye)
        m, slack = _fit_on_support(problem, walk, i, surface)
    walk.owners += [i] * len(m)
    walk.normals += list(m)
    walk.slacks += [max(float(s), 0.0) for s in slack]


def _shorten_before_walls(problem: Problem, walk: Walk, i: int) -> None:
    """Shorten an object that reaches through a wall from behind: its front was seen where it is, its back was not.

    Where what it holds up was seen before its front, the object comes forward so far instead.
    """
    for wall in problem.walls_near(i):
        axis = int(np.abs(wall.normal @ walk.R[i]).argmax())
        half = 0.5 * _size(problem, walk, i)
        through = wall.offset - float(wall.normal @ walk.p[i]) + float(np.abs(wall.normal @ walk.R[i]) @ half)
        factor = 1.0 - through / (2.0 * float(half[axis]))
        slanted = abs(float(wall.normal @ walk.R[i][:, axis])) < problem.settings.parallel
        if slanted or not problem.settings.shortest_before_wall <= factor < 1.0:
            continue
        forward = min(_overhang(problem, i, wall.normal), through)
        walk.scale[i, axis] *= factor + forward / (2.0 * float(half[axis]))
        walk.p[i] = walk.p[i] + (forward + 0.5 * (through - forward)) * wall.normal


def _overhang(problem: Problem, i: int, outward: np.ndarray) -> float:
    """How far what was observed on an object reaches beyond the object's own side, metres."""
    reach = [
        float(
            outward @ problem.p[k] + np.abs(outward @ problem.R[k]) @ (0.5 * problem.shape_size[k] * problem.scale[k])
        )
        for k in problem.rides(i)
    ]
    return max(reach) - reach[0]


def _fit_on_support(
    problem: Problem, walk: Walk, i: int, surface: RestingSurface
) -> tuple[Float[np.ndarray, "k 3"], Float[np.ndarray, " k"]]:
    """Fit the object on its support; gives outward normals of the sides that its free coordinates can meet.

    The object is shrunk where it does not fit and set on its surface first. How far each side is, is given with them.
    """
    reach = _fit(problem, walk, i, surface, surface.outward, surface.offset)
    walk.p[i] = walk.p[i] + _lift(problem, walk, i, surface) * surface.normal
    return sides(surface, _contact_centre(problem, walk, i), reach, walk.basis[i])


def sides(
    surface: RestingSurface,
    contact: Float[np.ndarray, "3"],
    reach: Float[np.ndarray, " s"],
    basis: Float[np.ndarray, "3 2"],
) -> tuple[Float[np.ndarray, "k 3"], Float[np.ndarray, " k"]]:
    """Outward normals of a support's sides that an object's free coordinates can meet, and how far each is.

    Args:
        surface: where the object rests, in the world.
        contact: centre of its contact face.
        reach: of the contact face along each side's outward normal, metres.
        basis: world directions in which the object may move.
    """
    m = surface.outward
    slack = surface.offset - m @ contact - reach - INSET_M
    rows = m @ basis
    mobile = (rows * rows).sum(axis=1) > 1e-12
    return m[mobile], slack[mobile]


def _move_onto_support(
    problem: Problem, walk: Walk, i: int, surface: RestingSurface, slack: np.ndarray, m: np.ndarray
) -> None:
    """Move the shortest way onto the surface: with the coordinates that a wall leaves where that is about as short."""
    plane = np.column_stack(plane_axes(surface.normal))
    shortest = plane @ _shortest_move(m @ plane, slack)
    along = walk.basis[i] @ _shortest_move(m @ walk.basis[i], slack)
    detour = np.linalg.norm(along) > problem.settings.max_detour * np.linalg.norm(shortest) and not problem.grounded[i]
    walk.p[i] = walk.p[i] + (shortest if detour else along)


def _move_along_edge(
    problem: Problem,
    walk: Walk,
    i: int,
    surface: RestingSurface,
    observations: PhotoObservations,
    pinned: np.ndarray,
    eye: np.ndarray | None,
) -> None:
    """Move an object that had to come back onto its support along the side that it came to, until it is seen best."""
    m, slack = _fit_on_support(problem, walk, i, surface)
    reached = m[int(np.argmin(slack))] if len(m) else np.zeros(3)
    side = cross(surface.normal, reached)
    length = float(np.linalg.norm(side))
    free = length > 1e-9 and float(np.linalg.norm(walk.basis[i].T @ (side / max(length, 1e-9)))) > 0.9
    if not free:
        return
    grown = 1.0 if eye is None else _nearness(walk.p[i], problem.p[i], eye, problem.settings.max_growth)
    basis = np.column_stack([side / length, np.zeros(3)])
    start = walk.p[i].copy(), walk.scale[i].copy()
    walk.p[i], walk.scale[i] = observations.fit_centre_and_scale(i, walk.R[i], *start, basis, pinned, grown)
    m, slack = _fit_on_support(problem, walk, i, surface)
    if (slack < 0).any():
        _move_onto_support(problem, walk, i, surface, slack, m)


def _nearness(p: np.ndarray, observed: np.ndarray, eye: np.ndarray, most: float) -> float:
    """How many times as far as it was observed an object is, along its viewing ray and within limits."""
    sight = observed - eye
    return float(np.clip((p - eye) @ sight / max(float(sight @ sight), 1e-9), 1.0 / most, most))


def _reach_floor(problem: Problem, walk: Walk, i: int) -> None:
    """Stretch a door to the floor, keeping its top where it was seen; lower it where that would change it too much."""
    height, most = float(_size(problem, walk, i)[2]), problem.settings.max_stretch
    top = float(walk.p[i][2]) + height / 2
    walk.scale[i, 2] *= np.clip((top - problem.floor_m) / height, 1.0 / most, most)
    walk.p[i] = [*walk.p[i][:2], problem.floor_m + float(_size(problem, walk, i)[2]) / 2]


def _size(problem: Problem, walk: Walk, i: int) -> np.ndarray:
    return problem.shape_size[i] * walk.scale[i]


def _contact_centre(problem: Problem, walk: Walk, i: int) -> np.ndarray:
    return walk.p[i] + walk.R[i] @ (problem.contact[i] * _size(problem, walk, i) / 2)


def _lift(problem: Problem, walk: Walk, i: int, surface: RestingSurface) -> float:
    """How far the contact face is below the surface."""
    return surface.level - float(surface.normal @ _contact_centre(problem, walk, i))


def _reach_support(problem: Problem, walk: Walk, i: int, surface: RestingSurface) -> None:
    """Stretch the object so that its contact face is on its surface; its far face, which was measured, stays."""
    axis = int(np.abs(problem.contact[i]).argmax())
    extent = float(_size(problem, walk, i)[axis])
    wanted = extent - _lift(problem, walk, i, surface)
    factor = float(np.clip(wanted / extent, 1.0 / problem.settings.max_stretch, problem.settings.max_stretch))
    walk.scale[i, axis] *= factor
    walk.p[i] = walk.p[i] - 0.5 * (factor - 1.0) * extent * surface.normal


def _set_on_support(problem: Problem, walk: Walk, i: int, surface: RestingSurface, ray: np.ndarray | None) -> None:
    """Move the object onto its surface: along the normal, or along its viewing ray where that meets it decently."""
    lift = _lift(problem, walk, i, surface)
    shift = lift * surface.normal
    if ray is not None and abs(lift) > 1e-6:
        meets = float(ray @ surface.normal)
        if abs(meets) > 0.15:
            slide = lift / meets * ray
            limit = max(0.5 * float(_size(problem, walk, i).max()), 0.15)
            sideways = slide - shift
            far = float(np.linalg.norm(sideways))
            shift = shift + sideways * min(1.0, limit / max(far, 1e-9))
    walk.p[i] = walk.p[i] + shift


def _from_the_eye(problem: Problem, walk: Walk, i: int, surface: RestingSurface, eye: np.ndarray) -> float:
    """Enlarge or reduce the object about the camera until its contact face is on the surface; returns by how much."""
    sight = _contact_centre(problem, walk, i) - eye
    meets = float(sight @ surface.normal)
    if abs(meets) < problem.settings.min_slant * float(np.linalg.norm(sight)):
        return 1.0
    grown = (surface.level - float(eye @ surface.normal)) / meets
    if not 1.0 / problem.settings.max_growth <= grown <= problem.settings.max_growth:
        return 1.0
    walk.p[i] = eye + grown * (walk.p[i] - eye)
    walk.scale[i] = grown * walk.scale[i]
    return grown


def _against_walls(problem: Problem, walk: Walk, i: int, against: list[tuple[int, np.ndarray]]) -> None:
    """Bring faces to their walls and give up the coordinate that would leave them."""
    basis = walk.basis[i]
    for w, _ in against[:2]:
        wall = problem.walls[w]
        slope = basis.T @ wall.normal
        steepness = float(slope @ slope)
        if steepness < 0.25:
            continue
        half = 0.5 * np.abs((wall.normal @ walk.R[i]) * _size(problem, walk, i)).sum()
        gap = float(wall.normal @ walk.p[i]) - wall.offset - half
        walk.p[i] = walk.p[i] - basis @ (slope * gap / steepness)
        along = basis @ (np.array([-slope[1], slope[0]]) / np.sqrt(steepness))
        free = np.linalg.norm(basis, axis=0).min() > 1e-9
        basis = np.column_stack([along, np.zeros(3)]) if free else np.zeros((3, 2))
    walk.basis[i] = basis


def _fit(problem: Problem, walk: Walk, i: int, surface: RestingSurface, m: np.ndarray, h: np.ndarray) -> np.ndarray:
    """Shrink only what does not fit; returns the reach of the contact face along each outward normal."""
    label = problem.labels[i]
    normal_axis = int(np.abs(problem.contact[i]).argmax())
    tall = float(_size(problem, walk, i)[normal_axis])
    if tall > surface.clearance_m - INSET_M:
        factor = max((surface.clearance_m - INSET_M) / tall, 1e-3)
        if factor * problem.settings.max_growth >= 1.0:
            walk.scale[i, normal_axis] *= factor
        else:
            walk.reasons.append(f"too tall: {label} does not fit in the {surface.clearance_m:.2f} m above its support")
    footprint = [k for k in range(3) if k != normal_axis]
    middle = m @ (surface.polygon.sum(axis=0) / len(surface.polygon))
    reach = _reach(problem, walk, i, m)
    room = largest_share(m, h - middle, reach)
    if room < 1.0:
        for k in footprint:
            axis = walk.R[i][:, k]
            width = float(np.ptp(surface.polygon @ axis)) - 2 * INSET_M
            factor = max(width, 1e-6) / max(float(np.ptp(problem.footing[i][:, k]) * walk.scale[i, k]), 1e-6)
            if problem.settings.smallest_shrink <= factor < 1.0:
                walk.scale[i, k] *= factor
        room = largest_share(m, h - middle, _reach(problem, walk, i, m))
        if problem.settings.smallest_shrink <= room < 1.0:
            walk.scale[i, footprint] *= room
            room = 1.0
        reach = _reach(problem, walk, i, m)
    if room < 1.0:
        walk.reasons.append(f"larger than its support: {label} overhangs by {100 * (1 - room):.0f} %")
    return max(min(room, 1.0), 0.0) * reach


def _reach(problem: Problem, walk: Walk, i: int, m: np.ndarray) -> np.ndarray:
    return reach_of(problem.footing[i], walk.R[i], walk.scale[i], m)


def _shortest_move(rows: np.ndarray, slack: np.ndarray) -> Float[np.ndarray, "2"]:
    """The shortest move r with rows r <= slack."""
    if not len(rows) or (slack >= 0).all():
        return np.zeros(2)
    return least_distance(-rows, -slack, np.full(len(slack), HARD))
