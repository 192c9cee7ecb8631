"""What is read of a project before it is shown: the scene, the photo, textures, notes, and what is damaged."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from diorama_app.session.shared_document import Textures
from diorama_core.artefacts import FurtherPhoto, Inputs, Reason
from diorama_core.errors import ProjectError
from diorama_core.io.bounded import shorten
from diorama_core.project.further_photos import load_photos
from diorama_core.project.reasons import load_reasons
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene

MAX_NOTES, MAX_NOTE_LENGTH = 50, 300


@dataclass(frozen=True, eq=False)
class ProjectContents:
    """A project as it is on disk."""

    scene: Scene
    """The newest version that can be read; empty where nothing was built yet."""
    inputs: Inputs | None
    """What is known of the photo; None without one."""
    further_photos: tuple[FurtherPhoto, ...]
    """Other photos of the same room."""
    textures: Textures
    notes: tuple[str, ...]
    """What the build said about how the scene was made."""
    reasons: tuple[Reason, ...]
    """Why its objects are where and what the build made them."""
    damage: tuple[str, ...]
    """One line for everything that could not be read."""


def read_project(project: Project) -> ProjectContents:
    """Read a project; parts that are damaged are left out and named.

    Raises:
        ProjectError, SceneError: no version of the scene can be read.
    """
    inputs, photo_damage = _inputs(project)
    unfinished = inputs is not None and not project.has_scene
    scene, scene_damage = (Scene(), "") if unfinished else project.newest_scene()
    further, further_damage = load_photos(project)
    reasons, reasons_damage = load_reasons(project)
    damage = tuple(line for line in (scene_damage, photo_damage, *further_damage, reasons_damage) if line)
    return ProjectContents(scene, inputs, further, project.textures(scene), build_notes(project), reasons, damage)


def build_notes(project: Project) -> tuple[str, ...]:
    """What the project's build had to say, each line once and of bounded length."""
    notes = project.info().get("notes", [])
    return limit_notes(notes if isinstance(notes, list) else [])


def limit_notes(notes: Sequence[object]) -> tuple[str, ...]:
    """Notes as they are shown: each line once and of bounded length, and not too many."""
    return tuple(dict.fromkeys(shorten(str(note), MAX_NOTE_LENGTH) for note in notes[:MAX_NOTES]))


def _inputs(project: Project) -> tuple[Inputs | None, str]:
    try:
        return project.load_inputs(), ""
    except ProjectError as error:
        return None, str(error)
