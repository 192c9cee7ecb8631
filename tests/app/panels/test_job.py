from __future__ import annotations

import threading

import pytest

from diorama_app.panels.job import JobStrip, time_left
from diorama_app.session.jobs import JobStatus
from diorama_app.session.layout_run import LayoutRun
from diorama_core.progress import Progress
from tests.app.page import Page


@pytest.fixture
def running(session):
    """A job that says where it is and waits."""
    told, go_on = threading.Event(), threading.Event()

    def work(progress: Progress) -> None:
        progress.report(0.5, "Half <way>")
        told.set()
        while not go_on.wait(0.01):
            progress.report(0.5, "Half <way>")

    session.jobs.start("optimise", "Tidying & such", work)
    assert told.wait(60.0)
    yield
    go_on.set()
    session.jobs.wait(60.0)


def test_nothing_is_shown_while_nothing_runs(page: Page, client) -> None:
    JobStrip(page, client).refresh()
    assert "__dioJob(null)" in page.html


def test_a_running_job_shows_its_progress_and_can_be_cancelled(session, page: Page, client, running) -> None:
    strip = JobStrip(page, client)
    strip.refresh()
    assert "Tidying &amp; such" in page.html
    assert "Half &lt;way&gt;" in page.html
    assert "&quot;percent&quot;: 50," in page.html
    assert "&quot;pause&quot;: &quot;&quot;" in page.html
    page.send(page.field("·"), "cancel", "")
    assert session.jobs.wait(60.0)
    page.settle()
    strip.refresh()
    assert "__dioJob(null)" in page.html


def test_an_optimisation_can_be_paused(session, page: Page, client, running) -> None:
    session.layout_run = LayoutRun("feasible", 0.0, session.scene)
    strip = JobStrip(page, client)
    strip.refresh()
    page.send(page.field("·"), "pause", "")
    assert session.layout_run.is_paused
    strip.refresh()
    assert "Resume" in page.html
    page.send(page.field("·"), "pause", "")
    assert not session.layout_run.is_paused


@pytest.mark.parametrize(
    ("fraction", "spent", "words"),
    [
        (0.5, 20.0, "about 20 s left"),
        (0.99, 60.0, "about 5 s left"),
        (1.0, 60.0, ""),
        (0.1, 60.0, "about 9 min left"),
        (0.05, 60.0, ""),
        (0.5, 1.0, ""),
    ],
)
def test_time_left_is_told_once_something_can_be_said(fraction: float, spent: float, words: str) -> None:
    assert time_left(JobStatus("build", "Building", fraction, started_at=100.0), 100.0 + spent) == words


def test_what_was_found_so_far_is_kept(session, page: Page, client) -> None:
    told, go_on = threading.Event(), threading.Event()

    def work(progress: Progress) -> None:
        progress.report(0.1, "Outlining")
        progress.part(0.0, 0.2).report_finding("9 objects")
        progress.report_finding("3 walls")
        told.set()
        assert go_on.wait(60.0)

    session.jobs.start("build", "Building", work)
    assert told.wait(60.0)
    strip = JobStrip(page, client)
    strip.refresh()
    assert "9 objects \\u00b7 3 walls" in page.html
    assert "Outlining" in page.html
    go_on.set()
    assert session.jobs.wait(60.0)
