"""The queue of the editor's thread: in order, fair, bounded."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import pytest

from diorama_app.session import ui_thread as module
from diorama_app.session.ui_thread import MAX_WAITING, UiThread
from diorama_core.errors import EditRefused, UnavailableError


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


def test_a_key_of_a_departed_browser_is_free_again(ui_thread: UiThread) -> None:
    go, done = blocked(ui_thread), []
    ui_thread.post(lambda: done.append("of who left"), client_id=1, key="redraw")
    ui_thread.forget(1)
    ui_thread.post(lambda: done.append("of who came"), client_id=1, key="redraw")
    go.set()
    assert ui_thread.wait()
    assert done == ["of who came"]


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


def test_what_nobody_awaits_is_done_later_or_dropped_at_the_end(
    ui_thread: UiThread, clock: list[float], told: list[str]
) -> None:
    done: list[str] = []
    ui_thread.post(lambda: done.append("faded"), after_s=5.0, awaited=False)
    ui_thread.post(lambda: done.append("left"), after_s=50.0, awaited=False)
    assert ui_thread.wait()
    assert done == []
    clock[0] += 6.0
    ui_thread.post(lambda: done.append("edit"))
    assert ui_thread.wait()
    assert sorted(done) == ["edit", "faded"]
    ui_thread.stop()
    assert "left" not in done


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


def test_a_task_of_a_key_is_done_again_after_it_was_done(ui_thread: UiThread) -> None:
    done: list[int] = []
    for number in range(2):
        ui_thread.post(lambda number=number: done.append(number), key="redraw")
        assert ui_thread.wait()
    assert done == [0, 1]


def test_who_floods_is_told_again_after_the_flood_and_the_server_itself_is_not_bounded(ui_thread: UiThread) -> None:
    told: list[str] = []
    done: list[int] = []
    for rounds in (1, 2):
        go = blocked(ui_thread)
        for _ in range(MAX_WAITING + 1):
            ui_thread.post(lambda: None, client_id=1, on_error=told.append)
            ui_thread.post(lambda: done.append(1))
        assert ui_thread.waiting == 2 * MAX_WAITING + 2
        go.set()
        assert ui_thread.wait()
        assert (len(done), len(told)) == (rounds * (MAX_WAITING + 1), rounds)
        assert ui_thread.waiting == 0


def test_the_newest_of_a_key_is_told_of_its_errors(ui_thread: UiThread, told: list[str]) -> None:
    def refuse() -> None:
        raise EditRefused("it is locked")

    go, newest = blocked(ui_thread), []
    ui_thread.post(lambda: None, key="drag")
    ui_thread.post(refuse, key="drag", on_error=newest.append)
    go.set()
    assert ui_thread.wait()
    assert (newest, told) == (["it is locked"], [])


def test_another_thread_gets_what_a_task_gives_or_raises(
    ui_thread: UiThread, told: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def late() -> None:
        raise TimeoutError("of the task itself")

    assert ui_thread.ask(lambda: threading.current_thread().name) == "desk"
    with pytest.raises(ZeroDivisionError):
        ui_thread.ask(lambda: 1 // 0)
    with pytest.raises(TimeoutError, match="of the task itself"):
        ui_thread.ask(late)
    monkeypatch.setattr(module, "MAX_ANSWER_S", 0.01)
    go = blocked(ui_thread)
    with pytest.raises(UnavailableError, match="the editor is busy"):
        ui_thread.ask(lambda: 1)
    go.set()
    assert told == [], "who asked is told, and nobody else"


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The time that the thread is told; it waits by another clock."""
    now = [time.monotonic()]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    return now


def test_delayed_tasks_are_done_in_the_order_of_their_times(ui_thread: UiThread, clock: list[float]) -> None:
    go, done = blocked(ui_thread), []
    for client_id, after_s in ((1, 1), (2, 5), (1, 2), (2, 6), (2, 7), (2, 3), (2, 4), (2, 3)):
        ui_thread.post(lambda after_s=after_s: done.append(after_s), client_id=client_id, after_s=after_s)
    ui_thread.post(lambda: done.append(0), client_id=2)
    assert ui_thread.waiting == 9
    ui_thread.forget(1)
    assert ui_thread.waiting == 7
    clock[0] += 7.0
    go.set()
    assert ui_thread.wait()
    assert done == [0, 3, 3, 4, 5, 6, 7]


def test_delayed_tasks_of_one_time_keep_their_order(ui_thread: UiThread, clock: list[float]) -> None:
    go, done = blocked(ui_thread), []
    for number in range(20):
        ui_thread.post(lambda number=number: done.append(number), client_id=1, after_s=1.0)
    clock[0] += 1.0
    go.set()
    assert ui_thread.wait()
    assert done == list(range(20))


def test_what_waits_for_the_end_goes_on_when_the_rest_is_dropped(ui_thread: UiThread) -> None:
    ui_thread.post(lambda: None, client_id=1, after_s=600.0)
    assert not ui_thread.wait(0.01)
    waiting = threading.Thread(target=ui_thread.wait, args=(600.0,), daemon=True)
    waiting.start()
    ui_thread.forget(1)
    waiting.join(60.0)
    assert not waiting.is_alive()


def test_it_is_waited_for_what_is_being_done(ui_thread: UiThread) -> None:
    go = blocked(ui_thread)
    assert not ui_thread.wait(0.01)
    go.set()
    assert ui_thread.wait()


def test_the_thread_can_stop_itself_and_does_not_keep_the_program(told: list[str]) -> None:
    made = UiThread(told.append)
    made.post(made.stop)
    made._thread.join(60.0)
    assert not made._thread.is_alive()
    assert made._thread.daemon
    assert told == []
