"""What plain words mean: the kinds of the library that a word is used for, and how often each is meant.

People and detectors say "chair" of office chairs and armchairs, "table" of desks, "cabinet" of a dozen kinds. The
shares are rough frequencies in photos of homes and offices; what a photo shows of the thing decides. A word that names
its kind and nothing else means that kind, and now and then a special kind of it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache

from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN, resolve

_SPECIAL_SHARE = 0.08
"""Of a category's name where no row says more: what all its special kinds have together."""

_TABLES = {
    "table": 0.42, "coffee table": 0.2, "side table": 0.14, "desk": 0.12, "console table": 0.05, "night stand": 0.03,
    "vanity table": 0.01, "kitchen island": 0.01, "bar cart": 0.01, "tv stand": 0.01,
}  # fmt: skip
_CASES = {
    "cabinet": 0.27, "wall cabinet": 0.14, "sideboard": 0.1, "kitchen counter": 0.08, "tv stand": 0.07, "dresser": 0.07,
    "night stand": 0.06, "filing cabinet": 0.06, "display cabinet": 0.04, "wardrobe": 0.04, "bookshelf": 0.03,
    "pantry cabinet": 0.02, "shoe cabinet": 0.01, "locker": 0.01,
}  # fmt: skip
_LAMPS = {"lamp": 0.42, "floor lamp": 0.2, "ceiling lamp": 0.2, "wall lamp": 0.1, "chandelier": 0.08}
_SHELVES = {"shelves": 0.4, "bookshelf": 0.45, "wall cabinet": 0.04, "tv stand": 0.04, "display cabinet": 0.03}
_PICTURES = {"picture": 0.85, "photo frame": 0.09, "whiteboard": 0.02, "bulletin board": 0.02, "mirror": 0.02}

MEANINGS: Mapping[str, Mapping[str, float]] = {
    "chair": {"chair": 0.56, "office chair": 0.2, "armchair": 0.18, "recliner": 0.02, "rocking chair": 0.015,
              "bar stool": 0.01, "stool": 0.01, "high chair": 0.005},
    "seat": {"chair": 0.4, "armchair": 0.2, "sofa": 0.1, "stool": 0.1, "bench": 0.1, "office chair": 0.1},
    "armchair": {"armchair": 0.9, "recliner": 0.05, "rocking chair": 0.03, "chair": 0.02},
    "stool": {"stool": 0.5, "bar stool": 0.35, "ottoman": 0.1, "side table": 0.05},
    "sofa": {"sofa": 0.8, "sectional sofa": 0.1, "armchair": 0.06, "chaise longue": 0.02, "day bed": 0.02},
    "couch": {"sofa": 0.8, "sectional sofa": 0.1, "armchair": 0.06, "chaise longue": 0.02, "day bed": 0.02},
    "bed": {"bed": 0.88, "bunk bed": 0.04, "day bed": 0.04, "crib": 0.04},
    "table": _TABLES,
    "desk": {"desk": 0.9, "table": 0.06, "vanity table": 0.04},
    "counter": {"kitchen counter": 0.75, "kitchen island": 0.2, "desk": 0.05},
    "island": {"kitchen island": 0.9, "kitchen counter": 0.1},
    "cabinet": _CASES,
    "cupboard": _CASES,
    "furniture": {**_CASES, "table": 0.1, "chair": 0.1},
    "drawer": {"dresser": 0.6, "night stand": 0.25, "filing cabinet": 0.1, "cabinet": 0.05},
    "dresser": {"dresser": 0.9, "sideboard": 0.04, "changing table": 0.02, "vanity table": 0.02, "night stand": 0.02},
    "sideboard": {"sideboard": 0.85, "tv stand": 0.06, "chest": 0.04, "cabinet": 0.05},
    "stand": {"tv stand": 0.4, "night stand": 0.25, "side table": 0.2, "console table": 0.1, "coat rack": 0.05},
    "wardrobe": {"wardrobe": 0.92, "pantry cabinet": 0.04, "locker": 0.02, "cabinet": 0.02},
    "shelf": _SHELVES,
    "rack": {"shelves": 0.35, "bookshelf": 0.25, "coat rack": 0.2, "wine rack": 0.1, "shoe cabinet": 0.1},
    "trunk": {"chest": 0.9, "suitcase": 0.1},
    "screen": {"monitor": 0.5, "television": 0.4, "room divider": 0.1},
    "display": {"monitor": 0.65, "television": 0.35},
    "partition": {"room divider": 1.0},
    "oven": {"stove": 0.6, "wall oven": 0.25, "microwave": 0.15},
    "lamp": _LAMPS,
    "light": {"ceiling lamp": 0.6, "wall lamp": 0.14, "chandelier": 0.08, "lamp": 0.12, "floor lamp": 0.06},
    "lampshade": _LAMPS,
    "light fixture": {"ceiling lamp": 0.7, "wall lamp": 0.15, "chandelier": 0.15},
    "ceiling lamp": {"ceiling lamp": 0.85, "chandelier": 0.15},
    "picture": _PICTURES,
    "picture frame": {"picture": 0.7, "photo frame": 0.3},
    "frame": {"picture": 0.65, "photo frame": 0.25, "mirror": 0.1},
    "board": {"whiteboard": 0.6, "bulletin board": 0.25, "cutting board": 0.15},
    "mirror": {"mirror": 0.82, "floor mirror": 0.12, "vanity mirror": 0.06},
    "clock": {"clock": 0.75, "mantel clock": 0.2, "grandfather clock": 0.05},
    "curtain": {"curtain": 0.95, "blinds": 0.05},
    "plant": {"plant": 0.95, "hanging plant": 0.05},
    "flowerpot": {"plant": 0.8, "vase": 0.2},
    "pot": {"plant": 0.5, "cooking pot": 0.4, "vase": 0.1},
    "box": {"box": 0.88, "basket": 0.04, "chest": 0.04, "suitcase": 0.02, "books": 0.02},
    "basket": {"basket": 0.7, "laundry basket": 0.25, "trash can": 0.05},
    "bag": {"handbag": 0.5, "backpack": 0.4, "suitcase": 0.1},
    "case": {"suitcase": 0.7, "display cabinet": 0.15, "box": 0.15},
    "mat": {"rug": 0.75, "bath mat": 0.2, "yoga mat": 0.05},
    "ball": {"toy": 0.7, "exercise ball": 0.3},
    "container": {"box": 0.6, "basket": 0.15, "jar": 0.15, "bottle": 0.1},
    "glass": {"glass": 0.95, "cup": 0.05},
    "cup": {"cup": 0.88, "glass": 0.12},
    "bowl": {"bowl": 0.92, "plate": 0.04, "tray": 0.04},
    "dish": {"plate": 0.6, "bowl": 0.35, "tray": 0.05},
    "vase": {"vase": 0.93, "jar": 0.05, "plant": 0.02},
    "phone": {"telephone": 0.5, "smartphone": 0.5},
    "keyboard": {"keyboard": 0.95, "piano": 0.05},
    "player": {"record player": 1.0},
}  # fmt: skip
"""By plain word; shares need not add up to one."""

LABELS: Mapping[str, str] = {
    # LVIS
    "monitor computer equipment computer monitor": "monitor", "television set": "television", "armoire": "wardrobe",
    "footstool": "ottoman", "deck chair": "chair", "pew church bench": "bench", "mattress": "bed", "hamper": "basket",
    "wineglass": "glass", "cassette": "speaker", "stereo sound system": "speaker", "newspaper": "books",
    "magazine": "books", "notebook": "books", "chandelier": "chandelier", "lantern": "lamp", "easel": "picture",
    "water jug": "vase", "pitcher vessel for liquid": "vase", "pan for cooking": "cooking pot",
    # ScanNet and NYU40
    "file cabinets": "filing cabinet", "mini fridge": "refrigerator", "recycling bin": "trash can",
    "trash bin": "trash can", "couch cushions": "pillow", "folded chair": "chair", "stack of chairs": "chair",
    "computer tower": "computer", "bathroom vanity": "cabinet", "bathroom cabinet": "cabinet", "clothes": "towel",
    "dish rack": "tray", "bathroom counter": "counter", "end table": "side table", "otherfurniture": "object",
    "otherstructure": "object", "otherprop": "object", "structure": "object", "person": "object",
    # Open Images
    "studio couch": "sofa", "kitchen dining room table": "table", "cabinetry": "cabinet", "infant bed": "crib",
    "waste container": "trash can", "houseplant": "plant", "gas stove": "stove", "home appliance": "object",
    "kitchen appliance": "object", "drinkware": "cup", "tableware": "bowl", "musical keyboard": "keyboard",
    "window blind": "blinds", "wall clock": "clock", "swivel chair": "office chair",
    # COCO
    "dining table": "table", "potted plant": "plant", "cell phone": "smartphone", "book": "books",
}  # fmt: skip
"""Labels of data sets whose meaning is not the one their words have for the taxonomy."""


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
    word = _plain(label)
    if not is_named(label):
        shares = {c.name: FREQUENCIES.get(c.name, _RARE) for c in CATEGORIES if c is not UNKNOWN}
        if category in shares:
            shares[category] = 2 * max(shares.values())
        return _ordered(shares)
    if word not in MEANINGS and resolve(category).category.name == category:
        word = category if _names_only(word, category) else word
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
    word = _plain(label)
    return resolve(word).category is not UNKNOWN or word in MEANINGS


def _ordered(shares: Mapping[str, float]) -> dict[str, float]:
    whole = sum(shares.values())
    return {kind: share / whole for kind, share in sorted(shares.items(), key=lambda row: (-row[1], row[0]))}


def _plain(label: str) -> str:
    """Lower case, single spaces, no number at the end; a data set's label by its plain word, plurals singular."""
    key = re.sub(r"[^a-z0-9]+", " ", label.lower()).strip()
    key = re.sub(r" \d+$", "", key)
    key = LABELS.get(key, key)
    if key in MEANINGS or not key.endswith("s"):
        return key
    singular = "shelf" if key == "shelves" else key[:-1]
    return singular if singular in MEANINGS else key


def _names_only(word: str, category: str) -> bool:
    """Whether a describing phrase ends in the bare name of its category: "red chair" is a chair of some kind."""
    return word.split()[-1:] == [category] and resolve(word).category.name == category and not _is_known(word)


@cache
def _known() -> frozenset[str]:
    return frozenset(w for c in CATEGORIES for w in (c.name, *c.synonyms))


def _is_known(word: str) -> bool:
    """Whether the taxonomy lists the very phrase: "dining chair" says which chair."""
    return word in _known()
