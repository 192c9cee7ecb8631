"""What company kinds keep: what lies on what, and in which rooms things are, as rough counts in homes and offices."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from diorama_core.library.taxonomy import UNKNOWN, lies_on_furniture, with_kin


@dataclass(frozen=True)
class Carried:
    """How many times more often kinds lie on some carriers than they are met at all."""

    carriers: frozenset[str]
    kinds: Mapping[str, float]


CARRIED: tuple[Carried, ...] = (
    Carried(with_kin("bed"), {
        "pillow": 14, "blanket": 14, "towel": 3, "toy": 3, "tray": 1, "handbag": 1, "books": 1, "laptop": 1,
    }),
    Carried(with_kin("sofa", "armchair"), {
        "pillow": 16, "blanket": 8, "toy": 2, "handbag": 1, "books": 1, "laptop": 1,
    }),
    Carried(with_kin("chair", "office chair", "bench", "stool"), {
        "pillow": 6, "blanket": 4, "handbag": 3, "towel": 1, "books": 1,
    }),
    Carried(with_kin("desk"), {
        "monitor": 14, "keyboard": 14, "mouse": 14, "laptop": 12, "telephone": 10, "computer": 8, "printer": 8,
        "lamp": 5, "globe": 5, "books": 4, "speaker": 4, "cup": 3, "photo frame": 3, "box": 2, "plant": 2, "bottle": 1,
        "vase": 1, "candle": 1,
    }),
    Carried(with_kin("night stand"), {
        "lamp": 14, "photo frame": 6, "mantel clock": 6, "telephone": 5, "books": 4, "clock": 4, "vase": 4, "cup": 3,
        "glass": 3, "candle": 3, "bottle": 2, "plant": 2, "box": 2,
    }),
    Carried(with_kin("side table", "console table", "dresser", "sideboard", "cabinet", "piano", "fireplace"), {
        "lamp": 8, "vase": 6, "photo frame": 6, "sculpture": 6, "mantel clock": 6, "candle": 5, "tray": 5,
        "vanity mirror": 5, "record player": 5, "books": 4, "plant": 4, "bowl": 4, "jar": 4, "cup": 3, "box": 3,
        "bottle": 3, "television": 3, "telephone": 3, "speaker": 3, "mirror": 2, "glass": 2, "toy": 2, "basket": 2,
        "coffee machine": 2, "microwave": 2, "picture": 1,
    }),
    Carried(with_kin("tv stand"), {
        "television": 20, "game console": 14, "speaker": 5, "remote control": 4, "router": 4, "books": 3, "vase": 3,
        "photo frame": 3, "box": 2, "plant": 2,
    }),
    Carried(with_kin("coffee table"), {
        "tray": 9, "remote control": 8, "books": 7, "vase": 6, "cup": 6, "bowl": 6, "candle": 6, "glass": 4, "fruit": 4,
        "plate": 3, "bottle": 3, "plant": 2, "laptop": 2, "box": 2, "toy": 2,
    }),
    Carried(with_kin("table"), {
        "bowl": 8, "plate": 8, "glass": 7, "vase": 7, "cup": 6, "fruit": 6, "bottle": 5, "candle": 5, "tray": 5,
        "utensils": 5, "laptop": 4, "books": 3, "plant": 2, "box": 2, "lamp": 1, "monitor": 1,
    }),
    Carried(with_kin("bookshelf", "shelves"), {
        "books": 8, "photo frame": 6, "sculpture": 6, "box": 6, "globe": 6, "vase": 5, "plant": 4, "basket": 4,
        "jar": 4, "toy": 4, "mantel clock": 4, "bowl": 3, "candle": 3, "speaker": 3, "cup": 2, "bottle": 2,
    }),
    Carried(with_kin("kitchen counter", "stove"), {
        "kettle": 12, "toaster": 12, "coffee machine": 12, "blender": 12, "cooking pot": 12, "cutting board": 12,
        "microwave": 10, "utensils": 10, "bottle": 6, "jar": 6, "cup": 5, "soap dispenser": 5, "fruit": 5, "bowl": 4,
        "plate": 4, "glass": 4, "tray": 4, "sink": 3, "vase": 2, "box": 2, "towel": 2, "plant": 1,
    }),
)  # fmt: skip
"""Kinds that are not named lie there now and then if they lie on things at all."""

CARRIED_KINDS: frozenset[str] = frozenset(kind for row in CARRIED for kind in row.kinds)
"""All that lies on other things now and then, whatever else it stands on."""

STACKED_ON: frozenset[str] = with_kin("books", "box", "tray", "plate")
"""Small things that lie on others and on which others are put."""

WITH_BOARDS: frozenset[str] = with_kin(
    "bookshelf", "shelves", "cabinet", "tv stand", "desk", "wardrobe", "night stand", "sideboard", "coffee table",
    "side table",
)  # fmt: skip
"""Furniture in which things are found as well as on it: on boards below its top."""

SELDOM_CARRIED, HARDLY_CARRIED = 0.3, 0.08
"""The same of kinds that lie on things and are not named, and of those that stand on floors or hang."""


def often_carried(kind: str, carrier: str) -> float:
    """How many times more often a kind lies on a carrier than it is met at all; 1 where nothing is known of either."""
    row = next((row for row in CARRIED if carrier in row.carriers), None)
    if row is None or kind == UNKNOWN.name:
        return 1.0
    return row.kinds.get(kind, SELDOM_CARRIED if lies_on_furniture(kind) else HARDLY_CARRIED)


ROOMS: Mapping[str, frozenset[str]] = {
    "bedroom": frozenset({
        "bed", "bunk bed", "day bed", "crib", "night stand", "dresser", "wardrobe", "pillow", "blanket", "lamp",
        "wall lamp", "mirror", "toy", "vanity table", "laundry basket", "curtain", "chest", "handbag",
    }),
    "living": frozenset({
        "sofa", "sectional sofa", "armchair", "coffee table", "side table", "tv stand", "television", "rug", "pillow",
        "lamp", "wall lamp", "floor lamp", "bookshelf", "fireplace", "plant", "curtain", "picture", "books",
        "sideboard", "speaker", "chandelier",
    }),
    "dining": frozenset({
        "table", "chair", "sideboard", "chandelier", "vase", "bowl", "plate", "glass", "display cabinet", "wine rack",
        "bottle", "fruit", "candle", "picture", "cabinet",
    }),
    "kitchen": frozenset({
        "kitchen counter", "wall cabinet", "stove", "refrigerator", "sink", "microwave", "range hood", "dishwasher",
        "kitchen island", "bar stool", "kettle", "toaster", "coffee machine", "cooking pot", "utensils",
        "cutting board", "bottle", "bowl", "cup", "plate", "glass", "fruit", "wall oven", "blender", "box", "trash can",
    }),
    "office": frozenset({
        "desk", "office chair", "monitor", "keyboard", "mouse", "computer", "laptop", "printer", "filing cabinet",
        "bookshelf", "whiteboard", "telephone", "books", "box", "trash can", "chair", "table", "bulletin board",
        "cabinet", "room divider",
    }),
    "bathroom": frozenset({
        "toilet", "sink", "bathtub", "shower", "mirror", "towel", "soap dispenser", "toilet paper", "bath mat",
        "toilet brush", "laundry basket", "basket", "trash can", "bottle", "radiator", "washing machine",
    }),
}  # fmt: skip
"""Kinds that are met more often in a room of a type than elsewhere."""
