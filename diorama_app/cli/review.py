"""`diorama review`: the questions about a project's scene whose answers help most, asked one after another."""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import diorama_core as diorama
from diorama_app.cli.arguments import command, print_note
from diorama_core.errors import EditRefused, InputError

if TYPE_CHECKING:
    from diorama_core.library.record import ShapeLibrary
    from diorama_core.review.questions import Question
    from diorama_core.scene.types import Scene

LATER, STOP = "l", "q"


def add_review(commands: Any) -> None:
    """Declare `diorama review`."""
    p = command(commands, "review", _review, "diorama review my-room")
    p.add_argument("project", type=Path, metavar="PROJECT")
    p.add_argument(
        "--answer",
        action="append",
        default=[],
        metavar="QUESTION=VALUE",
        help="give this answer, such as kind:chair_1=armchair, and ask nothing; may be repeated",
    )
    p.add_argument("--json", action="store_true", help="print the questions as JSON, and ask nothing")


def _review(a: argparse.Namespace) -> None:
    """Answer what the build of a scene is not sure of, the most helpful question first."""

    from diorama_core.project.lock import ProjectLock
    from diorama_core.review.questions import questions

    room = diorama.load(a.project)
    with ProjectLock(a.project, "diorama review"):
        scene = _with_answers(room.scene, room.library, a.answer)
        if not a.answer and not a.json:
            if not sys.stdin.isatty():
                raise InputError("nobody can be asked here; use --json for the questions and --answer for answers")
            scene = _ask(scene, room.library)
        if scene != room.scene:
            replace(room, scene=scene).save(a.project)
    left = questions(scene)
    if a.json:
        print(json.dumps({"project": str(a.project), "questions": [q.to_json() for q in left]}, ensure_ascii=False))
    else:
        print(f"{a.project}: {len(left)} question{'' if len(left) == 1 else 's'} left")


def _with_answers(scene: Scene, library: ShapeLibrary, given: list[str]) -> Scene:
    from diorama_core.review.answers import apply_answer

    for words in given:
        question, equals, value = words.partition("=")
        if not equals:
            raise InputError(f"--answer {words!r} is no answer; write it as kind:chair_1=armchair")
        scene = apply_answer(scene, library, question.strip(), value.strip())
    return scene


def _ask(scene: Scene, library: ShapeLibrary) -> Scene:
    """The scene with everything that the person at the terminal answered."""
    from diorama_core.review.answers import apply_answer
    from diorama_core.review.questions import questions

    put_off: set[str] = set()
    while (question := next((q for q in questions(scene) if q.id not in put_off), None)) is not None:
        print(f"\n{question.sentence}")
        for k, choice in enumerate(question.choices, 1):
            print(f"  {k}  {choice.label} ({100 * choice.probability:.0f} %)")
        reply = input(f"number, answer in words, {LATER} for later or {STOP} to stop: ").strip()
        if reply == STOP:
            return scene
        if reply in ("", LATER):
            put_off.add(question.id)
            continue
        try:
            scene = apply_answer(scene, library, question.id, _value(question, reply))
        except EditRefused as error:
            print_note(str(error))
    return scene


def _value(question: Question, reply: str) -> str:
    numbers = {str(k): choice.value for k, choice in enumerate(question.choices, 1)}
    return numbers.get(reply, reply)
