"""A connected browser: in which order what it shows leaves for it."""

from __future__ import annotations


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
