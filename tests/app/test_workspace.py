"""Several projects behind one port, without a browser."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from diorama_app.session.jobs import JobStatus
from diorama_app.workspace import Workspace
from diorama_core.editing.clipboard import clip_of
from diorama_core.errors import DioramaError
from tests.app.people import LocalClient, join
from tests.app.small_room import PlainLibrary, make_project
from tests.waiting import until


@pytest.fixture
def workspace(server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Workspace]:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path / "libraries"))
    made = Workspace(PlainLibrary(), tmp_path / "projects", low_graphics=True)
    made.begin(server, make_project(tmp_path / "projects" / "first"))
    make_project(tmp_path / "projects" / "second")
    yield made
    made.close()
    server.scene.reset()
    server.gui.reset()


def test_a_name_leads_to_the_server_of_its_project(workspace: Workspace, server) -> None:
    assert workspace.first() == "first"
    assert workspace.server("first") is server
    second = workspace.server("second")
    assert second is not None
    assert second is not server
    assert workspace.server("second") is second, "opened once"
    assert [e.session.project.name for e in workspace.editors] == ["first", "second"]


@pytest.mark.parametrize("name", ["../second", "gone", ""])
def test_a_name_of_no_project_is_told_on_the_first_page(workspace: Workspace, name: str) -> None:
    assert workspace.server(name) is None
    message, kind = workspace.editors[0].session.greeting
    assert "no project called" in message
    assert kind == "bad"


def test_a_copy_made_in_one_project_is_pasted_in_another(workspace: Workspace) -> None:
    workspace.server("second")
    first, second = (e.session for e in workspace.editors)
    first.shared.clip = clip_of(first.scene, ["chair_1"])
    assert second.shared.clip is first.shared.clip


def test_only_who_asked_goes_to_another_project(workspace: Workspace, tmp_path: Path) -> None:
    session = workspace.editors[0].session
    people = [LocalClient(session.server, number) for number in (0, 1)]
    for person in people:
        session.ui_thread.post(lambda person=person: session.join(person))
    assert session.ui_thread.wait(60.0)
    went: list[tuple[int, str]] = []
    for number, client in session.clients.items():
        client.go_to = lambda name, number=number: went.append((number, name))
    project = make_project(tmp_path / "projects" / "third")
    session.visit(session.clients[1], project, "Opened third.")
    assert went == [(1, "third")]
    assert workspace.editors[-1].session.greeting == ("Opened third.", "good")


def test_a_damaged_project_leaves_everybody_where_they_are(workspace: Workspace, tmp_path: Path) -> None:
    project = make_project(tmp_path / "projects" / "broken")
    project.scene_path.write_text("{")
    with pytest.raises(DioramaError):
        workspace.visit(join(workspace.editors[0].session), project, "")
    assert len(workspace.editors) == 1


def test_what_nobody_looks_at_is_closed_after_a_while(workspace: Workspace) -> None:
    workspace.server("second")
    workspace.close_unused()
    assert len(workspace.editors) == 2, "a reload takes a moment"
    workspace.close_unused(at_once=True)
    assert [e.session.project.name for e in workspace.editors] == ["first"]
    assert workspace.server("second") is not None, "and opened again when somebody comes"


def test_a_project_whose_job_outlasts_its_last_page_is_closed_after_it(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace.server("second")
    jobs = workspace.editors[1].session.jobs
    monkeypatch.setattr("diorama_app.workspace.CLOSED_AFTER_S", -0.5)
    monkeypatch.setattr(jobs, "_status", JobStatus("build", "Build"))
    workspace._look_for_unused()
    assert len(workspace.editors) == 2
    monkeypatch.setattr(jobs, "_status", None)
    until(lambda: len(workspace.editors) == 1, "looked at again although nobody leaves any more")


def test_many_who_leave_wait_in_one_thread(workspace: Workspace, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each page that was closed left a thread behind for a minute."""
    before = threading.active_count()
    for _ in range(120):
        workspace._leave()
    assert threading.active_count() <= before + 1
    looked: list[int] = []
    monkeypatch.setattr(workspace, "close_unused", lambda: looked.append(1))
    assert workspace._timer is not None
    workspace._timer.cancel()
    monkeypatch.setattr("diorama_app.workspace.CLOSED_AFTER_S", -1.0)
    workspace._look_for_unused()
    until(lambda: len(looked) >= 2, "whoever left while the timer ran is looked after, too")
