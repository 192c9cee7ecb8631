"""A folder of rooms becomes a home by the doors that its file names."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_app.projects.folder_home import SharedDoor, homes_of, join_rooms, read_doors
from diorama_core.errors import EditRefused, InputError
from diorama_core.project.storage import Project
from diorama_core.scene.types import PhotoMaterial
from tests.app.small_room import furnished_scene, make_project
from tests.editing.test_homes import with_door


@pytest.fixture
def rooms(tmp_path: Path) -> dict[str, Path]:
    """A hall with two doors, and two rooms with one each."""
    hall = with_door(with_door(furnished_scene(), "door_1", "wall_3", 0.2), "door_2", "wall_2", 0.2)
    scenes = {
        "hall": hall,
        "study": with_door(furnished_scene(), "door_1", "wall_1", 0.2),
        "bath": with_door(furnished_scene(), "door_1", "wall_3", 0.2),
    }
    door = scenes["study"].object("door_1")
    painted = replace(
        door, label="front door", photo_materials=(PhotoMaterial("panel", (0.5, 0.5, 0.5), texture="paint"),)
    )
    others = [o for o in scenes["study"].objects if o is not door]
    scenes["study"] = replace(scenes["study"], objects=(*others, painted))
    for name, scene in scenes.items():
        project = make_project(tmp_path / name)
        project.save_textures({"paint": np.zeros((4, 4, 3), np.uint8)})
        project.save_scene(scene)
    return {name: tmp_path / name for name in scenes}


def test_rooms_join_in_whatever_order_their_doors_are_named(rooms: dict[str, Path], tmp_path: Path) -> None:
    (tmp_path / "home.json").write_text(
        json.dumps({"doors": [{"hall": "door_1", "study": "front door"}, {"bath": "door_1", "hall": "door_2"}]})
    )
    home = join_rooms(rooms, read_doors(tmp_path), tmp_path / "home")
    scene = home.load_scene()
    assert [r.name for r in scene.rooms] == ["hall", "study", "bath"]
    assert sorted(o.id for o in scene.objects if o.category == "door") == ["door_1", "door_2"]
    assert len(home.textures(scene)) == len({p.texture for p in scene.architecture.planes if p.texture})
    assert home.load_inputs() is not None
    before = Project.open(rooms["hall"]).load_scene()
    again = join_rooms(rooms, read_doors(tmp_path)[:1], tmp_path / "home")
    assert len(again.load_scene().rooms) == 2
    assert Project.open(rooms["hall"]).load_scene() == before, "the rooms stay as they are"


@pytest.mark.parametrize(
    ("doors", "error", "line"),
    [
        ([("hall", "cellar", "door_1", "door_1")], InputError, "there is no room cellar"),
        ([("hall", "study", "door_7", "door_1")], EditRefused, "hall and study: there is no door 'door_7'"),
        ([("hall", "study", "door_1", "door_1"), ("bath", "attic", "door_1", "door_1")], InputError, "attic"),
    ],
)
def test_what_does_not_join_is_one_line(
    rooms: dict[str, Path], tmp_path: Path, doors: list[tuple[str, str, str, str]], error: type[Exception], line: str
) -> None:
    with pytest.raises(error, match=line):
        join_rooms(rooms, [SharedDoor((a, b), (x, y)) for a, b, x, y in doors], tmp_path / "home")


def test_a_room_that_no_door_leads_to_is_named(rooms: dict[str, Path], tmp_path: Path) -> None:
    make_project(tmp_path / "attic")
    doors = [SharedDoor(("hall", "study"), ("door_1", "door_1")), SharedDoor(("bath", "attic"), ("door_1", "door_1"))]
    with pytest.raises(InputError, match="no door leads from hall to attic, bath"):
        join_rooms({**rooms, "attic": tmp_path / "attic"}, doors, tmp_path / "home")


@pytest.mark.parametrize("content", ["[]", "{}", '{"doors": []}', '{"doors": [{"hall": "door_1"}]}', "{"])
def test_a_file_that_says_something_else_is_one_line(tmp_path: Path, content: str) -> None:
    (tmp_path / "home.json").write_text(content)
    with pytest.raises(InputError, match=r"home\.json"):
        read_doors(tmp_path)


def test_a_folder_of_folders_is_a_home_each(tmp_path: Path) -> None:
    for name in ("b", "a"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "room.jpg").write_bytes(b"")
    (tmp_path / "empty").mkdir()
    assert homes_of(tmp_path) == (tmp_path / "a", tmp_path / "b")
    assert homes_of(tmp_path / "a") == (tmp_path / "a",)
    assert homes_of(tmp_path / "empty") == (tmp_path / "empty",)
