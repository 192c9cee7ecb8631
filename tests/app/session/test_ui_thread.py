"""The queue of the editor's thread: in order, fair, bounded."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import pytest

from diorama_app.session.ui_thread import MAX_WAITING, UiThread
from diorama_core.errors import EditRefused


@pytest.fixture
def told() -> list[str]:
    return []


@pytest.fixture
def ui_thread(told: list[str]) -> Iterator[UiThread]:
    made = UiThread(told.append)
    yield made
    made.stop()


def blocked(ui_thread: UiThread) -> threading.Event:
    """Keeps the thread busy until the event is set."""
    go, begun = threading.Event(), threading.Event()

    def block() -> None:
        begun.set()
        go.wait(60.0)

    ui_thread.post(block)
    assert begun.wait(60.0)
    return go


def test_tasks_of_one_browser_run_in_order(ui_thread: UiThread) -> None:
    done: list[int] = []
    for i in range(50):
        ui_thread.post(lambda i=i: done.append(i), client_id=1)
    assert ui_thread.wait()
    assert done == list(range(50))


def test_a_flood_of_one_delays_the_others_by_one_task_and_is_bounded(ui_thread: UiThread, told: list[str]) -> None:
    go, order, mine = blocked(ui_thread), [], []
    for _ in range(10_000):
        ui_thread.post(lambda: order.append("flood"), client_id=1, on_error=mine.append)
    ui_thread.post(lambda: order.append("edit"), client_id=2)
    assert ui_thread.waiting <= MAX_WAITING + 2
    go.set()
    assert ui_thread.wait()
    assert order.index("edit") <= 1
    assert order.count("flood") == MAX_WAITING
    assert len(mine) == 1, "the one who floods is told once"
    assert told == []


def test_what_a_departed_browser_asked_for_is_dropped(ui_thread: UiThread) -> None:
    go, done = blocked(ui_thread), []
    for _ in range(20):
        ui_thread.post(lambda: done.append("gone"), client_id=1)
    ui_thread.post(lambda: done.append("gone"), client_id=1, key="redraw", after_s=0.05)
    ui_thread.post(lambda: done.append("here"), client_id=2)
    ui_thread.forget(1)
    go.set()
    assert ui_thread.wait()
    assert done == ["here"]


def test_a_newer_task_of_the_same_key_replaces_the_one_that_waits(ui_thread: UiThread) -> None:
    go, done = blocked(ui_thread), []
    for i in range(200):
        ui_thread.post(lambda i=i: done.append(i), key="drag", client_id=1)
    ui_thread.post(lambda: done.append(-1), key="drag", client_id=2)
    go.set()
    assert ui_thread.wait()
    assert done == [199, -1]


def test_a_delayed_task_waits_and_is_waited_for(ui_thread: UiThread) -> None:
    done: list[float] = []
    began = time.monotonic()
    ui_thread.post(lambda: done.append(time.monotonic()), after_s=0.1)
    assert ui_thread.wait()
    assert done[0] - began >= 0.1


def test_stopping_does_what_was_posted(told: list[str]) -> None:
    ui_thread, done = UiThread(told.append), []
    ui_thread.post(lambda: done.append(1), after_s=30.0)
    ui_thread.post(lambda: done.append(2))
    ui_thread.stop()
    assert sorted(done) == [1, 2]


def test_errors_are_one_line_and_do_not_end_the_thread(ui_thread: UiThread, told: list[str]) -> None:
    def refuse() -> None:
        raise EditRefused("nothing is selected")

    def crash() -> None:
        raise ZeroDivisionError

    ui_thread.post(refuse)
    ui_thread.post(crash)
    assert ui_thread.wait()
    assert told[0] == "nothing is selected"
    assert "nothing was changed" not in told[1], "it does not know that"
