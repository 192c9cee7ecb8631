from __future__ import annotations

import threading

import pytest

from diorama_app.panels.job import JobStrip
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
    assert told.wait(10.0)
    yield
    go_on.set()
    session.jobs.wait(10.0)


def test_nothing_is_drawn_while_nothing_runs(page: Page, client) -> None:
    JobStrip(page, client).refresh()
    assert "meter" not in page.html


def test_a_running_job_shows_its_progress_and_can_be_cancelled(session, page: Page, client, running) -> None:
    strip = JobStrip(page, client)
    strip.refresh()
    assert "Tidying &amp; such" in page.html
    assert "Half &lt;way&gt;" in page.html
    assert "width:50%" in page.html
    assert not page.shows("pause")
    page.act("cancel")
    assert session.jobs.wait(10.0)
    page.settle()
    strip.refresh()
    assert "meter" not in page.html


def test_an_optimisation_can_be_paused(session, page: Page, client, running) -> None:
    session.layout_run = LayoutRun("feasible", 0.0, session.scene)
    strip = JobStrip(page, client)
    strip.refresh()
    page.act("pause")
    assert session.layout_run.paused
    strip.refresh()
    assert "Resume" in page.html
    page.act("pause")
    assert not session.layout_run.paused
