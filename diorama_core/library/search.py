"""Finding shapes by words: "oak bookcase", "blue couch under 180 cm", "keeps food cold".

Kinds by what they are for: "keeps food cold", "something to sit on at a desk".

`definitions.txt` says of every kind in plain words what people do with it, what it is made of and where it stands. A
description is compared with all of them: the share of its words that a definition has, rare words counting more
(inverse document frequency, Spärck Jones 1972), in their stems, and less for words that only share a part.
"""

from __future__ import annotations

import difflib
import weakref
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from math import log
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.library import taxonomy
from diorama_core.library.language import (
    IGNORED,
    JOINTS,
    SizeLimit,
    SizeRequest,
    broader,
    narrower,
    size_limits,
    size_request,
    tokens,
)
from diorama_core.library.naming import TextQuery, understand
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN

CATEGORY_POINTS = 3.0
KIN_POINTS = 2.0
"""A special kind of what was asked for (a high chair for a chair), or the general kind."""
WORD_POINTS = 1.0
NAME_WORD_POINTS = 0.4
"""Words of the category's name count less: they have named the category already."""
CONCEPT_POINTS = 0.8
"""`oak` where wood was asked for."""
GENERAL_POINTS = 0.4
"""`wood` where oak was asked for."""
SPELLING_POINTS = 0.6
SIZE_POINTS = 0.7
SIZE_WORD_POINTS = 0.15
"""A caption that says "tall" counts little: sizes are measured."""
DESCRIPTION_POINTS = 4.0
"""Points of a kind whose definition has all words of a description; half of it beside an exact name."""
MIN_DESCRIBED = 0.25
"""Share of a description's words that a definition must have."""
BESIDE_DESCRIPTION = 0.3
"""Share that counts of a word that tells a use and no look."""
LIMIT_POINTS = 2.5
"""Lost by a shape that is larger or smaller than asked: what fits comes first."""
NOWHERE: Int[np.ndarray, "0"] = np.zeros(0, int)
_SPELLING_CUTOFF = 0.8
_MIN_SIZE_M = 0.01
_FILE = Path(__file__).with_name("definitions.txt")
_SILENT = (IGNORED | JOINTS | frozenset({
    "and", "or", "you", "he", "she", "they", "them", "us", "one", "who", "where", "which", "what", "while", "when",
    "as", "up", "out", "down", "off", "away", "through", "itself", "yourself", "somebody", "someone", "thing", "stuff",
    "use", "used", "place", "somewhere", "anything", "furniture", "object", "item", "do", "doe", "can", "have", "ha",
    "so", "if", "all", "more", "than", "not", "no", "there", "get", "put", "let", "make", "go", "everything",
}))  # fmt: skip
"""Words that tell no kind from another."""
_OPENERS = frozenset({
    "something", "anything", "somewhere", "thing", "things", "what", "where", "which", "to", "you", "used", "lets",
    "place", "furniture", "makes", "puts", "goes",
})  # fmt: skip
"""First words of descriptions; the verbs with which definitions begin are others."""
_ENDINGS = ("ing", "edly", "ed", "er", "ly", "y", "e", "s")
_SHORTEST_STEM, _SHORTEST_PART = 3, 4
_PART_WORTH = 0.7
"""Worth of a word that only begins like one of the definition's."""
_NAME_WORTH = 0.6
"""Worth of words of a kind's names, which say less of its use."""


@dataclass(frozen=True)
class FoundShapes:
    """What a search found, and what there is to say about how the text was understood."""

    shapes: tuple[Shape, ...]
    """Best first."""
    scores: tuple[float, ...]
    query: TextQuery
    note: str = ""
    """For the user, when something was not known."""


def search(library: ShapeLibrary, text: str, k: int = 24) -> tuple[Shape, ...]:
    """The `k` shapes that fit the words best, best first; all in their stable order when there are no words."""
    return find(library, text, k).shapes


def find(library: ShapeLibrary, text: str, k: int = 24) -> FoundShapes:
    """The `k` shapes that fit the words best, with notes on how the words were understood.

    Names of categories (synonyms, plurals, near names: `naming`) weigh most, then words of the caption, the style, the
    id and the shape's own synonyms, also by meaning ("wooden" finds oak) and comparative size ("small", "tall", or a
    size such as "60 x 50 x 110 cm"), then limits ("under 50 cm", "at least 2 m wide"). Where the text tells what a
    thing is for and names none ("keeps food cold"), kinds are found by their definitions (`definitions`). Nothing that
    shares neither a category nor a word nor a use with the text is found.
    """
    return find_in(text_index(library), text, k)


def find_in(index: TextIndex, text: str, k: int = 24) -> FoundShapes:
    """As `find`, in an index made before."""
    rest, limits = size_limits(text)
    query = understand(rest)
    if not tokens(text):
        return FoundShapes(index.shapes[:k], (0.0,) * min(k, len(index.shapes)), query)
    described = {kind: share for kind, share in kinds_described(rest).items() if share >= MIN_DESCRIBED}
    if described and is_description(rest):
        query = replace(query, categories=(), naming=(), exact=False, note="")
    elif query.categories and not query.exact and len(query.words) < 2:
        described = {}  # a slip of the pen
    elif described and not query.categories:
        query = replace(query, note="")
    scores = index.scores(query, described, limits)
    positions = np.flatnonzero(scores > 0)
    order = positions[np.lexsort((positions, -scores[positions]))][:k]
    known = not query.categories and any(index.knows(word) for word in query.words)  # "oak" needs no noun
    note = "" if known else query.note
    return FoundShapes(tuple(index.shapes[i] for i in order), tuple(float(scores[i]) for i in order), query, note)


class TextIndex:
    """Which shapes have which words; made once for a library, in about a hundredth of a millisecond a shape."""

    def __init__(self, shapes: Sequence[Shape]) -> None:
        self.shapes = tuple(shapes)
        words: dict[str, list[int]] = {}
        categories: dict[str, list[int]] = {}
        phrases: dict[tuple[str, ...], tuple[str, ...]] = {}
        for position, shape in enumerate(self.shapes):
            categories.setdefault(shape.category, []).append(position)
            # What all of a category may be called has named the category already and tells none of its shapes apart.
            synonyms = (name for name in shape.synonyms if name not in taxonomy.category(shape.category).synonyms)
            named = (shape.style, shape.category, *synonyms)
            shared = phrases.get(named)
            if shared is None:
                shared = phrases[named] = tuple(w for text in named for w in tokens(text))
            identified = (w for w in tokens(shape.id) if w.isalpha())  # not the numbers of data sets
            for word in {*tokens(shape.caption), *identified, *shared}:
                words.setdefault(word, []).append(position)
        self._words = {word: np.array(places) for word, places in words.items()}
        self._categories = {name: np.array(places) for name, places in categories.items()}

    def scores(
        self, query: TextQuery, described: Mapping[str, float] | None = None, limits: Sequence[SizeLimit] = ()
    ) -> Float[np.ndarray, "n"]:
        """How well each shape fits, 0 where nothing does.

        Args:
            query: names, words and sizes.
            described: for kinds how far their definitions have the words.
            limits: of sizes.
        """
        described = described or {}
        named = bool(query.categories) and query.exact
        category = np.zeros(len(self.shapes))
        for name in query.categories:
            for kin in _kin(name):
                places = self._categories.get(kin, NOWHERE)
                category[places] = np.maximum(category[places], CATEGORY_POINTS if kin == name else KIN_POINTS)
        if described and not named:
            category *= 0.5  # a name that is only near beside a use that is told
        total = category.copy()
        for kind, share in described.items():
            places = self._categories.get(kind, NOWHERE)
            places = places[category[places] > 0] if named else places
            total[places] += (0.5 if named else 1.0) * DESCRIPTION_POINTS * share
        sizes: list[SizeRequest] = []
        for word in query.words:
            asked = size_request(word)
            if asked is not None:
                sizes.append(asked)
            of_use = bool(described) and not named and not (narrower(word) or broader(word))
            points = SIZE_WORD_POINTS if asked else WORD_POINTS * (BESIDE_DESCRIPTION if of_use else 1.0)
            total += points * self._word(word, slips=not of_use)
        for word in query.naming:
            total += NAME_WORD_POINTS * self._word(word)
        fits = total > 0
        for asked in sizes:
            total[fits] += SIZE_POINTS * self._comparative(asked)[fits]
        if query.size_m is not None and (query.categories or not query.words):
            total[fits] += 2 * SIZE_POINTS * self._nearness(query.size_m)[fits]
        for limit in limits:
            total -= LIMIT_POINTS * ~self._meets_limit(limit)
        return np.maximum(total, np.where(fits, 1e-6, 0.0))

    def knows(self, word: str) -> bool:
        """Whether any shape has the word, in its normal form, or one of its meaning."""
        return any(w in self._words for w in (word, *narrower(word)))

    def _word(self, word: str, slips: bool = True) -> Float[np.ndarray, "n"]:
        """1 where the word is, less where something of its meaning or spelling is."""
        points = np.zeros(len(self.shapes))
        for general in broader(word):
            points[self._words.get(general, NOWHERE)] = GENERAL_POINTS
        for kind in narrower(word):
            points[self._words.get(kind, NOWHERE)] = CONCEPT_POINTS
        points[self._words.get(word, NOWHERE)] = 1.0
        if slips and not points.any() and len(word) > 3:
            alike = [w for w in self._words if w[0] == word[0] and abs(len(w) - len(word)) < 3]
            for near in difflib.get_close_matches(word, alike, n=1, cutoff=_SPELLING_CUTOFF):
                points[self._words.get(near, NOWHERE)] = SPELLING_POINTS
        return points

    @cached_property
    def _log_sizes(self) -> Float[np.ndarray, "n 3"]:
        sizes = np.array([s.size_m for s in self.shapes]).reshape(-1, 3)
        return np.log(np.maximum(sizes, _MIN_SIZE_M))

    def _comparative(self, asked: SizeRequest) -> Float[np.ndarray, "n"]:
        """-1 to 1: how much less or more of the asked size a shape has than its category's average."""
        depth, width, height = self._log_sizes.T
        measure = {"volume": depth + width + height, "height": height, "width": width, "depth": depth}[asked.of]
        relative = np.zeros(len(self.shapes))
        for places in self._categories.values():
            spread = max(float(measure[places].std()), 0.05)
            relative[places] = (measure[places] - measure[places].mean()) / spread
        return np.clip(asked.sign * relative / 2, -1, 1)

    def _meets_limit(self, limit: SizeLimit) -> Bool[np.ndarray, "n"]:
        """True for shapes that keep a limit."""
        depth, width, height = np.exp(self._log_sizes).T
        measure = {"height": height, "width": width, "depth": depth}[limit.of]
        return measure <= limit.metres if limit.most else measure >= limit.metres

    def _nearness(self, size_m: tuple[float, float, float]) -> Float[np.ndarray, "n"]:
        """1 for shapes of this size, falling to 0 as extents differ."""
        wanted = np.log(np.maximum(size_m, _MIN_SIZE_M))
        return np.exp(-(((self._log_sizes - wanted) / 0.4) ** 2).sum(axis=1) / 2)


_INDICES: weakref.WeakKeyDictionary[ShapeLibrary, TextIndex] = weakref.WeakKeyDictionary()


def text_index(library: ShapeLibrary) -> TextIndex:
    """The index of a library's words, remembered for as long as its records stay the same."""
    shapes = library.shapes()
    known = _INDICES.get(library)
    if known is None or known.shapes != shapes:
        known = _INDICES[library] = TextIndex(shapes)
    return known


def _kin(name: str) -> tuple[str, ...]:
    """A category, its special kinds, and the kind that it is one of."""
    return tuple(dict.fromkeys((name, *sorted(taxonomy.with_kin(name)), taxonomy.broad(name))))


def is_description(text: str) -> bool:
    """Whether a text tells what a thing is for, so that the nouns in it are other things: "stores books"."""
    words = [w for w in text.lower().split() if w not in ("a", "an", "the")]
    if len(words) < 2:
        return False
    return words[0] in _OPENERS or (words[0].endswith("s") and _stem(tokens(words[0])[0]) in _verbs())


def kinds_described(text: str) -> Mapping[str, float]:
    """For every kind the share of the description that its definition has, 0 to 1; kinds without any are left out."""
    asked = {_stem(word) for word in tokens(text) if word not in _SILENT and not word.isdigit()}
    rare = _rarity()
    most = log(len(CATEGORIES))
    weight = {stem: rare.get(stem, most) for stem in asked}
    whole = sum(weight.values())
    scores = {}
    for kind, defined in _definitions().items():
        share = sum(weight[stem] * _weight(stem, defined) for stem in asked)
        if share > 0:
            scores[kind] = share / whole
    return scores


def _weight(stem: str, defined: Mapping[str, float]) -> float:
    """How far a definition has a word."""
    if stem in defined:
        return defined[stem]
    if len(stem) < _SHORTEST_PART:
        return 0.0
    parts = (w for s, w in defined.items() if len(s) >= _SHORTEST_PART and (s.startswith(stem) or stem.startswith(s)))
    return _PART_WORTH * max(parts, default=0.0)


def _stem(word: str) -> str:
    """A word without its endings, which need be no word."""
    for ending in _ENDINGS:
        if word.endswith(ending) and len(word) - len(ending) >= _SHORTEST_STEM:
            word = word[: -len(ending)]
    return word[:-1] if len(word) > _SHORTEST_STEM and word[-1] == word[-2] else word


@cache
def _lines() -> Mapping[str, str]:
    lines = (line.partition(": ") for line in _FILE.read_text(encoding="utf-8").splitlines())
    return {kind: definition for kind, _, definition in lines}


@cache
def _definitions() -> Mapping[str, Mapping[str, float]]:
    """For every kind the stems of its definition and names, with what each is worth."""
    definitions: dict[str, Mapping[str, float]] = {}
    for category in CATEGORIES:
        if category is not UNKNOWN:
            names = {_stem(w): _NAME_WORTH for text in (category.name, *category.synonyms) for w in tokens(text)}
            words = {_stem(w): 1.0 for w in tokens(_lines()[category.name]) if w not in _SILENT}
            definitions[category.name] = names | words
    return definitions


@cache
def _rarity() -> Mapping[str, float]:
    """Inverse document frequency of every stem."""
    count: dict[str, int] = {}
    for defined in _definitions().values():
        for stem in defined:
            count[stem] = count.get(stem, 0) + 1
    return {stem: log(len(CATEGORIES) / times) for stem, times in count.items()}


@cache
def _verbs() -> frozenset[str]:
    """Stems of the verbs with which definitions begin."""
    first = (definition.split()[0].strip(",;.") for definition in _lines().values())
    return frozenset(_stem(tokens(word)[0]) for word in first if word.endswith("s"))
