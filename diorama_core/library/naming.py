"""The category, look and size that a text asks for, and names that are no category of their own."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from diorama_core.library import taxonomy
from diorama_core.library.language import IGNORED, JOINTS, size_in, tokens
from diorama_core.library.taxonomy import column


@cache
def other_names() -> dict[tuple[str, ...], str]:
    """Normal words of each name (`language.tokens`), and the category it is near to."""
    table: dict[tuple[str, ...], str] = {}
    for category, names in column("other_names").items():
        for name in names:
            table.setdefault(tokens(name), category)
    return table


_SLIP = 0.8
"""Least similarity of spelling (Ratcliff and Obershelp) that is taken for a slip of the pen."""
_RESEMBLANCE = 0.55
"""Minimum similarity of spelling when the size is known too."""
_SIZE_SPREAD = 3.0
"""Squared distance from a category's usual sizes, in standard deviations, at which the size stops speaking for it."""
_LONGEST_NAME = 5
_CONJUNCTIONS = frozenset({"and", "or", "plus"})

Size = tuple[float, float, float]


@dataclass(frozen=True)
class TextQuery:
    """A text, understood."""

    categories: tuple[str, ...]
    """Canonical categories that are named, in the order of the text; none when nothing is."""
    exact: bool
    """False when a category is only the nearest to an unknown noun."""
    words: tuple[str, ...]
    """Normal forms of the words that describe it: "desk lamp" names a lamp, and `desk` says which."""
    naming: tuple[str, ...]
    """Normal forms of the nouns that named the categories."""
    size_m: Size | None
    """Extents along x (depth), y (width), z (height), where the text or the caller gives them."""
    note: str = ""
    """Message to the user about unknown words; empty when all are known."""


def understand(text: str, size_m: Size | None = None) -> TextQuery:
    """Map the words of a user or a detector to categories.

    "a wooden armchair with cushions" is an armchair; "chests of drawers" a dresser; "desk lamp" a lamp; "sofas and
    rugs" two kinds. British and American spelling, plurals and slips are understood.

    Args:
        text: A noun, a phrase or a few of them; a size in it such as "60 x 50 x 110 cm" counts as one.
        size_m: Size of the object, where it is known otherwise.
    """
    rest, written = size_in(text)
    size = written or size_m
    named: dict[str, None] = {}
    naming: list[str] = []
    notes: list[str] = []
    exact = True
    for phrase in _phrases(rest):
        words = tokens(phrase)
        found = _find_name(words) or _nearest(words, size)
        if found is not None and found.note:
            exact = False
            notes.append(found.note)
        if found is not None and found.category:
            named[found.category] = None
            naming.append(found.words[-1])
    silent = IGNORED | JOINTS | _CONJUNCTIONS
    described = dict.fromkeys(w for w in tokens(rest) if w not in silent and w not in naming)
    return TextQuery(tuple(named), exact, tuple(described), tuple(dict.fromkeys(naming)), size, "; ".join(notes))


@dataclass(frozen=True)
class _Found:
    category: str
    """Empty when nothing is near."""
    words: tuple[str, ...]
    """The words that name it."""
    note: str = ""
    """Message about words that only are near a name."""


def _phrases(text: str) -> list[str]:
    """Parts that name one thing each."""
    return [part for part in re.split(r"[,;/&+]|\band\b|\bor\b|\bplus\b", text.lower()) if tokens(part)]


def _find_name(words: Sequence[str]) -> _Found | None:
    """The category that a phrase names: the last known name before "with", "for"..."""
    table = _names()
    across = [w for w in _runs(words, len(words)) if w in table and JOINTS & set(w)]
    if across:
        return _Found(table[across[0]], across[0])
    head = _head(words)
    for end in range(len(head), 0, -1):
        for start in range(max(end - _LONGEST_NAME, 0), end):
            run = tuple(head[start:end])
            name = run if run in table else ("".join(run),)  # "arm chair"
            if name in table:
                return _Found(table[name], run)
    if "of" in words:  # "a pair of lamps", "set of chairs"
        return _find_name(words[list(words).index("of") + 1 :])
    return None


def _head(words: Sequence[str]) -> list[str]:
    """The words before the first joint, without those that say nothing."""
    stop = next((i for i, word in enumerate(words) if word in JOINTS and i > 0), len(words))
    return [word for word in words[:stop] if word not in IGNORED]


def _runs(words: Sequence[str], end: int) -> Iterator[tuple[str, ...]]:
    """Neighbouring words, the longest first."""
    for length in range(min(_LONGEST_NAME, end), 0, -1):
        for start in range(end - length + 1):
            yield tuple(words[start : start + length])


def _nearest(words: Sequence[str], size: Size | None) -> _Found | None:
    """The category nearest to a phrase that names none; None for one that has no noun to be near to."""
    head = _head(words) or [w for w in words if w not in IGNORED and w not in JOINTS]
    if not head:
        return None
    table, near = _names(), other_names()
    for run in sorted(_runs(head, len(head)), key=lambda run: (-len(run), run != tuple(head[-len(run) :]))):
        if run in near:
            return _Found(near[run], run, f"'{' '.join(run)}' is no class of its own; the nearest is '{near[run]}'")
    for word in reversed(head):
        slip = _closest(word, _SLIP) if len(word) > 3 else None
        if slip is not None:
            return _Found(table[slip], (word,), f"'{word}' is not known; read as '{' '.join(slip)}' ({table[slip]})")
        ending = _ending(word)
        if ending is not None:
            return _Found(table[ending], (word,), f"'{word}' is not known; taken for a kind of '{table[ending]}'")
    noun = head[-1]
    if size is not None:
        category = _likeliest_category(noun, size)
        return _Found(category, (noun,), f"'{noun}' is not known; by its name and size the nearest is '{category}'")
    return _Found(
        "", (), f"'{noun}' is not known, and no class has a name or use like it; only its words are looked for"
    )


def _closest(word: str, cutoff: float) -> tuple[str, ...] | None:
    """The name of a category or a part of the near names that is spelt most like a word."""
    joined = {"".join(name): name for name in _names()}
    close = difflib.get_close_matches(word, list(joined), n=1, cutoff=cutoff)
    return joined[close[0]] if close else None


def _ending(word: str) -> tuple[str, ...] | None:
    """The longest name that ends a compound: "footlocker" is a locker."""
    names = _names()
    return next(((word[i:],) for i in range(2, len(word) - 2) if (word[i:],) in names), None)


def _likeliest_category(noun: str, size: Size) -> str:
    """The category whose names are spelt most like the noun and whose usual sizes fit best."""
    spelling: dict[str, float] = {}
    for name, category in _names().items():
        ratio = difflib.SequenceMatcher(None, noun, "".join(name)).ratio()
        spelling[category] = max(spelling.get(category, 0.0), ratio)

    def score(category: str) -> float:
        alike = max(spelling.get(category, 0.0) - _RESEMBLANCE, 0.0) / (1 - _RESEMBLANCE)
        return 2.0 * alike + float(np.exp(-size_distance(category, size) / _SIZE_SPREAD))

    broad = [c.name for c in taxonomy.CATEGORIES if c is not taxonomy.UNKNOWN and not c.kin]
    return max(broad, key=score)


def size_distance(category: str, size_m: Size) -> float:
    """Squared distance of a size from a category's usual ones, in standard deviations; either way round."""
    sizes = np.log(np.maximum([size_m, (size_m[1], size_m[0], size_m[2])], 1e-3))
    return float(
        min(
            (((sizes - prior.log_median_xyz) / prior.log_sigma_xyz) ** 2).sum(axis=1).min()
            for prior in taxonomy.category(category).priors
        )
    )


@cache
def _names() -> dict[tuple[str, ...], str]:
    """Normal words of every known name, and its category."""
    table: dict[tuple[str, ...], str] = {}
    known = [c for c in taxonomy.CATEGORIES if c is not taxonomy.UNKNOWN]
    for category in known:
        table[tokens(category.name)] = category.name
    for category in known:
        for word in category.synonyms:
            table.setdefault(tokens(word), category.name)
    for name in list(table):  # "night stand" is also written "nightstand", "arm chair" for "armchair" is a slip
        table.setdefault(("".join(name),), table[name])
    return table
