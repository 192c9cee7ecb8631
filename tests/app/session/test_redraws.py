from __future__ import annotations

import time
from pathlib import Path

import pytest

from diorama_app.session import redraws
from diorama_app.session.jobs import JobStatus, Outcome
from diorama_app.session.redraws import EVERY_S, FRESH_S, Glances, JobReports, Redraws
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
    until(lambda: all(p.drawn for p in people))
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


RUNNING = JobStatus("build", "Building", fraction=0.3)


@pytest.fixture
def said() -> list:
    return []


@pytest.fixture
def reports(said):
    ui_thread = UiThread(said.append)
    made = JobReports(
        ui_thread,
        on_start=lambda: said.append("start"),
        on_progress=lambda: said.append("progress"),
        on_end=said.append,
    )
    made.wait = ui_thread.wait
    yield made
    ui_thread.stop()


@pytest.fixture
def clock(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(redraws.time, "monotonic", lambda: now[0])
    return now


def report(reports, status: JobStatus) -> None:
    redraws.JobReports.update(reports, status)
    reports.wait()


def test_progress_is_told_a_few_times_a_second(reports, said, clock) -> None:
    for _ in range(5):
        report(reports, RUNNING)
    assert said == ["progress"]
    clock[0] += 2 * redraws.REPORT_INTERVAL_S
    report(reports, RUNNING)
    assert said == ["progress", "progress"]


def test_the_start_and_a_cancel_are_told_at_once(reports, said, clock) -> None:
    report(reports, RUNNING)
    report(reports, JobStatus("build", "Building"))
    report(reports, JobStatus("build", "Building", fraction=0.3, cancelling=True))
    assert said == ["progress", "start", "progress"]


def test_the_end_is_told_with_how_it_ended(reports, said) -> None:
    outcome = Outcome("build", error="the photo is too dark")
    reports.end(outcome)
    reports.wait()
    assert said == [outcome]


def test_the_disk_is_looked_at_once_a_second_and_after_own_changes() -> None:
    now = [0.0]
    glances, looked = Glances(lambda: now[0]), []

    def look() -> int:
        looked.append(1)
        return len(looked)

    assert [glances.get("name", look), glances.get("name", look)] == [1, 1]
    assert glances.get("versions", lambda: "others") == "others"
    now[0] = 1.5 * FRESH_S
    assert glances.get("name", look) == 2
    glances.forget()
    assert glances.get("name", look) == 3


def test_what_cannot_be_read_is_tried_again() -> None:
    glances = Glances()
    with pytest.raises(OSError):
        glances.get("name", Path("/nowhere/at/all").stat)
    assert glances.get("name", lambda: "there") == "there"
