"""What a prompt asks for: a kind of room, objects with counts and attributes, and where they go."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from diorama_core.library.taxonomy import ARCHITECTURE_WORDS, UNKNOWN, resolve
from diorama_core.synthesis import RoomKind

MAX_OF_A_KIND = 12
_NUMBERS = {
    "a": 1, "an": 1, "the": 1, "one": 1, "single": 1, "another": 1, "two": 2, "pair": 2, "couple": 2, "both": 2,
    "three": 3, "few": 3, "some": 3, "several": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8,
}  # fmt: skip
_ROOMS: tuple[tuple[str, RoomKind], ...] = (
    ("living room", "living"), ("sitting room", "living"), ("lounge", "living"), ("family room", "living"),
    ("reading corner", "living"), ("reading nook", "living"), ("bedroom", "bedroom"), ("guest room", "bedroom"),
    ("nursery", "bedroom"), ("home office", "study"), ("study", "study"), ("library", "study"), ("office", "office"),
    ("kitchen", "kitchen"), ("dining room", "dining"), ("dining area", "dining"), ("bathroom", "bathroom"),
    ("restroom", "bathroom"), ("laboratory", "lab"), ("lab", "lab"), ("workshop", "lab"), ("corridor", "corridor"),
    ("hallway", "corridor"), ("hall", "corridor"), ("apartment", "living"), ("room", "living"),
)  # fmt: skip
_PLACES: tuple[tuple[str, str], ...] = (
    ("on top of", "on"), ("next to", "beside"), ("in front of", "before"), ("on the wall above", "above"),
    ("on either side of", "beside"), ("on both sides of", "beside"), ("on each side of", "beside"),
    ("beside", "beside"), ("near", "beside"), ("by", "beside"), ("above", "above"), ("over", "above"),
    ("around", "around"), ("facing", "before"), ("opposite", "before"), ("under", "under"), ("below", "under"),
    ("in", "in"), ("on", "on"),
)  # fmt: skip
_JOINTS = re.compile(r",|;|\.|\band\b|\bwith\b|\bplus\b|\bcontaining\b|\bfeaturing\b|\bthat has\b|\bhas\b|\bhaving\b")
_FILLER = frozenset(
    {"of", "there", "is", "are", "it", "its", "which", "that", "this", "at", "to", "for", "each", "every"}
)
_APPEARANCES = (
    "red,orange,yellow,green,blue,purple,pink,brown,black,white,grey,gray,beige,cream,navy,teal,golden,silver,dark,"
    "light,bright,wooden,wood,oak,walnut,pine,birch,teak,bamboo,metal,steel,iron,brass,chrome,glass,marble,stone,leather,"
    "fabric,velvet,linen,wicker,rattan,plastic,upholstered,modern,scandinavian,rustic,vintage,classic,industrial,"
    "minimalist,traditional,mid-century,farmhouse,round,square,rectangular,oval,large,big,small,tiny,tall,low,long,wide,"
    "narrow,short,old,new,comfortable,cosy,cozy,elegant,beautiful,nice,simple,high,empty,open,matching"
)
APPEARANCES = frozenset(_APPEARANCES.split(","))
"""Words that say how an object looks, not what it is."""


@dataclass(frozen=True)
class RequestedObject:
    """One kind of object that is asked for."""

    category: str
    label: str
    """The words that name it."""
    count: int = 1
    appearance: tuple[str, ...] = ()
    """Adjectives: colours, materials, styles."""
    place: str = ""
    """"on", "beside", "before", "above", "around", "under"; empty where it does not matter."""
    target: str = ""
    """Category of what the place refers to."""


@dataclass(frozen=True)
class RoomRequest:
    """Everything a prompt asks for."""

    room: RoomKind
    objects: tuple[RequestedObject, ...]
    ignored: tuple[str, ...] = ()
    """Words that named nothing known, for a note to the user."""
    size: float = 1.0
    """How large the room should be beside a usual one."""


def understood_prompt(prompt: str) -> RoomRequest:
    """Read a prompt in plain English; whatever is not understood is listed, never fatal."""
    text = " ".join(re.sub(r"[^a-z0-9' ,;.-]+", " ", prompt.lower()).split())
    room, rest = _room(text)
    objects: list[RequestedObject] = []
    ignored: list[str] = []
    for clause in _JOINTS.split(rest):
        found, unknown = _clause(clause.strip(), objects)
        objects += found
        ignored += unknown
    size = 1.25 if re.search(r"\b(large|big|spacious|huge)\b.{0,20}\broom\b", text) else 1.0
    size = 0.85 if re.search(r"\b(small|tiny|cosy|cozy|little|corner|nook)\b", text) else size
    return RoomRequest(room, tuple(objects), tuple(dict.fromkeys(ignored)), size)


def _room(text: str) -> tuple[RoomKind, str]:
    """The kind of room that is named first, and the prompt without its name."""
    for words, kind in _ROOMS:
        match = re.search(rf"\b(?:a |an |the )?(?:[a-z-]+ ){{0,2}}?{words}\b", text)
        if match and not resolve(match.group()).exact:
            start = text.index(words, match.start())
            before = re.sub(
                r"\b(?:a|an|the|small|large|big|cosy|cozy|tiny|spacious|modern|bright)\s*$", "", text[:start]
            )
            return kind, f"{before} , {text[start + len(words) :]}"
    return _guessed_room(text), text


def _guessed_room(text: str) -> RoomKind:
    hints: tuple[tuple[str, RoomKind], ...] = (
        (r"\bbeds?\b|night ?stand", "bedroom"),
        (r"\bdesks?\b|\bmonitor|computer", "study"),
        (r"\bstove|\bfridge|refrigerator|kitchen", "kitchen"),
        (r"\btoilet|bathtub|shower", "bathroom"),
        (r"dining", "dining"),
    )
    return next((kind for pattern, kind in hints if re.search(pattern, text)), "living")


def _clause(clause: str, before: list[RequestedObject]) -> tuple[list[RequestedObject], list[str]]:
    """The objects of one clause: "two red chairs beside the table" names chairs, and a table unless it is known."""
    for words, place in _PLACES:
        parts = re.split(rf"\b{words}\b", clause, maxsplit=1)
        if len(parts) < 2:
            continue
        requested, unknown = _phrase(parts[0])
        target, more = _phrase(parts[1])
        if requested is not None and target is not None and re.match(r"\s*(each|every|both)\b", parts[1]):
            hosts = sum(t.count for t in before if t.category == target.category)
            requested = replace(requested, count=requested.count * max(hosts, 1))
        if target is None and before and re.match(r"\s*(it|them|top)\b", parts[1]):
            target = before[-1]  # "a sideboard with a vase on it"
        if place == "in" or target is None:
            return ([requested] if requested else []) + ([target] if target else []), unknown + more
        known = any(t.category == target.category for t in before)
        host = [] if known else [target]
        if requested is None and before and not parts[0].strip():
            before[-1] = _placed(before[-1], place, target.category)
            return host, unknown + more
        return [*host, *([_placed(requested, place, target.category)] if requested else [])], unknown + more
    requested, unknown = _phrase(clause)
    return ([requested] if requested else []), unknown


def _placed(requested: RequestedObject, place: str, target: str) -> RequestedObject:
    return replace(requested, place=place, target=target)


def _phrase(phrase: str) -> tuple[RequestedObject | None, list[str]]:
    """A noun phrase: count, attributes, noun."""
    left, of, _ = phrase.partition(" of ")
    if of and (head := _phrase(left))[0] is not None:
        return head  # "a vase of flowers" is a vase; "a pair of chairs" goes on below
    words = [w for w in re.findall(r"[a-z0-9'-]+", phrase) if w not in _FILLER]
    count = 1
    while words and (words[0] in _NUMBERS or words[0].isdigit()):
        count = max(count, int(words[0]) if words[0].isdigit() else _NUMBERS[words[0]])
        words = words[1:]
    if not words:
        return None, []
    appearance = tuple(w for w in words if w in APPEARANCES)
    words = [w for w in words if w not in APPEARANCES] or words
    for start in range(len(words)):
        for end in range(len(words), start, -1):
            noun = " ".join(words[start:end])
            found = resolve(noun)
            if noun in ARCHITECTURE_WORDS:
                return None, []
            if found.exact and found.category is not UNKNOWN:
                plural = count == 1 and noun.endswith("s") and not found.category.name.endswith("s")
                many = 2 if plural else count
                return RequestedObject(found.category.name, noun, min(many, MAX_OF_A_KIND), appearance), []
    return None, [" ".join(words)]
