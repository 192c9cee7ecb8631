"""Edits by counts and lengths in plain English: "double the number of books", "half a metre closer to the sofa"."""

from __future__ import annotations

import re
from collections import Counter

import numpy as np

from diorama_core.editing.footprints import footprint_of, gaps
from diorama_core.errors import EditRefused
from diorama_core.library.taxonomy import broad
from diorama_core.scene.types import Scene
from diorama_core.text.edit_plan import MAX_COPIES, Edit, Insert, Place, Remove, Resize, Shift
from diorama_core.text.edit_room import gap_to_wall
from diorama_core.text.phrases import split_places
from diorama_core.text.selecting import Selector

_DISTANCE = re.compile(
    r"\b(?:by )?(\d+(?:\.\d+)?|an?|half an?|one|two) ?"
    r"(?:(m|metres?|meters?)|(cm|centimet(?:re|er)s?)|(ft|foot|feet)|(inch(?:es)?))\b"
)
_UNITS_M = (1.0, 0.01, 0.3048, 0.0254)
_WAYS = {
    "left": (-1.0, 0.0), "right": (1.0, 0.0), "back": (0.0, 1.0), "backwards": (0.0, 1.0), "backward": (0.0, 1.0),
    "forward": (0.0, -1.0), "forwards": (0.0, -1.0), "closer": (0.0, -1.0), "away": (0.0, 1.0),
}  # fmt: skip
_WALLS = {"left": (-1.0, 0.0), "right": (1.0, 0.0), "back": (0.0, 1.0), "far": (0.0, 1.0), "front": (0.0, -1.0)}
_NEARER = re.compile(
    r"^(.+?)\s+(?:a (?:bit|little) |much |further )*(closer|nearer|towards?|away|farther|further)(?: (?:to|from))? "
    r"((?:the|my|that|this) .+)$"
)
_FROM = re.compile(
    r"^(.+?),?(?: to| at| about| around| exactly)*(?P<away> away)?(?: from| off) ((?:the|my|its|this) .+)$"
)
_TO_A_GAP = re.compile(
    r"^(.+?) (?:closer|nearer) to ((?:the|my|that|this) [^,]+?),? (?:to |at |about |around )*(?:away|apart|off)$"
)
_A_LITTLE = re.compile(r"\b(?:a (?:bit|little)|slightly|a touch)\b")
A_LITTLE_M = 0.2
STEP_M, HUNG_STEP_M = 0.5, 0.1
"""Where no distance is said: along the floor, and up or down a wall."""
GAP_STEPS = 8
"""Of finding how far to go until a gap is left: each takes up what the one before left."""
MAX_SHIFT_M, MAX_LIFT_M = 20.0, 3.0


def shift_of(selector: Selector, rest: str) -> Shift | None:
    """ "the sofa 50 cm to the left": None where it says something else."""
    plain = _DISTANCE.sub(" ", rest)
    way = re.search(rf"^(.*?)\s*(?:to the |a (?:bit|little) |further )*\b({'|'.join(_WAYS)})\s*$", plain.strip())
    if way is None or not way[1]:
        return None
    distance = _distance_m(rest, STEP_M, MAX_SHIFT_M)
    right, away = _WAYS[way[2]]
    head = re.sub(r"\b(?:to the|a bit|a little|further)\s*$", "", way[1]).strip()
    return Shift(objects=selector.subject(head), right_m=distance * right, away_m=distance * away)


def nearer(selector: Selector, rest: str) -> Shift | None:
    """ "the table half a metre closer to the sofa": None where it says something else.

    Without a distance "to" and "towards" mean beside, and walls are no objects to go nearer to.
    """
    way = _NEARER.match(" ".join(_DISTANCE.sub(" ", rest).split()))
    if way is None or split_places(way[1])[1]:
        return None
    distance = _distance_m(rest, STEP_M, MAX_SHIFT_M)
    by_m = -distance if way[2] in ("away", "farther", "further") else distance
    wall = re.fullmatch(r"\w+ (?:(\w+) )?walls?", way[3])
    if wall is not None and length_in(rest) is None:
        return None
    if wall is not None and wall[1] in _WALLS:
        right, back = _WALLS[wall[1]]
        return Shift(objects=selector.subject(way[1]), right_m=by_m * right, away_m=by_m * back)
    if wall is not None and wall[1] is None:
        return Shift(objects=selector.subject(way[1]), off_wall_m=-by_m)
    toward = selector.targets(way[3] if wall is None else f"the {wall[1]}")[0]  # the window wall is where the window is
    return Shift(objects=selector.subject(way[1]), toward=toward, toward_m=by_m)


def shift_in(selector: Selector, rest: str, *, leaves: bool) -> Shift | None:
    """Shift by "the table 40 cm from the sofa", "closer to the sofa, about 40 cm away"; None for anything else.

    "40 cm away from" is what is left between them where `leaves`, as in "put it"; the way otherwise, as in "move it".
    """
    length = length_in(rest)
    plain = " ".join(_DISTANCE.sub(" ", rest).split())
    way = _TO_A_GAP.match(plain) or _FROM.match(plain)
    if length is None or way is None or split_places(way[1])[1] or (way.groupdict().get("away") and not leaves):
        return None
    ids = selector.subject(way[1])
    if re.fullmatch(r"\w+ walls?", way[way.re.groups]):
        return Shift(objects=ids, off_wall_m=length - gap_to_wall(selector.scene, ids[0]))
    target = selector.targets(way[way.re.groups])[0]
    item, other = selector.scene.object(ids[0]), footprint_of(selector.scene.object(target))
    ahead = selector.scene.object(target).pose.position[:2] - item.pose.position[:2]
    ahead = ahead / max(float(np.linalg.norm(ahead)), 1e-6)
    toward_m = 0.0
    for _ in range(GAP_STEPS):
        toward_m += float(gaps((footprint_of(item) + toward_m * ahead)[None], other)[0]) - length
    return Shift(objects=ids, toward=target, toward_m=toward_m)


def lift(selector: Selector, clause: str, rest: str) -> Shift:
    """ "raise the picture by 20 cm", "lower the clock"; `rest` is what follows the verb."""
    distance = _distance_m(rest, HUNG_STEP_M, MAX_LIFT_M)
    head = re.sub(r"\b(?:a bit|a little|slightly)\s*$", "", _DISTANCE.sub(" ", rest).strip()).strip()
    down = re.search(r"\blower\b", clause) is not None
    return Shift(objects=selector.subject(head), up_m=-distance if down else distance)


def length_in(text: str) -> float | None:
    """The first length that a text says, metres."""
    match = _DISTANCE.search(text)
    if match is None:
        return None
    number = {"a": 1.0, "half a": 0.5, "one": 1.0, "two": 2.0}.get(re.sub("an$", "a", match[1])) or float(match[1])
    return number * next(m for m, unit in zip(_UNITS_M, match.groups()[1:]) if unit)


def without_lengths(text: str) -> str:
    """A text without the lengths that it says."""
    return _DISTANCE.sub(" ", text)


def _distance_m(text: str, otherwise_m: float, most_m: float) -> float:
    """The distance that a text says, or another where it says none."""
    distance = length_in(text)
    if distance is None:
        return A_LITTLE_M if otherwise_m > A_LITTLE_M and _A_LITTLE.search(text) else otherwise_m
    if distance > most_m:
        raise EditRefused(f"{distance:g} m is farther than any room; give at most {most_m:g} m")
    return distance


_TIMES = {"double": 2.0, "twice": 2.0, "triple": 3.0, "quadruple": 4.0, "halve": 0.5, "half": 0.5}
_CHANGED = re.compile(
    r"^(?:please )?(?:(?P<verb>double|triple|quadruple|halve) "
    r"(?:the (?P<what>number|amount|size) of )?(?:the |my |all )?"
    r"|.*?\b(?P<many>twice|half) as many )(?P<noun>.+)$"
)


def quantity_edits(selector: Selector, clause: str) -> tuple[Edit, ...] | None:
    """More of a kind beside those that are there, or fewer; None where a clause says something else.

    Raises:
        EditRefused: there is none of the kind, or there would be too many.
    """
    match = _CHANGED.match(clause)
    if match is None:
        return None
    factor, noun = _TIMES[match["verb"] or match["many"]], match["noun"]
    if match["what"] == "size":
        return (Resize(objects=list(selector.objects(noun)), factor=factor),)
    scene, ids = selector.scene, selector.objects(f"all {noun}")
    wanted = round(factor * len(ids))
    if wanted <= len(ids):
        if len(ids) == 1:
            raise EditRefused(f"there is only one {scene.object(ids[0]).category}")
        return (Remove(objects=list(ids[max(wanted, 1) :])),)
    if wanted - len(ids) > MAX_COPIES:
        raise EditRefused(f"that would be {wanted - len(ids)} more; {MAX_COPIES} at a time are possible")
    copies = (ids * (wanted // len(ids)))[: wanted - len(ids)]
    homes = Counter((scene.object(i).category, _carrier(scene, i)) for i in copies)
    return tuple(
        Insert(what=what, count=count, places=[Place(relation="on", targets=[carrier])] if carrier else [])
        for (what, carrier), count in homes.items()
    )


def _carrier(scene: Scene, object_id: str) -> str:
    """The object that carries another; empty for what stands on the floor, on a rug too, or hangs."""
    edge = scene.support_of(object_id)
    if edge is None or not scene.has_object(edge.parent):
        return ""
    return "" if broad(scene.object(edge.parent).category) == "rug" else edge.parent
