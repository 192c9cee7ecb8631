"""Questions about a file that may mean several things."""

from __future__ import annotations

from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from diorama_app.panels import input_questions
from diorama_core.perception.inputs.depth.units import UnknownUnitError
from diorama_core.perception.inputs.sorting import Recognised

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
    found, taken = (Recognised("photo", "a photo"), Recognised("depth", "a depth map")), []
    input_questions.ask_which(asked.client, "a.png", found, taken.append)
    asked.buttons["A depth map"]()
    assert taken == [found[1]]
    assert asked.closed == 1
    assert asked.words == ["What is a.png?"]


def test_which_unit(asked: SimpleNamespace) -> None:
    choices = ((5000.0, "1/5000 m"), (4000.0, "1/4000 m"))
    unknown = UnknownUnitError("d.png: things have 4.5 times their size; give", choices)
    taken: list[float] = []
    input_questions.ask_unit(asked.client, unknown, taken.append)
    asked.buttons["1/4000 m"]()
    assert taken == [4000.0]
    assert "4.5 times" in asked.words[1]
    with pytest.raises(UnknownUnitError):
        input_questions.ask_unit(asked.client, UnknownUnitError("x"), taken.append)
