"""Every document of a project: what a program writes it can read, whatever text and numbers are in it."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_app.projects.begin import begin_project
from diorama_app.projects.manage import duplicate_project, name_of, recent_projects, rename_project
from diorama_app.session.recovery import Recovery
from diorama_core.artefacts import FurtherPhoto
from diorama_core.errors import DioramaError
from diorama_core.perception.inputs import ReadInputs
from diorama_core.project.further_photos import load_photos, note_placed, save_photos, still_placed
from diorama_core.project.lock import ProjectLock, owner
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene
from tests.io.test_text import ANY_TEXT
from tests.pipeline.test_codec import example_inputs
from tests.scene.test_edits import _stack

NUMBERS = st.floats() | st.integers()
HALF = "caf\udce9"
"""As a file's name in Latin-1 is decoded."""


def _labelled(text: str) -> Scene:
    scene = _stack()
    return replace(scene, objects=(replace(scene.objects[0], label=text), *scene.objects[1:]))


def _info(project: Project, text: str, number: float) -> None:
    project.update_info(notes=[text], stages=[{"stage": text, "seconds": number}], warnings=[text])


def _inputs(project: Project, text: str, number: float) -> None:
    inputs = example_inputs()
    boxes = (replace(inputs.boxes[0], category=text, label=text, score=float(number)),)
    project.save_inputs(replace(inputs, photo=replace(inputs.photo, name=text), boxes=boxes))


def _photos(project: Project, text: str, number: float) -> None:
    inputs = example_inputs()
    seen = ((text, (0.0, 1.0, 2.0, float(number))),)
    save_photos(project, [FurtherPhoto("other", replace(inputs, photo=replace(inputs.photo, name=text)), None, seen)])


WRITERS: dict[str, Callable[[Project, str, float], object]] = {
    "name": lambda project, text, number: rename_project(project, text),
    "info": _info,
    "scene": lambda project, text, number: project.save_scene(_labelled(text)),
    "metrics": lambda project, text, number: project.save_scene(replace(_stack(), metrics={text: float(number)})),
    "inputs": _inputs,
    "further photos": _photos,
    "placed": lambda project, text, number: note_placed(project, _labelled(text)),
    "owner": lambda project, text, number: ProjectLock(project.folder, text).release(),
    "unsaved": lambda project, text, number: Recovery(project.folder / "unsaved").note(project, _labelled(text)),
}


def _read_all(folder: Path) -> None:
    """Everything that a program reads of a project; raises where anything is damaged."""
    project = Project.open(folder)
    assert project.name.encode()
    project.load_scene()
    project.load_inputs()
    assert load_photos(project)[1] == ()
    still_placed(project, project.load_scene())
    owner(folder).encode()
    for unsaved in Recovery(folder / "unsaved")._others(project):
        unsaved.scene()


@contextmanager
def _project() -> Iterator[Project]:
    with tempfile.TemporaryDirectory() as place:
        project = Project.create(Path(place) / "room")
        project.save_inputs(example_inputs())
        project.save_scene(_stack())
        yield project


@pytest.mark.parametrize("writer", WRITERS)
@given(text=ANY_TEXT, number=NUMBERS)
@settings(max_examples=12)
def test_what_is_written_is_read_again_or_refused(writer: str, text: str, number: float) -> None:
    with _project() as project:
        with suppress(DioramaError, OverflowError):
            WRITERS[writer](project, text, number)
        _read_all(project.folder)


@pytest.mark.parametrize("writer", WRITERS)
def test_half_characters_are_read_again_or_refused(writer: str) -> None:
    with _project() as project:
        with suppress(DioramaError):
            WRITERS[writer](project, HALF, 1.0)
        _read_all(project.folder)


@pytest.mark.parametrize("name", ["\U0003134b", "\u200b", "\x1b"])
def test_a_name_of_nothing_that_can_be_seen_is_none(name: str) -> None:
    with _project() as project:
        project.update_info(name=name)
        assert project.name
        with suppress(DioramaError):
            rename_project(project, name)
        assert project.name


def test_a_project_of_a_photo_whose_name_is_no_utf8(tmp_path: Path) -> None:
    """Built from such a photo, a project was written that nobody could open any more."""
    read = ReadInputs(replace(example_inputs(), photo=replace(example_inputs().photo, name=f"{HALF}.jpg")), (HALF,))
    project = begin_project(tmp_path, f"{HALF}.jpg", read, b"photo")
    assert Project.open(project.folder).name == "caf\ufffd"
    _ = project.load_inputs()


def test_a_folder_whose_name_is_no_utf8_is_listed_renamed_and_copied(tmp_path: Path) -> None:
    folder = Path(os.fsdecode(os.fsencode(tmp_path) + b"/b\xe9te"))
    Project.create(folder).save_scene(_stack())
    (Project(folder).folder / "project.json").write_text('{"format": "diorama-project", "version": 1}')
    assert name_of(folder) == "b\\xe9te"
    copy = duplicate_project(folder, tmp_path)
    assert copy.name == "b\\xe9te 2"
    rename_project(copy, "half \ud800 a name")
    assert Project.open(copy.folder).name == "half \ufffd a name"
    assert len(recent_projects(tmp_path)) == 2
