from __future__ import annotations

import argparse
import json
from pathlib import Path

import pytest

from diorama_app.cli.project import add_project
from diorama_core.project.storage import Project
from tests.app.small_room import furnished_scene, make_project
from tests.cli.running import refused, told
from tests.editing.test_homes import with_door


def test_projects_are_listed_copied_packed_and_unpacked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    home, away = tmp_path / "home", tmp_path / "away"
    make_project(home / "room")
    where = ["--projects", str(home)]

    def said(*command: str) -> str:
        return told(capsys, ["project", *command])

    assert "room-2" in said("copy", "room", *where)
    listed = json.loads(said("list", *where, "--json"))
    assert [Path(p["project"]).name for p in listed["projects"]] in (["room-2", "room"], ["room", "room-2"])
    assert "2 in" in said("list", *where)
    file = tmp_path / "sent.diorama"
    assert "MB" in said("zip", "room", *where, "-o", str(file))
    made = json.loads(said("unzip", str(file), "--projects", str(away), "--json"))
    assert Path(made["path"]) == away / "sent"
    assert (away / "sent" / "scene.json").read_bytes() == (home / "room" / "scene.json").read_bytes()


@pytest.mark.parametrize("command", [["copy", "nowhere"], ["zip", "nowhere"], ["unzip", "nowhere.diorama"]])
def test_what_is_not_there_is_one_line(command: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "nowhere" in refused(capsys, ["project", *command, "--projects", str(tmp_path)])


def test_a_room_joins_a_home_at_their_door(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, wall in (("hall", "wall_3"), ("study", "wall_2")):
        project = make_project(tmp_path / name)
        project.save_scene(with_door(furnished_scene(), "door_9", wall, 0.2))
    join = ["project", "join", "hall", "study", "--projects", str(tmp_path)]
    assert "a home of 2 rooms" in told(capsys, [*join, "--door", "door_9", "--to", "door_9"])
    made = Project.open(tmp_path / "hall").load_scene()
    assert len(made.rooms) == 2
    assert len(Project.open(tmp_path / "study").load_scene().rooms) == 0
    rooms = ["project", "rooms", "hall", "--projects", str(tmp_path)]
    said = told(capsys, rooms)
    assert "hall, storey 0: 17.6 m2, " in said
    assert "35.2 m2 in 2 rooms" in said
    assert [r["name"] for r in json.loads(told(capsys, [*rooms, "--json"]))["rooms"]] == ["hall", "study"]
    assert "choose one of: door_9" in refused(capsys, [*join, "--door", "door_1", "--to", "door_9"])
    Project.open(tmp_path / "study").update_info(library="mine")
    assert "uses the library mine" in refused(capsys, [*join, "--door", "door_9", "--to", "door_9"])


def test_an_action_is_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    parser = argparse.ArgumentParser()
    add_project(parser.add_subparsers())
    with pytest.raises(SystemExit, match="2"):
        parser.parse_args(["project"])
    assert "list|copy|join|rooms|zip|unzip" in capsys.readouterr().err


def test_a_project_is_found_by_its_own_name_where_one_alone_has_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for folder, name in (("a", "My room"), ("b", "Attic"), ("c", "Attic")):
        make_project(tmp_path / folder).update_info(name=name)
    assert "a copy of a" in told(capsys, ["project", "copy", "My room", "--projects", str(tmp_path)])
    assert "2 projects are called Attic; give a folder:" in refused(
        capsys, ["project", "copy", "Attic", "--projects", str(tmp_path)]
    )
