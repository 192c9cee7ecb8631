from __future__ import annotations

import pytest

from diorama_app.panels.optimiser import RECIPES, WEIGHTS, Optimiser, report_html
from diorama_app.session.layout_run import LayoutRun
from diorama_core.artefacts import LayoutReport
from diorama_core.layout.settings import cost_names
from tests.app.page import Page

START = "Optimise layout"


@pytest.fixture
def panel(page: Page, client) -> Optimiser:
    made = Optimiser(page, client)
    client.panels, client.curves = [made], made
    made.refresh()
    return made


def finished(session) -> LayoutRun:
    """A run that is over, with a report."""
    report = LayoutReport(
        "feasible", {"structure": 0.25}, {"structure": 1.0, "moved_m": 0.034, "place": 2.0}, 1.25, ("no <room>",)
    )
    run = LayoutRun("feasible", 0.0, session.scene, report=report, final=session.scene)
    run.read([(0.5, (("place", 3.0),)), (1.0, (("place", 2.0), ("align", 1.0)))])
    return run


def test_weights_are_those_of_the_recipe(client, page, panel) -> None:
    for label, name in RECIPES.items():
        page.write("Recipe", label)
        assert client.preferences.recipe == name
        for cost, (title, _) in WEIGHTS.items():
            assert page.field(title).visible == (cost in cost_names(name))


def test_changed_weights_go_back_to_one(client, page, panel) -> None:
    assert page.field("Reset weights").disabled
    shown = next(title for cost, (title, _) in WEIGHTS.items() if cost in cost_names(client.preferences.recipe))
    page.write(shown, 2.0)
    page.press("Reset weights")
    assert page.field(shown).value == 1.0


def test_the_layout_is_optimised_as_one_step_and_put_back(session, client, page, panel) -> None:
    before = session.scene
    page.press(START)
    assert session.jobs.wait(60.0)
    page.settle()
    assert session.layout_run is not None
    assert session.layout_run.final is not None
    assert "Before → after" in page.html
    if session.scene != before:
        page.act("back")
        assert session.scene == before


def test_only_what_is_selected_may_be_asked_to_move(session, client, page, panel) -> None:
    assert page.field("Optimise selection").disabled
    client.select(["chair_1"])
    page.press("Optimise selection")
    assert session.jobs.wait(60.0)
    page.settle()
    assert session.layout_run.only == ("chair_1",)


def test_curves_and_report_are_drawn(session, client, page, panel) -> None:
    session.layout_run = finished(session)
    panel.refresh()
    (plot,) = [h for kind, _, h in page.made if kind == "uplot"]
    assert plot.visible
    assert [s["label"] for s in plot.series] == ["Seconds", "Touching", "Upright"]
    assert plot.data[0].tolist() == [0.0, 0.5]
    assert "No &lt;room&gt;" in page.html
    assert "25% → 100%" in page.html
    assert "– → 3.4 cm" in page.html
    session.layout_run = None
    panel.refresh()
    assert not plot.visible


def test_before_and_after_are_shown_until_kept(session, client, page, panel) -> None:
    session.layout_run = finished(session)
    panel.refresh()
    page.act("before")
    assert session.layout_run.showing_before
    page.act("keep")
    assert session.layout_run is None
    assert not page.shows("before")


def test_the_whole_room_takes_its_second_best_shapes(session, client, page, panel) -> None:
    assert page.shows("arrangement", 1)
    assert not page.shows("mix", 1)
    page.act("arrangement", 1)
    assert session.scene.object("table_1").shape_id == "table_b"
    client.select(["table_1"])
    page.act("mix", 0)
    assert session.scene.object("table_1").shape_id == "table_a"
    assert session.scene.object("chair_2").shape_id != "chair_b"


def test_the_result_is_said_in_sentences_and_figures_are_folded(session) -> None:
    run: LayoutRun = finished(session)
    assert run.report is not None
    run.report.before.update(overlapping_pairs=7.0)
    run.report.after.update(overlapping_pairs=0.0, moved_m=0.03, moved_most_m=0.12, structure=1.0)
    words, _, figures = report_html(run).partition("<details>")
    assert "0 pairs of objects overlap; 7 before." in words
    assert "100 % of the objects stand upright and touch their support." in words
    assert "Objects moved 3.0 cm on average, 12.0 cm at most." in words
    assert "Before → after" in figures
