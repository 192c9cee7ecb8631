"""Exact structure: from the top of the support tree down, every object gets the one orientation, size and height that
its supporter allows; what stays free is two coordinates on the support surface.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from math import hypot, sqrt

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.cross import cross
from diorama_core.geometry.planes import plane_axes
from diorama_core.layout.feasible.footprints import INSET_M, largest_share
from diorama_core.layout.feasible.photo_observations import MAX_STRETCH, PhotoObservations
from diorama_core.layout.feasible.quadratic import HARD, least_distance
from diorama_core.layout.problem.footing import reach_of
from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.problem.supports import Surface, box_misfit, is_wall_like
from diorama_core.scene.types import box_corners

SMALLEST_SHRINK = 0.8
"""An object that does not fit is made smaller by at most this factor; beyond, it stays large and is named."""
SHORTEST_BEFORE_WALL = 0.5
"""An object that reaches through a wall ends before it, if this share of its extent is left."""
UPRIGHT_WITHIN = float(np.cos(np.deg2rad(35.0)))
"""Objects hung within this angle of upright hang upright; others keep their roll."""
MAX_GROWTH = 1.7
"""An object's distance, with its size, is corrected by at most this factor."""
MAX_DETOUR = 3.0
"""An object leaves its wall rather than move so many times as far along it to come back onto its support."""
PARALLEL = 0.97
"""Cosine within which a side of an object is along a wall."""
MIN_SLANT = 0.1
"""A surface seen more edge-on than this says nothing about distance."""


_IDENTITY = np.eye(3)
_FRONT_FIRST = np.array([2.25, 1.0, 1.0])


@dataclass(frozen=True, eq=False)
class Structure:
    """A layout that is structurally exact, and the coordinates in which it can still move.

    Object i moves by w_i = sum over its chain of supporters a of basis_a @ r_a, so children ride along.
    """

    R: Float[np.ndarray, "n 3 3"]
    p: Float[np.ndarray, "n 3"]
    scale: Float[np.ndarray, "n 3"]
    basis: Float[np.ndarray, "n 3 2"]
    """World directions of each object's two coordinates; zero columns where it cannot move."""
    bound_owner: np.ndarray
    bound_normal: Float[np.ndarray, "b 3"]
    bound_slack: Float[np.ndarray, " b"]
    """Rows m . (basis_i @ r_i) <= slack: the contact face stays on its surface."""
    surface: tuple[Surface | None, ...]
    """Where each object came to rest."""
    reasons: tuple[str, ...]
    reduced: tuple[int, ...] = ()
    """Objects that were made smaller to fit between their neighbours."""


@dataclass
class _Walk:
    """The structure while it grows."""

    R: np.ndarray
    p: np.ndarray
    scale: np.ndarray
    basis: np.ndarray
    surface: list[Surface | None]
    owners: list[int] = field(default_factory=list)
    normals: list[np.ndarray] = field(default_factory=list)
    slacks: list[float] = field(default_factory=list)
    reasons: list[str] = field(default_factory=list)


def exact_structure(
    problem: Problem,
    ray: Float[np.ndarray, "n 3"] | None = None,
    observations: PhotoObservations | None = None,
    *,
    only: Collection[int] | None = None,
    eye: Float[np.ndarray, "3"] | None = None,
) -> Structure:
    """Walk the support tree from the top and fix what the supporters determine.

    Args:
        problem: the observed poses and the graph.
        ray: unit viewing directions per object; where given, an object that must rise or sink slides along its ray so
            that it stays where the photo shows it.
        evidence: what the camera saw, for objects that their support moved.
        eye: the camera's position, where distances and with them sizes were only reasoned: an object that its support
            moves is then enlarged or reduced about the camera, which leaves the picture as it is.
        only: indices of the objects to settle; the others keep their poses and cannot move. All free ones when None.
    """
    n = problem.count
    walk = _Walk(problem.R.copy(), problem.p.copy(), problem.scale.copy(), np.zeros((n, 3, 2)), list(problem.surface))
    against: dict[int, list[tuple[int, np.ndarray]]] = {}
    for i, w, face in problem.adheres:
        against.setdefault(i, []).append((w, face))
    for i in problem.top_down:
        if problem.free[i] and (only is None or i in only):
            walk.surface[i] = surface = _level(problem, walk, i)
            if surface is None:
                walk.basis[i] = np.eye(3)[:, :2]
            else:
                _settle(problem, walk, i, _posed(walk, problem, i, surface), against.get(i, []), ray, observations, eye)
    owners = np.array(walk.owners, dtype=int)
    return Structure(
        walk.R, walk.p, walk.scale, walk.basis, owners,
        np.array(walk.normals).reshape(-1, 3), np.array(walk.slacks), tuple(walk.surface), tuple(walk.reasons),
    )  # fmt: skip


def _level(problem: Problem, walk: _Walk, i: int) -> Surface | None:
    """Of the places on a supporter as it stands now, the one that agrees best with where the object was observed."""
    if len(problem.levels[i]) < 2:
        return problem.surface[i]
    size = problem.shape_size[i] * problem.scale[i]
    corners = problem.p[i] + box_corners(size) @ problem.R[i].T
    return min(problem.levels[i], key=lambda s: box_misfit(corners, size, _posed(walk, problem, i, s)))


def _posed(walk: _Walk, problem: Problem, i: int, surface: Surface) -> Surface:
    j = int(problem.parent[i])
    return surface if j < 0 else surface.at(walk.R[j], walk.p[j], walk.scale[j])


def _settle(
    problem: Problem,
    walk: _Walk,
    i: int,
    surface: Surface,
    against: list[tuple[int, np.ndarray]],
    ray: np.ndarray | None,
    observations: PhotoObservations | None,
    eye: np.ndarray | None,
) -> None:
    n = surface.normal
    walk.R[i] = _aligned(walk.R[i], problem.contact[i], surface, [(problem.walls[w].normal, f) for w, f in against])
    u, v = plane_axes(n)
    _before_walls(problem, walk, i)
    if observations is not None:
        observations = observations.no_larger(i, np.where(walk.scale[i] < problem.scale[i], walk.scale[i], np.inf))
    grown = 1.0 if eye is None else _from_the_eye(problem, walk, i, surface, eye)
    if observations is not None and observations.measured[i]:
        _reach_support(problem, walk, i, surface)
    _on_support(problem, walk, i, surface, None if ray is None else ray[i])
    grounded = problem.grounded[i] and is_wall_like(surface)
    walk.basis[i] = np.column_stack([u, np.zeros(3) if grounded else v])
    _against_walls(problem, walk, i, against)
    if grounded:
        _reach_floor(problem, walk, i)
    if observations is not None:
        pinned = problem.contact[i] + sum((face for _, face in against), np.zeros(3))
        pinned[2] -= float(grounded)
        walk.p[i], walk.scale[i] = observations.fitted(
            i, walk.R[i], walk.p[i], walk.scale[i], walk.basis[i], pinned, grown
        )
    m, slack = _within_support(problem, walk, i, surface)
    if (slack < 0).any():
        _onto_support(problem, walk, i, surface, slack, m)
        if observations is not None:
            _seen_from_the_edge(problem, walk, i, surface, observations, pinned, eye)
        m, slack = _within_support(problem, walk, i, surface)
    walk.owners += [i] * len(m)
    walk.normals += list(m)
    walk.slacks += [max(float(s), 0.0) for s in slack]


def _before_walls(problem: Problem, walk: _Walk, i: int) -> None:
    """Shorten an object that reaches through a wall from behind: its front was seen where it is, its back was not.

    Where what it holds up was seen before its front, the object comes forward so far instead.
    """
    for wall in problem.walls_near(i):
        axis = int(np.abs(wall.normal @ walk.R[i]).argmax())
        half = 0.5 * _size(problem, walk, i)
        through = wall.offset - float(wall.normal @ walk.p[i]) + float(np.abs(wall.normal @ walk.R[i]) @ half)
        factor = 1.0 - through / (2.0 * float(half[axis]))
        if abs(float(wall.normal @ walk.R[i][:, axis])) < PARALLEL or not SHORTEST_BEFORE_WALL <= factor < 1.0:
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


def _within_support(
    problem: Problem, walk: _Walk, i: int, surface: Surface
) -> tuple[Float[np.ndarray, "k 3"], Float[np.ndarray, " k"]]:
    """Outward normals of the support's sides that the object's free coordinates can meet, and how far each is.

    The object is shrunk where it does not fit and set on its surface first.
    """
    m = surface.outward
    reach = _fit(problem, walk, i, surface, m, surface.offset)
    walk.p[i] = walk.p[i] + _lift(problem, walk, i, surface) * surface.normal
    slack = surface.offset - m @ _contact_centre(problem, walk, i) - reach - INSET_M
    rows = m @ walk.basis[i]
    mobile = (rows * rows).sum(axis=1) > 1e-12
    return m[mobile], slack[mobile]


def _onto_support(problem: Problem, walk: _Walk, i: int, surface: Surface, slack: np.ndarray, m: np.ndarray) -> None:
    """The shortest way onto the surface: with the coordinates that a wall leaves where that is about as short."""
    plane = np.column_stack(plane_axes(surface.normal))
    shortest = plane @ _into(m @ plane, slack)
    along = walk.basis[i] @ _into(m @ walk.basis[i], slack)
    detour = np.linalg.norm(along) > MAX_DETOUR * np.linalg.norm(shortest) and not problem.grounded[i]
    walk.p[i] = walk.p[i] + (shortest if detour else along)


def _seen_from_the_edge(
    problem: Problem,
    walk: _Walk,
    i: int,
    surface: Surface,
    observations: PhotoObservations,
    pinned: np.ndarray,
    eye: np.ndarray | None,
) -> None:
    """Move an object that had to come back onto its support along the side that it came to, until it is seen best."""
    m, slack = _within_support(problem, walk, i, surface)
    reached = m[int(np.argmin(slack))] if len(m) else np.zeros(3)
    side = cross(surface.normal, reached)
    length = float(np.linalg.norm(side))
    free = length > 1e-9 and float(np.linalg.norm(walk.basis[i].T @ (side / max(length, 1e-9)))) > 0.9
    if not free:
        return
    grown = 1.0 if eye is None else _nearness(walk.p[i], problem.p[i], eye)
    basis = np.column_stack([side / length, np.zeros(3)])
    start = walk.p[i].copy(), walk.scale[i].copy()
    walk.p[i], walk.scale[i] = observations.fitted(i, walk.R[i], *start, basis, pinned, grown)
    m, slack = _within_support(problem, walk, i, surface)
    if (slack < 0).any():
        _onto_support(problem, walk, i, surface, slack, m)


def _nearness(p: np.ndarray, observed: np.ndarray, eye: np.ndarray) -> float:
    """How many times as far as it was observed an object is, along its viewing ray and within limits."""
    sight = observed - eye
    return float(np.clip((p - eye) @ sight / max(float(sight @ sight), 1e-9), 1.0 / MAX_GROWTH, MAX_GROWTH))


def _reach_floor(problem: Problem, walk: _Walk, i: int) -> None:
    """Stretch a door to the floor, keeping its top where it was seen; lower it where that would change it too much."""
    height = float(_size(problem, walk, i)[2])
    top = float(walk.p[i][2]) + height / 2
    factor = (top - problem.floor_m) / height
    if SMALLEST_SHRINK <= factor <= 1.0 / SMALLEST_SHRINK:
        walk.scale[i, 2] *= factor
    walk.p[i] = [*walk.p[i][:2], problem.floor_m + float(_size(problem, walk, i)[2]) / 2]


def _size(problem: Problem, walk: _Walk, i: int) -> np.ndarray:
    return problem.shape_size[i] * walk.scale[i]


def _contact_centre(problem: Problem, walk: _Walk, i: int) -> np.ndarray:
    return walk.p[i] + walk.R[i] @ (problem.contact[i] * _size(problem, walk, i) / 2)


def _lift(problem: Problem, walk: _Walk, i: int, surface: Surface) -> float:
    """How far the contact face is below the surface."""
    return surface.level - float(surface.normal @ _contact_centre(problem, walk, i))


def _reach_support(problem: Problem, walk: _Walk, i: int, surface: Surface) -> None:
    """Stretch the object so that its contact face is on its surface; its far face, which was measured, stays."""
    axis = int(np.abs(problem.contact[i]).argmax())
    extent = float(_size(problem, walk, i)[axis])
    wanted = extent - _lift(problem, walk, i, surface)
    factor = float(np.clip(wanted / extent, 1.0 / MAX_STRETCH, MAX_STRETCH))
    walk.scale[i, axis] *= factor
    walk.p[i] = walk.p[i] - 0.5 * (factor - 1.0) * extent * surface.normal


def _on_support(problem: Problem, walk: _Walk, i: int, surface: Surface, ray: np.ndarray | None) -> None:
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


def _from_the_eye(problem: Problem, walk: _Walk, i: int, surface: Surface, eye: np.ndarray) -> float:
    """Enlarge or reduce the object about the camera until its contact face is on the surface; returns by how much."""
    sight = _contact_centre(problem, walk, i) - eye
    meets = float(sight @ surface.normal)
    if abs(meets) < MIN_SLANT * float(np.linalg.norm(sight)):
        return 1.0
    grown = (surface.level - float(eye @ surface.normal)) / meets
    if not 1.0 / MAX_GROWTH <= grown <= MAX_GROWTH:
        return 1.0
    walk.p[i] = eye + grown * (walk.p[i] - eye)
    walk.scale[i] = grown * walk.scale[i]
    return grown


def _aligned(
    R: np.ndarray, contact: np.ndarray, surface: Surface, against: list[tuple[np.ndarray, np.ndarray]]
) -> np.ndarray:
    """Swing the contact face onto the support, then twist about the normal to the observed front, or to a wall."""
    n = surface.normal
    swung = swing(R @ contact, -n) @ R
    if against:
        wall, face = against[0]
        return _twist(swung, n, face, -wall)
    if is_wall_like(surface):
        up = np.array([0.0, 0.0, 1.0])
        flat_up = up - (up @ n) * n
        own = swung[:, 2] - (swung[:, 2] @ n) * n
        if float(own @ flat_up) > UPRIGHT_WITHIN * float(np.linalg.norm(own) * np.linalg.norm(flat_up)):
            return _twist(swung, n, np.array([0.0, 0.0, 1.0]), up)
        return swung
    # The front, unless another axis lies much flatter on the support.
    axis = int(((1.0 - (n @ swung) ** 2) * _FRONT_FIRST).argmax())
    return _twist(swung, n, _IDENTITY[axis], R[:, axis])


def swing(a: Float[np.ndarray, "3"], b: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """The smallest rotation that takes unit vector a to unit vector b."""
    c = float(a @ b)
    if c < -1.0 + 1e-9:
        perpendicular = cross(a, np.eye(3)[int(np.abs(a).argmin())])
        perpendicular /= np.linalg.norm(perpendicular)
        return 2.0 * np.outer(perpendicular, perpendicular) - np.eye(3)
    x, y, z = cross(a, b)
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return _IDENTITY + K + K @ K / (1.0 + c)


def _twist(R: np.ndarray, n: np.ndarray, axis_object: np.ndarray, toward: np.ndarray) -> np.ndarray:
    """Turn about n until an object axis points toward a world direction, both seen along n."""
    have, want = R @ axis_object, np.asarray(toward)
    have, want = have - (have @ n) * n, want - (want @ n) * n
    length = sqrt(float(have @ have) * float(want @ want))
    if length < 1e-9:
        return R
    sine, cosine = float(n @ cross(have, want)) / length, float(have @ want) / length
    if abs(sine) < 1e-12 and cosine > 0:
        return R
    norm = hypot(sine, cosine)
    sine, cosine = sine / norm, cosine / norm
    x, y, z = n.tolist()
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return (_IDENTITY + sine * K + (1.0 - cosine) * (K @ K)) @ R


def _against_walls(problem: Problem, walk: _Walk, i: int, against: list[tuple[int, np.ndarray]]) -> None:
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


def _fit(problem: Problem, walk: _Walk, i: int, surface: Surface, m: np.ndarray, h: np.ndarray) -> np.ndarray:
    """Shrink only what does not fit; returns the reach of the contact face along each outward normal."""
    label = problem.labels[i]
    normal_axis = int(np.abs(problem.contact[i]).argmax())
    tall = float(_size(problem, walk, i)[normal_axis])
    if tall > surface.clearance_m - INSET_M:
        factor = max((surface.clearance_m - INSET_M) / tall, 1e-3)
        if factor >= SMALLEST_SHRINK:
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
            if SMALLEST_SHRINK <= factor < 1.0:
                walk.scale[i, k] *= factor
        room = largest_share(m, h - middle, _reach(problem, walk, i, m))
        if SMALLEST_SHRINK <= room < 1.0:
            walk.scale[i, footprint] *= room
            room = 1.0
        reach = _reach(problem, walk, i, m)
    if room < 1.0:
        walk.reasons.append(f"larger than its support: {label} overhangs by {100 * (1 - room):.0f} %")
    return max(min(room, 1.0), 0.0) * reach


def _reach(problem: Problem, walk: _Walk, i: int, m: np.ndarray) -> np.ndarray:
    return reach_of(problem.footing[i], walk.R[i], walk.scale[i], m)


def _into(rows: np.ndarray, slack: np.ndarray) -> Float[np.ndarray, "2"]:
    """The shortest move r with rows r <= slack."""
    if not len(rows) or (slack >= 0).all():
        return np.zeros(2)
    return least_distance(-rows, -slack, np.full(len(slack), HARD))
