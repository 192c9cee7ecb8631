"""What plain words mean: the kinds of the library that a word is used for, and how often each is meant.

People and detectors say "chair" of office chairs and armchairs, "table" of desks, "cabinet" of a dozen kinds. The
shares are rough frequencies in photos of homes and offices; what a photo shows of the thing decides. A word that names
its kind and nothing else means that kind, and now and then a special kind of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from diorama_core.library.labels import plain_word
from diorama_core.library.loose_words import MEANINGS
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN, column

_SPECIAL_SHARE = 0.08
"""Share of a category's name where no row says more: what all its special kinds have together."""

_RARE = 0.15
FREQUENCIES: Mapping[str, float] = column("frequency")
"""How often a thing in a room is of a kind, of a hundred; `_RARE` for the others: what something without a name is."""


@cache
def meanings(label: str, category: str) -> Mapping[str, float]:
    """How often each kind is meant by a label, as probabilities, the most frequent first.

    Args:
        label: as a person or a detector called the thing.
        category: the canonical category that it was understood as; its own special kinds where no row says more.
    """
    word = plain_word(label)
    if word is None or word == UNKNOWN.name:
        shares = {c.name: FREQUENCIES.get(c.name, _RARE) for c in CATEGORIES if c is not UNKNOWN}
        if category in shares:
            shares[category] = 2 * max(shares.values())
        return _ordered(shares)
    if word in MEANINGS:
        shares = dict(MEANINGS[word])
    else:
        special = [c.name for c in CATEGORIES if c.kin == category]
        shares = {category: 1.0, **{name: _SPECIAL_SHARE / len(special) for name in special}}
    if category != UNKNOWN.name:
        shares.setdefault(category, min(shares.values()))
    return _ordered(shares)


def is_named(label: str) -> bool:
    """Whether a label says anything of what a thing is."""
    return plain_word(label) not in (None, UNKNOWN.name)


def _ordered(shares: Mapping[str, float]) -> dict[str, float]:
    whole = sum(shares.values())
    return {kind: share / whole for kind, share in sorted(shares.items(), key=lambda row: (-row[1], row[0]))}
