"""Words that are used loosely, and labels of data sets. What labels of people, detectors and data sets say that a thing
is.
"""

from __future__ import annotations

import pytest

from diorama_core.library.labels import (
    FREQUENCIES,
    LABELS,
    MEANINGS,
    is_named,
    meanings,
    names_a_kind,
    plain_word,
    understand_label,
)
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN

NAMES = {c.name for c in CATEGORIES}


def test_every_row_speaks_of_known_kinds_and_no_word_has_two() -> None:
    assert {kind for row in MEANINGS.values() for kind in row} <= NAMES
    assert set(LABELS.values()) <= NAMES | set(MEANINGS)
    assert set(FREQUENCIES) <= NAMES
    assert not set(LABELS) & set(MEANINGS)


VOCABULARY = {
    "chair": "chair, Chairs, dining chair, a wooden chair, folding chair, chair_2, chair 3, stack of chairs, CHAIR",
    "office chair": "black office chair, swivel chair, desk chair, gaming chair, office chair with armrests",
    "armchair": "armchair, arm chair, sofa chair, lounge chair, accent chair",
    "stool": "stool, Stools, wooden step stool",
    "ottoman": "ottoman, pouf, footstool, foot stool, dog bed",
    "bench": "bench, benches, piano bench, window seat",
    "sofa": "couch, Couches, grey couch, gray sofa, 3-seater sofa, loveseat, studio couch, sofa bed, futon",
    "sectional sofa": "corner sofa, sectional, L-shaped sofa",
    "bed": "bed, mattress, double bed, bed frame",
    "crib": "crib, infant bed",
    "table": "table, tables, dining table, dining_table, Kitchen & dining room table, conference table",
    "coffee table": "coffee table, wooden coffee table with glass top, a round coffee table, coffee tables",
    "side table": "end table, side table, small round side table",
    "desk": "desk, office desk, computer desk, lectern",
    "night stand": "nightstand, NIGHT STAND, night_stand, bedside table, nightstands",
    "dresser": "dresser, chest of drawers, old chest of drawers, drawer, drawers",
    "cabinet": "cabinet, cupboard, cabinets, cabinetry, storage",
    "wall cabinet": "medicine cabinet, wall cabinet",
    "filing cabinet": "file cabinet, filing cabinets",
    "kitchen counter": "counter, countertop, counter top, kitchen cabinets, kitchen counter",
    "tv stand": "tv stand, tv-stand, TV cabinet, tv bench, media console, television stand",
    "bookshelf": "bookshelf, bookcase, book shelf, bookshelves, shelving unit",
    "shelves": "shelf, shelves, rack, wall shelf, floating shelves",
    "wardrobe": "wardrobe, closet, armoire",
    "coat rack": "coat rack, ironing board, broom",
    "room divider": "partition, folding screen, railing",
    "lamp": "lamp, lamps, table lamp, lampshade, lantern, bedside lamp",
    "floor lamp": "floor lamp, standing lamp",
    "ceiling lamp": "light, lights, ceiling light, pendant light, light fixture, hanging lamp, spotlight, track light",
    "wall lamp": "wall lamp, sconce",
    "television": "tv, TV, television_set, flat screen tv, tv screen, television",
    "monitor": "monitor, monitor_(computer_equipment) computer_monitor, screen, tvmonitor",
    "laptop": "laptop, laptop_computer, Laptops",
    "computer": "computer tower, computer, all-in-one computer",
    "keyboard": "keyboard, computer keyboard",
    "mouse": "mouse, mouse_(computer_equipment), mice",
    "printer": "printer, copier",
    "telephone": "telephone, phone",
    "smartphone": "cell phone, mobile phone",
    "speaker": "speaker, speaker_(stero_equipment), loudspeaker",
    "pillow": "pillow, cushion, cushions, throw pillow, couch cushions",
    "blanket": "blanket, duvet, bed sheet, bedding, quilt, tablecloth, bedspread",
    "towel": "towel, towels, clothes, clothing, bath_towel, coat",
    "curtain": "curtain, curtains, drapes, shower_curtain",
    "blinds": "blinds, window blind, venetian blinds",
    "rug": "rug, carpet, mat, doormat, floor mat",
    "picture": "picture, painting, poster, photo, wall art, picture frame, art, map, calendar",
    "mirror": "mirror, wall mirror",
    "clock": "clock, wall clock",
    "whiteboard": "whiteboard, blackboard, board",
    "plant": "plant, potted plant, pottedplant, houseplant, flowers, flowerpot, flower pot, tree, Christmas tree",
    "vase": "vase, pitcher_(vessel_for_liquid), vases",
    "box": "box, boxes, cardboard box, storage bin, crate, tissue box, shoe, shoes",
    "basket": "basket, wicker basket, bucket",
    "trash can": "trash can, bin, recycling bin, Waste container, waste basket, garbage bin",
    "backpack": "backpack, bag, paper bag",
    "suitcase": "suitcase, luggage",
    "handbag": "handbag, purse, tote bag",
    "books": "book, books, magazine, newspaper, notebook, binder, pile of books, stack of books",
    "cup": "cup, mug, Coffee cup, cup of coffee",
    "glass": "glass, glasses, wineglass, wine glass",
    "bottle": "bottle, wine bottle, water bottle, thermos",
    "bowl": "bowl, bowls",
    "plate": "plate, dishes",
    "refrigerator": "refrigerator, fridge, mini fridge, water cooler",
    "stove": "stove, oven, gas stove",
    "microwave": "microwave, microwave_oven, toaster oven",
    "sink": "sink, faucet, wash basin",
    "toilet": "toilet, toilet seat",
    "washing machine": "washing machine, washer",
    "fan": "fan, Mechanical fan, hair dryer, vacuum cleaner",
    "heater": "heater, space heater",
    "toy": "toy, teddy bear, stuffed animal, cat",
    "sculpture": "statue_(sculpture), figurine",
    "candle": "candle, candle holder",
}


def test_labels_of_people_and_detectors_are_understood() -> None:
    for label, kind in ((label.strip(), kind) for kind, row in VOCABULARY.items() for label in row.split(", ")):
        assert understand_label(label).category.name == kind, label
        assert is_named(label), label
        assert meanings(label, kind)[kind] > 0.1, label


@pytest.mark.parametrize("label", ["object", "thing", "otherprop", "", "???", "42"])
def test_what_says_nothing_names_nothing(label) -> None:
    assert understand_label(label).category is UNKNOWN
    assert not is_named(label)


@pytest.mark.parametrize(
    "label", ["person", "a man", "ceiling", "skirting board", "curtain rod", "cabinet door", "towel hook"]
)
def test_parts_and_people_are_no_furniture(label) -> None:
    found = understand_label(label)
    assert (found.category is UNKNOWN) == (label != "towel hook")
    assert not found.exact
    assert label in found.note


@pytest.mark.parametrize(("label", "kind"), [("vacuum cleaner", "fan"), ("fire extinguisher", "vase")])
def test_what_is_no_class_is_the_nearest_in_form_and_says_so(label, kind) -> None:
    found = understand_label(label)
    assert (found.category.name, found.exact) == (kind, False)
    assert label in found.note
    assert kind in found.note


@pytest.mark.parametrize(
    ("label", "word"),
    [("chair, black", "chair"), ("Lamp (floor)", "lamp"), ("sofa left", "couch"), ("the big red sofa", "sofa"),
     ("built in oven", "built in oven"), ("dresser with mirror", "dresser"), ("pair of lamps", "lamp")],
)  # fmt: skip
def test_only_the_words_that_name_the_thing_count(label, word) -> None:
    assert understand_label(label).category is understand_label(word).category


def test_slips_are_understood_and_near_names_come_first() -> None:
    assert plain_word("armchiar") == "armchair"
    assert plain_word("tablecloth") == "blanket"


def test_names_of_kinds_and_words_of_several() -> None:
    assert all(map(names_a_kind, ("chair", "couch", "a red armchair", "table")))
    assert not any(map(names_a_kind, ("stand", "seat", "furniture", "object", "???")))


def test_meanings_are_probabilities_that_include_the_word_itself() -> None:
    for name in NAMES - {UNKNOWN.name}:
        shares = meanings(name, name)
        assert sum(shares.values()) == pytest.approx(1.0), name
        assert shares[name] > 0, name
        assert list(shares.values()) == sorted(shares.values(), reverse=True), name


@pytest.mark.parametrize(
    ("label", "kind"),
    [("chair", "office chair"), ("Chairs", "armchair"), ("chair 2", "office chair"), ("red chair", "office chair"),
     ("table", "desk"), ("cabinet", "filing cabinet"), ("lamp", "floor lamp"), ("shelf", "bookshelf"),
     ("light", "ceiling lamp"), ("kitchen_dining_room_table", "desk")],
)  # fmt: skip
def test_loose_words_may_mean(label, kind) -> None:
    assert meanings(label, understand_label(label).category.name)[kind] > 0.02


@pytest.mark.parametrize("label", ["dining chair", "swivel chair", "wing chair", "bedside table"])
def test_words_that_say_which_leave_little_to_others(label) -> None:
    category = understand_label(label).category.name
    assert meanings(label, category)[category] > 0.85


def test_something_without_a_name_may_be_anything_common_objects_first() -> None:
    shares = meanings("object", UNKNOWN.name)
    assert set(shares) == NAMES - {UNKNOWN.name}
    assert next(iter(shares)) == "chair"
