"""Commands about projects: `diorama project ...`."""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

from diorama_app.cli.arguments import PROJECTS_HELP, command, projects_folder
from diorama_core.errors import InputError
from diorama_core.io.text import number_of


def add_project(commands: Any) -> None:
    """Declare `diorama project`."""
    p: argparse.ArgumentParser = commands.add_parser("project", help="List, copy, join, measure and pack projects.")
    actions = p.add_subparsers(dest="action", required=True, metavar="list|copy|join|rooms|zip|unzip")
    lists = command(actions, "list", _list, "diorama project list")
    copy = command(actions, "copy", _copy, "diorama project copy my-room")
    pack = command(actions, "zip", _zip, "diorama project zip my-room -o room.diorama")
    unpack = command(actions, "unzip", _unzip, "diorama project unzip room.diorama")
    join = command(actions, "join", _join, "diorama project join my-home my-kitchen --door door_1 --to door_2")
    rooms = command(actions, "rooms", _rooms, "diorama project rooms my-home")
    for one in (copy, join, rooms, pack):
        one.add_argument("project", type=Path, metavar="PROJECT", help="its folder, or its name among the projects")
    join.add_argument("--door", required=True, metavar="ID", help="the door in PROJECT")
    join.add_argument("other", type=Path, metavar="ROOM", help="the project that is added; it stays as it is")
    join.add_argument("--to", required=True, metavar="ID", help="the same door in ROOM")
    join.add_argument("--wall", type=float, default=0.12, metavar="METRES", help="between them (default: %(default)s)")
    pack.add_argument("-o", "--output", type=Path, metavar="FILE", help="file to write (default: PROJECT.diorama)")
    unpack.add_argument("file", type=Path, metavar="FILE")
    unpack.add_argument("-o", "--output", type=Path, metavar="PROJECT", help="folder to write (default: among them)")
    for one in (lists, copy, join, rooms, pack, unpack):
        one.add_argument("--projects", type=Path, metavar="DIR", help=PROJECTS_HELP)
        one.add_argument("--json", action="store_true", help="print the result as JSON")


def _list(a: argparse.Namespace) -> None:
    """List the projects, last changed first."""

    from diorama_app.projects.manage import mtime, name_of, recent_projects

    folder = projects_folder(a.projects)
    rows = [
        {
            "project": str(f),
            "name": name_of(f),
            "changed": time.strftime("%Y-%m-%dT%H:%M:%S", time.localtime(mtime(f))),
        }
        for f in recent_projects(folder)
    ]
    if a.json:
        print(json.dumps({"folder": str(folder), "projects": rows}))
        return
    for row in rows:
        print(f"{row['changed'].replace('T', ' ')}  {Path(row['project']).name}  {row['name']}")
    print(f"{len(rows)} in {folder}")


def _copy(a: argparse.Namespace) -> None:
    """Copy a project beside it."""

    from diorama_app.projects.manage import duplicate_project

    folder = _folder(a, a.project)
    _say(a, duplicate_project(folder, folder.parent).folder, f"a copy of {folder.name}")


def _join(a: argparse.Namespace) -> None:
    """Add another project's room to a home, at a door that both have."""

    from diorama_core.editing.homes import join_project
    from diorama_core.project.lock import ProjectLock
    from diorama_core.project.storage import Project

    folder, room = _folder(a, a.project), _folder(a, a.other)
    with ProjectLock(folder, "diorama project join"):
        project, other = Project.open(folder), Project.open(room)
        made, textures = join_project(project, project.load_scene(), other, a.door, a.to, wall_m=a.wall)
        project.save_textures(textures)
        project.save_scene(made.scene)
    _say(a, folder, f"a home of {number_of(len(made.scene.rooms), 'room')}")


def _rooms(a: argparse.Namespace) -> None:
    """Say how large rooms are, where a wheelchair turns and how wide the ways between doors are."""

    from diorama_core.editing.reach import TURNING_M, uses_of
    from diorama_core.project.storage import Project

    project = Project.open(_folder(a, a.project))
    uses = uses_of(project.load_scene())
    if a.json:
        rows = [{**asdict(u.room), **{k: v for k, v in asdict(u).items() if k != "room"}} for u in uses]
        print(json.dumps({"path": str(project.folder), "rooms": rows}))
        return
    for use in uses:
        turns = f"a circle of {TURNING_M} m" if use.turning_at else f"no circle of {TURNING_M} m"
        ways = "" if use.way_m is None else f"; ways of {use.way_m} m" if use.way_m else "; no way between its doors"
        stuck = f"; does not open: {', '.join(use.stuck)}" if use.stuck else ""
        print(f"{use.room.name}, storey {use.room.storey}: {use.area_m2:.1f} m2, {turns}{ways}{stuck}")
    print(f"{project.folder}: {sum(u.area_m2 for u in uses):.1f} m2 in {number_of(len(uses), 'room')}")


def _zip(a: argparse.Namespace) -> None:
    """Pack a project into one file, to send."""

    from diorama_app.projects.packing import SUFFIX, pack_project
    from diorama_core.project.storage import Project

    folder = _folder(a, a.project)
    target = a.output or Path(f"{folder.name}{SUFFIX}")
    pack_project(Project.open(folder), target)
    _say(a, target, f"{target.stat().st_size / 1e6:.1f} MB; drop it on the page, or 'diorama project unzip'")


def _unzip(a: argparse.Namespace) -> None:
    """Make a project of a packed one."""

    from diorama_app.projects.packing import unpack_project

    if not a.file.is_file():
        raise InputError(f"there is no file {a.file}; give a .diorama file")
    made = unpack_project(a.file, projects_folder(a.projects), folder=a.output)
    _say(a, made.folder, f"the project “{made.name}”")


def _folder(a: argparse.Namespace, project: Path) -> Path:
    """The folder of a project that is given by its folder, by that folder's name or by the project's own."""
    from diorama_app.projects.manage import find_project, name_of, recent_projects

    if project.is_dir():
        return project.resolve()
    folder, given = projects_folder(a.projects), str(project)
    match = find_project(folder, given)
    named = [match] if match is not None else [f for f in recent_projects(folder) if name_of(f) == given]
    if not named:
        raise InputError(f"there is no project {given}; 'diorama project list' names those that there are")
    if len(named) > 1:
        raise InputError(f"{len(named)} projects are called {given}; give a folder: {', '.join(f.name for f in named)}")
    return named[0]


def _say(a: argparse.Namespace, path: Path, about: str) -> None:
    print(json.dumps({"path": str(path), "about": about}) if a.json else f"{path}: {about}")
