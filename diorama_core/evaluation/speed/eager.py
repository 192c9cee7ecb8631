"""One step of the layout's last stage, four ways: as the program does it, and as one would write it down at first."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import torch
from jaxtyping import Float
from torch import Tensor

from diorama_core.evaluation.speed.meter import cost_of
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.published import costs, staged
from diorama_core.synthesis.layout_rooms import box_library, generate_room

OURS = "near pairs, closed-form gradients (ours)"
BATCHED = "all pairs at once, autograd"
BATCHED_GPU = "all pairs at once, autograd, GPU"
EAGER = "pair by pair, autograd"
WAYS = (OURS, BATCHED, BATCHED_GPU, EAGER)
NO_GPU = "no GPU here"


def step_seconds(way: str, count: int, seed: int) -> float | None:
    """Processor seconds of one refinement step on a generated room; on a GPU seconds by the clock, None without one."""
    problem = build_problem(generate_room(seed + 500, count).observed, box_library())
    if way == OURS:
        return our_seconds(problem)
    if way == BATCHED:
        return cost_of(partial(_slope_of_all, problem, "cpu"), 3).seconds
    if way == EAGER:
        return pair_by_pair_seconds(problem)
    return _gpu_seconds(partial(_slope_of_all, problem, "cuda")) if torch.cuda.is_available() else None


def our_seconds(problem: Problem) -> float:
    """Processor seconds of one of our steps."""
    state = staged.State(problem, staged.StageSchedule(), lambda *_: None)
    return cost_of(partial(staged.refinement_stage, state)).seconds / state.schedule.steps


def pair_by_pair_seconds(problem: Problem) -> float:
    """Processor seconds of one step that sums the cost pair by pair through autograd."""
    return cost_of(partial(_slope_pair_by_pair, problem)).seconds


def _tensors(problem: Problem, device: str) -> tuple[Tensor, Tensor, Tensor]:
    R = torch.tensor(problem.R, device=device)
    size = torch.tensor(problem.shape_size * problem.scale, device=device)
    return torch.tensor(problem.p, device=device, requires_grad=True), R, size


def _slope_of_all(problem: Problem, device: str) -> Float[Tensor, "n 3"]:
    with torch.device(device):  # the cost makes tensors of its own
        p, R, size = _tensors(problem, device)
        pairs = torch.tril_indices(problem.count, problem.count, -1).T
        return torch.autograd.grad(costs.e_col(p, R, size, pairs), p)[0]


def _slope_pair_by_pair(problem: Problem) -> Float[Tensor, "n 3"]:
    p, R, size = _tensors(problem, "cpu")
    total = (0.0 * p).sum()
    for i in range(problem.count):
        for j in range(i):
            total = total + costs.e_col(p, R, size, torch.tensor([[i, j]]))
    return torch.autograd.grad(total, p)[0]


def _gpu_seconds(work: Callable[[], object], repeats: int = 20) -> float:
    work()
    torch.cuda.synchronize()
    begun = time.perf_counter()
    for _ in range(repeats):
        work()
    torch.cuda.synchronize()
    return (time.perf_counter() - begun) / repeats
