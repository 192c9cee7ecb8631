"""Fields of the panels lose nothing that is typed while the program is at work."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import Locator, expect

from tests.e2e.browser import EditorPage

pytestmark = pytest.mark.browser


@pytest.fixture
def busy(editor: EditorPage) -> Iterator[threading.Event]:
    """The editor's thread does nothing more until the event is set."""
    editor.row("dining table").click()
    expect(editor.page.get_by_label("Size: Width")).to_be_visible()
    editor.settle()
    free = threading.Event()
    editor.session.ui_thread.post(lambda: free.wait(20))
    yield free
    free.set()


def size(editor: EditorPage) -> np.ndarray:
    return np.asarray(editor.session.scene.object("table_1").size_m)


def width_then_depth(editor: EditorPage, words: str) -> tuple[Locator, Locator]:
    """Write a width, and begin to type a depth; both fields."""
    width, depth = (editor.page.get_by_label(f"Size: {axis}") for axis in ("Width", "Depth"))
    width.fill("1.5")
    width.press("Enter")
    depth.focus()
    editor.page.keyboard.press("Control+a")
    editor.page.keyboard.type(words)
    return width, depth


def test_what_is_being_typed_stays_when_the_panel_is_drawn_anew(editor: EditorPage, busy: threading.Event) -> None:
    width, depth = width_then_depth(editor, "0.")
    busy.set()
    expect(width).to_have_value("1.5")
    editor.until(lambda: np.isclose(size(editor)[1], 1.5), "the width is written")
    editor.settle()
    expect(depth).to_have_value("0.")
    expect(depth).to_be_focused()
    editor.page.keyboard.type("95")
    editor.page.keyboard.press("Enter")
    editor.until(lambda: np.isclose(size(editor)[0], 0.95), "the depth is written")


@pytest.mark.parametrize("leave", ["Enter", "Tab", "press elsewhere"])
def test_a_field_drawn_anew_is_written_when_it_is_left(editor: EditorPage, busy: threading.Event, leave: str) -> None:
    width_then_depth(editor, "0.95")
    busy.set()
    editor.until(lambda: np.isclose(size(editor)[1], 1.5), "the width is written")
    editor.settle()
    if leave == "press elsewhere":
        editor.page.get_by_text("Position").first.click()
    else:
        editor.page.keyboard.press(leave)
    editor.until(lambda: np.isclose(size(editor)[0], 0.95), "the depth is written")


def test_a_field_is_selected_whole_but_not_over_what_is_typed_at_once(editor: EditorPage) -> None:
    editor.row("dining table").click()
    field = editor.page.get_by_label("Size: Width")
    shown = field.input_value()
    focused = """(field, typed) => {
        field.blur();
        field.focus();
        if (typed) {
            field.value = typed;
            field.dispatchEvent(new Event("input", { bubbles: true }));
        }
        return new Promise((told) => setTimeout(() => told(field.selectionEnd - field.selectionStart), 50));
    }"""
    assert field.evaluate(focused, "") == len(shown)
    editor.page.get_by_label("Size: Depth").focus()
    assert field.evaluate(focused, "0.9") == 0


def test_edits_told_at_once_are_all_made(editor: EditorPage, busy: threading.Event) -> None:
    for axis, value in (("Width", "1.5"), ("Depth", "0.95"), ("Height", "0.7")):
        field = editor.page.get_by_label(f"Size: {axis}")
        field.fill(value)
        field.press("Enter")
    busy.set()
    editor.until(lambda: np.allclose(size(editor), (0.95, 1.5, 0.7), atol=1e-3), "all three are written")


def test_actions_of_several_panels_at_once_are_all_made(editor: EditorPage) -> None:
    editor.row("dining table").click()
    expect(editor.page.get_by_label("Size: Width")).to_be_visible()
    editor.settle()
    keeps = editor.client.preferences.keep_colour
    editor.page.evaluate(
        """() => {
            const width = document.querySelector('[aria-label="Size: Width"]');
            width.value = "1.5";
            width.dispatchEvent(new Event("change", { bubbles: true }));
            for (const press of ["[data-do=finish][data-arg=gloss]", "[data-do=keep]"])
                document.querySelector(`.dio ${press}`).click();
        }"""
    )
    editor.until(lambda: np.isclose(size(editor)[1], 1.5), "the width is written")
    editor.until(lambda: editor.session.scene.object("table_1").finish == "gloss", "the finish is chosen")
    editor.until(lambda: editor.client.preferences.keep_colour != keeps, "the colour is kept or not")


def test_undo_in_a_field_whose_value_was_told_is_the_scenes(editor: EditorPage) -> None:
    editor.row("dining table").click()
    field = editor.page.get_by_label("Size: Width")
    before = size(editor)[1]
    field.fill("1.5")
    field.press("Enter")
    editor.until(lambda: np.isclose(size(editor)[1], 1.5), "the width is written")
    expect(field).to_be_focused()
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: np.isclose(size(editor)[1], before), "undone")
