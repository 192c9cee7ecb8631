"""What an object is called beyond its kind: "leather armchair", "round oak table" (the paper's text query)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.library.loose_words import NAMES_OF_SOME
from diorama_core.library.naming import understand
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.search import text_index


def names_some(label: str) -> bool:
    """Whether a label's noun names only some things of a kind, and so tells which."""
    return bool(NAMES_OF_SOME & set(understand(label).naming))


def described_share(
    library: ShapeLibrary, label: str, category: str, shapes: Sequence[Shape]
) -> Float[np.ndarray, " n"]:
    """For every shape the share of the label's describing words that fit it, 0 to 1, by word or by meaning.

    A name of some things of a kind describes them, too. All 1 where the label names the kind and nothing more, or says
    only what no shape here is known for: then words do not tell the shapes apart.

    Args:
        library: Whose words.
        label: As a person or a detector called the object; a number at its end is of no account.
        category: The object's kind, whose own words describe nothing.
        shapes: Of the library.
    """
    query = understand(label)
    words = (*query.words, *(w for w in query.naming if w in NAMES_OF_SOME))
    said = tuple(w for w in words if w not in category and not w.isdigit())  # an "arm chair" has no more arms
    if not said or not len(shapes):
        return np.ones(len(shapes))
    index = text_index(library)
    points = index.scores(replace(query, categories=(), words=said, naming=(), size_m=None))
    of_shape = dict(zip((s.id for s in index.shapes), points, strict=True))
    share = np.array([min(of_shape.get(s.id, 0.0) / len(said), 1.0) for s in shapes])
    return share if share.any() else np.ones(len(shapes))
