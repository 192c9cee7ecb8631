"""A folder of photos is a home where it holds `home.json`, which says at which doors its rooms meet:

    {"doors": [{"hall": "door_1", "kitchen": "door_2"}, {"hall": "door_3", "bath": "door_1"}]}

Rooms are called by their photos' names without ending, doors by the ids or labels that they have in the rooms' scenes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from diorama_app.projects.folder_photos import PHOTOS
from diorama_core.editing.homes import join_project
from diorama_core.errors import EditRefused, InputError
from diorama_core.geometry.openings import DOOR
from diorama_core.io.bounded import read_json
from diorama_core.project.lock import ProjectLock
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene

FILE = "home.json"
FOLDER = "home"
"""Name of the home's project beside those of its rooms."""
MAX_BYTES = 1_000_000


@dataclass(frozen=True)
class SharedDoor:
    """A door that two rooms have: its id in each."""

    rooms: tuple[str, str]
    ids: tuple[str, str]

    @property
    def reverse(self) -> SharedDoor:
        """This door, named from the other room."""
        return SharedDoor(self.rooms[::-1], self.ids[::-1])


def homes_of(folder: Path) -> tuple[Path, ...]:
    """The folders in a folder that hold photos where it holds none itself: a home each; else the folder."""
    if any(p.suffix.lower() in PHOTOS for p in folder.iterdir()):
        return (folder,)
    inside = sorted(p for p in folder.iterdir() if p.is_dir() and any(f.suffix.lower() in PHOTOS for f in p.iterdir()))
    return tuple(inside) or (folder,)


def read_doors(folder: Path) -> tuple[SharedDoor, ...]:
    """The doors that a folder's `home.json` names; none where there is no such file.

    Raises:
        InputError: the file says something else.
    """
    path = folder / FILE
    if not path.exists():
        return ()
    document = read_json(path, InputError, most=MAX_BYTES, advice="write it again")
    rows = document.get("doors") if isinstance(document, dict) else None
    if not isinstance(rows, list) or not rows or not all(map(_is_door, rows)):
        raise InputError(f'{path}: write {{"doors": [{{"ROOM": "door_1", "OTHER ROOM": "door_2"}}]}}')
    return tuple(SharedDoor(tuple(row), tuple(row.values())) for row in rows)


def _is_door(row: Any) -> bool:
    return isinstance(row, dict) and len(row) == 2 and all(isinstance(v, str) for v in row.values())


def join_rooms(rooms: Mapping[str, Path], doors: Sequence[SharedDoor], output: Path) -> Project:
    """The project of a home: the room of the first door, and all others beside it, door by door.

    A home that is there already gets the new scene; its earlier one is among its backups.

    Raises:
        InputError: a door is of a room that is not there, or rooms are left that no door leads to.
        EditRefused: a room has no such door, or rooms would be in one another's place.
        ProjectError: a project cannot be read or written.
    """
    unknown = sorted({name for door in doors for name in door.rooms} - set(rooms))
    if unknown:
        raise InputError(f"{FILE}: there is no room {', '.join(unknown)}; the rooms are {', '.join(sorted(rooms))}")
    first = doors[0].rooms[0]
    project = _begin(Project.open(rooms[first]), output)
    ids: dict[str, Mapping[str, str]] = {first: {}}
    with ProjectLock(project.folder, "diorama build"):
        scene, left = Project.open(rooms[first]).load_scene(), list(doors)
        while left:
            ways = [d if d.rooms[0] in ids else d.reverse for d in left]
            way = next((d for d in ways if d.rooms[0] in ids and d.rooms[1] not in ids), None)
            if way is None:
                break
            (here, there), (door, other_door) = way.rooms, way.ids
            try:
                other = Project.open(rooms[there])
                door = _door(Project.open(rooms[here]).load_scene(), door)
                other_door = _door(other.load_scene(), other_door)
                made, pictures = join_project(project, scene, other, ids[here].get(door, door), other_door, name=first)
            except EditRefused as error:
                raise EditRefused(f"{here} and {there}: {error}") from error
            project.save_textures(pictures)
            scene, ids[there] = made.scene, made.ids
            left = [d for d in left if d not in (way, way.reverse)]
        alone = sorted({name for door in left for name in door.rooms} - set(ids))
        if alone:
            raise InputError(f"{FILE}: no door leads from {first} to {', '.join(alone)}; name one that does")
        project.save_scene(scene)
    return project


def _door(scene: Scene, word: str) -> str:
    """Id of the door that is meant: by its id, or by its label where one door alone has it."""
    labelled = [o.id for o in scene.objects if o.category == DOOR and o.label == word]
    return labelled[0] if len(labelled) == 1 and not scene.has_object(word) else word


def _begin(first: Project, output: Path) -> Project:
    """The home's project with the photo and the pictures of its first room."""
    project = Project.create(output)
    inputs = first.load_inputs()
    if inputs is not None:
        project.save_inputs(inputs)
    project.save_textures(dict(first.textures(first.load_scene())))
    project.update_info(library=first.shared_library_name)
    if first.shapes_folder.is_dir():
        project.take_shapes(first)
    return project
