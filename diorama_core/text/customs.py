"""What rooms of a kind hold, and how furniture stands to other furniture where a prompt does not say."""

from __future__ import annotations

from typing import cast

from diorama_core.editing.relations import RelationKind
from diorama_core.library.taxonomy import category as find_category
from diorama_core.library.taxonomy import usual_carriers, with_kin
from diorama_core.synthesis import RoomKind

ESSENTIALS: dict[RoomKind, tuple[tuple[str, int], ...]] = {
    "kitchen": (("kitchen counter", 1), ("stove", 1), ("refrigerator", 1)),
    "bathroom": (("sink", 1), ("toilet", 1), ("bathtub", 1)),
    "bedroom": (("bed", 1),),
    "dining": (("table", 1), ("chair", 4)),
    "study": (("desk", 1), ("office chair", 1)),
    "office": (("desk", 1), ("office chair", 1)),
}
"""Added where a prompt names the kind of room and nothing that does the same."""
DECOR: dict[RoomKind, tuple[str, ...]] = {
    "living": ("ceiling lamp", "picture"), "bedroom": ("ceiling lamp", "picture"), "office": ("ceiling lamp",),
    "kitchen": ("ceiling lamp", "wall cabinet"), "dining": ("ceiling lamp", "picture"), "study": ("ceiling lamp", "picture"),
    "lab": ("ceiling lamp",), "bathroom": ("ceiling lamp", "mirror"), "corridor": ("ceiling lamp", "picture"),
}  # fmt: skip
"""What is added at last, where nothing of its kind was asked for; it hangs, so it takes no room."""


def stands_in_for(category: str, present: frozenset[str]) -> bool:
    """Whether something asked for does what an essential of a room does."""
    kinds = with_kin(category, *find_category(category).instead or ())
    return bool(kinds & present)


def usual_relations_of(kind: str) -> tuple[tuple[RelationKind, tuple[str, ...]], ...]:
    """How objects of a category stand where nobody says: relations in the order of their weight, and their targets."""
    row = find_category(kind)
    on = usual_carriers(kind) if row.mount == "surface" else ()
    stands = ((cast(RelationKind, relation), targets) for relation, targets in row.usual_relations or ())
    return (*((("on", on),) if on else ()), *stands)
