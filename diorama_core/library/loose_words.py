"""Words that are used loosely, with how often each kind is meant by them, and what data sets' labels say for them.

The shares are rough frequencies in photos of homes and offices; what a photo shows of the thing decides.
"""

from __future__ import annotations

from collections.abc import Mapping

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
    "dining table": {"table": 0.78, "coffee table": 0.09, "desk": 0.08, "side table": 0.03, "kitchen island": 0.02},
    "round table": {"table": 0.5, "side table": 0.25, "coffee table": 0.25},
    "desk": {"desk": 0.9, "table": 0.06, "vanity table": 0.04},
    "console": {"console table": 0.5, "tv stand": 0.35, "sideboard": 0.1, "game console": 0.05},
    "counter": {"kitchen counter": 0.75, "kitchen island": 0.2, "desk": 0.05},
    "island": {"kitchen island": 0.9, "kitchen counter": 0.1},
    "cabinet": _CASES,
    "cupboard": _CASES,
    "kitchen cabinet": {"kitchen counter": 0.45, "wall cabinet": 0.45, "pantry cabinet": 0.1},
    "bathroom cabinet": {"cabinet": 0.5, "wall cabinet": 0.3, "sink": 0.2},
    "vanity": {"vanity table": 0.4, "cabinet": 0.35, "sink": 0.25},
    "storage": {**_CASES, "bookshelf": 0.15, "shelves": 0.1, "box": 0.1},
    "furniture": {**_CASES, "table": 0.1, "chair": 0.1},
    "drawer": {"dresser": 0.6, "night stand": 0.25, "filing cabinet": 0.1, "cabinet": 0.05},
    "bureau": {"dresser": 0.6, "desk": 0.4},
    "chest": {"chest": 0.65, "dresser": 0.35},
    "dresser": {"dresser": 0.9, "sideboard": 0.04, "changing table": 0.02, "vanity table": 0.02, "night stand": 0.02},
    "sideboard": {"sideboard": 0.85, "tv stand": 0.06, "chest": 0.04, "cabinet": 0.05},
    "stand": {"tv stand": 0.4, "night stand": 0.25, "side table": 0.2, "console table": 0.1, "coat rack": 0.05},
    "wardrobe": {"wardrobe": 0.92, "pantry cabinet": 0.04, "locker": 0.02, "cabinet": 0.02},
    "shelf": _SHELVES,
    "rack": {"shelves": 0.35, "bookshelf": 0.25, "coat rack": 0.2, "wine rack": 0.1, "shoe cabinet": 0.1},
    "trunk": {"chest": 0.9, "suitcase": 0.1},
    "tv": {"television": 0.85, "monitor": 0.15},
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
    "flower": {"plant": 0.85, "vase": 0.15},
    "flowerpot": {"plant": 0.8, "vase": 0.2},
    "pot": {"plant": 0.5, "cooking pot": 0.4, "vase": 0.1},
    "box": {"box": 0.88, "basket": 0.04, "chest": 0.04, "suitcase": 0.02, "books": 0.02},
    "basket": {"basket": 0.7, "laundry basket": 0.25, "trash can": 0.05},
    "bin": {"trash can": 0.8, "box": 0.12, "basket": 0.08},
    "bag": {"handbag": 0.5, "backpack": 0.4, "suitcase": 0.1},
    "case": {"suitcase": 0.7, "display cabinet": 0.15, "box": 0.15},
    "mat": {"rug": 0.75, "bath mat": 0.2, "yoga mat": 0.05},
    "ball": {"toy": 0.7, "exercise ball": 0.3},
    "container": {"box": 0.6, "basket": 0.15, "jar": 0.15, "bottle": 0.1},
    "glass": {"glass": 0.95, "cup": 0.05},
    "cup": {"cup": 0.88, "glass": 0.12},
    "bowl": {"bowl": 0.92, "plate": 0.04, "tray": 0.04},
    "dish": {"plate": 0.6, "bowl": 0.35, "tray": 0.05},
    "vase": {"vase": 0.95, "jar": 0.05},
    "phone": {"telephone": 0.5, "smartphone": 0.5},
    "keyboard": {"keyboard": 0.95, "piano": 0.05},
    "player": {"record player": 1.0},
}  # fmt: skip
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
