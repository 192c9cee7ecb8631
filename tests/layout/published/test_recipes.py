from __future__ import annotations

import numpy as np
import pytest
import torch

from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.published import costs, staged
from diorama_core.layout.published.recipes import AllInOneRecipe, PaperRecipe, one_thread
from diorama_core.layout.published.staged import StageSchedule
from diorama_core.layout.report import measure
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene
from diorama_core.synthesis.layout_rooms import box_library, generate_room
from tests.layout.small_rooms import Room

LIBRARY = box_library()


def test_the_schedule_is_the_published_one() -> None:
    rates = list(StageSchedule().rates())
    assert len(rates) == 200
    assert (rates[0], rates[49], rates[50], rates[199]) == pytest.approx((1.0, 1.0, 0.1, 1e-3))


def test_stages_improve_what_they_are_for() -> None:
    room = generate_room(4, 15)
    reports = [PaperRecipe(LIBRARY, stages=k).optimise(room.observed, Progress())[1] for k in (1, 2, 4)]
    assert reports[0].after["orientation"] == 1.0 > reports[0].before["orientation"]
    assert reports[1].after["placement"] > 0.9 > reports[0].after["placement"]
    assert reports[2].after["box_overlap_m"] <= reports[0].after["box_overlap_m"]


def test_all_in_one_reaches_the_structure() -> None:
    room = generate_room(5, 8)
    _, report = AllInOneRecipe(LIBRARY).optimise(room.observed, Progress())
    assert report.after["structure"] >= 0.85
    assert report.recipe == "all-in-one"


SHORT = StageSchedule(steps=40, decay_every=10)
"""For what holds whatever the number of steps."""


@pytest.mark.parametrize("recipe", [PaperRecipe, AllInOneRecipe])
def test_deterministic_finite_and_locked(recipe, room: Room) -> None:
    stays = room.put("table_0", (0, 0, 0.5), locked=True)
    room.put("cup_21", (0, 0, 0.9), on=stays)
    room.put("chair_4", (0.3, 0, 0.5))
    scene = room.scene()
    a, b = (recipe(LIBRARY, schedule=SHORT).optimise(scene, Progress())[0] for _ in range(2))
    assert a != scene
    assert a == b
    assert a.object(stays).pose == scene.object(stays).pose
    assert all(np.isfinite(o.pose.matrix).all() for o in a.objects)


@pytest.mark.parametrize("recipe", [PaperRecipe, AllInOneRecipe])
def test_empty_and_single_scenes(recipe, room: Room) -> None:
    made = recipe(LIBRARY, schedule=SHORT)
    assert made.optimise(Scene(), Progress())[0].objects == ()
    room.put("cup_21", (0, 0, 0.3), on=None)
    scene, _ = made.optimise(room.scene(), Progress())
    assert np.isfinite(scene.objects[0].pose.position).all()


def test_the_placement_cost_of_the_inner_loop_is_e_place() -> None:
    problem = build_problem(generate_room(6, 12).observed, LIBRARY)
    state = staged.State(problem, StageSchedule(), lambda *_: None)
    edges = staged.Edges.of(problem)
    owner_R, owner_p, owner_s = edges.owners(state)
    p = torch.tensor(state.p, requires_grad=True)
    half = edges.contact * problem.shape_size[edges.child] * state.scale[edges.child] / 2
    centre = p[edges.child] + torch.tensor(np.einsum("eij,ej->ei", state.R[edges.child], half))
    supporter = torch.tensor(edges.supporter)
    base = torch.where((supporter >= 0)[:, None], p[supporter], torch.tensor(owner_p))
    point = base + torch.tensor(np.einsum("eij,ej->ei", owner_R, edges.point * owner_s))
    normal = torch.tensor(np.einsum("eij,ej->ei", owner_R, edges.normal))
    value = costs.e_place(centre, point, normal)
    ours, slope = staged.PlacementCost.of(state).value_and_gradient(state.p)
    assert ours == pytest.approx(float(value.detach()))
    assert np.allclose(slope, torch.autograd.grad(value, p)[0].numpy())


def test_torch_threads_are_given_back() -> None:
    before = torch.get_num_threads()
    with one_thread():
        assert torch.get_num_threads() == 1
    assert torch.get_num_threads() == before


def test_the_report_names_every_cost_and_exact_structure_has_none() -> None:
    room = generate_room(7, 12)
    problem = build_problem(room.truth, LIBRARY)
    figures = measure(problem, problem)
    for name in ("e_align", "e_sem", "e_place", "e_rel", "e_vol"):
        assert figures[name] == pytest.approx(0.0, abs=1e-6), name
    seen = build_problem(room.observed, LIBRARY)
    noisy = measure(seen, seen)
    assert noisy["e_align"] > 0.1
    assert noisy["e_place"] > 0.1
    assert noisy["e_sem"] == pytest.approx(0.0, abs=1e-9)
    assert noisy["e_rel"] == pytest.approx(0.0, abs=1e-9)
