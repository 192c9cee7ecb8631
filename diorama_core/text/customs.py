"""What rooms of a kind hold, and how furniture stands to other furniture where a prompt does not say."""

from __future__ import annotations

from diorama_core.editing.relations import RelationKind
from diorama_core.library.taxonomy import with_kin
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
INSTEAD: dict[str, tuple[str, ...]] = {
    "kitchen counter": ("kitchen island",), "bathtub": ("shower",), "bed": ("bunk bed", "crib", "day bed"),
    "office chair": ("chair", "stool", "armchair", "bench"), "chair": ("bench", "stool", "armchair"),
    "desk": ("vanity table", "table"), "toilet": (), "sink": (), "stove": ("wall oven",), "refrigerator": (),
}  # fmt: skip
USUAL: dict[str, tuple[tuple[RelationKind, tuple[str, ...]], ...]] = {
    "coffee table": (("in front of", ("sofa",)), ("near", ("armchair",))),
    "armchair": (("facing", ("coffee table", "fireplace", "sofa", "television", "side table", "table")), ("near", ("coffee table", "sofa", "side table", "table", "armchair"))),
    "side table": (("beside", ("armchair", "sofa", "bed")),),
    "floor lamp": (("beside", ("armchair", "sofa", "desk", "bookshelf")),),
    "night stand": (("beside", ("bed",)),),
    "tv stand": (("opposite", ("sofa", "bed")),),
    "television": (("on", ("tv stand", "sideboard", "cabinet")),),
    "office chair": (("around", ("desk", "table")), ("facing", ("desk",))),
    "chair": (("around", ("table", "desk", "vanity table")), ("facing", ("table", "desk"))),
    "stool": (("around", ("kitchen island", "kitchen counter", "table", "piano", "vanity table")),),
    "bench": (("around", ("table", "piano")), ("in front of", ("bed",))),
    "rug": (("under", ("coffee table", "table")), ("in front of", ("sofa", "bed"))),
    "plant": (("in corner", ()),),
    "pillow": (("on", ("sofa", "bed", "armchair")),),
    "monitor": (("on", ("desk",)),),
    "keyboard": (("on", ("desk",)),),
    "laptop": (("on", ("desk", "table")),),
    "lamp": (("on", ("night stand", "desk", "side table", "sideboard", "dresser")),),
    "picture": (("above", ("sofa", "bed", "sideboard", "desk", "fireplace")),),
    "mirror": (("above", ("sink", "dresser", "console table", "vanity table")),),
    "ceiling lamp": (("above", ("table", "coffee table")),),
    "ottoman": (("in front of", ("armchair", "sofa")),),
    "wall cabinet": (("above", ("kitchen counter",)),),
    "stove": (("beside", ("kitchen counter",)),),
    "refrigerator": (("beside", ("stove", "kitchen counter")),),
    "washing machine": (("beside", ("kitchen counter",)),),
    "dishwasher": (("beside", ("kitchen counter",)),),
    "range hood": (("above", ("stove",)),),
    "kitchen island": (("opposite", ("kitchen counter",)),),
    "vase": (("on", ("table", "coffee table", "sideboard", "side table")),),
    "microwave": (("on", ("kitchen counter",)),),
    "kettle": (("on", ("kitchen counter",)),),
    "curtain": (("beside", ("window",)),),
    "fireplace": (("opposite", ("sofa",)),),
    "bed": (("against wall", ()),),
}  # fmt: skip
"""By category, relations in the order of their weight; of the targets, the first that is there."""
DECOR: dict[RoomKind, tuple[str, ...]] = {
    "living": ("ceiling lamp", "picture"), "bedroom": ("ceiling lamp", "picture"), "office": ("ceiling lamp",),
    "kitchen": ("ceiling lamp", "wall cabinet"), "dining": ("ceiling lamp", "picture"), "study": ("ceiling lamp", "picture"),
    "lab": ("ceiling lamp",), "bathroom": ("ceiling lamp", "mirror"), "corridor": ("ceiling lamp", "picture"),
}  # fmt: skip
"""What is added at last, where nothing of its kind was asked for; it hangs, so it takes no room."""


HOSTS: dict[str, str] = {
    "lamp": "side table", "television": "tv stand", "vase": "side table", "monitor": "desk", "keyboard": "desk",
    "laptop": "desk", "pillow": "sofa", "books": "bookshelf", "bowl": "table", "cup": "table", "microwave": "kitchen counter",
    "record player": "sideboard", "globe": "side table", "printer": "desk", "sculpture": "side table",
}  # fmt: skip
"""Added for what lies on furniture where a prompt names none that could carry it."""


def stands_in_for(category: str, present: frozenset[str]) -> bool:
    """Whether something asked for does what an essential of a room does."""
    kinds = with_kin(category, *INSTEAD.get(category, ()))
    return bool(kinds & present)
