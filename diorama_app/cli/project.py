"""Commands about projects: `diorama project ...`."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

from diorama_app.cli.arguments import PROJECTS_HELP, command, projects_folder
from diorama_core.errors import InputError


def add_project(commands: Any) -> None:
    """Declare `diorama project`."""
    p: argparse.ArgumentParser = commands.add_parser("project", help="List, copy, pack and unpack projects.")
    actions = p.add_subparsers(dest="action", required=True, metavar="list|copy|zip|unzip")
    lists = command(actions, "list", _list, "List the projects, last changed first.", "diorama project list")
    copy = command(actions, "copy", _copy, "Copy a project beside it.", "diorama project copy my-room")
    pack = command(
        actions, "zip", _zip, "Pack a project into one file, to send.", "diorama project zip my-room -o room.diorama"
    )
    unpack = command(actions, "unzip", _unzip, "Make a project of a packed one.", "diorama project unzip room.diorama")
    for one in (copy, pack):
        one.add_argument("project", type=Path, metavar="PROJECT", help="its folder, or its name among the projects")
    pack.add_argument("-o", "--output", type=Path, metavar="FILE", help="file to write (default: PROJECT.diorama)")
    unpack.add_argument("file", type=Path, metavar="FILE")
    unpack.add_argument("-o", "--output", type=Path, metavar="PROJECT", help="folder to write (default: among them)")
    for one in (lists, copy, pack, unpack):
        one.add_argument("--projects", type=Path, metavar="DIR", help=PROJECTS_HELP)
        one.add_argument("--json", action="store_true", help="print the result as JSON")


def _list(a: argparse.Namespace) -> None:
    from diorama_app.projects.manage import name_of, recent_projects, touched

    folder = projects_folder(a.projects)
    rows = [
        {
            "project": str(f),
            "name": name_of(f),
            "changed": time.strftime("%Y-%m-%dT%H:%M:%S", time.localtime(touched(f))),
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
    from diorama_app.projects.manage import duplicate_project

    folder = _folder(a)
    _say(a, duplicate_project(folder, folder.parent).folder, f"a copy of {folder.name}")


def _zip(a: argparse.Namespace) -> None:
    from diorama_app.projects.packing import SUFFIX, pack_project
    from diorama_core.project.storage import Project

    folder = _folder(a)
    target = a.output or Path(f"{folder.name}{SUFFIX}")
    pack_project(Project.open(folder), target)
    _say(a, target, f"{target.stat().st_size / 1e6:.1f} MB; drop it on the page, or 'diorama project unzip'")


def _unzip(a: argparse.Namespace) -> None:
    from diorama_app.projects.packing import unpack_project

    if not a.file.is_file():
        raise InputError(f"there is no file {a.file}; give a .diorama file")
    made = unpack_project(a.file, projects_folder(a.projects), folder=a.output)
    _say(a, made.folder, f"the project “{made.name}”")


def _folder(a: argparse.Namespace) -> Path:
    """The folder of a project that is given by its folder, by that folder's name or by the project's own."""
    from diorama_app.projects.manage import find_project, name_of, recent_projects

    if a.project.is_dir():
        return Path(a.project).resolve()
    folder, given = projects_folder(a.projects), str(a.project)
    found = find_project(folder, given)
    named = [found] if found is not None else [f for f in recent_projects(folder) if name_of(f) == given]
    if not named:
        raise InputError(f"there is no project {given}; 'diorama project list' names those that there are")
    if len(named) > 1:
        raise InputError(f"{len(named)} projects are called {given}; give a folder: {', '.join(f.name for f in named)}")
    return named[0]


def _say(a: argparse.Namespace, path: Path, about: str) -> None:
    print(json.dumps({"path": str(path), "about": about}) if a.json else f"{path}: {about}")
