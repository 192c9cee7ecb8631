"""Words that are used loosely, with how often each kind is meant by them, and what data sets' labels say for them.

The shares are rough frequencies in photos of homes and offices; what a photo shows of the thing decides.
"""

from __future__ import annotations

from collections.abc import Mapping

from diorama_core.library.taxonomy import column

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
