"""What objects in rooms are called, how big they usually are, where they are usually found, and what lies on what.

One table, `kinds.toml`, serves naming (synonyms, plurals, British and American), metrology (size priors), retrieval
(category groups) and support reasoning (what stands on the floor, hangs on a wall or lies on something else).
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from diorama_core.library.kind_rows import PATH, Trait, read_rows
from diorama_core.library.kind_rows import Category as Category
from diorama_core.library.kind_rows import Mount as Mount
from diorama_core.library.kind_rows import SizePrior as SizePrior

CATEGORIES: tuple[Category, ...] = read_rows(PATH.read_text("utf-8"))
"""All canonical categories, in the order of the table."""
UNKNOWN = CATEGORIES[-1]
"""The category of what has no known name."""


@dataclass(frozen=True)
class Resolution:
    """The category a word was understood as."""

    category: Category
    exact: bool
    """False when the word was unknown and the nearest name was taken."""
    note: str = ""
    """What to tell the user when it was not exact."""


ARCHITECTURE_WORDS = frozenset({"wall", "floor", "ceiling", "walls"})
"""Words that name the room itself, never an object."""


def _key(word: str) -> str:
    return re.sub(r"[^a-z0-9]+", " ", word.lower()).strip()


def _singulars(key: str) -> tuple[str, ...]:
    """The key and its likely singulars."""
    forms = [key]
    if key.endswith("ies"):
        forms.append(key[:-3] + "y")
    if key.endswith("ves"):
        forms += [key[:-3] + "f", key[:-3] + "fe"]
    if key.endswith("es"):
        forms.append(key[:-2])
    if key.endswith("s"):
        forms.append(key[:-1])
    return tuple(forms)


@cache
def categories_by_word() -> Mapping[str, Category]:
    """Categories by name and synonym, in small letters, with blanks for all that is no letter or digit."""
    table = {_key(c.name): c for c in CATEGORIES}
    for category in CATEGORIES:
        for word in category.synonyms:
            table.setdefault(_key(word), category)
    return table


def category(name: str) -> Category:
    """The category with this canonical name; raises `KeyError` when there is none."""
    known = categories_by_word().get(_key(name))
    if known is None or known.name != name:
        raise KeyError(name)
    return known


@cache
def broad(name: str) -> str:
    """The category whose rules hold for this one: its kin, or itself when it has none or is unknown."""
    return next((c.kin for c in CATEGORIES if c.name == name and c.kin), name)


@cache
def with_kin(*names: str) -> frozenset[str]:
    """These categories and all the special kinds of them."""
    return frozenset(names) | {c.name for c in CATEGORIES if c.kin in names}


@cache
def having(trait: Trait) -> frozenset[str]:
    """Names of the categories that have a trait."""
    return frozenset(c.name for c in CATEGORIES if trait in c.traits)


@cache
def column(name: str) -> Mapping[str, Any]:
    """Values of a column of the table by category, of those that have one."""
    values = ((c.name, getattr(c, name)) for c in CATEGORIES)
    return {category: value for category, value in values if value is not None}


AGAINST_WALLS = having("back_at_wall")
"""Categories whose backs stand at walls."""
LAMPS = having("lamp")
RUGS = having("rug")
SETS = having("in_sets")
"""What comes in sets of one shape in a room; its books and pictures are different ones."""
PORTABLE = having("portable")
"""What stands on the floor or on furniture, by its size."""
NEVER_OPEN = having("never_open")
"""What nobody looks through: what has the colours of its surroundings within it, has them itself."""


def lies_on_furniture(name: str) -> bool:
    """Whether people put things of a category on furniture: what lies there only, and what is portable."""
    return category(name).mount == "surface" or name in PORTABLE


def carries_things(name: str) -> bool:
    """Whether people put things on what has this label rather than sit on it."""
    kind = resolve(name).category
    return kind.supports_objects and kind.seat_height_m is None


def is_furniture(name: str) -> bool:
    """Whether people call a category furniture: it stands on the floor, and is no lamp, plant, basket or rug."""
    return category(name).mount == "floor" and name not in PORTABLE | LAMPS and broad(name) != "rug"


_OTHER_THINGS = frozenset({
    "beam", "belt", "bird", "bolt", "boot", "bread", "cable", "cake", "car", "cat", "coat", "coin", "cord", "corn",
    "cow", "deer", "dress", "face", "fence", "fish", "flag", "food", "foot", "glove", "goat", "grass", "hammer",
    "hand", "hat", "head", "hook", "horse", "ladder", "leaf", "letter", "lid", "man", "meat", "menu", "nail", "pen",
    "person", "pet", "pipe", "plug", "rail", "road", "rope", "sign", "skateboard", "sky", "snow", "socket", "step",
    "switch", "tent", "tile", "train", "truck", "vent", "wall", "wheel", "wire",
})  # fmt: skip
"""Words of other things that are a letter or two away from words of the table."""
_SLIP_LETTERS, _SLIP_RATIO = 8, 0.75
"""A word of fewer letters is misspelt by one letter too many or too few; and how alike both must be."""


def _correct(key: str, words: tuple[str, ...]) -> str | None:
    """The word that a misspelt one stands for: people get the first letter right, and other words are not slips."""
    if len(key) < 4 or _OTHER_THINGS.intersection(_singulars(key)):
        return None
    off = 1 if len(key) < _SLIP_LETTERS else 2
    alike = [w for w in words if w[:1] == key[:1] and abs(len(w) - len(key)) <= off]
    near = difflib.get_close_matches(key, alike, n=1, cutoff=_SLIP_RATIO)
    return near[0] if near else None


@cache
def resolve(word: str) -> Resolution:
    """Understand a word that a person or a detector used.

    Exact names, synonyms and plurals first; then the last words of a phrase ("wooden armchair"); then the nearest
    spelling, with a note; at last the category "object".
    """
    table = categories_by_word()
    key = _key(word)
    parts = key.split()
    for start in range(len(parts)):
        for form in _singulars(" ".join(parts[start:])):
            if form in table:
                return Resolution(table[form], exact=True)
    near = _correct(key, tuple(table))
    if near is not None:
        entry = table[near]
        return Resolution(entry, exact=False, note=f"'{word}' is not a known class; read as '{entry.name}'")
    return Resolution(UNKNOWN, exact=False, note=f"'{word}' is not a known class; treated as an unnamed object")


CARRIES_AS: Mapping[str, str] = column("carries_as")
"""By carrier, the kind whose loads lie on it. Kinds that are not named lie there now and then if they lie at all."""

CARRIED_KINDS: frozenset[str] = frozenset(column("lies_on"))
"""All that lies on other things now and then, whatever else it stands on."""

STACKED_ON = having("stacked_on")
"""Small things that lie on others and on which others are put."""

WITH_BOARDS = having("has_boards")
"""Furniture in which things are found as well as on it: on boards below its top."""

SELDOM_CARRIED, HARDLY_CARRIED = 0.3, 0.08
"""Ratios for kinds that lie on things and are not named, and for those that stand on floors or hang."""


def often_carried(kind: str, carrier: str) -> float:
    """How many times more often a kind lies on a carrier than it is met at all; 1 where nothing is known of either."""
    if carrier not in CARRIES_AS or kind == UNKNOWN.name:
        return 1.0
    seldom = SELDOM_CARRIED if lies_on_furniture(kind) else HARDLY_CARRIED
    return (category(kind).lies_on or {}).get(CARRIES_AS[carrier], seldom)


ROOMS: Mapping[str, frozenset[str]] = {
    room: frozenset(kind for kind, rooms in column("rooms").items() if room in rooms)
    for room in sorted({room for rooms in column("rooms").values() for room in rooms})
}
"""Kinds that are met more often in a room of a type than elsewhere."""


@cache
def usual_carriers(kind: str) -> tuple[str, ...]:
    """What things of a kind are put on, the likeliest first: where they lie more often than they are met at all."""
    weights = {carrier: often_carried(kind, carrier) for carrier in CARRIES_AS if kind != UNKNOWN.name}
    likely = sorted(
        weights, key=lambda carrier: (-weights[carrier], CARRIES_AS[carrier] != carrier, category(carrier).kin)
    )
    return tuple(carrier for carrier in likely if weights[carrier] > 1.0)


def carrier_in(kind: str, room: str) -> str | None:
    """What a thing of a kind is most likely put on in a room of a type; None for what is not put on furniture."""
    at_home, usual = ROOMS.get(room, frozenset()), column("frequency")
    carriers = [carrier for carrier in usual_carriers(kind) if not category(carrier).kin]
    return max(
        carriers,
        key=lambda carrier: (often_carried(kind, carrier) * (1 + (carrier in at_home)), usual.get(carrier, 0.0)),
        default=None,
    )
