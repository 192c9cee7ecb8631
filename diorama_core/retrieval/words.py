"""What an object is called beyond its kind: "leather armchair", "round oak table" (the paper's text query)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.library.labels import MEANINGS
from diorama_core.library.language import tokens
from diorama_core.library.naming import understand
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.search import text_index
from diorama_core.library.taxonomy import CATEGORIES
from diorama_core.retrieval.settings import SETTINGS, RankingSettings

_KINDS = frozenset(kind.name for kind in CATEGORIES)


def words_factor(
    library: ShapeLibrary,
    label: str,
    category: str,
    shapes: Sequence[Shape],
    settings: RankingSettings = SETTINGS.ranking,
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """By what words weaken the score of every shape, and the share of the describing words that fit it (0 to 1).

    Args:
        library: Whose words.
        label: As a person or a detector called the object; a number at its end is of no account.
        category: The object's kind.
        shapes: Of the library.
        settings: Numbers to work with.
    """
    share = description_share(library, label, category, shapes, settings)
    penalty = settings.other_noun if nouns_of_few(library, label, category, settings) else settings.other_words
    return 1.0 - penalty * (1.0 - share), share


def nouns_of_few(
    library: ShapeLibrary, label: str, category: str, settings: RankingSettings = SETTINGS.ranking
) -> tuple[str, ...]:
    """The label's nouns that name only a few things of a kind, and so tell which: flowers are some of the plants.

    The kind's own name, names of kinds and what is said loosely of several kinds tell nothing.

    Args:
        library, label, category, settings: as of `words_factor`.
    """
    members = library.in_category(category)
    captions = [set(tokens(shape.caption)) for shape in members]
    nouns = (w for w in understand(label).naming if w not in category and not _is_loose(w, settings.several))
    return tuple(w for w in nouns if 0 < sum(w in words for words in captions) < settings.few * len(members))


def _is_loose(noun: str, several: int) -> bool:
    """Whether a noun is the name of a kind or is said of several."""
    return noun in _KINDS or len(MEANINGS.get(noun, {})) >= several


def description_share(
    library: ShapeLibrary,
    label: str,
    category: str,
    shapes: Sequence[Shape],
    settings: RankingSettings = SETTINGS.ranking,
) -> Float[np.ndarray, " n"]:
    """For every shape the share of the label's describing words that fit it, 0 to 1, by word or by meaning.

    A name of a few things of a kind describes them, too. All 1 where the label names the kind and nothing more, or says
    only what no shape here is known for: then words do not tell the shapes apart.

    Args:
        library, label, category, shapes, settings: as of `words_factor`.
    """
    query = understand(label)
    words = (*query.words, *nouns_of_few(library, label, category, settings))
    adjectives = tuple(w for w in words if w not in category and not w.isdigit())  # an "arm chair" has no more arms
    if not adjectives or not len(shapes):
        return np.ones(len(shapes))
    index = text_index(library)
    points = index.scores(replace(query, categories=(), words=adjectives, naming=(), size_m=None))
    of_shape = dict(zip((s.id for s in index.shapes), points, strict=True))
    share = np.array([min(of_shape.get(s.id, 0.0) / len(adjectives), 1.0) for s in shapes])
    return share if share.any() else np.ones(len(shapes))
