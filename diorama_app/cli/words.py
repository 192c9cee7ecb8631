"""`diorama text` and `diorama edit`: a scene from words, and changes in words to a project's scene."""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import diorama_core as diorama
from diorama_app.cli.arguments import PROFILES, RECIPES, command, print_note, progress_bar
from diorama_core.errors import InputError

if TYPE_CHECKING:
    from diorama_core.text.editing_by_words import ProposedEdits


def add_text(commands: Any) -> None:
    """Declare `diorama text`."""
    p = command(commands, "text", _text, 'diorama text "a reading corner with two armchairs" -o my-corner')
    p.add_argument("prompt", metavar="TEXT", help="description of the room and its furniture")
    p.add_argument("-o", "--output", type=Path, required=True, metavar="PROJECT", help="project folder to write")
    p.add_argument("--profile", choices=PROFILES, default="auto", help="which networks to use (default: %(default)s)")
    p.add_argument("--library", default="built-in", metavar="NAME", help="shape library (default: %(default)s)")
    p.add_argument("--recipe", choices=RECIPES, default=RECIPES[0], help="layout optimiser (default: %(default)s)")
    p.add_argument("--seed", type=int, default=0, help="random seed (default: %(default)s)")
    p.add_argument("--json", action="store_true", help="print the result as JSON")


def _text(a: argparse.Namespace) -> None:
    """Make a scene from a description."""

    from diorama_app.projects.report import build_report

    with progress_bar() as progress:
        room = diorama.build_from_text(
            a.prompt,
            seed=a.seed,
            profile=a.profile,
            recipe=a.recipe,
            library=a.library,
            output=a.output,
            progress=progress,
            warn=print_note,
        )
    report = build_report(room, ("scene.json",))
    if a.json:
        print(json.dumps(report))
        return
    print(f"{a.output}: {report['summary']}")
    if not room.scene.objects and room.built is not None:
        print("No furniture was found in the picture: run 'diorama models pull tiny', or draw boxes in the editor.")


def add_edit(commands: Any) -> None:
    """Declare `diorama edit`."""
    p = command(
        commands, "edit", _edit, 'diorama edit my-room "make all chairs wooden and put a rug under the table" --yes'
    )
    p.add_argument("project", type=Path, metavar="PROJECT")
    p.add_argument("command", metavar="TEXT", help="what to change, in plain English")
    p.add_argument("--yes", action="store_true", help="make the edits without asking")
    p.add_argument("--json", action="store_true", help="print the edits as JSON; makes them only with --yes")


def _edit(a: argparse.Namespace) -> None:
    """Change a project's scene by words; the edits are shown first."""

    from diorama_core.perception.language.client import LmmSettings
    from diorama_core.project.lock import ProjectLock
    from diorama_core.text.editing_by_words import propose_edits

    room = diorama.load(a.project)
    with ProjectLock(a.project, "diorama edit"):
        with progress_bar() as progress:
            proposed = propose_edits(
                a.command,
                room.scene,
                room.library,
                language_model=LmmSettings.from_environment(),
                progress=progress,
            )
        if not a.json:
            print("\n".join(f"- {line}" for line in proposed.lines))
            for note in proposed.notes:
                print_note(note)
        done = a.yes or (not a.json and _confirm())
        if done:
            replace(room, scene=proposed.scene).save(a.project)
    if a.json:
        print(json.dumps(_report(a.project, proposed, done)))
    else:
        print(f"{a.project}: done" if done else f"{a.project}: nothing was changed")


def _confirm() -> bool:
    if not sys.stdin.isatty():
        raise InputError("the edits were not made, because nobody can be asked here; add --yes to make them")
    return input("Make these edits? [y/N] ").strip().lower() in ("y", "yes")


def _report(project: Path, proposed: ProposedEdits, done: bool) -> dict[str, Any]:
    return {
        "project": str(project),
        "command": proposed.command,
        "translator": proposed.translator,
        "edits": [edit.model_dump() for edit in proposed.edits],
        "lines": list(proposed.lines),
        "notes": list(proposed.notes),
        "changed": list(proposed.changed),
        "objects": len(proposed.scene.objects),
        "done": done,
    }
