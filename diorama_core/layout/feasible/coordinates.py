"""The reduced coordinates as a differentiable map: slide and yaw on the support, exact for every value.

Each object has three numbers: a slide along the two axes of its support surface, and a turn about the surface's normal
through its contact. Supporters carry what they hold up. Whatever the numbers, contact faces stay on their supports; so
a cost of poses can be minimised over them without giving up any structure.
"""

from __future__ import annotations

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from diorama_core.layout.feasible.structure import Structure
from diorama_core.layout.problem.problem import Problem


def poses_of(
    problem: Problem, structure: Structure, slide: Float[Tensor, "n 2"], yaw: Float[Tensor, " n"]
) -> tuple[Float[Tensor, "n 3 3"], Float[Tensor, "n 3"]]:
    """Rotations and centres of all objects at the given coordinates (metres, radians); zero gives `structure`.

    Args:
        problem: the layout as observed, with its supports.
        structure: the layout with every object on its support.
        slide: of each object along its support, metres.
        yaw: of each object, radians.
    """
    base_R, base_p = torch.tensor(structure.R), torch.tensor(structure.p)
    turn: dict[int, Tensor] = {}
    shift: dict[int, Tensor] = {}
    identity, still = torch.eye(3, dtype=torch.float64), torch.zeros(3, dtype=torch.float64)
    for i in problem.top_down:
        above = int(problem.parent[i])
        carried_R, carried_t = (turn[above], shift[above]) if above >= 0 else (identity, still)
        own_R, own_t = identity, still
        if problem.free[i] and problem.surface[i] is not None:
            contact = base_p[i] + base_R[i] @ torch.tensor(_half_to_contact(problem, structure, i))
            own_R = _about(torch.tensor(-structure.R[i] @ problem.contact[i]), yaw[i])
            own_t = contact - own_R @ contact + torch.tensor(structure.basis[i]) @ slide[i]
        turn[i], shift[i] = carried_R @ own_R, carried_R @ own_t + carried_t
    R = [turn[i] @ base_R[i] for i in range(problem.count)]
    p = [turn[i] @ base_p[i] + shift[i] for i in range(problem.count)]
    if not R:
        return base_R, base_p
    return torch.stack(R), torch.stack(p)


def _half_to_contact(problem: Problem, structure: Structure, i: int) -> Float[np.ndarray, "3"]:
    return np.asarray(problem.contact[i] * problem.shape_size[i] * structure.scale[i] / 2)


def _about(axis: Float[Tensor, "3"], angle: Float[Tensor, ""]) -> Float[Tensor, "3 3"]:
    """Rotation about a unit axis (Rodrigues)."""
    x, y, z = axis
    zero = torch.zeros_like(x)
    K = torch.stack([zero, -z, y, z, zero, -x, -y, x, zero]).reshape(3, 3)
    return torch.eye(3, dtype=torch.float64) + torch.sin(angle) * K + (1.0 - torch.cos(angle)) * (K @ K)
