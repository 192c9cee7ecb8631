from __future__ import annotations

import pytest

from diorama_app.session import job_reports
from diorama_app.session.job_reports import JobReports
from diorama_app.session.jobs import JobStatus, Outcome
from diorama_app.session.ui_thread import UiThread

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
    monkeypatch.setattr(job_reports.time, "monotonic", lambda: now[0])
    return now


def report(reports, status: JobStatus) -> None:
    job_reports.JobReports.changed(reports, status)
    reports.wait()


def test_progress_is_told_a_few_times_a_second(reports, said, clock) -> None:
    for _ in range(5):
        report(reports, RUNNING)
    assert said == ["progress"]
    clock[0] += 2 * job_reports.REPORT_INTERVAL_S
    report(reports, RUNNING)
    assert said == ["progress", "progress"]


def test_the_start_and_a_cancel_are_told_at_once(reports, said, clock) -> None:
    report(reports, RUNNING)
    report(reports, JobStatus("build", "Building"))
    report(reports, JobStatus("build", "Building", fraction=0.3, cancelling=True))
    assert said == ["progress", "start", "progress"]


def test_the_end_is_told_with_how_it_ended(reports, said) -> None:
    outcome = Outcome("build", error="the photo is too dark")
    reports.ended(outcome)
    reports.wait()
    assert said == [outcome]
