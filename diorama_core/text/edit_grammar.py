"""Edits in plain English without a language model: a small grammar of verbs, objects and places.

A command is a list of clauses ("remove the vase and move the lamp beside the sofa"). Each clause is understood in the
scene as the clauses before it leave it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Literal

from pydantic import ValidationError

from diorama_core.editing.relations import SEATS, RelationKind
from diorama_core.errors import EditRefused
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.io.bounded import shorten
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import broad, category
from diorama_core.scene.types import Scene
from diorama_core.text.edit_lengths import lift, nearer, quantity_edits, shift_in, shift_of
from diorama_core.text.edit_plan import (
    MAX_COPIES,
    Copy,
    Edit,
    Insert,
    Move,
    Paint,
    Place,
    Remove,
    Resize,
    Restyle,
    Swap,
    Turn,
)
from diorama_core.text.edit_wording import EXAMPLES, VERBS, plain
from diorama_core.text.edit_words_objects import object_edits, places_of_phrases
from diorama_core.text.edit_words_room import room_edits
from diorama_core.text.looks import has_look, look_of
from diorama_core.text.phrases import (
    APPEARANCES,
    NUMBERS,
    PlacePhrase,
    noun_phrase,
    relation_pattern,
    split_list,
    split_places,
)
from diorama_core.text.selecting import Selector

_VERB = re.compile(
    r"^(?:please |now |then |also |and |can you |could you )*(?:"
    + "|".join(f"(?P<{name}>(?:{words})\\b)" for name, words in VERBS.items())
    + ")"
)
_HIGHER = re.compile(
    r"(?:\s+(?:a (?:bit|little)|slightly|much|somewhat))?\s+(?:(higher|lower)(?: up| down)?|up|(down))$"
)
_PARTS = frozenset({"drawer", "drawers", "shelf", "shelves", "legs", "arms", "back", "lid", "wheels", "shade"})
"""What furniture has and what is no object beside it."""
_AND_SO = frozenset({"of", "more", "new", "another", "please", "also", "and", "pair", "set", "few", "some", "with"})
"""Words that may stand beside what is named anew."""
_COMPARED = {"bigger": 1.25, "larger": 1.25, "smaller": 0.8}
"""“I want a bigger rug” is about the rug that is there."""
_SCALES = {"twice": 2.0, "double": 2.0, "half": 0.5}
MAX_LINE = 380
"""Characters of a refusal."""


def edits_of(
    clause: str, scene: Scene, library: ShapeLibrary, last: Sequence[str] = (), selected: Sequence[str] = ()
) -> tuple[Edit, ...]:
    """What one clause asks for in a scene.

    Args:
        clause: lower case.
        scene: as the clauses before leave it.
        library: of its shapes.
        last: ids that "it" means: those of the clause before.
        selected: ids that a person has selected.

    Raises:
        EditRefused: the clause is not understood, or names what is not there; one line that says which.
    """
    try:
        return _edits_of(clause, scene, library, last, selected)
    except ValidationError as error:  # the limits of an edit: lengths of words, numbers of copies
        first = error.errors(include_url=False, include_input=False)[0]
        where = shorten(" ".join(str(part) for part in first["loc"]), 40)
        quoted = shorten(clause, 60)
        raise EditRefused(f"“{quoted}”: {where}: {shorten(first['msg'].lower())}; say it in fewer words") from error
    except EditRefused as refused:  # which quotes words that may be very long
        raise EditRefused(shorten(str(refused), MAX_LINE)) from refused


def _edits_of(
    clause: str, scene: Scene, library: ShapeLibrary, last: Sequence[str], selected: Sequence[str]
) -> tuple[Edit, ...]:
    selector = Selector(scene, library, last, selected)
    clause = plain(clause)
    known = quantity_edits(selector, clause) or room_edits(selector, clause) or object_edits(selector, clause)
    if known:
        return known
    match = _VERB.match(clause)
    verb = "" if match is None else str(match.lastgroup)
    rest = clause if match is None else clause[match.end() :].strip()
    if not rest and verb:
        raise EditRefused(f"“{clause}”: {verb} what? For example: {EXAMPLES}")
    if verb == "remove":
        return (Remove(objects=selector.subject(rest)),)
    if verb == "clear":
        carrier = selector.objects(rest.removeprefix("off ").removeprefix("up "))
        on = [i for c in carrier for i in scene.children_of(c)]
        if not on:
            raise EditRefused(f"there is nothing on {scene.object(carrier[0]).label}")
        return (Remove(objects=on),)
    if verb in ("swap", "change") or (verb == "turn" and re.search(r" into (?:an?|some) ", rest)):
        return _with_copies(_swap(selector, clause, rest))
    if verb == "turn":
        return (_turn(selector, clause, rest),)
    if verb in ("paint", "make"):
        return _each_alone(_look, selector, clause, rest)
    if verb in ("larger", "smaller"):
        return (Resize(objects=selector.subject(rest), factor=_factor(rest, verb == "larger")),)
    if verb == "lift":
        return (lift(selector, clause, rest),)
    if verb in ("move", "put") and (height := _HIGHER.search(rest)) is not None:
        way = "lower" if height[2] or height[1] == "lower" else "raise"
        return (lift(selector, way, rest[: height.start()]),)
    if verb in ("move", "put") and (shift := shift_in(selector, rest, leaves=verb == "put")) is not None:
        return (shift,)
    if verb == "move" or (verb == "put" and _is_known(selector, rest)):
        return _each_alone(_move, selector, clause, rest)
    if not verb and not _is_wish(rest):
        raise EditRefused(f"“{clause}” is not understood; for example: {EXAMPLES}")
    return _inserts(selector, clause, rest)


def _each_alone(
    read: Callable[[Selector, str, str], Edit], selector: Selector, clause: str, rest: str
) -> tuple[Edit, ...]:
    """ "the desk white and the chair black" is two edits, "the desk and the chair black" is one of two objects."""
    parts = split_list(rest)
    if len(parts) > 1:
        with suppress(EditRefused):  # not all of them are whole by themselves
            return tuple(read(selector, clause, part) for part in parts)
    return (read(selector, clause, rest),)


def _is_wish(text: str) -> bool:
    """Whether words without a verb name something new: "a rug under the table", not "hide the lamp"."""
    head, _ = split_places(text)
    if re.search(r"\b(?:the|this|that|these|those|my|our)\b", head):
        return False
    phrase, _ = noun_phrase(head)
    named = {} if phrase is None else {*phrase.label.split(), *phrase.appearance}
    others = [w for w in re.findall(r"[a-z0-9'-]+", head) if w not in named and w not in NUMBERS and not w.isdigit()]
    return phrase is None or set(others) <= _AND_SO


def _is_known(selector: Selector, text: str) -> bool:
    """Whether what is put somewhere is in the scene: "the lamp", not "a lamp"."""
    head, _ = split_places(text)
    phrase, _ = noun_phrase(head)
    if phrase is None or phrase.pronoun or phrase.every or phrase.definite or not phrase.label:
        return True
    first = head.split()[0]
    counted = first in NUMBERS or first.isdigit()
    return not counted and any(o.category == phrase.category for o in selector.scene.objects)


def _move(selector: Selector, clause: str, rest: str) -> Edit:
    head, places = split_places(rest)
    shift = nearer(selector, rest) or shift_of(selector, rest)
    if shift is not None:
        return shift
    toward = re.match(r"(.*?)\s+\bto\s+(.+)$", rest)
    if not places and toward is not None:
        head, places = toward[1], [PlacePhrase(_usual_relation(selector, toward[1], toward[2]), toward[2])]
    if not places:
        raise EditRefused(f"“{clause}”: where to? For example: move the lamp beside the sofa")
    qualifiers, goals = _split(selector, head, places)
    ids = selector.objects(head, qualifiers, movable=True)
    wanted = places_of_phrases(selector, goals)
    if not wanted:
        raise EditRefused(f"“{clause}”: where to? For example: beside the sofa, against the wall, in the corner")
    return Move(objects=list(ids), places=wanted)


def _usual_relation(selector: Selector, head: str, goal: str) -> RelationKind:
    """What "to" means: onto furniture for what lies on things, beside it for what stands on the floor."""
    scene = selector.scene
    item, target = scene.object(selector.objects(head)[0]), scene.object(selector.targets(goal)[0])
    return _usual_kind(item.category, target.category)


def _usual_kind(kind: str, target: str) -> RelationKind:
    """How something of a category is usually at something of another one."""
    if category(kind).mount == "surface" and category(target).supports_objects:
        return "on"
    return "around" if kind in SEATS and broad(target) in ("table", "desk") else "beside"


def _split(selector: Selector, head: str, places: list[PlacePhrase]) -> tuple[list[PlacePhrase], list[PlacePhrase]]:
    """What tells the object from others of its kind, and where it goes: "the lamp on the desk", "beside the sofa"."""
    if len(places) < 2:
        return [], places
    try:
        selector.objects(head, places[:1])
    except EditRefused:
        return [], places
    return places[:1], places[1:]


_ANGLES = tuple(
    (re.compile(rf"\b(?:by )?(?:{words})\b"), f"by {angle} degrees")
    for words, angle in (
        (r"(?:a |one )?quarter(?: of a| of the way)?(?: turn| circle| round| around)?", 90),
        (r"half(?: a| way|way)?(?: turn| circle| round| around)|(?:a )?half(?: turn| circle)", 180),
        (r"a (?:bit|little)|slightly|a touch", 15),
    )
)


def _turn(selector: Selector, clause: str, rest: str) -> Edit:
    for pattern, pattern_words in _ANGLES:
        rest = pattern.sub(pattern_words, rest, count=1)
    degrees = re.search(r"(?:by )?(-?\d+(?:\.\d+)?)\s*(?:degrees|degree|deg|°)", rest)
    fixed = re.search(r"\b(around|round|over|left|right|clockwise|anticlockwise|counter-?clockwise)\b\s*$", rest)
    if degrees is not None:
        head = re.sub(r"\bby\b.*$", "", rest[: degrees.start()]).strip()
        sign = -1.0 if re.search(r"\bright\b|(?<!anti)(?<!counter)(?<!-)\bclockwise\b", rest) else 1.0
        head = re.sub(r"\b(left|right|clockwise)\b", "", head)
        return Turn(objects=selector.subject(head), degrees=max(min(sign * float(degrees[1]), 360.0), -360.0))
    toward = re.match(r"(.*?)\s*\b(?:(?:to |it )?faces?|to look at|towards?|to|at|facing)\b\s+(.*)$", rest) or re.match(
        r"(the [\w ]+?)\s+(the [\w ]+)$", rest
    )
    if toward is not None and toward[1] and toward[2] not in ("left", "right", "the left", "the right"):
        targets = selector.targets(toward[2])
        return Turn(objects=selector.subject(toward[1]), toward=targets[0])
    if fixed is not None or (toward is not None and toward[1]):
        word = fixed[1] if fixed is not None else str(toward and toward[2]).removeprefix("the ")
        angle = {"left": 90.0, "anticlockwise": 90.0, "right": -90.0, "clockwise": -90.0}.get(word, 180.0)
        head = rest[: fixed.start()] if fixed is not None else str(toward and toward[1])
        return Turn(objects=selector.subject(re.sub(r"\bto the\b\s*$", "", head)), degrees=angle)
    raise EditRefused(f"“{clause}”: which way? For example: turn the armchair to the window, or by 90 degrees")


def _with_copies(edit: Edit) -> tuple[Edit, ...]:
    """ "two armchairs" in the place of one sofa: the second beside the first."""
    if isinstance(edit, Swap) and len(edit.objects) == 1:
        phrase = noun_phrase(edit.what)[0]
        if phrase is not None and phrase.label != edit.what and phrase.count > 1:
            return edit, Copy(objects=edit.objects, count=min(phrase.count - 1, MAX_COPIES))
    return (edit,)


def _swap(selector: Selector, clause: str, rest: str) -> Edit:
    parts = re.split(r"\s+\b(?:for|with|by|into|to)\b\s+", rest, maxsplit=1)
    if len(parts) < 2:
        raise EditRefused(f"“{clause}”: for what? For example: swap the sofa for a leather one")
    surface = _room_part(parts[0])
    if surface is not None:
        return Paint(part=surface, colour=_colour(parts[1], clause))
    ids = selector.subject(parts[0])
    what = re.sub(r"^(?:an?|some|the|another|something|anything)\s+|\s+\b(?:ones?|instead)\b", " ", parts[1]).strip()
    phrase, unknown = noun_phrase(what)
    if phrase is None and look_of(what) is None and unknown and unknown not in ("one", "ones", "different", "other"):
        raise EditRefused(f"the library has nothing called “{unknown}”; try another word")
    kind = selector.scene.object(ids[0]).category
    if (phrase is None or (look_of(what) is not None and not phrase.label)) and re.match(r"change|make", clause):
        return Restyle(objects=ids, look=what)
    return Swap(objects=ids, what=what if phrase is not None and phrase.label else f"{what} {kind}".strip())


def _room_part(text: str) -> Literal["walls", "floor", "ceiling"] | None:
    """The part of the room that a phrase names, if it names one."""
    match = re.fullmatch(r"(?:all |of |the |my |this |room's )*(walls?|floor|ceiling)", text.strip())
    if match is None:
        return None
    return "floor" if match[1] == "floor" else "ceiling" if match[1] == "ceiling" else "walls"


def _colour(text: str, clause: str) -> str:
    look = look_of(text)
    if look is None:
        raise EditRefused(
            f"“{clause}”: “{text.strip()}” is no colour or material known here; try light blue, sage, oak"
        )
    return look.words


def _look(selector: Selector, clause: str, rest: str) -> Edit:
    """ "make the chairs wooden", "paint the walls blue", "make the table bigger", "make the chair face the door"."""
    facing = re.match(r"(.*?)\s*\b(?:face|look at|point (?:at|to))\b\s+(.*)$", rest)
    if facing is not None and facing[1]:
        if facing[2] in ("each other", "one another"):
            return Move(objects=selector.subject(facing[1]), places=[Place(relation="facing", targets=[])])
        return Turn(objects=selector.subject(facing[1]), toward=selector.targets(facing[2])[0])
    resized = re.match(
        r"(.*?)\s*\b((?:a (?:bit|little) |much |\d+ ?(?:%|percent) |twice as |half as |\d+(?:\.\d+)? times )*"
        r"(?:bigger|larger|smaller|big|large|small|(?:half|twice|double) (?:the|its|their) size))$",
        rest,
    )
    if resized is not None and resized[1]:
        shrinks = bool(re.search(r"small|half", resized[2]))
        return Resize(objects=selector.subject(resized[1]), factor=_factor(resized[2], not shrinks))
    words = rest.split()
    for cut in range(1, len(words)):
        head, look = " ".join(words[:cut]), " ".join(words[cut:])
        look = re.sub(r"^(?:in|into|to|of|be|out of|look)\s+", "", look)
        if look_of(look) is None:
            continue
        surface = _room_part(head)
        if surface is not None:
            return Paint(part=surface, colour=look)
        phrase, _ = noun_phrase(split_places(head)[0])
        if phrase is None:
            continue
        return Restyle(objects=selector.subject(head), look=look)
    head, _, shaped = rest.rpartition(" ")
    ids: list[str] = []
    with suppress(EditRefused):  # what is wrong with the look is the better answer
        ids = selector.subject(head) if shaped in APPEARANCES else []
    if ids:  # "make the rug round"
        kind = selector.scene.object(ids[0]).category
        if any(has_look(shape, shaped) for shape in selector.library.in_category(kind)):
            return Swap(objects=ids, what=f"{shaped} {kind}")
    if _room_part(rest) is not None:
        raise EditRefused(f"“{clause}”: in what colour? For example: paint the walls light blue")
    raise EditRefused(f"“{clause}” names no colour, material or size known here; for example: make all chairs wooden")


def _factor(text: str, larger: bool) -> float:
    percent = re.search(r"(\d+(?:\.\d+)?) ?(?:%|percent)", text)
    times = re.search(r"(\d+(?:\.\d+)?) times", text)
    if percent is not None:
        factor = 1.0 + float(percent[1]) / 100 * (1 if larger else -1)
    elif times is not None:
        factor = float(times[1])
    else:
        named = next((f for word, f in _SCALES.items() if re.search(rf"\b{word}\b", text)), None)
        factor = named or (1.25 if larger else 0.8)
    if not 0.2 <= factor <= 5.0:
        raise EditRefused(f"a factor of {factor:g} is too much; between 0.2 and 5 is possible")
    return factor


def _inserts(selector: Selector, clause: str, rest: str) -> tuple[Edit, ...]:
    """Each of "a lamp, two plants and a rug", with the phrases of place that follow it."""
    parts = [rest] if re.search(r"\bbetween\b", rest) else split_list(rest)
    at = None if not parts else relation_pattern().search(parts[-1])
    if at is not None and not re.search(r"\b(?:it|them|each|one)\b", parts[-1][at.start() :]):
        parts = [p if split_places(p)[1] or " to " in p else f"{p} {parts[-1][at.start() :]}" for p in parts]
    return tuple(edit for part in parts for edit in _with_its_own(selector, clause, part))


def _with_its_own(selector: Selector, clause: str, rest: str) -> tuple[Edit, ...]:
    """ "a desk with an office chair by the wall" are two things, "a cabinet with two doors" is one."""
    head, _ = split_places(rest)
    match = re.match(rf"(.+?) with (?=(?:{'|'.join(NUMBERS)}|its|\d+) )(.+)$", head)
    belongings = None if match is None else noun_phrase(match[2])[0]
    carrier = None if match is None else noun_phrase(match[1])[0]
    if match is None or belongings is None or carrier is None or not belongings.label or not carrier.label:
        return (_insert(selector, clause, rest),)
    if belongings.category in (*OPENING_CATEGORIES, carrier.category) or belongings.label in _PARTS:
        return (_insert(selector, clause, rest),)
    place = re.sub(r"^(?:on|in|at|under|by|beside) (?:it|top)\b", "", rest[len(head) :].strip())
    first = _insert(selector, clause, f"{match[1]} {place}")
    name = f"new {carrier.category}"
    relation = _usual_kind(belongings.category, carrier.category)
    what = " ".join((*belongings.appearance, belongings.label))
    second = Insert(what=what, count=belongings.count, places=[Place(relation=relation, targets=[name])])
    return first.model_copy(update={"name": name}), second


def _insert(selector: Selector, clause: str, rest: str) -> Insert | Resize:
    head, places = split_places(rest)
    onto = None if places else re.match(r"(.+?) to ((?:the|my|this|all|each|every) .+)$", rest)
    if onto is not None:
        head = onto[1]
        phrase, _ = noun_phrase(head)
        if phrase is not None and not re.fullmatch(r"\w+ (?:\w+ )?room", onto[2]):
            target = selector.scene.object(selector.targets(onto[2])[0])
            places = [PlacePhrase(_usual_kind(phrase.category, target.category), onto[2])]
    purpose = None if places else re.match(r"(.+?) for ((?:the|my|this) .+)$", head)
    if purpose is not None:
        head, places = purpose[1], [PlacePhrase("near", purpose[2])]
    phrase, unknown = noun_phrase(head)
    if phrase is None or not phrase.label or phrase.beyond:
        words = unknown or (" ".join(phrase.beyond) if phrase is not None else "") or head or clause
        raise EditRefused(f"“{words}” is not understood; for example: {EXAMPLES}")
    same_kind = [o.id for o in selector.scene.objects if o.category == phrase.category]
    change = next((f for w, f in _COMPARED.items() if w in phrase.appearance), None)
    if change is not None and same_kind and not places:
        return Resize(objects=same_kind, factor=change)
    if category(phrase.category).name in OPENING_CATEGORIES:
        raise EditRefused(f"a {phrase.category} is part of the room, which edits by words leave as it is")
    wanted = places_of_phrases(selector, places)
    each = len(wanted[0].targets) if wanted and re.match(r"(?:each|every|all)\b", places[0].words) else 1
    what = " ".join((*phrase.appearance, phrase.label))
    return Insert(what=what, count=min(phrase.count * max(each, 1), MAX_COPIES), places=wanted)
