from __future__ import annotations

import numpy as np
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.layout.feasible.coordinates import poses_of
from diorama_core.layout.feasible.structure import Structure, exact_structure
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.report import measure
from diorama_core.synthesis.layout_rooms import box_library, generate_room

LIBRARY = box_library()


def solved(seed: int, count: int) -> tuple[Problem, Structure]:
    problem = build_problem(generate_room(seed, count).observed, LIBRARY)
    return problem, exact_structure(problem)


def test_zero_is_the_structure_itself() -> None:
    problem, structure = solved(0, 12)
    R, p = poses_of(problem, structure, torch.zeros(12, 2, dtype=torch.float64), torch.zeros(12, dtype=torch.float64))
    assert np.allclose(R.numpy(), structure.R)
    assert np.allclose(p.numpy(), structure.p)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 200))
def test_support_is_exact_for_every_value(seed: int) -> None:
    problem, structure = solved(seed, 12)
    rng = np.random.default_rng(seed)
    slide, yaw = torch.tensor(rng.normal(size=(12, 2))), torch.tensor(rng.normal(size=12))
    R, p = poses_of(problem, structure, slide, yaw)
    figures = measure(problem, R.numpy(), p.numpy(), structure.scale)
    assert figures["structure"] == 1.0


def test_differentiable() -> None:
    problem, structure = solved(2, 5)
    slide = torch.zeros(5, 2, dtype=torch.float64, requires_grad=True)
    yaw = torch.zeros(5, dtype=torch.float64, requires_grad=True)
    assert torch.autograd.gradcheck(lambda s, y: poses_of(problem, structure, s, y), (slide, yaw))
