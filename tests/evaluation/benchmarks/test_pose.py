"""Solvers side by side on a hand-made room: everyone is given the same, and what fails counts."""

from __future__ import annotations

from dataclasses import replace

import pytest

from diorama_core.artefacts import RankedShapes
from diorama_core.evaluation.benchmarks import pose as pose_bench
from diorama_core.evaluation.benchmarks.pose_comparison import (
    BASELINES,
    CONDITIONS,
    ESTIMATED_DEPTH,
    GIVEN,
    IN_LIBRARY,
    NOISY_DEPTH,
    OURS,
    REMOVED,
    TRUE_DEPTH,
    PoseScores,
    SideBySide,
    inputs_with,
    pose_scores,
    predict,
    shapes_of,
)
from diorama_core.evaluation.benchmarks.pose_tables import comparison_table
from diorama_core.pose import RenderAndCompare
from diorama_core.pose.correspondence.solvers import CorrespondencePose
from diorama_core.render.templates import TemplateGrid
from diorama_core.synthesis.layout_rooms import box_library
from diorama_core.synthesis.truth import TruthView
from tests.evaluation.truth import view_of_boxes, without_unasked


@pytest.fixture(scope="module")
def library():
    return box_library()


@pytest.fixture(scope="module")
def view() -> TruthView:
    return view_of_boxes()


@pytest.fixture(scope="module")
def solvers(library) -> SideBySide:
    few = TemplateGrid(elevations_deg=(15.0,), azimuths=8, size_px=48)
    return SideBySide(library, RenderAndCompare(library), CorrespondencePose(library, grid=few))


GIVEN_SHAPES = (RankedShapes("a", (("true", 1.0),)), RankedShapes("b", (("other", 1.0),)))
RETRIEVED = (
    RankedShapes("a", (("near", 0.9), ("true", 0.8), ("far", 0.1))),
    RankedShapes("b", (("near", 0.9), ("far", 0.2))),
)


def test_the_true_shape_is_given_retained_or_removed() -> None:
    assert shapes_of(GIVEN_SHAPES, RETRIEVED, GIVEN, 2) == GIVEN_SHAPES
    retained = shapes_of(GIVEN_SHAPES, RETRIEVED, IN_LIBRARY, 2)
    assert [s for s, _ in retained[0].ranked] == ["near", "true"]
    removed = shapes_of(GIVEN_SHAPES, RETRIEVED, REMOVED, 2)
    assert [s for s, _ in removed[0].ranked] == ["near", "far"]
    assert removed[1] == RETRIEVED[1]


def test_depth_is_true_noisy_or_absent(view) -> None:
    true = inputs_with(view, TRUE_DEPTH).depth_m
    noisy = inputs_with(view, NOISY_DEPTH).depth_m
    assert inputs_with(view, ESTIMATED_DEPTH).depth_m is None
    known = true > 0
    assert 0.045 < float((noisy[known] / true[known] - 1).std()) < 0.055
    assert (noisy == inputs_with(view, NOISY_DEPTH).depth_m).all()


def test_every_solver_poses_the_same_objects(view, library, solvers) -> None:
    seen = predict(view.inputs, library)
    given = solvers.true_shapes(view, seen)
    assert len(given) == len(view.indices) > 2
    scenes = solvers.scenes(seen, given)
    assert set(scenes) == {OURS, *BASELINES}
    for scene in scenes.values():
        true = {r.object_id: r.ranked[0][0] for r in given}
        assert all(true[o.id] == o.shape_id for o in scene.objects)
    ours = pose_scores(view, scenes[OURS], library)
    assert ours.own.t_acc > 0.7
    assert ours.asked == len(view.indices)


def test_the_truth_is_right_and_nothing_is_wrong(view, library) -> None:
    best = pose_scores(view, without_unasked(view), library)
    assert (best.pairs.acc, best.every.acc, best.own.acc, best.relation) == (1, 1, 1, 1)
    assert pose_scores(view, None, library) == PoseScores.failure(len(view.indices))


def test_a_column_for_each_reading(view, library) -> None:
    right, wrong = pose_scores(view, without_unasked(view), library), PoseScores.failure(len(view.indices))
    table = comparison_table("t", {"a": (right, wrong), "b": (wrong, wrong)}, {"ZSP": (0.1, 0.2, 0.3, 0.4, 5.0, 0.6)})
    assert table.row("a")["Acc"] == table.row("a")["strict Acc"] == table.row("a")["own Acc"] == 0.5
    assert table.row("b")["own rAcc"] == 0
    assert (table.row("a")["relation"], table.row("b")["relation"]) == (0.5, 0.0)
    assert "ZSP (paper, other dataset) | 0.10 | 0.20 | 0.30 | 0.40 | –" in table.to_markdown()


def test_a_room_that_fails_counts_for_every_solver(view, library, solvers, monkeypatch) -> None:
    monkeypatch.setattr(pose_bench, "predict", lambda inputs, library: 1 / 0)
    bench = pose_bench.PoseBench(0)
    pose_bench._one_room(view, solvers, bench, pose_bench.Progress(), "room")
    assert list(bench.compared) == list(CONDITIONS)
    for named in bench.compared.values():
        assert [len(rows) for rows in named.values()] == [1] * (1 + len(BASELINES))
        assert all(rows[0].pairs.acc == 0 and rows[0].asked == len(view.indices) for rows in named.values())
    assert len(bench.tables()) == len(CONDITIONS) + 6
    assert replace(bench, seed=1).to_json()["seed"] == 1
    truths = {f"{stage}true {what}" for stage in ("", "feasible, ") for what in ("graph", "architecture")}
    assert bench.ablation.keys() >= {"O, P, S, R", *truths}
    assert bench.groups_after
    assert all(every == 0 for group in bench.groups_after.values() for *_, every, _ in group)


def test_groups_are_counted_after_the_papers_layout_too(view, library) -> None:
    ablation: dict[str, list[PoseScores]] = {}
    arranged = pose_bench._arrange(view, without_unasked(view), library, ablation, pose_bench.Progress())
    assert pose_bench.PAPER_LAYOUT in arranged
    assert ablation["true graph"][0].structure > 0.9
    assert ablation["true graph"] != [] != ablation["feasible, true architecture"]
    groups: dict[str, list[tuple[float, ...]]] = {}
    pose_bench._count_groups(view, arranged[pose_bench.PAPER_LAYOUT], library, groups)
    assert sum(len(rows) for name, rows in groups.items() if name in ("household", "furniture")) == len(view.indices)
