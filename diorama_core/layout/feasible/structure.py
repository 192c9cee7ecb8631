"""Exact structure: from the top of the support tree down, every object gets the one orientation, size and height that
its supporter allows; what stays free is two coordinates on the support surface.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.surfaces import RestingSurface
from diorama_core.layout.feasible.photo_observations import PhotoObservations
from diorama_core.layout.feasible.settle import Walk, settle
from diorama_core.layout.problem.problem import Problem


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
    surface: tuple[RestingSurface | None, ...]
    """Where each object came to rest."""
    reasons: tuple[str, ...]
    reduced: tuple[int, ...] = ()
    """Objects that were made smaller to fit between their neighbours."""


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
        observations: what the camera saw, for objects that their support moved.
        eye: the camera's position, where distances and with them sizes were only reasoned: an object that its support
            moves is then enlarged or reduced about the camera, which leaves the picture as it is.
        only: indices of the objects to settle; the others keep their poses and cannot move. All free ones when None.
    """
    n = problem.count
    walk = Walk(problem.R.copy(), problem.p.copy(), problem.scale.copy(), np.zeros((n, 3, 2)), list(problem.surface))
    now = problem.with_poses(walk.R, walk.p, walk.scale)  # and so wherever the walk has brought them
    against: dict[int, list[tuple[int, np.ndarray]]] = {}
    for i, w, face in problem.adheres:
        against.setdefault(i, []).append((w, face))
    for i in problem.top_down:
        if problem.free[i] and (only is None or i in only):
            walk.surface[i] = surface = now.place_of(i, problem)
            if surface is None:
                walk.basis[i] = np.eye(3)[:, :2]
            else:
                place = now.to_world(i, surface)
                settle(problem, walk, i, place, against.get(i, []), ray, observations, eye)
    owners = np.array(walk.owners, dtype=int)
    return Structure(
        walk.R, walk.p, walk.scale, walk.basis, owners,
        np.array(walk.normals).reshape(-1, 3), np.array(walk.slacks), tuple(walk.surface), tuple(walk.reasons),
    )  # fmt: skip
