"""What encloses a place: the parts of a supporter that rise above it, beside what rests there.

An object touches the board it stands on, so it never collides with its supporter as a whole. It does collide with the
back and the sides of a bookcase, with the arms of a chair, with the frame of a mirror on a dresser and with the tap of
a worktop. Soft loads sink into bedding and cushions: of what rises above their place they meet what stands beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from jaxtyping import Bool

from diorama_core.arrangement.surfaces import RestingSurface
from diorama_core.geometry.sat import PosedBodies
from diorama_core.layout.problem.problem import Problem


def may_meet(
    problem: Problem, bodies: PosedBodies, surface: Sequence[RestingSurface | None]
) -> Bool[np.ndarray, "b b"]:
    """Which pairs of parts must not overlap: those of unrelated objects, and what encloses a place with what is there.

    Args:
        problem: who holds up whom.
        bodies: every part, posed.
        surface: the place of every object, in the world; None without one.
    """
    owner = bodies.owner
    allowed = ~problem.kin[owner[:, None], owner[None]]
    for i in range(problem.count):
        chain = problem.chain(i)
        for above, below in pairwise(chain):
            place = surface[above]
            if place is None or problem.yielding[i, below]:
                continue
            parts = np.flatnonzero(owner == below)
            rises = _rises(bodies, parts, place, problem.settings.above_m)
            soft, reach_m = problem.firm[i] < 1.0, problem.settings.beside_m
            beside = parts[rises & _stands_beside(bodies, parts, place, reach_m) if soft else rises]
            body_rows = np.flatnonzero(owner == i)
            allowed[np.ix_(body_rows, beside)] = allowed[np.ix_(beside, body_rows)] = True
    return allowed


def _rises(bodies: PosedBodies, parts: np.ndarray, place: RestingSurface, above_m: float) -> Bool[np.ndarray, " k"]:
    """Which parts rise above a place (world) beside its middle.

    One that has the middle of the place inside it encloses nothing: it is the hull of a worktop and of what rises
    behind it, and nothing could stand there.
    """
    vertices, normals = bodies.vertices[parts], bodies.normals[parts]
    middle = place.polygon.mean(axis=0)
    middle = middle + (place.level + above_m - float(middle @ place.normal)) * place.normal
    along = np.einsum("pvc,pfc->pvf", vertices, normals)
    here = normals @ middle
    around = ((along.min(axis=1) <= here) & (here <= along.max(axis=1))).all(axis=1)
    return np.asarray(((vertices @ place.normal).max(axis=1) - place.level > above_m) & ~around)


def _stands_beside(
    bodies: PosedBodies, parts: np.ndarray, place: RestingSurface, beside_m: float
) -> Bool[np.ndarray, " k"]:
    """Which parts lie outside of one of a place's sides (world)."""
    out = np.matmul(bodies.vertices[parts], place.outward.T) - place.offset
    return np.asarray(out.min(axis=1).max(axis=1) > -beside_m)
