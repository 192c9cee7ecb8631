"""What a prompt asks for: a kind of room, objects with counts and attributes, and how they stand to one another."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

from diorama_core.editing.habits import usual_relations_of
from diorama_core.editing.relations import OF_ROOM, SEATS, RelationKind
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.library.taxonomy import broad, category, having, is_furniture, resolve
from diorama_core.synthesis import RoomKind
from diorama_core.text.foreign_words import to_english
from diorama_core.text.phrases import MAX_OF_A_KIND, NUMBERS, NounPhrase, PlacePhrase, noun_phrase, split_places
from diorama_core.text.rows import with_marks

ROOMS: tuple[tuple[str, RoomKind], ...] = (
    ("living room", "living"), ("sitting room", "living"), ("lounge", "living"), ("family room", "living"),
    ("reading corner", "living"), ("reading nook", "living"), ("bedroom", "bedroom"), ("guest room", "bedroom"),
    ("nursery", "bedroom"), ("children's room", "bedroom"), ("child's room", "bedroom"),
    ("kids' room", "bedroom"), ("kids room", "bedroom"), ("kid's room", "bedroom"), ("home office", "study"), ("study", "study"), ("library", "study"), ("office", "office"),
    ("kitchen", "kitchen"), ("dining room", "dining"), ("dining area", "dining"), ("bathroom", "bathroom"),
    ("restroom", "bathroom"), ("classroom", "lab"), ("laboratory", "lab"), ("lab", "lab"), ("workshop", "lab"), ("corridor", "corridor"),
    ("hallway", "corridor"), ("hall", "corridor"), ("apartment", "living"), ("cinema", "living"), ("room", "living"),
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
    (r"\b(one|two|three|four|[1-4])[ -]seat(?:er)?s?\b", r"\1-seater"),
    (r"\b(?:flanked|bordered) by ([^,;.]*?)(?=,|;|\.| and a| and an| and the| with |$)", r", \1 beside it"),
    (r"\bsurrounded by ([^,;.]*?)(?=,|;|\.| and a| and an| and the| with |$)", r", \1 around it"),
    (
        r"\b(?:that |which )?(?:is |are )?(?:faces|face|facing|looks? (?:at|out of|towards?)|(?:turned|oriented) towards?)\b",
        "facing",
    ),
    (r"\bopposite (?:each other|one another)\b", "facing each other"),
    (r"\bside by side\b|\bnext to (?:each other|one another)\b", "beside each other"),
    (r"\bat its foot\b", "at the foot of it"),
    (r"\b(?:at|by|on) its sides?\b", "beside it"),
    (r"\b(?:on|to|at) its (left|right)\b", r"\1 of it"),
    (r"\b(?:aligned|lined up)\b(?! with)", "aligned with each other"),
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
_SAYS_NOTHING = re.compile(r"(?:there|i|we|want|need|would|like|please|room|one|two|three|some)(?: .*)?")
_SEATS_FOR = re.compile(
    r"\bfor (two|three|four|five|six|seven|eight|nine|ten|twelve|\d\d?)(?: people| persons| guests| diners)?(?=,|;|\.|$| and\b| with\b)"
)
"""How many are to sit: "a dining room for six"."""
_EACH = re.compile(r"^(?:(.*) )?(?:each|both)(?: of (?:them|these|those|the \w+))?$")
"""A clause after which everything is meant once for each: "two desks, each with a lamp"."""
_FIGURES = re.compile(r"\b(?:an? )((?:l|u|ring|circle|semicircle|half circle|triangle)(?:[ -]shaped?)? of)\b")
"""Arrangements that are read as no relation."""
_NOT_WISHED = re.compile(
    r"\b(?:(?:with|has|have|having|there (?:is|are)|needs?|want) )?(?:no|without|not any)(?: any| a| an)? "
    r"((?:[a-z-]+ )*?[a-z-]+?(?:,? (?:or|nor) (?:any |a |an |no )?(?:[a-z-]+ )*?[a-z-]+?)*)(?=,|;|\.| and | but | with | in | on | at | by |$)"
)
"""What the room is to do without: "no curtains", "without a rug or pictures"."""
_BEFORE_ROOM = re.compile(r"\b(?:a|an|the|small|large|big|cosy|cozy|tiny|spacious|modern|bright)\s*$")
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
    rows: int = 0
    """In how many rows they stand; 0 where nothing is said."""


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
    excluded: tuple[str, ...] = ()
    """Categories that the room is to do without."""


@dataclass
class _Reading:
    """What was read so far."""

    objects: list[RequestedObject] = field(default_factory=list)
    ignored: list[str] = field(default_factory=list)
    last: int = -1
    """The request that "it" means."""
    hosts: int | None = None
    """The request for each of which the following ones are meant."""
    waiting: list[tuple[PlacePhrase, str]] = field(default_factory=list)
    """Places, with their clauses, that were named before any object: "a reading nook by the window"."""


def read_prompt(prompt: str) -> RoomRequest:
    """Read a prompt in plain English, German, French or Spanish; what is not understood is listed, never fatal."""
    text = " ".join(re.sub(r"[^a-z0-9' ,;.-]+", " ", to_english(prompt).lower()).split())
    room, rest = _room(text)
    named = rest != text
    rest, excluded = _without_unwished(rest)
    rest, too_long = with_marks(rest)
    for pattern, form in _REWRITES:
        rest = re.sub(pattern, form, rest)
    reading = _Reading(ignored=[*too_long, *(match.group(1) for match in _FIGURES.finditer(rest))])
    for sentence in re.split(r"[;.]", rest):
        reading.hosts = None
        for clause in _JOINTS.split(sentence):
            _read(reading, clause.strip())
    _add_seats(reading, room, text)
    ignored = tuple(dict.fromkeys(reading.ignored))
    return RoomRequest(room, tuple(reading.objects), ignored, _size(text), named, excluded)


def _size(text: str) -> float:
    small = r"\b(small|tiny|cosy|cozy|little|corner|nook)\b.{0,12}\b(room|bedroom|office|corner|nook|kitchen|study)\b"
    if re.search(small, text):
        return 0.85
    return 1.25 if re.search(r"\b(large|big|spacious|huge)\b.{0,20}\broom\b", text) else 1.0


def _without_unwished(text: str) -> tuple[str, tuple[str, ...]]:
    """A prompt without what it says the room is to do without, and the categories of that."""
    excluded: list[str] = []
    for match in _NOT_WISHED.finditer(text):
        phrases = (noun_phrase(words)[0] for words in re.split(r",|\bn?or\b", match[1]))
        openings = (name for name in ("window", "door") if re.search(rf"\b{name}s?\b", match[1]))
        excluded += [*(p.category for p in phrases if p is not None and p.label), *openings]
    return _NOT_WISHED.sub(" ", text), tuple(dict.fromkeys(excluded))


def _read(reading: _Reading, clause: str) -> None:
    """Take in one clause: "two red chairs beside the table" names chairs, and a table unless it is known."""
    each = _EACH.match(clause)
    if each is not None:
        _read(reading, each[1] or "")
        reading.hosts = reading.last if reading.last >= 0 and reading.objects[reading.last].count > 1 else None
        return
    if not clause:
        return
    head, places = split_places(clause)
    phrase, unknown = noun_phrase(head) if head else (None, "")
    index = _subject(reading, phrase)
    if index is None and not head and not reading.objects:
        reading.waiting += [(place, clause) for place in places]
        return
    if index is not None:
        waiting, reading.waiting = reading.waiting, []
        for place, text in waiting:
            _place(reading, index, place, text)
    asked = index is None or (phrase is None and _ASKED.match(head) is not None)
    if asked and unknown and not _SAYS_NOTHING.fullmatch(unknown):
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
    count = min(phrase.count * _times(reading, phrase.category), max(MAX_OF_A_KIND, phrase.count))
    reading.objects.append(_request(phrase, count))
    return len(reading.objects) - 1


def _request(phrase: NounPhrase, count: int) -> RequestedObject:
    """Rows are of what stands on the floor; what hangs or lies on others in a row is aligned."""
    request = RequestedObject(phrase.category, phrase.label, count, phrase.appearance)
    if not phrase.rows or count < 2:
        return request
    if category(phrase.category).mount == "floor":
        return replace(request, rows=min(phrase.rows, count))
    return replace(request, wishes=(Wish("aligned with", each_other=True),))


def _times(reading: _Reading, category: str) -> int:
    """How often something is meant: once for each host, where its kind usually goes with theirs."""
    if reading.hosts is None:
        return 1
    host = reading.objects[reading.hosts]
    usual = usual_relations_of(category)
    return host.count if any({host.category, broad(host.category)} & set(names) for _, names in usual) else 1


def _add_seats(reading: _Reading, room: RoomKind, text: str) -> None:
    """Chairs for as many as a table or a dining room is for, where none are asked for."""
    match = _SEATS_FOR.search(text)
    table = next((o.category for o in reading.objects if broad(o.category) == "table"), None)
    seated = any(o.category in having("drawn_up") for o in reading.objects)
    if match is None or seated or (table is None and room != "dining"):
        return
    count = int(match[1]) if match[1].isdigit() else NUMBERS[match[1]]
    around = Wish("around", (table or "table",))
    reading.objects.append(RequestedObject("chair", "chair", max(1, min(count, MAX_OF_A_KIND)), wishes=(around,)))


def _place(reading: _Reading, index: int | None, place: PlacePhrase, clause: str) -> None:
    """Add a wish to a request; what it refers to is asked for, too, where it was not named before."""
    if place.kind in OF_ROOM:
        _wish(reading, index, Wish(place.kind))
        if re.search(r"\bopposite walls\b", clause):
            _wish(reading, index, Wish("opposite", each_other=True))
        return
    if re.search(r"\b(?:each other|one another)\b", place.words):
        _each_other(reading, index, place.kind)
        return
    if _NOT_PLACES.match(place.words) or not place.words:
        return
    targets: list[str] = []
    for words in re.split(r"&|\bor\b", place.words):
        target = _target(reading, words, index, place.kind)
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
    if kind in ("under", "beside") and set(targets) <= set(OPENING_CATEGORIES):
        kind = "near"
    if kind in ("beside", "in front of") and request.category in having("drawn_up") and _sat_at(targets[0]):
        kind = "around"
    _wish(reading, index, Wish(kind, tuple(targets)))


def _each_other(reading: _Reading, index: int | None, kind: RelationKind) -> None:
    """Several of one kind stand so to one another; "a washer and a dryer side by side" are one of two kinds each."""
    if index is None:
        return
    current, before = reading.objects[index], reading.objects[index - 1] if index else None
    if current.count > 1 or before is None or before.category == current.category:
        _wish(reading, index, Wish(kind, each_other=True))
        return
    _wish(reading, index, Wish(kind, (before.category,)))
    if kind in ("facing", "opposite"):
        _wish(reading, index - 1, Wish(kind, (current.category,)))


_SAT_AT = frozenset(name for seat in having("drawn_up") for name in category(seat).tucked_under or ())


def _sat_at(category: str) -> bool:
    return broad(category) in _SAT_AT


def _wish(reading: _Reading, index: int | None, wish: Wish) -> None:
    if index is not None and wish not in reading.objects[index].wishes:
        request = reading.objects[index]
        reading.objects[index] = replace(request, wishes=(*request.wishes, wish))


def _referent(reading: _Reading, index: int | None, kind: RelationKind, several: bool) -> str | None:
    """Category of what "it" means: the last before that can be what the relation says, else the last at all.

    Things are on what carries things, and stand near furniture rather than near its lamps and plants: in "an armchair,
    a floor lamp and a bookshelf near it" the bookshelf is near the armchair. "Them" are several.
    """
    if not reading.objects or reading.last < 0:
        return None
    newest = index is not None and index == len(reading.objects) - 1 and reading.last != index
    last = index - 1 if newest and index else reading.last
    named = reading.objects[: last + 1]
    named = [o for o in named if o.count > 1 or not several] or named
    before = [o.category for o in named][::-1] or [reading.objects[reading.last].category]
    if kind != "on":
        return next((name for name in before if is_furniture(name)), before[0])
    carriers = [name for name in before if category(name).supports_objects]
    what = reading.objects[index].category if index is not None else ""
    relations = usual_relations_of(what) if what else ()
    usual = {name for relation, names in relations if relation == "on" for name in names}
    # A lamp is on the table rather than on one of its chairs, a cushion on a chair.
    unsat = [name for name in carriers if name not in SEATS or broad(name) in usual]
    return next(iter([*unsat, *carriers]), before[0])


def _target(reading: _Reading, words: str, index: int | None, kind: RelationKind) -> str | None:
    """Category of what a place refers to; asked for as well where it is new, but for windows and doors."""
    phrase, _ = noun_phrase(words)
    if phrase is None:
        return None
    if phrase.pronoun:
        return _referent(reading, index, kind, phrase.count > 1)
    if not phrase.label:
        return None
    known = [o.category for o in reading.objects]
    kin = phrase.category if phrase.category in known else None
    if kin is None and phrase.definite:
        kin = next((name for name in known if name.endswith(f" {phrase.category}")), None)
    if kin is None and phrase.category not in OPENING_CATEGORIES:
        # "A lamp on each night stand" means at least two.
        count = max(phrase.count, 2) if phrase.every else phrase.count
        reading.objects.append(_request(phrase, count))
    return kin or phrase.category


def _room(text: str) -> tuple[RoomKind, str]:
    """The kind of room that is named first, and the prompt without its name."""
    begins = re.match(r"(?:an? |the )?(?:[a-z'-]+ ){1,2}(?:corner|nook|area|den)\b", text)
    if begins and noun_phrase(begins.group().rpartition(" ")[0])[0] is None and "reading" not in begins.group():
        return _guess_room(text), f" , {text[begins.end() :]}"
    for words, kind in ROOMS:
        match = re.search(rf"\b(?:a |an |the )?(?:[a-z'-]+ ){{0,2}}?{words}\b(?! (?:{_COMPOUNDS})s?\b)", text)
        if match and not resolve(match.group()).exact:
            start = text.index(words, match.start())
            before = text[: match.start()]
            if noun_phrase(text[match.start() : start])[0] is not None or re.match(r"(?:in|for|of)\b", match.group()):
                before = _BEFORE_ROOM.sub("", text[:start])
            return kind, f"{before} , {text[start + len(words) :]}"
    return _guess_room(text), text


def _guess_room(text: str) -> RoomKind:
    hints: tuple[tuple[str, RoomKind], ...] = (
        (r"\bbeds?\b|night ?stand", "bedroom"),
        (r"\bdesks?\b|\bmonitor|computer", "study"),
        (r"\bstove|\bfridge|refrigerator|kitchen", "kitchen"),
        (r"\btoilet|bathtub|shower", "bathroom"),
        (r"dining", "dining"),
    )
    return next((kind for pattern, kind in hints if re.search(pattern, text)), "living")
