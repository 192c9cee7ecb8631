"""A scene that was built again is shown with the photos that joined it anew."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_app.projects.begin import begin_project
from diorama_app.reconstruction.build_job import NewScene, build, show_built, start_build
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.artefacts import FurtherPhoto, Inputs, LabelledBox, Photo
from diorama_core.multiview import sphere_scene
from diorama_core.multiview.rebuilding import Rebuilt
from diorama_core.multiview.rooms import JoinedRoom, PosedInputs
from diorama_core.multiview.sphere_scene import SphereScene
from diorama_core.perception.inputs import ReadInputs
from diorama_core.pipeline.run import Built
from diorama_core.project import build as build_module
from diorama_core.project.storage import Project
from diorama_core.scene.types import Camera, Scene
from tests.app.small_room import photo_camera, plain_photo
from tests.built import built_scene
from tests.waiting import until


def turned(camera: Camera) -> Camera:
    T = camera.T_world_camera.copy()
    T[:3, 3] += (0.5, 0.0, 0.0)
    return Camera(camera.intrinsics, T)


def test_photos_have_their_new_cameras_and_those_that_do_not_join_are_named(
    session: EditorSession, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = photo_camera()
    joined = FurtherPhoto("one", Inputs(plain_photo()), own, (("table_1", (1.0, 2.0, 3.0, 4.0)),))
    lost, added = FurtherPhoto("two", Inputs(plain_photo()), own), FurtherPhoto("three", Inputs(plain_photo()))
    session.commit("photos", session.scene, further=(joined, lost, added), by=client)
    said: list[str] = []
    monkeypatch.setattr(session, "notice_all", lambda message, kind: said.append(message))
    scene = replace(session.scene, camera=turned(own))
    photos = (replace(joined, camera=turned(own)), replace(lost, camera=None))
    again = Rebuilt(scene, photos, {}, ("two",))
    assert session.project is not None
    made = NewScene(scene, {}, Inputs(plain_photo()), (), again=again)
    opened: list[str] = []
    client.open_tab = opened.append
    show_built(session, session.project, made, label="set the camera", inputs_before=session.inputs)
    assert opened == [], "who corrects the camera goes on correcting it"
    assert session.scene is scene
    assert session.further_photos == (*photos, added)
    assert any("to be added again: two." in line for line in said), said
    session.undo(client)
    assert session.further_photos == (joined, lost, added)


def test_without_other_photos_nothing_is_said_of_them(session: EditorSession, monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    monkeypatch.setattr(session, "notice_all", lambda message, kind: said.append(message))
    assert session.project is not None
    made = NewScene(replace(session.scene, camera=turned(photo_camera())), {}, Inputs(plain_photo()), ())
    show_built(session, session.project, made, label="build", inputs_before=session.inputs)
    assert not any("again" in line for line in said), said


@pytest.fixture
def built(session: EditorSession, monkeypatch: pytest.MonkeyPatch) -> Built:
    """A build of the open project that takes no time."""
    shown = replace(session.scene.architecture.planes[0], texture="grey")
    room = replace(session.scene.architecture, planes=(shown, *session.scene.architecture.planes[1:]))
    made = built_scene(replace(session.scene, architecture=room, camera=turned(photo_camera())))
    made = replace(made, textures={"grey": np.full((8, 8, 3), 99, np.uint8)}, notes=("a note",))

    def build(*given: object, **more: object) -> Built:
        return replace(made, inputs=replace(made.inputs, boxes=session_inputs.boxes))

    session_inputs = Inputs(plain_photo())
    monkeypatch.setattr(build_module, "build_with_usable_networks", build)
    return made


def test_a_build_is_shown_from_memory_and_its_scene_written_once(
    session: EditorSession, built: Built, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert session.project is not None
    read, written = list[str](), list[Scene]()
    save = Project.save_scene
    for name in ("load_inputs", "load_scene", "texture", "textures"):
        monkeypatch.setattr(Project, name, lambda project, *given, name=name: read.append(name))

    def saved(project: Project, scene: Scene) -> bool:
        written.append(scene)
        return save(project, scene)

    monkeypatch.setattr(Project, "save_scene", saved)
    start_build(session, Inputs(plain_photo()), "Building", "build the scene")
    until(lambda: session.scene is built.scene and session.jobs.status is None)
    session.autosave.flush()
    assert not read
    assert [scene for scene in written if scene is built.scene] == [built.scene]
    assert session.notes == ("a note",)
    assert session.textures["grey"] is built.textures["grey"]
    monkeypatch.undo()
    assert session.project.load_scene() == built.scene
    assert set(session.project.textures(built.scene)) == {"grey"}


def test_boxes_that_a_person_draws_while_a_scene_is_built_stay(session: EditorSession, built: Built) -> None:
    assert session.project is not None
    said = Inputs(plain_photo(), (LabelledBox((1.0, 1.0, 9.0, 9.0), "chair", "chair"),))
    made = NewScene(built.scene, built.textures, Inputs(plain_photo()), ())
    before = session.inputs
    session.commit("draw a box", session.scene, inputs=said)
    show_built(session, session.project, made, label="build", inputs_before=before)
    assert session.inputs is said
    session.autosave.flush()
    kept = session.project.load_inputs()
    assert kept is not None
    assert kept.boxes == said.boxes


def test_who_was_marking_sees_the_scene_after_a_build(session: EditorSession, client: Client) -> None:
    assert session.project is not None
    photo = plain_photo()
    client.view.canvas.open(photo.rgb, lambda event: None)
    opened: list[str] = []
    client.open_tab = opened.append
    made = NewScene(replace(session.scene, camera=turned(photo_camera())), {}, Inputs(photo), ())
    show_built(session, session.project, made, label="build the scene", inputs_before=session.inputs)
    assert opened == ["Scene"]
    assert not client.view.canvas.is_open


def test_a_360_degree_photo_that_was_marked_becomes_a_room_with_its_views(
    session: EditorSession, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a build makes of one is tested in `tests/app/projects/test_posed_build.py`."""
    photo = replace(plain_photo(256, 128), equirectangular=True)
    given = Inputs(photo, (LabelledBox((9.0, 9.0, 50.0, 90.0), "table", "table"),))
    views = tuple(PosedInputs(Inputs(plain_photo()), camera) for camera in (photo_camera(), turned(photo_camera())))
    scene = session.scene

    def build_sphere(photo: Photo, boxes: object, *rest: object) -> SphereScene:
        assert boxes == given.boxes
        room = JoinedRoom(scene, (), built_scene(scene), {}, None, ("a note",), ((), ()))
        return SphereScene(room, views, ("ahead.jpg", "behind.jpg"), np.eye(3), ())

    monkeypatch.setattr(sphere_scene, "build_sphere", build_sphere)
    session.open_project(begin_project(session.projects_dir, "all.png", ReadInputs(given, ()), b"as it came"))
    assert session.is_unbuilt
    before = session.scene
    session.commit("add", before, further=(FurtherPhoto("mine", Inputs(plain_photo()), photo_camera()),))
    build(session)
    until(lambda: session.jobs.status is None and bool(session.scene.objects))
    assert session.scene is scene
    assert session.notes == ("a note",)
    assert session.inputs is not None
    assert session.inputs.photo is views[0].inputs.photo
    assert session.inputs.intrinsics == views[0].camera.intrinsics
    sphere, behind, mine = session.further_photos
    assert sphere.inputs == given
    assert (behind.name, behind.camera) == ("behind", views[1].camera)
    assert sphere.is_placed
    assert mine.name == "mine"
    assert not mine.is_placed, "where it was taken in the new room is not known"
    session.undo(client)
    assert session.scene is before
    assert session.inputs.photo.equirectangular
