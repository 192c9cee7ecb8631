"""What an object is called beyond its kind: "leather armchair", "round oak table" (the paper's text query)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.library.language import tokens
from diorama_core.library.loose_words import MEANINGS
from diorama_core.library.naming import understand
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.search import text_index
from diorama_core.library.taxonomy import CATEGORIES

_KINDS = frozenset(kind.name for kind in CATEGORIES)


FEW = 0.3
"""Largest share of a kind's shapes that a noun names which tells them from the rest: balls are a few of the toys. What
is said of many is used loosely of all."""
SEVERAL = 3
"""A noun that is said of so many kinds says nothing of the things of one."""
CERTAIN, ROUGHLY = 0.85, 0.12
"""Penalties of a shape that the label's very noun rules out, and of one that matches none of its describing words."""


def words_factor(
    library: ShapeLibrary, label: str, category: str, shapes: Sequence[Shape]
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """By what words weaken the score of every shape, and the share of the describing words that fit it (0 to 1).

    Args:
        library: Whose words.
        label: As a person or a detector called the object; a number at its end is of no account.
        category: The object's kind.
        shapes: Of the library.
    """
    share = described_share(library, label, category, shapes)
    penalty = CERTAIN if nouns_of_few(library, label, category) else ROUGHLY
    return 1.0 - penalty * (1.0 - share), share


def nouns_of_few(library: ShapeLibrary, label: str, category: str) -> tuple[str, ...]:
    """The label's nouns that name only a few things of a kind, and so tell which: flowers are some of the plants.

    The kind's own name, names of kinds and what is said loosely of several kinds tell nothing.
    """
    members = library.in_category(category)
    captions = [set(tokens(shape.caption)) for shape in members]
    nouns = (w for w in understand(label).naming if w not in category and not _is_loose(w))
    return tuple(w for w in nouns if 0 < sum(w in words for words in captions) < FEW * len(members))


def _is_loose(noun: str) -> bool:
    """Whether a noun is the name of a kind or is said of several."""
    return noun in _KINDS or len(MEANINGS.get(noun, {})) >= SEVERAL


def described_share(
    library: ShapeLibrary, label: str, category: str, shapes: Sequence[Shape]
) -> Float[np.ndarray, " n"]:
    """For every shape the share of the label's describing words that fit it, 0 to 1, by word or by meaning.

    A name of a few things of a kind describes them, too. All 1 where the label names the kind and nothing more, or says
    only what no shape here is known for: then words do not tell the shapes apart.

    Args:
        library: Whose words.
        label: As a person or a detector called the object; a number at its end is of no account.
        category: The object's kind, whose own words describe nothing.
        shapes: Of the library.
    """
    query = understand(label)
    words = (*query.words, *nouns_of_few(library, label, category))
    said = tuple(w for w in words if w not in category and not w.isdigit())  # an "arm chair" has no more arms
    if not said or not len(shapes):
        return np.ones(len(shapes))
    index = text_index(library)
    points = index.scores(replace(query, categories=(), words=said, naming=(), size_m=None))
    of_shape = dict(zip((s.id for s in index.shapes), points, strict=True))
    share = np.array([min(of_shape.get(s.id, 0.0) / len(said), 1.0) for s in shapes])
    return share if share.any() else np.ones(len(shapes))
