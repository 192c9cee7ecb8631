from __future__ import annotations

import html
import json

import pytest
import viser
from hypothesis import given
from hypothesis import strategies as st

from diorama_app.web.html import Action, LiveHtml, _read_actions, button, run_once, switch, text
from tests.app.page import Page


@given(st.text(max_size=60))
def test_escaped_text_comes_back_and_opens_no_tag(value: str) -> None:
    escaped = text(value)
    assert html.unescape(escaped) == value or "&" in value
    assert not set(escaped) & set("<>\"'")


def test_a_button_says_what_it_does_and_escapes_its_argument() -> None:
    drawn = button("&#8630; Undo", "run", 'a"b<c', title="It's", on=True)
    assert 'data-do="run" data-arg="a&quot;b&lt;c"' in drawn
    assert 'title="It&#x27;s"' in drawn
    assert 'class="on"' in drawn
    assert ">&#8630; Undo</button>" in drawn
    assert " disabled>" in button("x", "y", disabled=True)


@pytest.mark.parametrize(
    ("arg", "pair"),
    [('["a", "b"]', ("a", "b")), ("[1, 2]", ("1", "2")), ("a", ("", "")), ("[1]", ("", "")), ("3", ("", ""))],
)
def test_two_words_in_one_argument(arg: str, pair: tuple[str, str]) -> None:
    assert Action("change", arg, False).pair == pair


def test_html_is_redrawn_only_when_it_differs(page: Page) -> None:
    live = LiveHtml(page)
    handle = page.made[-1][2]
    assert not handle.visible
    live.show("<b>100%</b>")
    first = handle.content
    assert live.body in first
    handle.content = "touched"
    live.show("<b>100%</b>")
    assert handle.content == "touched"
    live.show("<b>100%</b>", again=True)
    again = handle.content
    live.show("<b>60%</b>")
    live.show("<b>100%</b>")
    assert len({first, again, handle.content}) == 3, "or the page would take it for what it shows"
    live.show("")
    assert not handle.visible


def test_clicks_arrive_and_what_others_write_is_ignored(page: Page) -> None:
    told: list[Action] = []
    live = LiveHtml(page, told.append)
    live.show(button("Go", "run", "there"))
    page.act("run", "there")
    assert told == [Action("run", "there", False)]
    hidden = next(h for kind, label, h in page.made if label == "·")
    for junk in ("", "hello", "[1]", '{"do": "x"}', '[{"do": "x"}]', "null"):
        hidden.value = junk
        page._told(hidden)
    assert len(told) == 1
    hidden.value = '[{"do": "run", "arg": "there", "add": false, "number": 9}]'
    for callback in hidden._impl.update_cb:
        with pytest.raises(StopIteration):
            callback(viser.GuiEvent(None, None, hidden)).send(None)
    assert len(told) == 1, "the program's own writing is no click"


def test_actions_that_overtake_each_other_are_each_told_once(page: Page) -> None:
    told: list[Action] = []
    LiveHtml(page, told.append)
    hidden = next(h for kind, label, h in page.made if label == "·")
    said = [{"do": "run", "arg": name, "add": False, "number": k + 1} for k, name in enumerate("abc")]
    for message in (said[:1], said, said[1:], said[:2]):
        hidden.value = json.dumps(message)
        page._told(hidden)
    assert [action.arg for action in told] == ["a", "b", "c"]


def test_floating_html_starts_over_each_time(page: Page) -> None:
    live = LiveHtml(page, floating="dio-x")
    handle = page.made[-1][2]
    live.show("<i>said</i>", again=True)
    first = handle.content
    live.show("<i>said</i>", again=True)
    assert handle.content != first
    assert 'data-float="dio-x"' in handle.content
    live.show("")
    assert 'data-empty="1"' in handle.content


def test_a_script_runs_when_it_is_drawn() -> None:
    drawn = run_once('const a = "x";\n  go(a);')
    assert 'onerror="const a = &quot;x&quot;; go(a);"' in drawn


def test_a_switch_says_its_state_and_its_name_alone() -> None:
    on, off = switch("With <photo>", "Who gets it & sees it", "photo", on=True), switch("A", "B", "c", disabled=True)
    assert 'role="switch" aria-checked="true" aria-label="With &lt;photo&gt;"' in on
    assert 'data-do="switch" data-arg="photo"' in on
    assert "Who gets it &amp; sees it</small>" in on
    assert 'aria-checked="false"' in off
    assert "disabled" in off
    assert "disabled" not in on


def test_half_characters_of_a_page_are_replaced_where_they_enter() -> None:
    said = json.dumps([{"number": 1, "do": "rename", "arg": json.dumps(["", "caf\udce9"]), "add": False}])
    ((_, action),) = _read_actions(said)
    assert action.pair == ("", "caf\ufffd")
    assert action.value == ["", "caf\ufffd"]
    for odd in ("[" * 100_000, '[{"number": 1e999, "do": "a", "arg": "", "add": 0}]', "{", "7"):
        assert _read_actions(odd) == []
        assert Action("do", odd, False).pair == ("", "")
