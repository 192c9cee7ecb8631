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
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN

_SPECIAL_SHARE = 0.08
"""Of a category's name where no row says more: what all its special kinds have together."""

_RARE = 0.15
FREQUENCIES: Mapping[str, float] = {
    "chair": 10, "pillow": 9, "picture": 7, "table": 4, "lamp": 4, "cabinet": 3, "books": 4, "box": 4, "sofa": 3,
    "plant": 3.5, "window": 2.5, "door": 2, "curtain": 2.5, "bed": 2, "night stand": 2.5, "coffee table": 2,
    "side table": 2, "vase": 3, "bottle": 2.5, "cup": 2.5, "bowl": 1.5, "rug": 2.5, "ceiling lamp": 2.5,
    "floor lamp": 1.5, "wall lamp": 1, "chandelier": 0.7, "desk": 1.5, "office chair": 2, "armchair": 2,
    "monitor": 1.8, "keyboard": 0.8, "laptop": 0.8, "television": 1.2, "tv stand": 0.8, "mirror": 1.2, "clock": 0.8,
    "shelves": 1.5, "bookshelf": 1.8, "dresser": 1.3, "wardrobe": 1, "sideboard": 0.8, "blanket": 1.2, "towel": 1,
    "basket": 0.8, "trash can": 1, "stool": 0.8, "ottoman": 0.7, "bench": 0.5, "refrigerator": 0.5, "stove": 0.5,
    "microwave": 0.4, "sink": 0.6, "toilet": 0.3, "kitchen counter": 1, "wall cabinet": 1, "whiteboard": 0.4,
    "photo frame": 0.6, "toy": 0.8, "handbag": 0.4, "backpack": 0.4, "candle": 0.5, "sculpture": 0.6,
    "console table": 0.5, "filing cabinet": 0.4, "display cabinet": 0.4, "plate": 0.6, "glass": 0.6, "radiator": 0.4,
    "blinds": 0.6, "bar stool": 0.5, "washing machine": 0.3, "computer": 0.4, "printer": 0.3, "speaker": 0.5,
}  # fmt: skip
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
