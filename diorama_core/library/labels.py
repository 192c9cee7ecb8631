"""The word of the taxonomy that a label means, and what plain and loose words mean, each with its frequency.

The shares are rough frequencies in photos of homes and offices; what a photo shows of the thing decides.

"a wooden coffee table with a glass top", "chair_2", "Statue (sculpture)" and "arm chair" name a coffee table, a chair,
a statue and an armchair: what follows "with" or "on" and what brackets hold describes, the last words before it name.
Where none is known the nearest in form is taken (`naming.other_names`), then the nearest spelling.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache

from diorama_core.library import taxonomy
from diorama_core.library.language import JOINTS, broader, narrower, size_request, tokens
from diorama_core.library.naming import other_names
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN, Resolution, category, column, resolve

MEANINGS: Mapping[str, Mapping[str, float]] = {
    word: {kind: shares[word] for kind, shares in column("meant_by").items() if word in shares}
    for word in sorted({word for shares in column("meant_by").values() for word in shares})
}
"""By plain word; shares need not add up to one."""

LABELS: Mapping[str, str] = {
    # what has several names
    "arm chair": "armchair", "wooden chair": "chair", "hanging lamp": "ceiling lamp", "ceiling fixture": "ceiling lamp",
    "flower pot": "flowerpot", "tv bench": "tv stand", "tv table": "tv stand", "tv console": "tv stand",
    "tv screen": "tv", "television screen": "tv", "photo": "picture", "art": "picture", "artwork": "picture",
    "art print": "picture", "storage bin": "box", "storage basket": "basket", "carrier bag": "bag",
    "paper bag": "bag", "plastic bag": "bag", "cushions": "pillow", "dvd": "books", "bookshelves": "bookshelf",
    "bookcase": "bookshelf", "base unit": "kitchen counter", "kitchen unit": "kitchen cabinet", "couches": "couch",
    "coffee pot": "coffee machine", "laptop computer": "laptop", "crockery": "plate", "seating": "seat",
    "closet door": "door",
    # soft things
    "bedding": "blanket", "bed sheet": "blanket", "sheet": "blanket", "bed linen": "blanket", "bed cover": "blanket",
    "tablecloth": "blanket", "cloth": "towel", "clothes": "towel", "clothing": "towel", "laundry": "towel",
    "shirt": "towel", "jacket": "towel", "coat": "towel", "robe": "towel", "bathrobe": "towel", "dress": "towel",
    "napkin": "towel",
    # parts that are not what their last word names
    "toilet seat": "toilet", "towel bar": "towel", "toilet seat cover dispenser": "soap dispenser",
    "paper towel dispenser": "toilet paper", "grab bar": "object", "power bar": "object", "baseboard": "object",
    "skirting board": "object", "floor board": "object", "footboard": "object", "shower head": "object",
    "shower door": "shower", "shower wall": "shower", "curtain rod": "object", "closet rod": "object",
    "shower rod": "object", "door handle": "object", "door knob": "object", "window sill": "object",
    "table leg": "object", "chair leg": "object", "cabinet door": "object", "surfboard": "object",
    "skateboard": "object", "switchboard": "object", "monitor stand": "object", "pencil case": "box",
    # LVIS
    "television set": "tv", "armoire": "wardrobe", "footstool": "ottoman", "deck chair": "chair",
    "church bench": "bench", "pew": "bench", "mattress": "bed", "hamper": "basket", "wineglass": "glass",
    "cassette": "speaker", "stereo sound system": "speaker", "newspaper": "books", "magazine": "books",
    "notebook": "books", "lantern": "lamp", "easel": "picture", "water jug": "vase", "pitcher": "vase",
    "mousepad": "books",
    # ScanNet and NYU40
    "file cabinets": "filing cabinet", "mini fridge": "refrigerator", "recycling bin": "trash can",
    "trash bin": "trash can", "couch cushions": "pillow", "folded chair": "chair", "stack of chairs": "chair",
    "computer tower": "computer", "bathroom vanity": "bathroom cabinet", "medicine cabinet": "wall cabinet",
    "dish rack": "tray", "bathroom counter": "counter", "end table": "side table", "storage container": "box",
    "storage organizer": "box", "water cooler": "refrigerator", "water dispenser": "refrigerator",
    "case of water bottles": "box", "guitar case": "guitar",
    "otherfurniture": "furniture", "otherstructure": "object", "otherprop": "object", "structure": "object",
    "machine": "object", "tube": "object", "camera": "object",
    # Open Images
    "studio couch": "sofa", "kitchen dining room table": "dining table", "cabinetry": "cabinet", "infant bed": "crib",
    "waste container": "trash can", "houseplant": "plant", "gas stove": "stove", "home appliance": "object",
    "kitchen appliance": "object", "drinkware": "cup", "tableware": "bowl", "musical keyboard": "keyboard",
    "window blind": "blinds", "swivel chair": "office chair", "mechanical fan": "fan", "luggage and bags": "bag",
    "plumbing fixture": "sink", "office supplies": "box", "wood burning stove": "fireplace", "serving tray": "tray",
    # COCO and Pascal VOC
    "potted plant": "plant", "cell phone": "smartphone", "book": "books", "tvmonitor": "display",
    "sports ball": "ball",
    # who and what furnishes no room
    "person": "object", "people": "object", "man": "object", "woman": "object", "child": "object", "boy": "object",
    "girl": "object", "baby": "object", "human": "object", "hand": "object", "face": "object",
    "wall": "object", "floor": "object", "ceiling": "object", "column": "object", "pillar": "object",
    "stairs": "object", "pipe": "object", "sky": "object",
}  # fmt: skip
"""Labels whose meaning is not the one their last words have for the taxonomy, and the words that say it."""


_POSITIONS = frozenset({"left", "right", "front", "back", "middle", "corner", "first", "second", "upper", "lower"})

_NOTHING = "'{}' is nothing that furnishes a room; treated as an unnamed object"

Words = tuple[str, ...]


def understand_label(label: str) -> Resolution:
    """The category that a label names; "object" for what is none.

    Args:
        label: as a person or a detector called one thing: a noun, a phrase, a data set's label.
    """
    resolution = _find(label)
    if resolution is None:
        return resolve(label)
    word, exact = resolution
    kind = _category_of(word)
    if kind is UNKNOWN:
        unsaid = resolve(label)
        said_so = unsaid.exact and unsaid.category is UNKNOWN
        return unsaid if said_so else Resolution(UNKNOWN, exact=False, note=_NOTHING.format(label))
    return Resolution(kind, exact, "" if exact else f"'{label}' is no class of its own; read as '{kind.name}'")


@cache
def plain_word(label: str) -> str | None:
    """The name, synonym or loose word (a key of `MEANINGS`) that a label comes down to; None where it names nothing."""
    resolution = _find(label)
    if resolution is not None:
        return resolution[0]
    slip = resolve(label).category
    return None if slip is UNKNOWN else slip.name


def names_a_kind(label: str) -> bool:
    """Whether the plain word of a label is a name of one kind, and not only loosely used of several: "stand"."""
    word = plain_word(label)
    return word is not None and resolve(word).exact and resolve(word).category is not UNKNOWN


def _category_of(word: str) -> taxonomy.Category:
    named = resolve(word)
    if named.exact or word not in MEANINGS:
        return named.category
    shares = MEANINGS[word]
    return category(max(shares, key=lambda kind: shares[kind]))


def _find(label: str) -> tuple[str, bool] | None:
    """The plain word, and whether it says the same rather than the nearest thing in form."""
    exact, near = _names(), other_names()
    run = next((run for run in _runs(label) if run in exact or run in near), None)
    return None if run is None else (exact.get(run) or near[run], run in exact)


def _runs(label: str) -> Iterator[Words]:
    """Words that may name the thing, the likeliest first."""
    words = tokens(re.sub(r"\([^)]*\)", " ", label))
    while len(words) > 1 and words[-1].isdigit():
        words = words[:-1]
    joint = next((i for i, word in enumerate(words) if word in JOINTS and i > 0), len(words))
    yield from (run for run in _endings(words) if JOINTS.intersection(run))  # "chest of drawers"
    head = words[:joint]
    yield from _endings(head)
    yield from _endings(words[joint + 1 :] if words[joint : joint + 1] == ("of",) else ())  # "pile of books"
    while len(head) > 1 and _describes(head[-1]):  # "chair, black"
        head = head[:-1]
        yield from _endings(head)
    yield from _endings(words)  # "all in one computer"


def _endings(words: Sequence[str]) -> Iterator[Words]:
    """Endings of a phrase, the longest first; each also as one word, for "arm chair" and "waste basket"."""
    for start in range(len(words)):
        ending = tuple(words[start:])
        yield ending
        if len(ending) == 2:
            yield ("".join(ending),)


def _describes(word: str) -> bool:
    return bool(broader(word) or narrower(word) or size_request(word) or word in _POSITIONS)


@cache
def _names() -> Mapping[Words, str]:
    """Normal words of every data set's label, loose word, name and synonym; the former come first."""
    table: dict[Words, str] = {}
    for label, word in LABELS.items():
        table.setdefault(tokens(label), word)
    for word in MEANINGS:
        table.setdefault(tokens(word), word)
    for entry in CATEGORIES:
        table.setdefault(tokens(entry.name), entry.name)
    for entry in CATEGORIES:
        for word in entry.synonyms:
            table.setdefault(tokens(word), UNKNOWN.name if entry is UNKNOWN else word)
    return table


def with_article(words: str) -> str:
    """Words with "a" or "an" before them; those that are plural stay alone."""
    if words.endswith("s") and not words.endswith("ss"):
        return words
    return f"{'an' if words[:1] in 'aeiou' else 'a'} {words}"


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
        return _order(shares)
    if word in MEANINGS:
        shares = dict(MEANINGS[word])
    else:
        special = [c.name for c in CATEGORIES if c.kin == category]
        shares = {category: 1.0, **{name: _SPECIAL_SHARE / len(special) for name in special}}
    if category != UNKNOWN.name:
        shares.setdefault(category, min(shares.values()))
    return _order(shares)


def is_named(label: str) -> bool:
    """Whether a label says anything of what a thing is."""
    return plain_word(label) not in (None, UNKNOWN.name)


def _order(shares: Mapping[str, float]) -> dict[str, float]:
    whole = sum(shares.values())
    return {kind: share / whole for kind, share in sorted(shares.items(), key=lambda row: (-row[1], row[0]))}
