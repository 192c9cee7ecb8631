"""Small objects where people leave them: books in shelves, cups on trays on tables, lamps on night stands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diorama_core.library.record import Shape
from diorama_core.library.taxonomy import having
from diorama_core.synthesis.bodies import Item
from diorama_core.synthesis.furnisher import Furnisher
from diorama_core.synthesis.groups import put_on


@dataclass(frozen=True)
class Habit:
    """What people put on objects of a category."""

    items: tuple[str, ...]
    """Categories, likelier ones repeated."""
    most: int
    """Per open surface."""
    tallest_m: float = 0.6


HABITS: dict[str, Habit] = {
    "coffee table": Habit(("books", "tray", "cup", "vase", "plant", "remote control", "candle", "tablet"), 4, 0.4),
    "side table": Habit(("lamp", "lamp", "books", "cup", "vase", "plant", "photo frame", "telephone"), 2, 0.75),
    "night stand": Habit(("lamp", "lamp", "books", "cup", "clock", "glass", "smartphone", "photo frame"), 3, 0.7),
    "console table": Habit(("lamp", "vase", "bowl", "books", "plant", "photo frame", "tray", "telephone"), 3, 0.8),
    "sideboard": Habit(("lamp", "vase", "books", "tray", "plant", "bottle", "record player", "sculpture"), 4, 0.7),
    "dresser": Habit(("lamp", "vase", "books", "box", "plant", "vanity mirror", "toy", "photo frame"), 4, 0.6),
    "cabinet": Habit(("vase", "books", "box", "plant", "basket", "mantel clock", "globe", "sculpture"), 3, 0.5),
    "display cabinet": Habit(("vase", "plate", "glass", "bowl", "sculpture"), 3, 0.3),
    "filing cabinet": Habit(("printer", "books", "box", "plant"), 2, 0.5),
    "tv stand": Habit(("books", "vase", "plant", "box", "game console", "speaker", "router"), 2, 0.35),
    "table": Habit(("tray", "cup", "bottle", "vase", "books", "plate", "bowl", "glass", "fruit", "candle"), 6, 0.5),
    "desk": Habit(("books", "cup", "lamp", "plant", "laptop", "bottle", "telephone", "printer", "photo frame"), 4, 0.6),
    "bookshelf": Habit(("books", "books", "books", "vase", "box", "plant", "toy", "globe", "basket"), 3, 0.4),
    "sink": Habit(("soap dispenser", "cup", "soap dispenser"), 2, 0.3),
    "toilet": Habit(("toilet paper", "plant", "box"), 1, 0.3),
    "shelves": Habit(("books", "books", "vase", "plant", "cup", "jar", "bottle", "candle", "photo frame"), 3, 0.35),
    "kitchen counter": Habit(
        ("microwave", "kettle", "toaster", "coffee machine", "bowl", "bottle", "cutting board", "jar", "cooking pot",
         "utensils", "tray", "blender", "fruit"), 5, 0.45,
    ),
    "refrigerator": Habit(("box", "basket", "bowl"), 1, 0.35),
    "washing machine": Habit(("basket", "bottle", "box", "towel"), 2, 0.4),
    "bench": Habit(("books", "basket", "handbag", "blanket"), 1, 0.35),
    "ottoman": Habit(("books", "tray"), 1, 0.12),
    "chest": Habit(("books", "box", "blanket", "tray"), 2, 0.4),
    "box": Habit(("books", "box"), 1, 0.3),
    "piano": Habit(("books", "lamp", "vase", "photo frame"), 2, 0.5),
    "tray": Habit(("cup", "cup", "glass", "bottle", "candle", "bowl"), 3, 0.3),
    "books": Habit(("books", "cup", "remote control", "candle"), 1, 0.12),
    "plate": Habit(("fruit", "cup"), 1, 0.12),
}  # fmt: skip
"""By the category that carries."""

ALONG_THE_BACK = having("along_the_back")
"""Objects that stand at the back of a surface; the rest lies anywhere."""
NEVER_AT_ANGLES = ("microwave", "computer", "box", "clock", "coffee machine", "printer", "record player")


def scatter(f: Furnisher, parents: Sequence[str], budget: int) -> int:
    """Put up to `budget` objects on and in what can carry them, carriers in random order; returns how many.

    New carriers (a tray, a box) are offered too, so that hierarchies grow deep.
    """
    left = budget
    queue = [parents[int(k)] for k in f.rng.permutation(len(parents))]
    rounds = 0
    while queue and left > 0 and rounds < 4 * len(parents) + 40:
        rounds += 1
        parent = queue.pop(0)
        habit = HABITS.get(f.object(parent).category)
        if habit is None:
            continue
        faces = f.surfaces(parent)
        if not faces:
            continue
        order = f.rng.permutation(len(faces))
        for index in order[: max(1, len(order) // 2)]:
            share = 1 + int(f.rng.integers(habit.most))
            for _ in range(min(share, left)):
                name = _leave(f, parent, int(index), habit)
                if name:
                    left -= 1
                    if f.object(name).category in HABITS and f.surfaces(name):
                        queue.insert(0, name)
        if f.chance(0.5):
            queue.append(parent)
    return budget - left


def _leave(f: Furnisher, parent: str, index: int, habit: Habit) -> str | None:
    carrier = f.object(parent)
    face = f.surfaces(parent)[index]
    scale = carrier.pose.scale
    low, high = face.polygon[:, :2].min(axis=0) * scale[:2], face.polygon[:, :2].max(axis=0) * scale[:2]
    room = high - low
    headroom = min(face.clearance_m * scale[2] - 0.015, habit.tallest_m)

    def fits(s: Shape) -> bool:
        if s.category == "clock" and s.size_m[2] > 0.22:
            return False  # made for a wall
        return bool(s.size_m[2] < headroom and s.size_m[0] < 0.95 * room[0] and s.size_m[1] < 0.9 * room[1])

    kind = habit.items[int(f.rng.integers(len(habit.items)))]
    item = f.pick(kind, where=fits)
    if item is None:
        return None
    half = item.size_m[:2] / 2 + 0.006
    for _ in range(6):
        if (room <= 2 * half).any():
            return None
        xy = f.rng.uniform(low + half, high - half)
        turn = 0.0
        if face.interior or carrier.category in ("bookshelf", "shelves"):
            xy[0] = high[0] - half[0] - float(f.rng.uniform(0.0, min(0.04, room[0] - 2 * half[0])))
        elif item.category in ALONG_THE_BACK:
            xy[0] = low[0] + half[0] + float(f.rng.uniform(0.0, 0.25)) * (room[0] - 2 * half[0])
        if not face.interior and item.category not in NEVER_AT_ANGLES:
            turn = float(f.rng.normal(0.0, 0.35))
        placed = f.rest(item, parent, index, xy, turn)
        if placed:
            return placed
    return None


def equip_desk(f: Furnisher, desk: str) -> None:
    """A screen at the back with a keyboard before it, or a laptop; a tower on the floor below, a bin beside."""
    screen = f.pick("monitor")
    if screen and f.chance(0.75):
        side = float(f.rng.uniform(-0.3, 0.3))
        if put_on(f, desk, screen, np.array([-0.75, side])):
            keyboard = f.pick("keyboard")
            if keyboard:
                put_on(f, desk, keyboard, np.array([0.45, side * 1.1]), float(f.rng.normal(0, 0.06)))
            mouse = f.pick("mouse")
            if mouse:
                put_on(f, desk, mouse, np.array([0.45, side * 1.1 + 0.42]), float(f.rng.normal(0, 0.2)))
    else:
        laptop = f.pick("laptop")
        if laptop:
            put_on(f, desk, laptop, np.array([0.2, float(f.rng.uniform(-0.3, 0.3))]), float(f.rng.normal(0, 0.12)))
    lamp = f.pick("lamp")
    if lamp and f.chance(0.6):
        put_on(f, desk, lamp, np.array([-0.7, float(f.rng.choice([-0.9, 0.9]))]), float(f.rng.normal(0, 0.3)))
    _place_beside_desk(f, desk, "computer", 0.45)
    _place_beside_desk(f, desk, "trash can", 0.6)


def _place_beside_desk(f: Furnisher, desk: str, category: str, probability: float) -> None:
    """Place something on the floor under or next to a desk."""
    if not f.chance(probability):
        return
    item = f.pick(category, where=lambda s: s.size_m[2] < 0.6 and (category != "computer" or s.size_m[2] > 0.35))
    if item is None:
        return
    pose = f.object(desk).pose
    size = f.object(desk).size_m
    for side in f.rng.permutation([-1.0, 1.0]):
        for share in (0.75, 0.6, 1.25):
            local = np.array([-0.05, side * (size[1] / 2) * share])
            if share > 1.0:
                local[1] = side * (size[1] / 2 + item.size_m[1] / 2 + 0.06)
            xy = (pose.R_world_object[:2, :2] @ local) + pose.position[:2]
            if f.stand(item, xy, pose.yaw_rad, beside=(desk,)):
                return


def pillows(f: Furnisher, seat: str, count: int) -> None:
    """Cushions leaning on the back of a sofa or armchair, at its ends first."""
    item = f.pick("pillow", where=lambda s: s.size_m[0] < 0.3 and s.size_m[2] > 0.25)
    if item is None:
        return
    spots = [-0.97, 0.97, -0.5, 0.5][:count] if count > 1 else [float(f.rng.uniform(-0.3, 0.3))]
    for share in spots:
        for back in (-1.0, -0.8, -0.55, -0.3):
            if _lean(f, seat, item, back, share):
                break


def _lean(f: Furnisher, seat: str, item: Item, back: float, side: float) -> str | None:
    body = f.object(seat)
    faces = [(k, s) for k, s in enumerate(f.surfaces(seat)) if not s.interior]
    if not faces:
        return None
    index, face = max(faces, key=lambda pair: float(np.prod(np.ptp(pair[1].polygon[:, :2], axis=0))))
    low, high = face.polygon[:, :2].min(axis=0), face.polygon[:, :2].max(axis=0)
    free = np.maximum((high - low) * body.pose.scale[:2] / 2 - item.size_m[:2] / 2 - 0.01, 0.0)
    middle = (low + high) / 2 * body.pose.scale[:2]
    return f.rest(item, seat, index, middle + free * np.array([back, side]), float(f.rng.normal(0.0, 0.08)))
