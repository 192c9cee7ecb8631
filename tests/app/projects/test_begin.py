from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import diorama_app
from diorama_app.projects import manage
from diorama_app.projects.begin import begin_project, begin_with_scene, fresh_folder
from diorama_app.reconstruction import opening_job
from diorama_app.reconstruction.text_to_scene import describe_room
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.artefacts import Inputs
from diorama_core.errors import DioramaError, ProjectError
from diorama_core.importing.opening import Opened
from diorama_core.perception.inputs import ReadInputs
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene
from diorama_core.text import scene_from_text
from tests.app.small_room import PlainLibrary, furnished_scene, plain_photo


def test_a_photo_is_a_listed_project_without_a_scene(tmp_path: Path) -> None:
    read = ReadInputs(Inputs(plain_photo()), ("it is dark",))
    made = begin_project(tmp_path, "my room.JPG", read, b"as it came")
    assert made.folder.name == "my-room"
    assert made.name == "my room"
    again = Project.open(made.folder)
    assert not again.has_scene
    assert again.has_photo
    assert again.uploads() == {"photo": b"as it came"}
    assert again.info()["warnings"] == ["it is dark"]
    assert manage.recent_projects(tmp_path) == [made.folder]
    assert begin_project(tmp_path, "my room.JPG", read, b"x").folder.name == "my-room-2"
    copy = manage.duplicate_project(made.folder, tmp_path)
    assert not copy.has_scene


def test_nothing_is_left_behind_where_it_cannot_be_saved(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*given: object) -> None:
        raise ProjectError("no space left")

    monkeypatch.setattr(Project, "save_inputs", full)
    with pytest.raises(ProjectError):
        begin_project(tmp_path, "room.jpg", ReadInputs(Inputs(plain_photo())), b"x")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("name", "folder"), [("../../etc/x.png", "x"), ("Zimmer Ä.jpg", "Zimmer"), ("...", "room")])
def test_folders_have_plain_names(tmp_path: Path, name: str, folder: str) -> None:
    assert fresh_folder(tmp_path, name) == tmp_path / folder


def _sized(scene: Scene, size: tuple[float, float, float]) -> Scene:
    return replace(scene, objects=(replace(scene.objects[0], shape_size_m=size), *scene.objects[1:]))


def _of_shape(scene: Scene, shape_id: str) -> Scene:
    return replace(scene, objects=(replace(scene.objects[0], shape_id=shape_id), *scene.objects[1:]))


UNOPENABLE = {"flat": _sized(furnished_scene(), (0.0, 1.0, 1.0)), "unknown": _of_shape(furnished_scene(), "no_such")}


@pytest.mark.unchecked
@pytest.mark.parametrize("scene", UNOPENABLE.values(), ids=UNOPENABLE)
def test_a_scene_that_would_not_open_is_no_project(tmp_path: Path, scene: Scene) -> None:
    with pytest.raises(DioramaError):
        begin_with_scene(tmp_path, "Room", scene, {}, (), PlainLibrary())
    assert list(tmp_path.iterdir()) == []


@pytest.mark.unchecked
@pytest.mark.parametrize("scene", UNOPENABLE.values(), ids=UNOPENABLE)
def test_described_and_opened_scenes_that_would_not_open_are_no_projects(
    session: EditorSession, client: Client, scene: Scene, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("DIORAMA_IMAGE_BASE_URL", raising=False)
    monkeypatch.setattr(
        scene_from_text, "scene_from_text", lambda said, library, **_: scene_from_text.SceneFromText(scene, {}, ("",))
    )
    monkeypatch.setattr(opening_job, "read_apart", lambda *_, **__: Opened(scene))
    before = sorted(session.projects_dir.iterdir())
    for begin in (lambda: describe_room(client, "a room"), lambda: opening_job.open_file(client, "room.glb", b"")):
        begin()
        assert session.jobs.wait(20.0)
        assert sorted(session.projects_dir.iterdir()) == before


def test_every_project_of_the_editor_is_begun_in_one_place() -> None:
    """Elsewhere nobody looks whether it opens again; the command line has its own folders."""
    app = Path(diorama_app.__file__).parent
    makers = {p.relative_to(app).as_posix() for p in app.rglob("*.py") if "Project.create(" in p.read_text()}
    assert makers == {"projects/begin.py", "projects/folder_home.py", "projects/posed_build.py", "cli/importing.py"}
