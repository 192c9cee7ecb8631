"""A connected browser: in which order what it shows leaves for it."""

from __future__ import annotations

from tests.app.small_room import make_project


class Part:
    """A part of the page that notes when it is drawn."""

    def __init__(self, name: str, order: list[str]) -> None:
        self._name, self._order = name, order

    def refresh(self) -> None:
        self._order.append(self._name)


def test_marks_and_handles_leave_before_the_panels_are_drawn(client, monkeypatch) -> None:
    order: list[str] = []
    monkeypatch.setattr(client, "show_marks", lambda: order.append("marks"))
    monkeypatch.setattr(client.viser_client, "flush", lambda: order.append("sent"), raising=False)
    client.handles = Part("handles", order)
    client.panels = [Part("panel", order)]
    client.select(("chair_1",))
    assert order == ["marks", "handles", "sent", "panel"]


def test_handles_that_fail_leave_the_panels(client) -> None:
    order: list[str] = []

    class Broken:
        def refresh(self) -> None:
            raise RuntimeError("no handles")

    client.handles = Broken()
    client.panels = [Part("panel", order)]
    client.select(("chair_1",))
    assert order == ["panel"]
    assert "handles" in client.failing


def test_another_project_begins_with_nothing_chosen(session, client, tmp_path) -> None:
    client.select(("chair_1",))
    client.selected_box, client.photo_name, client.rooms = 0, "further.jpg", frozenset({"room_1"})
    session.open_project(make_project(tmp_path / "other"))
    assert client.selection == ()
    assert client.selected_box is None, "a click on that row would put it out again"
    assert client.photo_name is None
    assert client.rooms == frozenset()
