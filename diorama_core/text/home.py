"""A home of several rooms from words: "two bedrooms, a bath and an open kitchen".

Each room is composed by itself. It joins the home at its own door, at the wall where the home stays most compact and
floors keep a wall apart; an open room has a wide passage in place of the door.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from diorama_core.editing.free_space import FLAT_M
from diorama_core.editing.homes import join
from diorama_core.editing.opening_insertion import with_opening
from diorama_core.editing.plan_edits import wall_feet
from diorama_core.editing.room_frame import SWING_M
from diorama_core.errors import EditRefused, InputError
from diorama_core.geometry.openings import DOOR, OPENING_CATEGORIES, WINDOW, faces_behind, wall_of, with_hole
from diorama_core.geometry.rooms import doorways
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Scene, SceneObject
from diorama_core.text.compose import compose_room
from diorama_core.text.phrases import NUMBERS
from diorama_core.text.prompt import ROOMS

HOME = re.compile(r"^(?:an? |the )?(?:[a-z]+ )?(?:home|house|flat|apartment)(?: with| of| that has|:)? ")
OPEN = frozenset({"open", "open-plan"})
SAYS_HOME = 3
"""So many rooms are a home without the word: of two, one is often a part of the other."""
MAX_ROOMS = 12
PASSAGE_M = (1.8, 2.1)
"""Width and height of the passage to an open room; narrower where the wall is."""
TRIED = (0.5, 0.2, 0.8)
"""Shares of a wall's length where the way into it is tried."""
APART_M = 0.1
"""Floors are at least a thin wall apart."""
SHORT = {"bath": "bathroom", "bed room": "bedroom", "wc": "bathroom", "living": "living room", "dining": "dining room"}


@dataclass(frozen=True)
class AskedRoom:
    """One room of a home."""

    name: str
    looks: str = ""
    is_open: bool = False


def rooms_asked(prompt: str) -> tuple[AskedRoom, ...]:
    """The rooms of a home that a prompt lists; none where it describes one room.

    Raises:
        InputError: it asks for more rooms than a home has.
    """
    text = prompt.lower().strip(" .!")
    bare = HOME.sub("", text, count=1)
    found: list[AskedRoom] = []
    for clause in re.split(r"\s*(?:,| and | plus |;)\s*(?:and )?", bare):
        words = clause.split()
        count = NUMBERS.get(words[0], int(words[0]) if words[0].isdigit() else 0) if words else 0
        words = words[1:] if count else words
        size = next((n for n in (2, 1) if _room_name(" ".join(words[-n:]))), 0)
        name = _room_name(" ".join(words[-size:])) if size else None
        if name is None:
            return ()
        looks = " ".join(w for w in words[:-size] if w not in OPEN)
        found += [AskedRoom(name, looks, bool(OPEN & set(words[:-size])))] * max(count, 1)
    if len(found) > MAX_ROOMS:
        raise InputError(f"a home of {len(found)} rooms is asked for; up to {MAX_ROOMS} are made")
    return tuple(found) if len(found) >= SAYS_HOME or (len(found) > 1 and bare != text) else ()


def compose_home(
    asked: Sequence[AskedRoom], library: ShapeLibrary, seed: int, progress: Progress
) -> tuple[Scene, tuple[str, ...]]:
    """The home, without a camera, and notes about what could not be met.

    Args:
        asked: its rooms, in the order in which they join.
        library: where shapes come from.
        seed: another number, another home.
        progress: reports and cancellation.
    """
    home, notes = Scene(), list[str]()
    for number, one in enumerate(asked):
        progress.report(number / len(asked), f"composing the {one.name}")
        room = compose_room(f"a {one.looks} {one.name}".replace("  ", " "), library, seed + number)
        notes += room.notes
        if number == 0:
            home = room.scene
            continue
        names = (asked[0].name, one.name)
        fits = list(_places(home, room.scene, library, names, is_open=one.is_open))
        if not fits:
            notes.append(f"the {one.name} found no place in the home and was left out")
            continue
        home = min(fits, key=lambda fit: fit[0])[1]
    between = {d.opening.object_id for d in doorways(home)}
    return edits.remove(home, [o.id for o in home.objects if o.category == WINDOW and o.id in between]), tuple(notes)


def _places(
    home: Scene, room: Scene, library: ShapeLibrary, names: tuple[str, str], *, is_open: bool
) -> Iterator[tuple[tuple[float, float], Scene]]:
    """Ways in which a room joins: floor of what has to go (m²), area of the whole's bounds (m²), and the home."""
    own = next(o for o in room.objects if o.category == DOOR)
    walls = home.architecture.by_role("wall")
    for foot, share in itertools.product(wall_feet(home), TRIED):
        if faces_behind(home.plane(foot.id), home.plane(foot.id).centre, walls):
            continue
        try:
            opened, door = with_opening(home, library, DOOR, foot.id, foot.start + share * (foot.end - foot.start))
            made = join(opened, room, door, own.id, names=names).scene
        except EditRefused:
            continue
        floors = [shapely.Polygon(made.plane(r.floor).polygon[:, :2]) for r in made.rooms]
        if all(floors[-1].distance(f) > APART_M for f in floors[:-1]):
            low_x, low_y, high_x, high_y = shapely.union_all(floors).bounds
            between = made.object(door)
            made, half = _open(made, door) if is_open else (made, float(between.size_m[1]) / 2)
            gone = _ids_in_way(made, between, half)
            lost_m2 = sum(float(np.prod(made.object(i).size_m[:2])) for i in gone)
            yield (round(lost_m2, 1), (high_x - low_x) * (high_y - low_y)), edits.remove(made, gone)


def _ids_in_way(home: Scene, door: SceneObject, half_m: float) -> set[str]:
    """Ids of what hangs or stands in a new way between two rooms, with what stands on it.

    Args:
        home: the rooms joined.
        door: that was put in, its front away from the wall.
        half_m: half the width of the way.
    """
    ahead = door.pose.R_world_object[:, 0]
    axes = np.stack([np.cross([0.0, 0.0, 1.0], ahead), ahead, [0.0, 0.0, 1.0]], axis=1)
    half = np.array([half_m, SWING_M, door.size_m[2] / 2])
    gone = set[str]()
    for item in home.objects:
        local = (item.corners_world - door.pose.position) @ axes
        low, high = local.min(axis=0), local.max(axis=0)
        is_flat = high[2] < FLAT_M - half[2]
        if item.category not in OPENING_CATEGORIES and not is_flat and (low < half).all() and (high > -half).all():
            gone |= {item.id, *descendants(home, item.id)}
    return gone


def _open(home: Scene, door: str) -> tuple[Scene, float]:
    """The home with a passage in place of a door, as wide as both faces let it be; and half its width."""
    item, walls = home.object(door), home.architecture.by_role("wall")
    wall = wall_of(item, walls, home)
    assert wall is not None, "it was put there"
    faces = (wall, *faces_behind(wall, item.pose.position, walls))
    along = np.cross([0.0, 0.0, 1.0], wall.normal)
    middle = float(item.pose.position @ along)
    ends = [(float((f.polygon @ along).min()), float((f.polygon @ along).max())) for f in faces]
    half = min(PASSAGE_M[0] / 2, *(min(middle - low, high - middle) - APART_M for low, high in ends))
    foot = float(wall.polygon[:, 2].min())
    corners = np.array(
        [
            item.pose.position * (1, 1, 0) + s * half * along + [0, 0, foot + z]
            for s in (-1, 1)
            for z in (0, PASSAGE_M[1])
        ]
    )
    cut = {f.id: with_hole(f, corners) for f in faces}
    planes = [cut.get(p.id, p) for p in home.architecture.planes]
    return edits.set_planes(edits.remove(home, [door]), planes), half


def _room_name(words: str) -> str | None:
    """The name of a room in the singular."""
    for name in (words, words.removesuffix("s")):
        if name in SHORT:
            return SHORT[name]
        if any(name == known for known, _ in ROOMS):
            return name
    return None
