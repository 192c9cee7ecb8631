"""Edits of how many there are, in plain English: "double the number of books", "all but one of the pillows"."""

from __future__ import annotations

import re
from collections import Counter

from diorama_core.errors import EditRefused
from diorama_core.library.taxonomy import broad
from diorama_core.text.edit_plan import MAX_COPIES, Edit, Insert, Place, Remove, Resize
from diorama_core.text.phrases import NUMBERS
from diorama_core.text.selecting import Selector

_TIMES = {"double": 2.0, "twice": 2.0, "triple": 3.0, "quadruple": 4.0, "halve": 0.5, "half": 0.5}
_CHANGED = re.compile(
    r"^(?:please )?(?:(?P<verb>double|triple|quadruple|halve) "
    r"(?:the (?P<what>number|amount|size) of )?(?:the |my |all )?"
    r"|.*?\b(?P<many>twice|half) as many )(?P<noun>.+)$"
)
_ALL_BUT = re.compile(r"^all (?:of )?(?:but|except) (\w+)(?: of)? (?:the |my |these |those )?(.+)$")


def counted_edits(selector: Selector, clause: str) -> tuple[Edit, ...] | None:
    """More of a kind beside those that are there, or fewer; None where a clause says something else.

    Raises:
        EditRefused: there is none of the kind, or there would be too many.
    """
    found = _CHANGED.match(clause)
    if found is None:
        return None
    factor, noun = _TIMES[found["verb"] or found["many"]], found["noun"]
    if found["what"] == "size":
        return (Resize(objects=list(selector.objects(noun)), factor=factor),)
    ids = selector.objects(f"all {noun}")
    wanted = round(factor * len(ids))
    if wanted <= len(ids):
        return (Remove(objects=list(ids[max(wanted, 1) :])),) if len(ids) > 1 else _too_few(selector, ids[0])
    if wanted - len(ids) > MAX_COPIES:
        raise EditRefused(f"that would be {wanted - len(ids)} more; {MAX_COPIES} at a time are possible")
    copies = (ids * (wanted // len(ids)))[: wanted - len(ids)]
    scene = selector.scene
    homes = Counter((scene.object(i).category, _carrier(selector, i)) for i in copies)
    return tuple(
        Insert(what=what, count=count, places=[Place(relation="on", targets=[carrier])] if carrier else [])
        for (what, carrier), count in homes.items()
    )


def all_but(text: str) -> tuple[int, str] | None:
    """How many of what are spared: "all but one of the pillows"; None where a phrase says something else."""
    found = _ALL_BUT.match(text.strip())
    if found is None or not (found[1].isdigit() or NUMBERS.get(found[1], 0)) or found[1] in ("the", "a", "an"):
        return None
    return (int(found[1]) if found[1].isdigit() else NUMBERS[found[1]]), found[2]


def _carrier(selector: Selector, object_id: str) -> str:
    """The object that carries another; empty for what stands on the floor, on a rug too, or hangs."""
    edge = selector.scene.support_of(object_id)
    if edge is None or not selector.scene.has_object(edge.parent):
        return ""
    return "" if broad(selector.scene.object(edge.parent).category) == "rug" else edge.parent


def _too_few(selector: Selector, object_id: str) -> tuple[Edit, ...]:
    raise EditRefused(f"there is only one {selector.scene.object(object_id).category}")
