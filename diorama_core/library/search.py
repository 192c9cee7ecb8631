"""Finding shapes by words: "oak bookcase", "blue couch", "round table"."""

from __future__ import annotations

import difflib
import re

from diorama_core.library import taxonomy
from diorama_core.library.record import Shape, ShapeLibrary

CATEGORY_POINTS = 3.0
WORD_POINTS = 1.0
NEAR_POINTS = 0.6
_IGNORED = frozenset({"a", "an", "the", "with", "of", "and", "in", "on", "for", "some", "my"})


def search(library: ShapeLibrary, text: str, k: int = 24) -> tuple[Shape, ...]:
    """The `k` shapes that fit the words best, best first; all in their stable order when there are no words.

    Names of categories (with synonyms, plurals and near spellings) weigh most, then words of the caption, the style
    and the id. Nothing that shares no word with the text is returned, unless no shape shares any: then a name that is
    not known stands for its nearest category.
    """
    words = _words(text)
    shapes = library.shapes()
    if not words:
        return shapes[:k]
    category = _category(text, words)
    scores = [_score(shape, words, category) for shape in shapes]
    order = sorted((i for i, s in enumerate(scores) if s > 0), key=lambda i: (-scores[i], i))
    return tuple(shapes[i] for i in order[:k])


def _words(text: str) -> tuple[str, ...]:
    return tuple(w for w in re.findall(r"[a-z0-9]+", text.lower()) if w not in _IGNORED)


def _category(text: str, words: tuple[str, ...]) -> str | None:
    """The category that the text names: by its last words first, then by any one of them."""
    whole = taxonomy.resolve(text)
    if whole.exact:
        return whole.category.name
    for word in reversed(words):
        named = taxonomy.resolve(word)
        if named.exact:
            return named.category.name
    near = taxonomy.resolve(words[-1])
    return near.category.name if near.category is not taxonomy.UNKNOWN else None


def _score(shape: Shape, words: tuple[str, ...], category: str | None) -> float:
    known = set(_words(f"{shape.caption} {shape.style} {shape.id} {shape.category}"))
    score = CATEGORY_POINTS if shape.category == category else 0.0
    for word in words:
        if word in known or word.rstrip("s") in known:
            score += WORD_POINTS
        elif len(word) > 3 and difflib.get_close_matches(word, known, n=1, cutoff=0.8):
            score += NEAR_POINTS
    return score
