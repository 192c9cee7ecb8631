"""While a layout is optimised: every picture moves the objects, the curves follow at their own pace."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest

from diorama_app.commands import edit, optimise
from diorama_app.session.layout_run import LayoutRun
from diorama_core.artefacts import LayoutReport
from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from tests.app.people import settle


class Curves:
    """Counts how often the curves are drawn."""

    def __init__(self) -> None:
        self.drawn = 0

    def refresh(self) -> None:
        self.drawn += 1


def test_curves_are_drawn_less_often_than_the_objects(session, client, monkeypatch) -> None:
    client.curves = curves = Curves()
    shown: list[float] = []
    monkeypatch.setattr(session.viewport, "preview", lambda poses: shown.append(poses["chair_1"].position[0]))
    run = LayoutRun("paper", time.monotonic(), session.scene)
    here = session.scene.object("chair_1").pose
    now = [100.0]
    monkeypatch.setattr(optimise.time, "monotonic", lambda: now[0])
    samples = []
    for step in range(20):
        samples.append((0.0625 * step, (("place", 1.0 / (step + 1)),)))
        scene = edits.place(session.scene, {"chair_1": here.move((0.01 * step, 0.0, 0.0))})
        optimise._show_step(session, scene, run, samples)
        now[0] += 0.0625
    assert len(set(shown)) == 20
    assert curves.drawn == 3  # in 1.2 s, every half second
    assert run.times_s == [0.0625 * step for step in range(17)]  # what came since is read when the run ends


def _run(session, *given, **more) -> LayoutRun:
    run = optimise.optimise(session, *given, **more)
    settle(session)
    return run


def test_tidying_up_leaves_what_a_person_placed(session, client) -> None:
    edit.set_base_position(client, "chair_1", np.array([0.1, 2.2, 0.5]))  # in the air, in the middle of the table
    chair, other = session.scene.object("chair_1"), session.scene.object("chair_2")
    session.edit("lift", lambda s: edits.move(s, "chair_2", other.pose.move((0.0, 0.0, 0.4))), by=client)
    run = _run(session, "feasible")
    assert session.scene.object("chair_1") == chair
    assert session.scene.object("chair_2").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-3)
    assert run.left == 1


def test_asked_for_everything_it_moves_that_too(session, client) -> None:
    edit.set_base_position(client, "chair_1", np.array([-0.9, 1.5, 0.5]))
    _run(session, "feasible", by_hand_too=True)
    assert session.scene.object("chair_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-3)


def test_a_selection_is_asked_for_whoever_placed_it(session, client) -> None:
    edit.set_base_position(client, "chair_1", np.array([-0.9, 1.5, 0.5]))
    _run(session, "feasible", ("chair_1",))
    assert session.scene.object("chair_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-3)


def test_a_room_that_people_furnished_alone_is_not_tidied(session, client) -> None:
    by_hand = replace(session.scene, objects=tuple(replace(o, by_hand=True) for o in session.scene.objects))
    session.commit("all", by_hand, by=client)
    with pytest.raises(EditRefused, match="everything here was placed by people"):
        optimise.optimise(session, "feasible")


def _shrunk(session, client, recipe: str) -> LayoutRun:
    """A run of a recipe that made the table much smaller."""
    start = session.scene
    final = edits.resize(start, "table_1", 0.3 * start.object("table_1").size_m)
    run = LayoutRun(recipe, time.monotonic(), start)
    run.worse = optimise._worse(session, start, final)
    figures = optimise.layout_figures(start, final, session.library)
    optimise._arrange(session, final, LayoutReport(recipe, {}, figures, 0.1), run, by=client, author="")
    session.layout_run = run
    return run


def test_putting_back_what_got_worse_restores_sizes_and_the_report(session, client) -> None:
    before = session.scene
    run = _shrunk(session, client, "paper")
    assert run.worse["table_1"] == ("was resized",)
    figures = run.report.after
    optimise.put_back_worse(client)
    assert session.scene.object("table_1") == before.object("table_1")
    assert session.scene.object("lamp_1").pose == before.object("lamp_1").pose
    assert run.report.after != figures
    assert run.report.after["moved_m"] == pytest.approx(0.0, abs=1e-9)
