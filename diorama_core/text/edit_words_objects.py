"""Words about objects: phrases of place, sizes of one side, copies, exchanges, states, names, lines."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Literal, cast

import numpy as np

from diorama_core.editing.relations import Relation, is_met
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.errors import EditRefused
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.text.edit_lengths import length_in, without_lengths
from diorama_core.text.edit_plan import Align, Copy, Edit, Exchange, Measure, Place, Rename, SetState, Shift, Side
from diorama_core.text.phrases import NUMBERS, PlacePhrase, split_places
from diorama_core.text.selecting import Selector


def places_of_phrases(selector: Selector, places: Sequence[PlacePhrase]) -> list[Place]:
    """Where phrases of place say that something goes; raises `EditRefused` where they name what is not there."""
    resolved = []
    for place in places:
        if place.words in ("", "each other", "one another"):
            resolved.append(Place(relation=place.kind, targets=[], side=side_in(place.said)))
        elif re.fullmatch(r"(?:the |this )?(?:\w+ )?(?:room|bedroom|kitchen|office|scene|floor|ground)", place.words):
            continue
        elif re.fullmatch(r"(?:the |a )?(?:\w+ )?walls?", place.words):
            resolved.append(Place(relation="against wall", targets=[], side=side_in(place.words)))
        else:
            targets = list(selector.targets(place.words))
            openings = all(selector.scene.object(t).category in OPENING_CATEGORIES for t in targets)
            by = place.kind == "under" and openings  # under a window is at it, on the floor
            resolved.append(Place(relation="near" if by else place.kind, targets=targets))
    return resolved


def side_in(words: str) -> Side:
    """Which side of the room words about a wall or a corner say."""
    match = re.search(r"\b(left|right|back|far|front|near|other|opposite|another)\b", words)
    word = "" if match is None else match[1]
    known = {"far": "back", "near": "front", "opposite": "other", "another": "other"}
    return cast("Side", known.get(word, word))


_SIDES: dict[str, tuple[Literal["width", "depth", "height"], float]] = {
    "wide": ("width", 1), "wider": ("width", 1), "broad": ("width", 1), "broader": ("width", 1),
    "narrow": ("width", -1), "narrower": ("width", -1), "slimmer": ("width", -1), "width": ("width", 1),
    "long": ("width", 1), "longer": ("width", 1), "shorter": ("height", -1),
    "deep": ("depth", 1), "deeper": ("depth", 1), "shallower": ("depth", -1), "depth": ("depth", 1),
    "high": ("height", 1), "higher": ("height", 1), "tall": ("height", 1), "taller": ("height", 1),
    "low": ("height", -1), "lower": ("height", -1), "height": ("height", 1), "thicker": ("height", 1),
}  # fmt: skip
_SIDE = "|".join(sorted(_SIDES, key=len, reverse=True))
_SIZED = re.compile(
    rf"^make (?P<who>.+?) (?:(?:a (?:bit|little)|much|slightly|somewhat|about|exactly) )*"
    rf"(?:(?P<times>half|twice|double|(?:\d+(?:\.\d+)?) times) as )?(?P<side>{_SIDE})$"
)
_LENGTH_AND_SIDE = re.compile(rf"\d+(?:\.\d+)? ?(?:c?m|c\w+et(?:re|er)s?|met(?:re|er)s?) ({_SIDE})\b")
_SET_SIDE = re.compile(
    r"^(?P<verb>set|change|make|increase|reduce|decrease|raise|lower) the (?P<side>width|depth|height|length) of "
    r"(?P<who>.+?)(?: (?P<to>to|by))?$"
)
_BOTH_SIDES = re.compile(
    r"^(?:make|resize|set) (.+?) (?:to (?:be )?|about |exactly )*(\d+(?:\.\d+)?) ?(m|cm)?(?:et\w+)?,? ?(?:by|x|×) ?"
    r"(\d+(?:\.\d+)?) ?(m|cm)(?:et\w+)?(?: in size)?$"
)
_ONE_LENGTH = re.compile(r"^(?:make|resize|set) (.+?)(?: to(?: be)?| about| exactly| just| only)*$")
_AS_ANOTHER = re.compile(
    rf"^(?:make|set) (.+?) (?:the same (height|width|depth|length) as|(?:just )?as ({_SIDE}) as) ((?:the|my|this) .+)$"
)
_AXES: dict[str, int] = {"depth": 0, "width": 1, "height": 2}
_TIMES = {"half": 0.5, "twice": 2.0, "double": 2.0}
SCREEN_WIDTH = 16 / np.hypot(16, 9)
"""Of the diagonal, in which screens are sold."""
STEP_FACTOR = 1.25
"""Where no length is said."""
_STATES: dict[str, Literal["locked", "unlocked", "hidden", "shown", "open", "closed", "on", "off"]] = {
    "lock": "locked", "unlock": "unlocked", "hide": "hidden", "show": "shown", "unhide": "shown", "open": "open",
    "close": "closed", "shut": "closed", "turn on": "on", "switch on": "on", "turn off": "off", "switch off": "off",
}  # fmt: skip
_STATE = re.compile(
    r"^(" + "|".join(sorted(_STATES, key=len, reverse=True)) + r") ((?:the|all|my|every|this|it|them)\b.*)$"
)
_COPIED = re.compile(
    r"^(?:(?:duplicate|clone|copy)|make (?:(?P<many>\w+) )?(?:copy|copies|duplicates?) of) (?P<rest>.+)$"
)
_OTHER_SIDE = re.compile(r"\bon the (?:other|opposite) side of\b")
_EXCHANGED = re.compile(
    r"^(?:swap|exchange|switch)(?: (?:the )?(?:places?|positions?) of)? ((?:the|my) .+?) (?:and|with) ((?:the|my) .+?)"
    r"(?: around| places| positions)?$"
)
_BOTH_EXCHANGED = re.compile(
    r"^(?:swap|exchange|switch)(?: (?:the )?(?:places?|positions?) of)? ((?:the|my|these|those) (?:two|2) .+?|both .+?)"
    r"(?: around| over| places| positions| with each other)?$"
)
_LEVELLED = re.compile(
    r"^(?:put|hang|set|bring|get|make|have|place) (.+?)"
    r" (?:at|to|on|in) (?:the same|one|equal|a) (?:height|level|line|row)$"
)
_NAMED = re.compile(r"^(?:rename|call|name|label) (.+)$")
_LINED = re.compile(r"^(?:line up|align|straighten) (.+?)(?: (?:in|into) (?:a|one) (?:row|line))?$")
_SPACED = re.compile(r"^(?:space(?: out)?|distribute|spread(?: out)?) (.+?)(?: evenly| equally)?$")
_OFF_WALL = re.compile(
    r"^(?:move|pull|push|shift|bring|slide|take) (.+?) (?:away|off|out)(?: from)? (?:the|its) walls?"
    r"(?: a (?:bit|little)| slightly)?$"
)
_QUOTES = "“”\"' "
OFF_WALL_M = 0.2
"""Where no length is said."""


def object_edits(selector: Selector, clause: str) -> tuple[Edit, ...] | None:
    """The edits of objects that a clause asks for; None where it says something else.

    Raises:
        EditRefused: the clause is one of these, and names what is not there.
    """
    if len(each := list(_LENGTH_AND_SIDE.finditer(clause))) > 1 and clause.startswith(("make ", "set ")):
        ids = selector.subject(clause[: each[0].start()].partition(" ")[2])
        return tuple(Measure(objects=ids, side=_SIDES[m[1]][0], to_m=length_in(m[0]) or 0.0) for m in each)
    for read in (_measure, _off_wall, _state, _copy, _exchange, _rename, _align):
        if (edit := read(selector, clause)) is not None:
            return (edit,)
    return _measures(selector, clause)


def _measure(selector: Selector, clause: str) -> Measure | None:
    """ "make the sofa 2 m wide", "make the plant half as tall", "set the width of the desk to 1.4 m"."""
    length = length_in(clause)
    plain = " ".join(without_lengths(clause).split())
    match = _SIZED.match(plain) or _SET_SIDE.match(plain)
    if match is None:
        return None
    side_word = match["side"]
    side, sign = _SIDES.get(side_word, ("width", 1.0))
    groups = match.groupdict()
    ids = selector.subject(match["who"])
    if times := groups.get("times"):
        return Measure(objects=ids, side=side, factor=_TIMES.get(times) or float(times.split()[0]))
    verb = groups.get("verb")
    if verb in ("reduce", "decrease", "lower"):
        sign = -1.0
    relative = side_word.endswith("er") or groups.get("to") == "by" or verb in ("increase", "reduce", "decrease")
    if length is None:
        if not relative:
            return None  # "make the shelf wide" is a look of it
        return Measure(objects=ids, side=side, factor=STEP_FACTOR if sign > 0 else 1.0 / STEP_FACTOR)
    if relative and groups.get("to") != "to":
        return Measure(objects=ids, side=side, by_m=sign * length)
    return Measure(objects=ids, side=side, to_m=length)


def _measures(selector: Selector, clause: str) -> tuple[Edit, ...] | None:
    """ "make the rug 3 by 2 m", "make the sideboard 1.6 m", "make the table as high as the desk"."""
    if (like := _AS_ANOTHER.match(clause)) is not None:
        side = _SIDES.get(like[2] or like[3], ("width", 1.0))[0]
        length = float(selector.scene.object(selector.targets(like[4])[0]).size_m[_AXES[side]])
        return (Measure(objects=selector.subject(like[1]), side=side, to_m=length),)
    both = _BOTH_SIDES.match(clause)
    one = None if length_in(clause) is None else _ONE_LENGTH.match(" ".join(without_lengths(clause).split()))
    if both is not None:
        units = [0.01 if (u or both[5]) == "cm" else 1.0 for u in (both[3], both[5])]
        lengths, ids = sorted(float(n) * u for n, u in zip((both[2], both[4]), units)), selector.subject(both[1])
        sides = sorted(("depth", "width"), key=lambda s: float(selector.scene.object(ids[0]).size_m[_AXES[s]]))
    elif one is not None and one[1] not in ("the room", "the ceiling"):
        ids, lengths = selector.subject(one[1]), [length_in(clause) or 0.0]
        item = selector.scene.object(ids[0])
        if re.search(r"\binch(?:es)?\b", clause) and item.category in ("television", "monitor"):
            lengths = [SCREEN_WIDTH * lengths[0]]
        sides = [max(_AXES, key=lambda s: float(item.size_m[_AXES[s]]))]
    else:
        return None
    return tuple(
        Measure(objects=ids, side=cast("Literal['width', 'depth', 'height']", side), to_m=length)
        for side, length in zip(sides, lengths, strict=True)
    )


def _off_wall(selector: Selector, clause: str) -> Shift | None:
    match = _OFF_WALL.match(" ".join(without_lengths(clause).split()))
    if match is None:
        return None
    return Shift(objects=selector.subject(match[1]), off_wall_m=length_in(clause) or OFF_WALL_M)


def _state(selector: Selector, clause: str) -> SetState | None:
    clause = re.sub(r"^(turn|switch) ((?:the|all|my) .+) (on|off)$", r"\1 \3 \2", clause)
    match = _STATE.match(clause)
    if match is None:
        return None
    return SetState(objects=selector.subject(match[2]), state=_STATES[match[1]])


def _copy(selector: Selector, clause: str) -> Copy | None:
    match = _COPIED.match(clause)
    if match is None:
        return None
    many = match["many"] or "one"
    count = int(many) if many.isdigit() else NUMBERS.get(many, 1)
    head, places = split_places(match["rest"])
    try:
        ids = selector.subject(head)
    except EditRefused:  # the place may be what tells it from others: "the lamp on the desk"
        if not places:
            raise
        return Copy(objects=selector.subject(match["rest"]), count=count)
    wanted = places_of_phrases(selector, places)
    if _OTHER_SIDE.search(match["rest"]) and len(wanted) == 1:
        at_left = Relation("left of", tuple(wanted[0].targets))
        on_left = is_met(selector.scene, ids[0], at_left, RoomFrame.of(selector.scene))
        wanted = [Place(relation="right of" if on_left else "left of", targets=wanted[0].targets)]
    return Copy(objects=ids, count=count, places=wanted)


def _exchange(selector: Selector, clause: str) -> Exchange | None:
    match, both = _EXCHANGED.match(clause), _BOTH_EXCHANGED.match(clause)
    if both is not None and not re.search(r" (?:for|with|and) ", both[1]):
        pair = selector.subject(re.sub(r"\b(?:two|2|both)\b", "", f"all {both[1]}"))
        pair = [i for i in pair if i in selector.selected] or pair
        if len(pair) != 2:
            raise EditRefused(f"there are {len(pair)} of these; say which two change places, or select two")
        return Exchange(objects=pair)
    if match is None:
        return None
    first, second = (selector.subject(words) for words in (match[1], match[2]))
    if len(first) != 1 or len(second) != 1:
        raise EditRefused("two objects can change places; name one of each")
    return Exchange(objects=[first[0], second[0]])


def _rename(selector: Selector, clause: str) -> Rename | None:
    match = _NAMED.match(clause)
    if match is None:
        return None
    words = match[1].split()
    joint = next((w for w in ("to", "as", "into") if w in words[1:-1]), None)
    if joint is not None:
        at = words.index(joint)
        ids = selector.subject(" ".join(words[:at]))
        return Rename(objects=ids[:1], to=" ".join(words[at + 1 :]).strip(_QUOTES))
    for cut in range(len(words) - 1, 0, -1):
        try:
            ids = selector.subject(" ".join(words[:cut]))
        except EditRefused:
            continue
        name = " ".join(words[cut:]).strip(_QUOTES)
        if name and len(ids) == 1:
            return Rename(objects=ids, to=name)
    raise EditRefused(f"“{clause}”: which object, and what name? For example: call the plant ficus")


def _align(selector: Selector, clause: str) -> Align | None:
    for pattern, how in ((_LINED, "in line"), (_LEVELLED, "in line"), (_SPACED, "evenly")):
        match = pattern.match(clause)
        if match is None or split_places(match[1])[1] or re.search(r"\bwith\b", match[1]):
            continue
        return Align(objects=selector.subject(match[1]), how=cast("Literal['in line', 'evenly']", how))
    return None
