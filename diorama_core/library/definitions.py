"""Kinds by what they are for: "keeps food cold", "something to sit on at a desk".

`definitions.txt` says of every kind in plain words what people do with it, what it is made of and where it stands. A
description is compared with all of them: the share of its words that a definition has, rare words counting more
(inverse document frequency, Spärck Jones 1972), in their stems, and less for words that only share a part.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from math import log
from pathlib import Path

from diorama_core.library.language import IGNORED, JOINTS, tokens
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN

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
        share = sum(weight[stem] * _met(stem, defined) for stem in asked)
        if share > 0:
            scores[kind] = share / whole
    return scores


def _met(stem: str, defined: Mapping[str, float]) -> float:
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
