"""Words about the room itself, in plain English: its surfaces, its lengths, its light, its doors and windows."""

from __future__ import annotations

import re
from contextlib import suppress
from typing import Literal, cast

from diorama_core.errors import EditRefused
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.scene.types import PlaneRole
from diorama_core.text.edit_lengths import length_in
from diorama_core.text.edit_plan import Edit, InsertOpening, Light, Paint, RoomLength, Side
from diorama_core.text.edit_room import covering_in_words, wall_on
from diorama_core.text.edit_words_objects import side_in
from diorama_core.text.phrases import split_list
from diorama_core.text.selecting import Selector

_PARTS: dict[PlaneRole, Literal["walls", "floor", "ceiling"]] = {
    "wall": "walls",
    "floor": "floor",
    "ceiling": "ceiling",
}
_PART = re.compile(
    r"\b(?:all (?:of )?)?(?:the |my |our |its |this |that )?(?:room's )?"
    r"(?:(?P<side>left|right|back|far|front)(?:[ -]hand)? )?(?P<part>wall|floor|ceiling)s?\b(?:ing\b)?"
    r"(?:\s+(?:behind|beside|next to|by|near) (?P<at>(?:the|my|this) [\w ]+?)(?=\s+(?:in|with|a|an|to|into)\b|$))?"
)
_ASKED = re.compile(
    r"^(?:make|paint|repaint|colou?r|cover|redo|do|change|turn|give|get|have|use|lay|put in|put|install|add|create"
    r"|i want|i need|clad|wallpaper(?= the))\b"
)
_BESIDE = re.compile(r"\b(?:me|some|an?|new|in|into|to|with|of|on|for|be|look|out|the room|room|it|colou?r|one)\b")
_SPARED = re.compile(
    r"^(.*\bwalls\b.*?),? (?:except|apart from|other than|but(?: not)?)(?: for)?"
    r" the (left|right|back|far|front)(?: wall| one)?(.*)$"
)
"""“all walls beige except the back wall”."""
_BEHIND = re.compile(r"\bbehind (?P<at>(?:the|my|this) .+?)(?=\s+(?:in|with|to)\b|$)")
_GROWS: dict[Literal["height", "length", "width"], str] = {
    "height": "higher|taller|high|tall|lower",
    "length": "longer|deeper|long|deep|shorter|bigger|larger|smaller",
    "width": "wider|wide|broader|narrower",
}
_SHRINKS = re.compile(r"\b(?:lower|shorter|narrower|smaller|reduce|shrink|shorten)\b")
STEP_M = 0.5
"""Where no length is said."""
_HOURS = {
    "sunrise": 6.5, "dawn": 6.0, "early morning": 7.0, "morning": 9.0, "midday": 12.0, "noon": 12.0,
    "day": 12.0, "afternoon": 15.0, "sunset": 19.0, "dusk": 19.5, "evening": 18.5, "midnight": 0.0, "night": 23.0,
}  # fmt: skip
_CLOCK = re.compile(r"\b(\d{1,2})(?::(\d\d))?\s*(am|pm|o'clock)?$")
STOPS = 0.7
"""By which "brighter" and "darker" change the light."""
_LIGHT = r"(?:the |all )?(?:lights?|lighting|room|scene|picture|view|it)"
_LAMPS = r"(?:the |all (?:of )?(?:the )?)?(?:lights|lamps|light)"


def room_edits(selector: Selector, clause: str) -> tuple[Edit, ...] | None:
    """The edits of the room that a clause asks for; None where it is about something else.

    Raises:
        EditRefused: it is about the room, and cannot be done.
    """
    readings = (read(selector, clause) for read in (_lengths, _light, _openings, _surfaces))
    return next((edits for edits in readings if edits is not None), None)


def _surfaces(selector: Selector, clause: str) -> tuple[Edit, ...] | None:
    asked = _ASKED.match(clause)
    rest = clause[asked.end() :] if asked is not None else clause
    parts = split_list(rest)
    if len(parts) > 1 and all(_PART.search(p) for p in parts):
        surfaces = [_surface(selector, p) for p in parts]
        return tuple(e for e in surfaces if e is not None) if None not in surfaces else None
    spared = _SPARED.match(rest)
    one = _surface(selector, rest if spared is None else f"{spared[1]} {spared[3]}")
    if one is None or spared is None:
        return None if one is None else (one,)
    left_out = wall_on(selector.scene, side_in(spared[2])).id
    sides = {}
    for side in ("left", "right", "back", "front"):
        with suppress(EditRefused):  # the room has none there
            sides[wall_on(selector.scene, side).id] = side
    return tuple(one.model_copy(update={"wall": side}) for wall, side in sides.items() if wall != left_out)


def _surface(selector: Selector, text: str) -> Paint | None:
    """ "the wall behind the sofa terracotta", "an oak floor", "wallpaper on the walls"."""
    part = _PART.search(text)
    if part is None:
        return None
    role = cast(PlaneRole, part["part"])
    planes = selector.scene.architecture.by_role(role)
    left, right = text[: part.start()], text[part.end("at") if part["at"] else part.end() :]
    behind = part["at"]
    if behind is None and role == "wall" and (where := _BEHIND.match(text[part.end() :].strip())) is not None:
        behind, right = _cut(selector, where["at"])
    elif behind is not None:
        behind, more = _cut(selector, behind)
        right = f"{more} {right}"
    look = " ".join(_BESIDE.sub(" ", f"{left} {right}").split())
    if not look or not planes or covering_in_words(look, planes[0]) is None:
        return None
    at = selector.targets(behind)[0] if behind else ""
    wall = side_in(part["side"] or "") if role == "wall" else ""
    return Paint(part=_PARTS[role], colour=look, behind=at, wall=wall)


def _cut(selector: Selector, words: str) -> tuple[str, str]:
    """What names an object at the beginning of some words, and the rest: "the sofa terracotta"."""
    split = words.split()
    for end in range(2, len(split) + 1):
        with suppress(EditRefused):
            selector.targets(" ".join(split[:end]))
            longer = next((k for k in range(len(split), end, -1) if _is_label(selector, split[:k])), end)
            return " ".join(split[:longer]), " ".join(split[longer:])
    return words, ""


def _is_label(selector: Selector, words: list[str]) -> bool:
    """Whether words are an object's kind or name, word for word: "the coffee table"."""
    name = " ".join(w for w in words if w not in ("the", "my", "this"))
    return any(name in (o.label.lower(), o.category) for o in selector.scene.objects)


def _lengths(selector: Selector, clause: str) -> tuple[Edit, ...] | None:
    lifted = re.match(r"^(?:raise|lift|lower|drop) the ceiling\b((?: (?:by|to|a|slightly|much)\b.*)?)$", clause)
    if lifted is not None:
        return (_length("height", lifted[1], shrinks=clause.startswith(("lower", "drop"))),)
    both = re.match(r"^make the room (?:to be )?(\d+(?:\.\d+)?) ?m?\w* ?(?:by|x|×) ?(\d+(?:\.\d+)?) ?m\w*$", clause)
    if both is not None:
        long_m, wide_m = sorted((float(both[1]), float(both[2])), reverse=True)
        return RoomLength(side="length", to_m=long_m), RoomLength(side="width", to_m=wide_m)
    made = re.match(r"^(?:make|extend|enlarge|widen|lengthen|shrink|shorten|set) the (room|ceiling)\b(.*)$", clause)
    if made is None:
        return None
    command = f"{clause.split()[0]} {made[2]}"
    said = length_in(command) is not None
    side = next((s for s, words in _GROWS.items() if re.search(rf"\b(?:{words})\b", command)), None)
    if made[1] == "ceiling":
        if re.search(r"\b(?:darker|lighter|brighter|paler)\b", command) or not (said or "er" in made[2]):
            return None
        side = "height"
    elif side is None and said:
        side = "width" if "widen" in command else "length"
    return None if side is None else (_length(side, command, shrinks=bool(_SHRINKS.search(command))),)


def _length(side: Literal["height", "length", "width"], words: str, *, shrinks: bool) -> RoomLength:
    length = length_in(words)
    absolute = re.search(r"\bto\b|\b(?:high|tall|long|deep|wide)\b", words) is not None or (
        length is not None and re.search(r"\bby\b|er\b", words) is None
    )
    if length is not None and absolute:
        return RoomLength(side=side, to_m=length)
    return RoomLength(side=side, by_m=(-1.0 if shrinks else 1.0) * (STEP_M if length is None else length))


def _light(selector: Selector, clause: str) -> tuple[Edit, ...] | None:
    lamps = re.match(rf"^(?:turn|switch|put) (?:(on|off) {_LAMPS}|{_LAMPS} (on|off))$", clause)
    if lamps is not None:
        return (Light(lamps="on" if "on" in lamps.groups() else "off"),)
    if re.match(rf"^make {_LIGHT} (?:a (?:bit|little) |much )?(?:warmer|cooler|colder)$", clause):
        raise EditRefused(
            "the light has its colour from the hour and the lamps; for example: make it evening, turn on the lamps"
        )
    bright = re.match(rf"^(?:make|turn) {_LIGHT} (?:a (?:bit|little) |much )?(brighter|lighter|darker|dimmer)$", clause)
    bright = bright or re.match(rf"^(dim|brighten) {_LIGHT}$", clause)
    if bright is not None:
        return (Light(brighter_ev=STOPS if bright[1] in ("brighter", "lighter", "brighten") else -STOPS),)
    timed = re.match(
        r"^(?:make it|set the (?:time|hour|light)(?: of day)?(?: to)?|it should be"
        r"|(?:show|let me see|let us see) (?:me )?(?:it|the room|this room)(?: in| at| by)?) (.+?)"
        r"(?: with (?:the )?(?:lamps|lights) (on|off))?$",
        clause,
    )
    if timed is None:
        return None
    lamps_too = (Light(lamps=cast("Literal['on', 'off']", timed[2])),) if timed[2] else ()
    words = re.sub(r"^(?:the |at |an? |sunny |bright |late )+|(?<=[a-z])[ -]?time$", "", timed[1])
    if words in _HOURS:
        return (Light(hour=_HOURS[words]), *lamps_too)
    at = _CLOCK.match(words)
    if at is None or int(at[1]) > 24:
        return None
    hour = int(at[1]) % 12 + (12 if at[3] == "pm" else 0) if at[3] in ("am", "pm") else int(at[1])
    return (Light(hour=min(hour + int(at[2] or 0) / 60, 24.0)), *lamps_too)


def _openings(selector: Selector, clause: str) -> tuple[Edit, ...] | None:
    kinds = "|".join(OPENING_CATEGORIES)
    match = re.match(
        r"^(?:add|put|insert|create|make|cut|place|i want|i need|give me) (?:an?|another|a second|one more) "
        rf"(?:new )?({kinds})"
        r"(?: (?:in|into|to|on|at) (?:the|a|an|another) (?:(left|right|back|front|far|opposite) )?wall)?"
        r"(?: (?:behind|next to|beside|by|near|opposite) (.+))?(?: (?:in|into|to) the room)?$",
        clause,
    )
    if match is None:
        return None
    side = {"far": "back", "opposite": "back"}.get(match[2] or "", match[2] or "")
    behind = selector.targets(match[3])[0] if match[3] else ""
    return (InsertOpening(what=match[1], wall=cast("Side", side), behind=behind),)
