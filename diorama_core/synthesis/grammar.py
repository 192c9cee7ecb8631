"""The room grammar: kinds of rooms and how each is furnished.

`furnish_room` is the one way in. A room is built in the order in which people move in: doors and windows, the
main group of furniture, what stands along the walls, what hangs on them, and at last the small objects. Every step
places only what is free of all meshes placed before, so a room is valid by construction.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Scene
from diorama_core.synthesis import groups
from diorama_core.synthesis.clutter import equip_desk, pillows, scatter
from diorama_core.synthesis.finishes import choose_finishes
from diorama_core.synthesis.furnisher import Furnisher
from diorama_core.synthesis.openings import add_door, add_window
from diorama_core.synthesis.plan import Outline, room_plan
from diorama_core.synthesis.splits import Split

RoomKind = Literal["living", "bedroom", "office", "kitchen", "dining", "study", "lab", "bathroom", "corridor"]
ROOM_KINDS: tuple[RoomKind, ...] = get_args(RoomKind)


@dataclass(frozen=True)
class Recipe:
    """How big a kind of room is, what outlines it may have, and how it is furnished."""

    width_m: tuple[float, float]
    depth_m: tuple[float, float]
    furnish: Callable[[Furnisher], None]
    outlines: tuple[Outline, ...] = ("box", "box", "L-shape", "slanted wall")
    windows: tuple[int, int] = (1, 2)
    clutter: tuple[int, int] = (4, 20)


def furnish_room(
    seed: int,
    kind: RoomKind,
    library: ShapeLibrary | None = None,
    *,
    outline: Outline | None = None,
    clutter: int | None = None,
    split: Split | None = None,
    extra: Callable[[Furnisher], None] | None = None,
) -> Scene:
    """A furnished room with its architecture and support graph: the truth that pictures are made of.

    The room frame has its origin in the middle of the floor; the scene has no camera yet (`cameras.sample_cameras`).
    Shapes are chosen by category, so any library will do; the same library, seed and kind give the same room.
    Planes carry the names of procedural finishes in `Plane.texture` (`finishes.finish_textures`).

    Args:
        seed: Of everything left to chance.
        kind: What the room is for.
        library: Where shapes come from; the built-in one by default.
        outline: The floor's outline; None leaves it to chance.
        clutter: How many small objects to try to place; None leaves it to chance.
        split: Whose finishes and room styles are used (shapes are the given library's); all by default.
        extra: Adds further objects after the furniture and before the clutter.
    """
    library = library or built_in_library()
    rng = np.random.default_rng((seed, zlib.crc32(kind.encode())))
    recipe = RECIPES[kind]
    shape: Outline = outline or recipe.outlines[int(rng.integers(len(recipe.outlines)))]
    plan = room_plan(rng, recipe.width_m, recipe.depth_m, shape)
    f = Furnisher(plan, library, rng)
    add_door(f)
    _windows(f, int(rng.integers(recipe.windows[0], recipe.windows[1] + 1)))
    recipe.furnish(f)
    if extra is not None:
        extra(f)
    budget = int(rng.integers(*recipe.clutter)) if clutter is None else clutter
    carriers = [o.id for o in f.objects if o.category not in ("sofa", "armchair", "chair", "bed", "rug", "stool")]
    scatter(f, carriers, budget)
    scene = Scene(
        architecture=plan.architecture(choose_finishes(rng, kind, split)),
        objects=tuple(f.objects),
        supports=tuple(f.supports),
    )
    check_scene(scene)
    return scene


def _windows(f: Furnisher, count: int) -> None:
    walls = groups.long_walls(f, 1.9)
    for k in f.rng.permutation(len(walls))[:count]:
        add_window(f, walls[int(k)])


def _living(f: Furnisher) -> None:
    sofa = groups.seating(f)
    if f.plan.area_m2 > 20 and f.chance(0.6):
        groups.dining(f, rug=f.chance(0.3))
    groups.storage(
        f, int(f.rng.integers(1, 4)), "bookshelf", "bookshelf", "sideboard", "cabinet", "console table", "piano",
        "display cabinet", "chest",
    )  # fmt: skip
    groups.corner_objects(
        f,
        int(f.rng.integers(1, 4)),
        "plant",
        "plant",
        "floor lamp",
        "basket",
        "grandfather clock",
        "guitar",
        "bean bag",
    )
    groups.pictures(f, int(f.rng.integers(1, 4)))
    groups.ceiling_light(f)
    if sofa:
        pillows(f, sofa, int(f.rng.integers(0, 5)))
    if f.chance(0.4):
        _loose(f, "ottoman")


def _bedroom(f: Furnisher) -> None:
    groups.sleeping(f)
    groups.storage(f, int(f.rng.integers(1, 3)), "wardrobe")
    groups.storage(f, int(f.rng.integers(1, 3)), "dresser", "bookshelf", "cabinet", "chest")
    if f.plan.area_m2 > 14 and f.chance(0.5):
        desk = groups.workplace(f)
        if desk:
            equip_desk(f, desk)
    _hang_over_all(f, "dresser", "mirror", "picture")
    groups.corner_objects(
        f, int(f.rng.integers(1, 3)), "plant", "basket", "floor lamp", "armchair", "laundry basket", "floor mirror"
    )
    groups.pictures(f, int(f.rng.integers(0, 3)))
    groups.ceiling_light(f)


def _office(f: Furnisher) -> None:
    for _ in range(int(f.rng.integers(2, 5))):
        desk = groups.workplace(f)
        if desk:
            equip_desk(f, desk)
    if f.plan.area_m2 > 22 and f.chance(0.6):
        groups.dining(f)
    groups.storage(f, int(f.rng.integers(1, 4)), "bookshelf", "cabinet", "filing cabinet")
    groups.corner_objects(f, int(f.rng.integers(1, 3)), "plant", "trash can", "box", "fan")
    groups.pictures(f, int(f.rng.integers(1, 3)), "picture", "clock", "whiteboard", "bulletin board")
    groups.ceiling_light(f)


def _study(f: Furnisher) -> None:
    desk = groups.workplace(f)
    if desk:
        equip_desk(f, desk)
    groups.storage(f, int(f.rng.integers(2, 4)), "bookshelf")
    armchair = f.pick("armchair", "recliner", "rocking chair")
    if armchair and f.against_wall(armchair, gap_m=0.15, free_front_m=0.4):
        groups.corner_objects(f, 1, "floor lamp")
    _rug_in_the_middle(f)
    groups.corner_objects(f, int(f.rng.integers(0, 3)), "plant", "box", "trash can")
    groups.pictures(f, int(f.rng.integers(1, 3)))
    groups.ceiling_light(f)


def _kitchen(f: Furnisher) -> None:
    walls = groups.long_walls(f, 2.4)
    for wall in walls:
        row = groups.row_along_wall(f, wall, ("refrigerator", "kitchen counter", "stove", "kitchen counter"))
        if len(row) >= 2:
            _shelves_above(f, row)
            break
    if f.chance(0.5):
        groups.storage(f, 1, "washing machine", "cabinet", "pantry cabinet", "wine rack")
    groups.dining(f)
    groups.corner_objects(f, int(f.rng.integers(1, 3)), "trash can", "plant", "basket")
    groups.pictures(f, int(f.rng.integers(1, 3)), "picture", "clock")
    groups.ceiling_light(f)


def _dining(f: Furnisher) -> None:
    groups.dining(f, np.zeros(2), rug=f.chance(0.5))
    groups.storage(f, int(f.rng.integers(1, 3)), "sideboard", "cabinet", "dresser", "display cabinet", "bar cart")
    _hang_over_all(f, "sideboard", "picture", "mirror")
    groups.corner_objects(f, int(f.rng.integers(1, 3)), "plant", "floor lamp")
    groups.pictures(f, int(f.rng.integers(1, 4)))
    groups.ceiling_light(f)


def _lab(f: Furnisher) -> None:
    for wall in groups.long_walls(f, 2.0)[: int(f.rng.integers(2, 4))]:
        row = groups.row_along_wall(f, wall, ("table", "table") if wall.length_m > 3.4 else ("table",), 0.4)
        for table in row:
            equip_desk(f, table)
            stool = f.pick("stool", "office chair", where=lambda s: s.size_m[2] > 0.4)
            size = f.object(table).size_m
            if stool:
                xy = groups.local_xy(
                    f, table, size[0] / 2 + stool.size_m[0] / 2 + 0.03, float(f.rng.uniform(-0.2, 0.2))
                )
                f.stand(stool, xy, f.object(table).pose.yaw_rad + np.pi + float(f.rng.normal(0, 0.4)), in_zone=True)
    groups.storage(f, int(f.rng.integers(1, 4)), "cabinet", "bookshelf", "refrigerator")
    groups.corner_objects(f, int(f.rng.integers(1, 3)), "trash can", "box", "computer")
    groups.pictures(f, int(f.rng.integers(1, 3)), "picture", "clock")
    groups.ceiling_light(f)


def _bathroom(f: Furnisher) -> None:
    tub = f.pick("bathtub")
    if tub:
        f.against_wall(tub, walls=groups.long_walls(f, tub.size_m[1] + 0.1), free_front_m=0.0, corner=True)
    sink = f.pick("sink", where=lambda s: s.size_m[2] > 0.7)
    basin = f.against_wall(sink, free_front_m=0.5) if sink else None
    if basin:
        groups.picture_above(f, basin, "mirror", gap_m=0.12)
    toilet = f.pick("toilet", where=lambda s: s.size_m[2] < 1.2)
    if toilet:
        f.against_wall(toilet, free_front_m=0.45)
    groups.storage(f, int(f.rng.integers(0, 2)), "washing machine", "cabinet")
    mat = f.pick("rug", "bath mat", where=lambda s: s.size_m[0] < 1.0)
    if mat:
        f.anywhere(mat)
    groups.corner_objects(
        f, int(f.rng.integers(1, 4)), "basket", "trash can", "plant", "stool", "laundry basket", "bathroom scale"
    )
    towels = f.pick("radiator", where=lambda s: s.size_m[2] > 0.9)
    if towels and f.chance(0.6):
        wall = f.plan.walls[int(f.rng.integers(len(f.plan.walls)))]
        f.hang(towels, wall, float(f.rng.uniform(0.5, max(wall.length_m - 0.5, 0.6))), 1.1)
    for _ in range(3):
        wall = f.plan.walls[int(f.rng.integers(len(f.plan.walls)))]
        groups.wall_shelf(f, wall, float(f.rng.uniform(0.6, max(wall.length_m - 0.6, 0.7))), 1.4)
    groups.pictures(f, int(f.rng.integers(1, 3)), "picture", "mirror", "towel")
    groups.ceiling_light(f)


def _corridor(f: Furnisher) -> None:
    add_door(f)
    add_door(f)
    groups.storage(f, int(f.rng.integers(2, 4)), "console table", "bench", "cabinet", "shoe cabinet", "bookshelf")
    _hang_over_all(f, "console table", "mirror", "picture")
    _hang_over_all(f, "dresser", "mirror", "picture")
    _rug_in_the_middle(f)
    groups.corner_objects(
        f, int(f.rng.integers(1, 4)), "plant", "box", "basket", "floor lamp", "coat rack", "umbrella stand"
    )
    groups.pictures(f, int(f.rng.integers(2, 5)))
    groups.ceiling_light(f)


def _hang_over_all(f: Furnisher, category: str, *hung: str) -> None:
    for item in [o for o in f.objects if o.category == category]:
        groups.picture_above(f, item.id, *hung)


def _loose(f: Furnisher, category: str) -> None:
    item = f.pick(category)
    if item:
        f.anywhere(item, margin_m=0.1)


def _rug_in_the_middle(f: Furnisher) -> None:
    rug = f.pick("rug", where=lambda s: s.size_m[0] > 1.0)
    if rug is None:
        return
    extent = np.ptp(f.plan.outline, axis=0)
    yaw = 0.0 if (rug.size_m[0] > rug.size_m[1]) == (extent[0] > extent[1]) else np.pi / 2
    middle = 0.5 * (f.plan.outline.min(axis=0) + f.plan.outline.max(axis=0))
    for spread in (0.1, 0.3, 0.6):
        if f.stand(rug, middle + f.rng.normal(0.0, spread, 2), yaw):
            return


def _shelves_above(f: Furnisher, row: list[str]) -> None:
    for unit in row:
        if f.object(unit).category == "kitchen counter" and f.chance(0.7):
            at = groups.wall_at_back(f, unit)
            if at:
                groups.wall_shelf(f, at[0], at[1], 1.45)


SLEPT_IN: tuple[Outline, ...] = ("box", "box", "L-shape", "slanted wall", "attic")
"""Outlines of rooms that are found under roofs too."""
RECIPES: dict[RoomKind, Recipe] = {
    "living": Recipe((4.2, 6.2), (3.8, 5.4), _living, clutter=(8, 40)),
    "bedroom": Recipe((3.4, 5.0), (3.4, 4.6), _bedroom, SLEPT_IN, clutter=(5, 18)),
    "office": Recipe((4.0, 6.5), (3.8, 5.5), _office, SLEPT_IN, clutter=(8, 40)),
    "kitchen": Recipe((3.6, 5.4), (3.4, 4.8), _kitchen, clutter=(8, 30)),
    "dining": Recipe((3.8, 5.4), (3.6, 4.8), _dining, clutter=(6, 24)),
    "study": Recipe((3.0, 4.4), (3.0, 4.2), _study, SLEPT_IN, clutter=(8, 34)),
    "lab": Recipe((4.8, 7.0), (4.2, 6.0), _lab, clutter=(8, 36)),
    "bathroom": Recipe((2.4, 3.4), (2.6, 3.6), _bathroom, ("box", "box", "slanted wall"), (0, 1), (6, 16)),
    "corridor": Recipe((1.9, 2.4), (4.5, 7.0), _corridor, ("box", "box", "L-shape"), (0, 1), (3, 12)),
}
