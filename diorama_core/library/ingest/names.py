"""What the names in and around a model say it is: `chairDesk_02.glb`, `SM_Sofa_Leather`, `night stands/a.obj`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cache

from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN

_SAME = {"television": ("tv",), "bed": ("bedside",), "tv": ("television",), "fridge": ("refrigerator",)}
"""Words that stand for one another inside compound names."""
_EMPTY = frozenset(
    [
        "the",
        "a",
        "an",
        "of",
        "and",
        "with",
        "model",
        "models",
        "mesh",
        "object",
        "obj",
        "default",
        "normalized",
        "untitled",
        "scene",
        "root",
        "node",
        "group",
        "geometry",
        "sm",
        "mat",
        "material",
        "lod",
        "low",
        "high",
        "poly",
        "final",
        "new",
        "copy",
        "export",
        "asset",
        "assets",
        "glb",
        "gltf",
        "fbx",
        "set",
    ]
)
MANY_WORDS, ONE_WORD, ELSEWHERE = 0.0, -1.2, -1.0
"""Logarithms of how much less a single word says than a compound, and a folder or a part than the file's own name."""


def words_of(name: str) -> tuple[str, ...]:
    """Plain lower-case words of a name in any usual spelling; numbers and fillers are dropped."""
    spaced = re.sub(
        r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])|(?<=[A-Za-z])(?=\d)|(?<=\d)(?=[A-Za-z])", " ", name
    )
    words = re.findall(r"[^\W\d_]+", spaced.lower())
    return tuple(w for w in words if w not in _EMPTY and len(w) > 1)


def named_categories(stem: str, folders: Iterable[str] = (), parts: Iterable[str] = ()) -> dict[str, float] | None:
    """Categories that names speak of, with logarithmic weights (0 is strongest).

    The file's own name is asked first; then the folders from the innermost outwards; then the names of its parts.
    Empty when its name is made of words, but none of them is known; None when it has no such name.
    """
    for names, less in (([stem], 0.0), (list(folders), ELSEWHERE), (list(parts), ELSEWHERE)):
        for name in names:
            found = _spoken_of(words_of(name))
            if found:
                return {category: weight + less for category, weight in found.items()}
    return {} if words_of(stem) else None


def _spoken_of(words: tuple[str, ...]) -> dict[str, float]:
    words = words[:8]
    known = {p: _known()[p] for p in _phrases(words) if p in _known()}
    used = {word for phrase in known if " " in phrase for word in phrase.split()}
    found: dict[str, float] = {}
    for phrase, category in known.items():
        if " " in phrase or not used.intersection(_singulars(phrase)):
            weight = MANY_WORDS if " " in phrase else ONE_WORD
            found[category] = max(found.get(category, weight), weight)
    return found


def _phrases(words: tuple[str, ...]) -> Iterator[str]:
    """Runs of words, and any two of them either way round: furniture is named head first as often as head last."""
    for start in range(len(words)):
        for end in range(start + 1, min(start + 4, len(words)) + 1):
            yield from _singulars(" ".join(words[start:end]))
    for a in words:
        for b in words:
            if a != b:
                for first in (a, *_SAME.get(a, ())):
                    yield from _singulars(f"{first} {b}")


def _singulars(phrase: str) -> Iterator[str]:
    yield phrase
    if phrase.endswith("s"):
        yield phrase[:-1]
    if phrase.endswith("es"):
        yield phrase[:-2]
    if phrase.endswith("ves"):
        yield phrase[:-3] + "f"


@cache
def _known() -> dict[str, str]:
    table = {_plain(c.name): c.name for c in CATEGORIES if c is not UNKNOWN}
    for category in CATEGORIES:
        if category is not UNKNOWN:
            for word in category.synonyms:
                table.setdefault(_plain(word), category.name)
    return table


def _plain(word: str) -> str:
    return re.sub(r"[^a-z0-9]+", " ", word.lower()).strip()
