"""`diorama text`: a scene from words."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import diorama_core as diorama
from diorama_app.cli.arguments import PROFILES, RECIPES, command, print_note, progress_bar


def add_text(commands: Any) -> None:
    """Declare `diorama text`."""
    p = command(
        commands,
        "text",
        _text,
        "Make a scene from a description.",
        'diorama text "a reading corner with two armchairs" -o my-corner',
    )
    p.add_argument("prompt", metavar="TEXT", help="description of the room and its furniture")
    p.add_argument("-o", "--output", type=Path, required=True, metavar="PROJECT", help="project folder to write")
    p.add_argument("--profile", choices=PROFILES, default="auto", help="which networks to use (default: %(default)s)")
    p.add_argument("--library", default="built-in", metavar="NAME", help="shape library (default: %(default)s)")
    p.add_argument("--recipe", choices=RECIPES, default=RECIPES[0], help="layout optimiser (default: %(default)s)")
    p.add_argument("--seed", type=int, default=0, help="random seed (default: %(default)s)")
    p.add_argument("--json", action="store_true", help="print the result as JSON")


def _text(a: argparse.Namespace) -> None:
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
