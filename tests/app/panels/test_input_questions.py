"""Questions about a file that may mean several things."""

from __future__ import annotations

from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from diorama_app.panels import input_questions
from diorama_app.projects.dropped import Dropped, Reading
from diorama_core.perception.inputs.depth.scale import AmbiguousDepthError, DepthAnswer

pytestmark = pytest.mark.unchecked  # the page is a stand-in


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """A page whose dialog keeps its buttons and what they do."""
    page = SimpleNamespace(buttons={}, words=[], closed=0)

    @contextmanager
    def dialog(client: object, title: str):
        page.words.append(title)

        def close() -> None:
            page.closed += 1

        yield close

    monkeypatch.setattr(input_questions, "dialog", dialog)
    monkeypatch.setattr(input_questions, "on_press", lambda label, do: page.buttons.update({label: do}))
    gui = SimpleNamespace(add_html=page.words.append, add_button=lambda label: label)
    page.client = SimpleNamespace(viser_client=SimpleNamespace(gui=gui), post=lambda task: task())
    return page


def test_what_a_file_is(asked: SimpleNamespace) -> None:
    found, taken = (Reading("photo", "a photo"), Reading("inputs", "a depth map")), []
    input_questions.ask_which(asked.client, "a.zip", Dropped(found, ("notes.txt",)), taken.append)
    asked.buttons["A depth map"]()
    assert taken == [found[1]]
    assert asked.closed == 1
    assert asked.words == ["What is a.zip?", "<p>Left out: notes.txt.</p>"]


def test_which_unit(asked: SimpleNamespace) -> None:
    choices = (DepthAnswer("1/5000 m", 5000.0), DepthAnswer("1/4000 m", 4000.0))
    unknown = AmbiguousDepthError("d.png: things have 4.5 times their size; give", choices)
    taken: list[DepthAnswer] = []
    input_questions.ask_depth(asked.client, unknown, taken.append)
    asked.buttons["1/4000 m"]()
    assert taken == [choices[1]]
    assert "4.5 times" in asked.words[1]
    with pytest.raises(AmbiguousDepthError):
        input_questions.ask_depth(asked.client, AmbiguousDepthError("x"), taken.append)
