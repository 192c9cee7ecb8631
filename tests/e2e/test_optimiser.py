"""Points 8 and 9: weights, curves of every cost, pause and cancel, the report, arrangements mixed."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import NoReturn

import pytest
from playwright.sync_api import expect

from diorama_core.layout import recipes
from diorama_core.progress import Progress
from diorama_core.protocols import LayoutStage, Preview
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.e2e.browser import EditorPage

pytestmark = pytest.mark.browser


def choose_recipe(editor: EditorPage, name: str) -> None:
    editor.page.get_by_label("Recipe").click()
    editor.page.get_by_role("option", name=name).click()


def lift_chair(editor: EditorPage) -> Scene:
    session = editor.running.session
    lifted = session.scene.object("chair_1").pose.move((0.0, 0.0, 0.3))
    session.ui_thread.post(lambda: session.edit("lift", lambda s: edits.move(s, "chair_1", lifted)))
    editor.until(lambda: session.scene.object("chair_1").pose == lifted)
    return session.scene


def test_a_cost_left_out_is_not_followed_and_every_cost_has_a_curve(editor: EditorPage) -> None:
    session = editor.running.session
    before = lift_chair(editor)
    editor.tab("Arrange")
    choose_recipe(editor, "As in the paper")
    editor.page.get_by_text("Weights", exact=True).click()
    touching = editor.page.locator(".mantine-Flex-root", has_text="Touching").locator("input[type=text]")
    expect(touching).to_be_visible()
    expect(editor.page.get_by_text("Distance", exact=True)).not_to_be_visible()
    touching.fill("0")
    touching.press("Tab")
    expect(editor.button("Reset weights")).to_be_enabled()
    editor.button("Optimise layout").click()
    editor.until(lambda: session.jobs.status is None and session.scene is not before, "arranged", seconds=90)
    assert session.scene.object("chair_1").corners_world[:, 2].min() > 0.2, "nothing asked it to touch the floor"
    run = session.layout_run
    assert run is not None
    assert {"align", "heading", "place", "neighbours", "volume", "collision"} == set(run.costs)
    editor.page.wait_for_function("!!document.querySelector('.u-legend')")
    legend = editor.page.locator(".u-legend").first
    for name in ("Upright", "Facing", "Neighbours", "Separation"):
        expect(legend).to_contain_text(name)
    editor.page.get_by_text("Before → after").click()
    expect(editor.page.get_by_text("Moved, mean")).to_be_visible()
    expect(editor.page.get_by_text("Overlapping pairs")).to_be_visible()
    editor.button("Revert").click()
    editor.until(lambda: session.scene == before, "put back")
    editor.button("Reset weights").click()
    expect(touching).to_have_value("1")
    editor.button("Optimise layout").click()
    editor.until(lambda: session.jobs.status is None and session.scene != before, "arranged", seconds=90)
    assert session.scene.object("chair_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=0.02)
    editor.button("Keep").click()
    expect(editor.button("Revert")).to_have_count(0)


class Endless:
    """A recipe that shows its last step again and again until it is cancelled: the page is never too late."""

    def __init__(self, stage: LayoutStage) -> None:
        self._stage = stage

    def optimise(self, scene: Scene, progress: Progress, preview: Preview) -> NoReturn:
        steps: list[tuple[Scene, Sequence[tuple[str, float]]]] = []

        def noted(scene: Scene, costs: Sequence[tuple[str, float]]) -> None:
            steps.append((scene, costs))
            preview(scene, costs)

        self._stage.optimise(scene, progress, noted)
        while True:
            progress.check()
            preview(*steps[-1])
            time.sleep(0.02)


def test_an_optimisation_is_paused_gone_on_with_and_cancelled(
    editor: EditorPage, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = recipes.recipe
    monkeypatch.setattr(recipes, "recipe", lambda *args, **kwargs: Endless(made(*args, **kwargs)))
    session = editor.running.session
    before = lift_chair(editor)
    editor.tab("Arrange")
    choose_recipe(editor, "All in one")
    editor.button("Optimise layout").click()
    editor.button("Pause").click()
    expect(editor.button("Resume")).to_be_visible()
    run = session.layout_run
    assert run is not None
    assert run.is_paused
    seen = editor.still(lambda: len(run.times_s))  # the step that was on its way ends
    editor.button("Resume").click()
    editor.until(lambda: len(run.times_s) > seen, "it goes on")
    editor.button("Cancel").click()
    editor.until(lambda: session.jobs.status is None, "stopped")
    assert session.scene is before
    node = session.viewport.node_name("chair_1")
    z = before.object("chair_1").pose.position[2]
    editor.page.wait_for_function(f"Math.abs(window.__viserMutable.nodeRefFromName['{node}']?.position.z - {z}) < 1e-4")


def test_arrangements_are_mixed_by_what_is_selected(editor: EditorPage) -> None:
    session = editor.running.session
    editor.tab("Arrange")
    expect(editor.page.locator('.dio button[data-do="arrangement"].on')).to_have_text("1")
    editor.page.locator('.dio button[data-do="arrangement"]', has_text="2").click()
    editor.until(lambda: session.scene.object("chair_1").shape_id == "chair_b", "the whole room")
    assert session.scene.object("table_1").shape_id == "table_b"
    editor.tab("Scene")
    editor.row("dining table").click()
    editor.tab("Arrange")
    editor.page.locator('.dio button[data-do="mix"]', has_text="1").click()
    editor.until(lambda: session.scene.object("table_1").shape_id == "table_a", "only the table")
    assert session.scene.object("chair_1").shape_id == "chair_b"
    assert session.document.history.current.label == "arrangement 1 for dining table"
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: session.scene.object("table_1").shape_id == "table_b", "one undo step")


def test_a_run_of_several_stages_updates_nothing_that_is_gone(editor: EditorPage) -> None:
    """Every stage has costs of its own, and with them a chart of its own."""
    session = editor.running.session
    said: list[str] = []
    editor.page.on("console", lambda message: said.append(message.text))
    editor.tab("Arrange")
    before = lift_chair(editor)
    for name in ("All in one", "As in the paper"):
        choose_recipe(editor, name)
        editor.button("Optimise layout").click()
        editor.until(lambda: session.jobs.status is None and session.scene is not before, "arranged", seconds=90)
        editor.settle()
        editor.button("Revert").click()
        editor.until(lambda: session.scene == before, "put back")
    editor.settle()
    assert not [line for line in said if "non-existent" in line]
