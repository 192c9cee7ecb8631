"""`diorama text`: a scene from words."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from diorama_app.cli.arguments import PROFILES, RECIPES, command, progress_bar


def add_text(commands: Any) -> None:
    """Declare `diorama text`."""
    p = command(
        commands,
        "text",
        _text,
        "Make a scene from a description.",
        'diorama text "a reading corner with two armchairs" -o my-corner',
    )
    p.add_argument("prompt", metavar="TEXT", help="what the room is and what is in it")
    p.add_argument("-o", "--output", type=Path, required=True, metavar="PROJECT", help="project folder to write")
    p.add_argument("--profile", choices=PROFILES, default="auto", help="which networks to use (default: %(default)s)")
    p.add_argument("--library", default="built-in", metavar="NAME", help="shape library (default: %(default)s)")
    p.add_argument("--recipe", choices=RECIPES, default=RECIPES[0], help="layout optimiser (default: %(default)s)")
    p.add_argument("--seed", type=int, default=0, help="another number, another room (default: %(default)s)")
    p.add_argument("--json", action="store_true", help="print the result as JSON")


def _text(a: argparse.Namespace) -> None:
    from diorama_app.projects.report import build_report, library_named
    from diorama_core.pipeline.presets import stages_for
    from diorama_core.project.build import build_project
    from diorama_core.project.storage import Project
    from diorama_core.text.pictures import ImageSettings, picture_of

    library = library_named(a.library)
    with progress_bar() as progress:
        made = picture_of(
            a.prompt,
            library,
            seed=a.seed,
            endpoint=ImageSettings.from_environment(),
            progress=progress.part(0.0, 0.2),
        )
        stages = stages_for(a.profile, made.inputs, library, recipe=a.recipe)
        project = Project.create(a.output)
        built = build_project(
            project, made.inputs, library, stages=stages, warnings=made.notes, progress=progress.part(0.2, 1.0)
        )
    report = build_report(project, built, ("scene.json",))
    if a.json:
        print(json.dumps(report))
        return
    for note in made.notes:
        print(f"diorama: note: {note}", file=sys.stderr)
    print(f"{a.output}: {report['summary']}")
    if not built.objects:
        print("No furniture was found in the picture: run 'diorama models pull lite', or draw boxes in the editor.")
