"""Noun phrases and phrases of place in plain English: counts, attributes, nouns, relations."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache

from diorama_core.editing.relations import RelationKind
from diorama_core.library.taxonomy import ARCHITECTURE_WORDS, UNKNOWN, Category, resolve
from diorama_core.text.looks import MATERIALS
from diorama_core.text.rows import MAX_IN_ROWS, USUAL_IN_ROW, without_marks

NUMBERS = {
    "a": 1, "an": 1, "the": 1, "one": 1, "another": 1, "two": 2, "pair": 2, "couple": 2, "both": 2,
    "three": 3, "few": 3, "some": 3, "several": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8, "nine": 9,
    "ten": 10, "eleven": 11, "twelve": 12, "dozen": 12,
}  # fmt: skip
MAX_OF_A_KIND = 12
EVERY = frozenset({"all", "every", "each", "everything", "both"})
_FILLER = frozenset(
    {"of", "there", "is", "are", "it", "its", "which", "that", "this", "at", "to", "for", "each", "every", "all", "my",
     "these", "those", "our", "your", "please", "just", "also", "set", "new", "other", "more", "piece", "pieces", "then",
     "them", "and", "on", "in", "whole", "either", "standing", "hanging", "sitting", "placed", "lying"}
)  # fmt: skip
_ADVERBS = frozenset(
    {"back", "up", "down", "over", "away", "along", "around", "together", "apart", "again", "too", "closer", "nearer",
     "close", "right", "left", "straight", "exactly", "directly", "further", "so", "they", "here", "face", "all", "now"}
)  # fmt: skip
"""What may follow a noun and says how something is done, not what it is."""
_OF_CLAUSES = frozenset({"where", "when", "if", "until", "unless", "than", "how", "what", "who", "not", "without"})
"""A phrase with one of these says more than which object is meant."""
APPEARANCES = frozenset(
    {*MATERIALS, "red", "orange", "yellow", "green", "blue", "purple", "pink", "brown", "black", "white", "grey",
     "gray", "beige", "cream", "navy", "teal", "turquoise", "golden", "gold", "silver", "burgundy", "olive", "sage",
     "mustard", "tan", "charcoal", "ivory", "violet", "lilac", "coral", "terracotta", "dark", "light", "pale", "deep",
     "bright", "wooden", "metallic", "upholstered", "modern", "scandinavian", "rustic", "vintage", "classic",
     "industrial", "minimalist", "traditional", "mid-century", "farmhouse", "round", "square", "rectangular", "oval",
     "large", "big", "small", "tiny", "tall", "low", "long", "wide", "narrow", "short", "huge", "little", "old",
     "comfortable", "cosy", "cozy", "elegant", "beautiful", "nice", "simple", "high", "empty", "open", "matching",
     "soft", "hard", "patterned", "striped", "persian", "framed", "padded", "colourful", "colorful", "slim", "antique",
     "contemporary", "comfy", "plush", "stainless", "potted", "double", "single", "twin", "one-seater", "two-seater",
     "three-seater", "four-seater", "king", "queen", "larger", "bigger", "smaller", "largest", "biggest", "smallest",
     "sleek", "warm", "lovely"}
)  # fmt: skip
"""Words that say how an object looks, not what it is."""
RELATION_WORDS: tuple[tuple[str, RelationKind | None], ...] = (
    (r"on (?:either|both|each|the other|the opposite|one) sides? of", "beside"), (r"(?:flanked|surrounded) by", None),
    (r"on the wall above", "above"), (r"(?:on|to|at) the left(?: hand)?(?: side)? of", "left of"),
    (r"(?:on|to|at) the right(?: hand)?(?: side)? of", "right of"), (r"left of", "left of"), (r"right of", "right of"),
    (r"(?:at|on|by) (?:the |one |either |each )?(?:far |other |very )?(?:ends?|head) of", "beside"), (r"on top of", "on"), (r"next to|beside|alongside|adjacent to|at the side of|close by", "beside"),
    (r"in front of", "in front of"), (r"at the foot of", "in front of"), (r"behind|in back of", "behind"),
    (r"across from|opposite(?: to| from)?", "opposite"), (r"facing|looking at|turned to(?:wards?)?", "facing"),
    (r"in line with|aligned with|lined up with", "aligned with"), (r"between|in between", "between"),
    (r"(?:all )?around|round about|surrounding", "around"),
    (r"(?:with (?:its|their) backs? to|up against|against|along|at|by|to|near|next to|onto|on) (?:the|a|one|any|opposite) "
     r"(?:back |long |far |same |left |right |opposite |other |front )?walls?", "against wall"),
    (r"(?:in|into|to|at) (?:the|a|one|each|opposite|another|any) (?:far |back |same |other |opposite |left |right |front )*corners?(?! table| sofa| desk)"
     r"(?: of (?:the|this) room)?", "in corner"),
    (r"(?:in|into|to|at) the (?:middle|cent(?:re|er))(?: of (?:the|this) (?:\w+ )?(?:room|floor|bedroom|kitchen|office|space))?",
     "in middle"),
    (r"above|over", "above"), (r"underneath|under|below|beneath", "under"), (r"close to|near to|near", "near"),
    (r"by|at", "beside"), (r"inside|in|into|onto|upon|on", "on"), (r"beside", "beside"), (r"to", None),
)  # fmt: skip
"""Phrases of place, what is longer first, and the relation that each names."""


@dataclass(frozen=True)
class NounPhrase:
    """Some objects in words: "two dark chairs"."""

    label: str
    """The words that name it, as they were written; empty for "it", "everything" and the like."""
    category: str
    count: int = 1
    appearance: tuple[str, ...] = ()
    definite: bool = False
    """Whether it means objects that are known: "the chair", "my desk"."""
    every: bool = False
    """Whether it means all of them."""
    plural: bool = False
    pronoun: bool = False
    rows: int = 0
    """In how many rows they stand; 0 where nothing is said."""
    beyond: tuple[str, ...] = ()
    """Words after the noun that say nothing known: what precedes it may be any attribute, what follows is of a place."""


@dataclass(frozen=True)
class PlacePhrase:
    """One phrase of place: what relation, and to what."""

    kind: RelationKind
    words: str
    """What it refers to, in words; empty for relations to the room."""
    said: str = ""
    """The phrase itself: "against the left wall"."""


@cache
def relation_pattern() -> re.Pattern[str]:
    """All phrases of place."""
    return re.compile(
        "|".join(f"(?P<r{k}>\\b(?:{words})\\b)" for k, (words, kind) in enumerate(RELATION_WORDS) if kind)
    )


def split_places(text: str) -> tuple[str, list[PlacePhrase]]:
    """The words before the first phrase of place, and each phrase with what it refers to."""
    matches = list(relation_pattern().finditer(text))
    if not matches:
        return text.strip(), []
    phrases = []
    for match, after in zip(matches, [*matches[1:], None]):
        kind = RELATION_WORDS[int(str(match.lastgroup)[1:])][1]
        assert kind is not None
        words = text[match.end() : after.start() if after else len(text)].strip(" ,")
        phrases.append(PlacePhrase(kind, words, match[0]))
    return text[: matches[0].start()].strip(), phrases


def split_list(text: str) -> list[str]:
    """The parts of "the desk, the chair and the lamp"."""
    return [part.strip() for part in re.split(r",\s*(?:and\s+)?|\band\b", text) if part.strip()]


def noun_phrase(text: str) -> tuple[NounPhrase | None, str]:
    """Count, attributes and noun of a phrase, and the words that name nothing known (empty where all are known)."""
    left, of, right = text.partition(" of ")
    if of:
        head = noun_phrase(left)[0]
        if head is not None and head.label and not re.fullmatch(r"(?:a |the )?(?:pair|couple|set|few)s?", left.strip()):
            return head, ""  # "a vase of flowers" is a vase; "a pair of chairs" is chairs
        text = f"{left} {right}"
    raw = re.findall(r"[a-z0-9'-]+", text.lower())
    definite = any(w in ("the", "this", "these", "those", "my", "our", "that") for w in raw[:3])
    every = any(w in EVERY for w in raw)
    if raw and all(
        w in ("it", "them", "that", "this", "one", "ones", "top", "the", "both", "these", "those") for w in raw
    ):
        return NounPhrase("", "", 2 if "them" in raw or "both" in raw else 1, (), True, "both" in raw, False, True), ""
    if raw and raw[-1] in ("everything", "things", "objects", "furniture", "all", "items", "stuff"):
        return NounPhrase("", "", 1, tuple(w for w in raw[:-1] if w in APPEARANCES), True, True, True), ""
    count = 1
    words: list[str] = []
    raw, in_rows = without_marks(raw)
    for word in raw:
        if not words and (word in NUMBERS or word.isdigit()):
            count = max(count, int(word) if word.isdigit() else NUMBERS[word])
        elif word not in _FILLER and word not in ("the", "a", "an"):
            words.append(word)
    if not words:
        return None, ""
    known = _noun(words)
    if known is None:
        rest = [w for w in words if w not in APPEARANCES]
        return None, " ".join(rest)
    start, end, category_name = known
    label = " ".join(words[start:end])
    appearance = tuple(w for w in words[:start] + words[end:] if w in APPEARANCES)
    beyond = tuple(w for w in words[end:] if w not in APPEARANCES | _ADVERBS) + tuple(
        w for w in words[:start] if w in _OF_CLAUSES
    )
    last = words[end - 1]
    plural = (
        last.endswith("s")
        and not last.endswith("ss")
        and not category_name.endswith("s")
        and last != category_name.split()[-1]
    )
    rows, most = 0, MAX_OF_A_KIND
    if in_rows is not None:
        rows, each = in_rows
        most = MAX_IN_ROWS
        count = rows * (each or (USUAL_IN_ROW if plural else 1)) if count == 1 else count
    elif plural and count == 1:
        count = 2
    several = plural or count > 1
    return NounPhrase(
        label, category_name, min(count, most), appearance, definite, every, several, rows=rows, beyond=beyond
    ), ""


def _noun(words: list[str]) -> tuple[int, int, str] | None:
    """The last and longest run of words that is a name: where it begins and ends, and its category."""
    for end in range(len(words), 0, -1):
        for start in range(end):
            noun = " ".join(words[start:end])
            if noun in ARCHITECTURE_WORDS:
                return None
            resolution = resolve(noun)
            if resolution.exact and resolution.category is not UNKNOWN and _is_name(noun, resolution.category):
                return start, end, resolution.category.name
    return None


def _is_name(noun: str, kind: Category) -> bool:
    """Whether the whole phrase names the category, rather than its last words."""
    forms = {
        noun,
        noun.removesuffix("s"),
        noun.removesuffix("es"),
        re.sub("ves$", "f", noun),
        re.sub("ies$", "y", noun),
    }
    return bool(forms & {kind.name, *kind.synonyms})
