"""The document and what the editor does to it, without a browser."""

from __future__ import annotations

import queue
import threading
import time
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from diorama_app.commands import edit as editing
from diorama_app.commands import swap as swapping
from diorama_app.commands.insert import insert_shape
from diorama_app.commands.optimise import final_poses
from diorama_app.panels.fields import unique_names
from diorama_app.panels.outliner import tree_html
from diorama_app.panels.room_size import RoomSize
from diorama_app.panels.supports import supporters
from diorama_app.session.client import Client
from diorama_app.session.jobs import AT_ONCE, Jobs, JobStatus, Outcome
from diorama_app.session.session import EditorSession
from diorama_core.errors import EditRefused, InputError
from diorama_core.progress import Progress
from diorama_core.scene import edits
from diorama_core.scene.support import check_scene
from tests.app.people import join
from tests.app.small_room import furnished_scene
from tests.waiting import until


def test_undo_restores_scene_and_selection(session: EditorSession, client: Client) -> None:
    client.select(["chair_1"])
    editing.delete_selected(client)
    assert not session.scene.has_object("chair_1")
    assert client.selection == ()
    session.undo(client)
    assert client.selection == ("chair_1",)
    assert session.scene.has_object("chair_1")
    session.redo(client)
    assert not session.scene.has_object("chair_1")
    with pytest.raises(EditRefused):
        session.redo(client)


def test_what_stood_on_a_deleted_table_comes_down_and_may_go_too(session: EditorSession, client: Client) -> None:
    offered: list[tuple[str, str, Any]] = []
    client.offer = lambda message, label, do: offered.append((message, label, do))
    client.select(["table_1"])
    editing.delete_selected(client)
    lamp = session.scene.object("lamp_1")
    assert lamp.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    assert session.scene.support_of("lamp_1").parent == "floor"
    message, label, do = offered[-1]
    assert message == "Deleted dining table; lowered what stood on top: lamp"
    assert label == "Delete it too"
    do()
    assert not session.scene.has_object("lamp_1")
    session.undo(client)
    session.undo(client)
    assert session.scene.object("lamp_1") == furnished_scene().object("lamp_1")


def test_a_selection_is_ones_own(session: EditorSession, client: Client) -> None:
    other = join(session, 1)
    client.select(["chair_1"])
    other.select(["lamp_1", "chair_2"])
    assert client.selection == ("chair_1",)
    editing.delete_selected(other)
    assert other.selection == ()
    session.undo(other)
    assert session.scene.has_object("lamp_1")
    assert client.selection == ("chair_1",)
    editing.delete_selected(client)
    assert other.session.scene is client.session.scene


def test_a_refused_edit_changes_nothing(session: EditorSession, client: Client) -> None:
    editing.set_locked(client, ["chair_1"], True)
    before = session.document.history
    client.select(["chair_1"])
    with pytest.raises(EditRefused, match="locked"):
        editing.delete_selected(client)
    assert session.scene is before.current.scene


def test_resizing_keeps_the_base_and_lifts_what_stands_on_it(session: EditorSession, client: Client) -> None:
    lamp = session.scene.object("lamp_1").corners_world[:, 2].min()
    editing.set_size(client, "table_1", np.array([0.8, 1.4, 1.0]))
    table = session.scene.object("table_1")
    np.testing.assert_allclose(table.size_m, [0.8, 1.4, 1.0])
    assert table.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    assert session.scene.object("lamp_1").corners_world[:, 2].min() == pytest.approx(lamp + 0.26)
    with pytest.raises(EditRefused):
        editing.set_size(client, "table_1", np.array([0.8, 0.0, 1.0]))


def test_fields_write_place_and_turn(session: EditorSession, client: Client) -> None:
    editing.set_base_position(client, "table_1", np.array([0.5, 2.0, 0.1]))
    table, lamp = session.scene.object("table_1"), session.scene.object("lamp_1")
    np.testing.assert_allclose(editing.base_position(table), [0.5, 2.0, 0.1], atol=1e-9)
    assert lamp.corners_world[:, 2].min() == pytest.approx(0.84)
    steps = len(session.document.history.entries)
    for degrees in (10.0, 20.0, 30.0):
        editing.set_yaw(client, "table_1", degrees)
    assert np.degrees(session.scene.object("table_1").pose.yaw_rad) == pytest.approx(30.0)
    assert len(session.document.history.entries) == steps + 1, "quick nudges are one undo step"


@pytest.mark.parametrize("shape_id", ["chair_a", "lamp_a", "table_b"])
def test_inserted_objects_stand_on_the_floor_clear_of_others(
    session: EditorSession, client: Client, shape_id: str
) -> None:
    insert_shape(client, shape_id)
    new = session.scene.object(client.selection[0])
    check_scene(session.scene)
    assert session.scene.support_of(new.id).parent == "floor"
    assert new.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    low, high = session.scene.plane("floor").polygon.min(axis=0), session.scene.plane("floor").polygon.max(axis=0)
    assert (new.pose.position[:2] > low[:2]).all()
    assert (new.pose.position[:2] < high[:2]).all()


def test_a_swap_keeps_the_photos_colour_unless_told_otherwise(session: EditorSession, client: Client) -> None:
    blue = (0.1, 0.2, 0.9)
    editing.set_colour(client, ["chair_1"], blue)
    swapping.swap(client, "chair_1", "chair_b")
    assert session.scene.object("chair_1").shape_id == "chair_b"
    assert session.scene.object("chair_1").colour == blue
    client.change_preferences(keep_colour=False)
    swapping.swap(client, "chair_1", "chair_c")
    assert session.scene.object("chair_1").colour is None
    session.undo(client)
    assert session.scene.object("chair_1").colour == blue


def test_sizes_of_a_swap_and_all_that_are_alike(session: EditorSession, client: Client) -> None:
    editing.set_size(client, "chair_1", np.array([0.6, 0.6, 1.2]))
    item = session.scene.object("chair_1")
    for mode, expected in (("same box", item.size_m), ("catalogue", [0.48, 0.5, 0.95])):
        candidate = swapping.candidate_for(session.library, item, "chair_c", mode)
        np.testing.assert_allclose(np.array(candidate.shape_size_m) * candidate.pose.scale, expected)
    even = swapping.candidate_for(session.library, item, "chair_c", "in proportion").pose.scale
    assert np.ptp(even) == pytest.approx(0.0)
    assert np.prod(even * (0.48, 0.5, 0.95)) == pytest.approx(np.prod(item.size_m))
    swapping.swap(client, "chair_1", "chair_b")
    client.change_preferences(all_alike=True)
    swapping.swap(client, "chair_1", "chair_c")
    assert {session.scene.object(i).shape_id for i in ("chair_1", "chair_2")} == {"chair_c"}
    session.undo(client)
    assert {session.scene.object(i).shape_id for i in ("chair_1", "chair_2")} == {"chair_b"}


def test_the_room_is_made_higher_and_a_wall_is_moved_with_what_hangs_on_it(
    session: EditorSession, client: Client
) -> None:
    panel = RoomSize(session.server.gui, client)
    panel._do("height", "", "3 m")
    assert session.scene.plane("ceiling").polygon[:, 2] == pytest.approx(3.0)
    picture = session.scene.object("picture_1").pose.position[1]
    client.change_preferences(unit="cm")
    panel._do("wall", "wall_3", "40")
    assert session.scene.object("picture_1").pose.position[1] == pytest.approx(picture + 0.4)
    session.undo(client)
    assert session.scene.object("picture_1").pose.position[1] == pytest.approx(picture)
    panel.refresh()
    with pytest.raises(InputError, match="not a length"):
        panel._do("height", "", "tall")


def test_every_commit_is_on_disk_soon(session: EditorSession, client: Client) -> None:
    editing.set_yaw(client, "chair_1", 77.0)

    def saved() -> bool:
        return abs(np.degrees(session.project.load_scene().object("chair_1").pose.yaw_rad) - 77.0) < 1e-6

    until(saved, seconds=20.0)


def test_names_are_escaped_and_supporters_are_named_apart() -> None:
    scene = edits.rename(furnished_scene(), "chair_1", "<script>alert(1)</script>")
    assert "<script>" not in tree_html(scene, ())
    assert unique_names(["chair", "chair", "table"]) == ["chair", "chair (2)", "table"]
    assert supporters(scene, "lamp_1")["dining table"] == "table_1"
    assert "lamp_1" not in supporters(scene, "lamp_1").values()


def test_an_optimiser_result_leaves_what_was_edited_meanwhile_and_what_is_locked() -> None:
    start = furnished_scene()
    raised = {o.id: o.pose.move((0, 0, 1.0)) for o in start.objects}
    final = edits.place(start, raised)
    current = edits.set_locked(edits.rename(start, "chair_1", "mine"), "lamp_1", True)
    assert set(final_poses(current, start, final)) == {"table_1", "chair_2", "picture_1"}


def test_a_job_that_ends_while_it_is_cancelled_has_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    def slowly(status: JobStatus, **changes: Any) -> JobStatus:
        (job,) = (thread for thread in threading.enumerate() if thread.name == "job export")
        job.join(0.1)  # it ends meanwhile, or waits for what is changed
        return replace(status, **changes)

    monkeypatch.setattr("diorama_app.session.jobs.replace", slowly)
    jobs = Jobs(lambda status: None, lambda outcome: None)

    def work(progress: Progress) -> None:
        while True:
            progress.check()

    jobs.start("export", "Exporting", work)
    jobs.cancel()
    assert jobs.wait(60.0)
    jobs.start("export", "Exporting", lambda progress: None)
    assert jobs.wait(60.0)


def test_one_job_at_a_time_and_cancel_ends_it() -> None:
    ended: list[Outcome] = []
    jobs = Jobs(lambda status: None, ended.append)

    def work(progress: Progress) -> None:
        while True:
            progress.report(0.5, "working")
            time.sleep(0.005)  # the work

    jobs.start("build", "Building", work)
    with pytest.raises(EditRefused, match="still running"):
        jobs.start("export", "Exporting", work)
    jobs.cancel()
    assert jobs.wait(60.0)
    assert ended == [Outcome("build", cancelled=True)]

    def fail(progress: Progress) -> None:
        raise InputError("the photo is no photo")

    jobs.start("build", "Building", fail)
    assert jobs.wait(60.0)
    assert ended[-1].error == "the photo is no photo"


def test_no_more_jobs_compute_at_once_than_processors_and_what_waits_can_be_cancelled() -> None:
    ended = queue.Queue[Outcome]()
    statuses = queue.Queue[JobStatus]()
    computing, release = threading.Semaphore(0), threading.Event()

    def work(progress: Progress) -> None:
        computing.release()
        release.wait(60.0)

    every = [Jobs(lambda status: None, ended.put) for _ in range(AT_ONCE)]
    for jobs in every:
        jobs.start("build", "Building", work)
        assert computing.acquire(timeout=60.0)
    late, quick = Jobs(statuses.put, ended.put), Jobs(lambda status: None, ended.put)
    late.start("build", "Building", work)
    while "Waiting" not in statuses.get(timeout=60.0).message:
        pass
    quick.start("export", "Exporting", lambda progress: None)
    assert ended.get(timeout=60.0) == Outcome("export")
    late.cancel()
    assert ended.get(timeout=60.0) == Outcome("build", cancelled=True)
    release.set()
    assert all(jobs.wait(60.0) for jobs in every)
