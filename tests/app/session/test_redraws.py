from __future__ import annotations

import time

import pytest

from diorama_app.session.redraws import EVERY_S, Redraws
from diorama_app.session.ui_thread import UiThread
from tests.waiting import until


@pytest.fixture
def ui_thread():
    made = UiThread(lambda message: pytest.fail(message))
    yield made
    made.stop()


class Watcher:
    """A browser that counts how often its panels are drawn."""

    def __init__(self, number: int, takes_s: float = 0.0) -> None:
        self.id, self.drawn, self.takes_s = number, [], takes_s

    def refresh(self) -> None:
        self.drawn.append(time.monotonic())
        time.sleep(self.takes_s)


def test_whoever_caused_it_is_drawn_at_once_and_the_others_soon(ui_thread) -> None:
    people = [Watcher(k) for k in range(3)]
    redraws = Redraws(ui_thread, lambda i: True)
    redraws.ask(people, people[1])
    assert [len(p.drawn) for p in people] == [0, 1, 0]
    time.sleep(2 * EVERY_S)  # in which anybody would be drawn a second time
    assert ui_thread.wait(60.0)
    assert [len(p.drawn) for p in people] == [1, 1, 1]


def test_many_edits_in_a_moment_are_drawn_a_few_times_and_the_last_is_seen(ui_thread) -> None:
    one = Watcher(0)
    redraws = Redraws(ui_thread, lambda i: True)
    began = time.monotonic()
    for _ in range(200):
        redraws.ask([one], one)
    asked = time.monotonic()
    time.sleep(2.5 * EVERY_S)  # in which what is too much would be drawn
    assert ui_thread.wait(60.0)
    assert len(one.drawn) <= 2 + (asked - began) / EVERY_S
    assert one.drawn[-1] >= asked or len(one.drawn) == 1
    assert all(b - a > 0.8 * EVERY_S for a, b in zip(one.drawn, one.drawn[1:], strict=False))


def test_who_went_away_is_not_drawn(ui_thread) -> None:
    gone, there = Watcher(0), Watcher(1)
    redraws = Redraws(ui_thread, lambda i: i == 1)
    redraws.ask([gone, there], gone)
    until(lambda: there.drawn, "who is there is drawn")
    assert ui_thread.wait(60.0)
    assert (gone.drawn, len(there.drawn)) == ([], 1)
