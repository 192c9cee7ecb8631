"""Steps of people and programs: who did what, what each may take back, and pictures of planes that change."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from diorama_app.commands import edit
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.session.shared_document import SharedDocument, refit
from diorama_core.appearance.surface_finish import usual_finish
from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from diorama_core.scene.room_edits import move_plane, set_surface_finish
from diorama_core.scene.types import Scene
from tests.app.people import join
from tests.app.small_room import furnished_scene
from tests.waiting import until


def without(name: str, scene: Scene) -> Scene:
    return edits.remove(scene, (name,))


def test_a_program_takes_back_its_own_step_alone(session: EditorSession) -> None:
    document: SharedDocument = session
    person, said = join(session), list[str]()
    person.toast = lambda message, offers_undo: said.append(message)
    document.edit("remove the lamp", partial(without, "lamp_1"), author="Agent")
    document.edit("remove a chair", partial(without, "chair_1"), by=person)
    assert document.undo("Agent").label == "remove the lamp"
    assert document.scene.has_object("lamp_1")
    assert not document.scene.has_object("chair_1")
    assert said == ["Agent: Remove the lamp", "Remove a chair", "Undone: remove the lamp"]


def test_a_refused_edit_and_one_that_changes_nothing_leave_no_step(session: EditorSession) -> None:
    before = session.document.version
    session.edit("nothing", lambda scene: scene)
    with pytest.raises(EditRefused, match="this is not possible: no number"):
        session.edit("wrong", refused)
    assert session.document.version == before


def refused(scene: Scene) -> Scene:
    raise ValueError("no number")


SCENE = furnished_scene()


def test_an_edit_of_furniture_leaves_every_picture_alone() -> None:
    moved = edits.rename(SCENE, "chair_1", "throne")
    assert refit(SCENE, moved, {"floor.png": np.zeros((4, 4, 3), dtype=np.uint8)}) == (moved, {})


def test_a_longer_floor_gets_a_larger_picture_of_the_same_scale(rng) -> None:
    floor = next(p for p in SCENE.architecture.planes if p.role == "floor")
    square = floor.polygon * (*(4.0 / np.ptp(floor.polygon[:, :2], axis=0)), 1.0)
    textured = replace(floor, texture="floor.png", polygon=square)
    planes = tuple(textured if p is floor else p for p in SCENE.architecture.planes)
    before = replace(SCENE, architecture=replace(SCENE.architecture, planes=planes))
    longer = replace(textured, polygon=square * (1.5, 1.0, 1.0))
    after = replace(
        before, architecture=replace(before.architecture, planes=tuple(longer if p is textured else p for p in planes))
    )
    picture = rng.integers(0, 256, (80, 80, 3), dtype=np.uint8)
    scene, made = refit(before, after, {"floor.png": picture})
    assert len(made) == 1
    name = next(iter(made))
    assert name != "floor.png"
    assert next(p for p in scene.architecture.planes if p.role == "floor").texture == name
    grown = np.array(made[name].shape[:2]) / picture.shape[:2]
    np.testing.assert_allclose(sorted(grown), (1.0, 1.5), atol=0.03)


def test_a_moved_wall_has_its_finish_made_anew_and_the_photo_below_it_fitted(rng) -> None:
    photo = rng.integers(0, 256, (80, 120, 3), dtype=np.uint8)
    bare = replace(SCENE.plane("wall_2"), texture="wall.png")
    planes = tuple(bare if p.id == "wall_2" else p for p in SCENE.architecture.planes)
    before = replace(SCENE, architecture=replace(SCENE.architecture, planes=planes))
    finished, made = refit(before, set_surface_finish(before, ("wall_2",), usual_finish("dots")), {"wall.png": photo})
    known = {"wall.png": photo, **made}
    moved, more = refit(finished, move_plane(finished, "wall_3", 1.0), known)
    wall = moved.plane("wall_2")
    assert {wall.texture, wall.photo_texture} == set(more)
    assert wall.texture != finished.plane("wall_2").texture
    back = set_surface_finish(moved, ("wall_2",), None).plane("wall_2")
    assert back.texture == wall.photo_texture
    assert more[str(back.texture)].shape[1] > photo.shape[1]


RED, BLUE = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


@pytest.fixture
def other(session: EditorSession, client: Client) -> Client:
    return join(session, 1)


def test_each_undoes_and_redoes_what_is_theirs(session: EditorSession, client: Client, other: Client) -> None:
    edit.set_colour(client, ["chair_1"], RED)
    edit.set_colour(other, ["lamp_1"], BLUE)
    session.undo(client)
    assert session.scene.object("chair_1").colour is None
    assert session.scene.object("lamp_1").colour == BLUE
    with pytest.raises(EditRefused, match="nothing of yours to undo"):
        session.undo(client)
    with pytest.raises(EditRefused, match="nothing of yours to redo"):
        session.redo(other)
    session.redo(client)
    assert session.scene.object("chair_1").colour == RED


def test_what_the_other_changed_since_stays(session: EditorSession, client: Client, other: Client) -> None:
    edit.set_colour(client, ["chair_1"], RED)
    edit.set_colour(other, ["chair_1"], BLUE)
    with pytest.raises(EditRefused, match=f"{other.name} has changed chair since"):
        session.undo(client)
    session.undo(other)
    session.undo(client)
    assert session.scene.object("chair_1").colour is None


def test_what_somebody_left_behind_is_anybodys(session: EditorSession, client: Client, other: Client) -> None:
    edit.set_colour(other, ["lamp_1"], BLUE)
    session.leave(other.viser_client)
    session.undo(client)
    assert session.scene.object("lamp_1").colour is None


def test_only_who_made_an_edit_is_offered_to_undo_it(session: EditorSession, client: Client, other: Client) -> None:
    told: dict[int, list[tuple[str, bool]]] = {client.id: [], other.id: []}
    for one in (client, other):
        one.toast = lambda message, undo, to=told[one.id]: to.append((message, undo))
    edit.set_colour(client, ["lamp_1"], BLUE)
    until(lambda: told[client.id] and told[other.id])  # the others' pages are drawn a moment later
    assert told[client.id][-1] == ("Paint lamp", True)
    assert told[other.id][-1] == (f"{client.name}: Paint lamp", False)
