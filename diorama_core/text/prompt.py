"""What a prompt asks for: a kind of room, objects with counts and attributes, and how they stand to one another."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

from diorama_core.editing.relations import OF_ROOM, RelationKind
from diorama_core.library.taxonomy import broad, resolve
from diorama_core.synthesis import RoomKind
from diorama_core.text.phrases import MAX_OF_A_KIND, NounPhrase, Placing, noun_phrase, split_places

_ROOMS: tuple[tuple[str, RoomKind], ...] = (
    ("living room", "living"), ("sitting room", "living"), ("lounge", "living"), ("family room", "living"),
    ("reading corner", "living"), ("reading nook", "living"), ("bedroom", "bedroom"), ("guest room", "bedroom"),
    ("nursery", "bedroom"), ("home office", "study"), ("study", "study"), ("library", "study"), ("office", "office"),
    ("kitchen", "kitchen"), ("dining room", "dining"), ("dining area", "dining"), ("bathroom", "bathroom"),
    ("restroom", "bathroom"), ("laboratory", "lab"), ("lab", "lab"), ("workshop", "lab"), ("corridor", "corridor"),
    ("hallway", "corridor"), ("hall", "corridor"), ("apartment", "living"), ("room", "living"),
)  # fmt: skip
_COMPOUNDS = (
    "chair|desk|table|cabinet|counter|island|sink|stool|scale|mat|lamp|shel(?:f|ve)|unit|mirror|bench|cart|tree|rug"
)
"""After the name of a room, these name a piece of furniture."""
_JOINTS = re.compile(
    r",|;|\.|\band\b|(?<!aligned )(?<!in line )(?<!lined up )\bwith\b(?! (?:its|their) backs?)|\bplus\b|\bcontaining\b|\bfeaturing\b|\bthat has\b|\bhas\b|\bhaving\b"
    r"|\bwhile\b|\bincluding\b|\bfurnished\b|\bwhere\b|\bholding\b|\bcarrying\b"
)
_REWRITES = (
    (r"\b(?:flanked|bordered) by ([^,;.]*?)(?=,|;|\.| and a| and an| and the| with |$)", r", \1 beside it"),
    (r"\bsurrounded by ([^,;.]*?)(?=,|;|\.| and a| and an| and the| with |$)", r", \1 around it"),
    (
        r"\b(?:that |which )?(?:is |are )?(?:faces|face|facing|looks? (?:at|out of|towards?)|(?:turned|oriented) towards?)\b",
        "facing",
    ),
    (r"\bopposite (?:each other|one another)\b", "facing each other"),
    (r"\b(?:aligned|lined up|in a (?:row|line))\b(?! with)", "aligned with each other"),
    (r"\b(?:that|which|who)\b", " "),
    (
        r"\b(?:is|are|(?<!night )(?<!tv )(?<!television )(?<!coat )(?<!umbrella )(?<!hat )stands?|sits?|hangs?|lies|placed|positioned|located|standing|hanging|leaning|lying|arranged|mounted|set)\b",
        " ",
    ),
    (
        r"\bbetween (?!them\b|it\b|these\b|both\b|(?:the |two |both )?[a-z]+s\b)(.+?) and (?=(?:the |a |an )?\w)",
        r"between \1 & ",
    ),
)
"""Phrases that say the same in other words, brought to one form."""
_ASKED = re.compile(r"(?:an?|one|two|three|four|five|six|\d+|some|several|many)\b")
"""How a clause begins that asks for something of its own, and says nothing more of what came before."""
_NOT_PLACES = re.compile(
    r"^(?:the |a |an |this )?(?:[a-z]+ )?(?:room|bedroom|kitchen|office|floor|ground|space|house|home|apartment|style|corner of .*)$"
)


@dataclass(frozen=True)
class Wish:
    """How an object stands to others or to the room."""

    kind: RelationKind
    targets: tuple[str, ...] = ()
    """Categories; none for relations to the room and for objects of its own kind."""
    each_other: bool = False
    """Whether the objects of one request stand so to one another: "facing each other"."""

    @property
    def words(self) -> str:
        """As people say it."""
        if self.kind in OF_ROOM:
            return {"against wall": "against a wall", "in corner": "in a corner"}.get(self.kind, "in the middle")
        return f"{self.kind} {'each other' if self.each_other else ' and '.join(f'the {t}' for t in self.targets)}"


@dataclass(frozen=True)
class RequestedObject:
    """One kind of object that is asked for."""

    category: str
    label: str
    """The words that name it."""
    count: int = 1
    appearance: tuple[str, ...] = ()
    """Adjectives: colours, materials, styles."""
    wishes: tuple[Wish, ...] = ()


@dataclass(frozen=True)
class RoomRequest:
    """Everything a prompt asks for."""

    room: RoomKind
    objects: tuple[RequestedObject, ...]
    ignored: tuple[str, ...] = ()
    """Words that named nothing known, for a note to the user."""
    size: float = 1.0
    """How large the room should be beside a usual one."""
    named: bool = False
    """Whether the prompt names the kind of room."""


@dataclass
class _Reading:
    """What was read so far."""

    objects: list[RequestedObject] = field(default_factory=list)
    ignored: list[str] = field(default_factory=list)
    last: int = -1
    """The request that "it" means."""


def understood_prompt(prompt: str) -> RoomRequest:
    """Read a prompt in plain English; whatever is not understood is listed, never fatal."""
    text = " ".join(re.sub(r"[^a-z0-9' ,;.-]+", " ", prompt.lower()).split())
    room, rest = _room(text)
    named = rest != text
    for pattern, form in _REWRITES:
        rest = re.sub(pattern, form, rest)
    reading = _Reading()
    for clause in _JOINTS.split(rest):
        _read(reading, clause.strip())
    size = 1.25 if re.search(r"\b(large|big|spacious|huge)\b.{0,20}\broom\b", text) else 1.0
    size = (
        0.85
        if re.search(
            r"\b(small|tiny|cosy|cozy|little|corner|nook)\b.{0,12}\b(room|bedroom|office|corner|nook|kitchen|study)\b",
            text,
        )
        else size
    )
    return RoomRequest(room, tuple(reading.objects), tuple(dict.fromkeys(reading.ignored)), size, named)


def _read(reading: _Reading, clause: str) -> None:
    """Take in one clause: "two red chairs beside the table" names chairs, and a table unless it is known."""
    if not clause:
        return
    head, places = split_places(clause)
    phrase, unknown = noun_phrase(head) if head else (None, "")
    index = _subject(reading, phrase)
    asked = index is None or (phrase is None and _ASKED.match(head) is not None)
    if (
        asked
        and unknown
        and not re.fullmatch(r"(?:there|i|we|want|need|would|like|please|room|one|two|three|some)(?: .*)?", unknown)
    ):
        reading.ignored.append(unknown)
    subject = index
    for place in places:
        before = len(reading.objects)
        if place.kind != "on":
            subject = index
        _place(reading, subject, place, clause)
        # "facing a television on a tv stand": what is named anew is what is on the next.
        subject = len(reading.objects) - 1 if len(reading.objects) == before + 1 else index
    if index is not None:
        reading.last = index


def _subject(reading: _Reading, phrase: NounPhrase | None) -> int | None:
    """The request that a phrase is about: a new one, one before, or the last for "it" and for no noun at all."""
    if phrase is None or phrase.pronoun or not phrase.label:
        return reading.last if reading.last >= 0 and (phrase is None or phrase.pronoun) else None
    if phrase.definite:
        known = next((k for k, o in enumerate(reading.objects) if o.category == phrase.category), None)
        if known is not None:
            return known
    reading.objects.append(RequestedObject(phrase.category, phrase.label, phrase.count, phrase.appearance))
    return len(reading.objects) - 1


def _place(reading: _Reading, index: int | None, place: Placing, clause: str) -> None:
    """Add a wish to a request; what it refers to is asked for, too, where it was not named before."""
    if place.kind in OF_ROOM:
        _wish(reading, index, Wish(place.kind))
        if re.search(r"\bopposite walls\b", clause):
            _wish(reading, index, Wish("opposite", each_other=True))
        return
    if re.search(r"\b(?:each other|one another)\b", place.words):
        _wish(reading, index, Wish(place.kind, each_other=True))
        return
    if _NOT_PLACES.match(place.words) or not place.words:
        return
    targets: list[str] = []
    for words in re.split(r"&|\bor\b", place.words):
        target = _target(reading, words, index)
        if target is not None:
            targets.append(target)
        elif (unknown := noun_phrase(words)[1]) and place.kind not in ("on", "near"):
            reading.ignored.append(unknown)
    if not targets or index is None or targets == [reading.objects[index].category]:
        return
    request = reading.objects[index]
    hosts = sum(o.count for o in reading.objects if o.category == targets[0])
    if re.match(r"\s*(?:each|every|both)\b", place.words) or re.search(r"\bon (?:each|either|both) sides?\b", clause):
        if not re.search(r"\bsides?\b", clause):
            reading.objects[index] = replace(request, count=min(request.count * max(hosts, 1), MAX_OF_A_KIND))
        elif request.count == 1:
            reading.objects[index] = replace(request, count=2)
    kind: RelationKind = place.kind
    if kind in ("under", "beside") and set(targets) <= {"window", "door"}:
        kind = "near"
    if (
        kind in ("beside", "in front of")
        and broad(request.category) in ("chair", "office chair", "stool", "bench")
        and _sat_at(targets[0])
    ):
        kind = "around"
    _wish(reading, index, Wish(kind, tuple(targets)))


def _sat_at(category: str) -> bool:
    return broad(category) in ("table", "desk", "kitchen counter")


def _wish(reading: _Reading, index: int | None, wish: Wish) -> None:
    if index is not None and wish not in reading.objects[index].wishes:
        request = reading.objects[index]
        reading.objects[index] = replace(request, wishes=(*request.wishes, wish))


def _target(reading: _Reading, words: str, own: int | None) -> str | None:
    """Category of what a place refers to; asked for as well where it is new, but for windows and doors."""
    phrase, _ = noun_phrase(words)
    if phrase is None:
        return None
    if phrase.pronoun:
        before = (
            own - 1 if own is not None and own == len(reading.objects) - 1 and reading.last != own else reading.last
        )
        known = (
            reading.objects[reading.last if before < 0 else before] if reading.objects and reading.last >= 0 else None
        )
        return None if known is None else known.category
    if not phrase.label:
        return None
    kin = next((o.category for o in reading.objects if o.category == phrase.category), None)
    kin = kin or next(
        (o.category for o in reading.objects if o.category.endswith(f" {phrase.category}") and phrase.definite), None
    )
    if kin is None and phrase.category not in ("window", "door"):
        reading.objects.append(RequestedObject(phrase.category, phrase.label, phrase.count, phrase.appearance))
    return kin or phrase.category


def _room(text: str) -> tuple[RoomKind, str]:
    """The kind of room that is named first, and the prompt without its name."""
    begins = re.match(r"(?:an? |the )?(?:[a-z'-]+ ){1,2}(?:corner|nook|area|den)\b", text)
    if begins and noun_phrase(begins.group().rpartition(" ")[0])[0] is None and "reading" not in begins.group():
        return _guessed_room(text), f" , {text[begins.end() :]}"
    for words, kind in _ROOMS:
        match = re.search(rf"\b(?:a |an |the )?(?:[a-z'-]+ ){{0,2}}?{words}\b(?! (?:{_COMPOUNDS})s?\b)", text)
        if match and not resolve(match.group()).exact:
            start = text.index(words, match.start())
            if noun_phrase(text[match.start() : start])[0] is None and not re.match(r"(?:in|for|of)\b", match.group()):
                start_of_name = match.start()
                return kind, f"{text[:start_of_name]} , {text[start + len(words) :]}"
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
