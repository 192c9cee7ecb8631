"""What a description asked for and a scene does not have, in words for the user."""

from __future__ import annotations

from collections import Counter

from diorama_core.library.taxonomy import category, with_kin
from diorama_core.scene.types import Scene
from diorama_core.text.prompt import RequestedObject, understood_prompt


def unmet(prompt: str, scene: Scene) -> tuple[str, ...]:
    """Every request of a description that a scene does not meet, one line each; empty where all are met.

    An object counts for the first request that names its category, else for one of a kindred category.
    """
    request = understood_prompt(prompt)
    there = Counter(o.category for o in scene.objects)
    lines = []
    for asked in request.objects:
        found = _take(there, asked)
        if found < asked.count:
            lines.append(_line(asked, found))
    return (*lines, *(f"the library has nothing called “{words}”" for words in request.ignored))


def _take(there: Counter[str], asked: RequestedObject) -> int:
    """How many of what is asked for are there, taken out so that they count once."""
    found = 0
    for name in (asked.category, *sorted(with_kin(asked.category) - {asked.category})):
        here = min(there[name], asked.count - found)
        there[name] -= here
        found += here
    return found


def _line(asked: RequestedObject, found: int) -> str:
    name = asked.label or category(asked.category).name
    if not found:
        return f"no {name}" if asked.count == 1 else f"none of {asked.count} {name}"
    return f"{found} of {asked.count} {name}"
