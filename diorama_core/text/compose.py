"""A furnished room that holds what a prompt asks for, with everything where people put it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import category, resolve
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Scene
from diorama_core.synthesis import furnished_room, groups
from diorama_core.synthesis.bodies import Item
from diorama_core.synthesis.clutter import pillows
from diorama_core.synthesis.finishes import choose_finishes
from diorama_core.synthesis.furnisher import Furnisher
from diorama_core.synthesis.grammar import RECIPES
from diorama_core.synthesis.openings import add_door, add_window
from diorama_core.synthesis.plan import room_plan
from diorama_core.text.prompt import RequestedObject, RoomRequest, understood_prompt

TRIES = 6
"""Rooms begun anew, each a little larger, until everything finds a place."""
_AT_WALLS = frozenset(
    {"bed", "sofa", "wardrobe", "dresser", "cabinet", "sideboard", "console table", "tv stand"}
).union(
    ["bookshelf", "refrigerator", "stove", "washing machine", "kitchen counter", "sink", "toilet", "bathtub", "desk"],
    ["night stand", "piano", "fireplace"],
)
_ORDER = ("bed", "sofa", "rug", "desk", "kitchen counter", "table", "wardrobe", "bookshelf", "coffee table", "armchair")
_COMPANIONS = ("desk", "bookshelf", "bed", "dresser", "sideboard", "tv stand", "piano")
"""Beside these stand lamps and plants where there are no seats."""
TALL_PLANT_M = 0.6
"""Lower ones are put on something, where nothing is said."""
_FREE_FRONT_M = {"bed": 0.6, "sofa": 0.8, "desk": 0.85, "wardrobe": 0.6}


@dataclass(frozen=True)
class Composed:
    """A room made of words, without a camera yet."""

    scene: Scene
    notes: tuple[str, ...]
    """What could not be met, in words for the user."""


def composed_room(prompt: str, library: ShapeLibrary, seed: int = 0) -> Composed:
    """The room that a prompt describes. Same prompt, seed and library give the same room.

    A prompt that names only a kind of room gets one furnished as such rooms are.
    """
    request = understood_prompt(prompt)
    digest = int.from_bytes(hashlib.sha256(f"{seed} {prompt}".encode()).digest()[:4], "big")
    notes = tuple(f"'{words}' names nothing in the library and was left out" for words in request.ignored)
    if not request.objects:
        return Composed(furnished_room(digest, request.room, library, outline="box", clutter=6), notes)
    best: tuple[int, Scene, tuple[str, ...]] | None = None
    for attempt in range(TRIES):
        scene, missing = _attempt(request, library, digest, attempt)
        lacking = sum(n * _weight(label) for label, n in missing.items())
        if best is None or lacking < best[0]:
            said = tuple(f"no place was found for {n} x {label}" for label, n in missing.items())
            best = (lacking, scene, said)
        if lacking < 10:
            break
    assert best is not None
    return Composed(best[1], (*notes, *best[2]))


def _weight(label: str) -> int:
    """How much it matters that an object found no place: a larger room does not help what lies on others."""
    return 1 if resolve(label).category.mount == "surface" else 10


def _attempt(request: RoomRequest, library: ShapeLibrary, digest: int, attempt: int) -> tuple[Scene, dict[str, int]]:
    rng = np.random.default_rng((digest, attempt))
    recipe = RECIPES[request.room]
    factor = request.size * (1.0 + 0.08 * attempt)
    wide, deep = ((low * factor, 0.5 * (low + high) * factor) for low, high in (recipe.width_m, recipe.depth_m))
    f = Furnisher(room_plan(rng, wide, deep, "box"), library, rng)
    add_door(f)
    if not any(t.category == "window" for t in request.objects) and request.room != "corridor":
        add_window(f, groups.long_walls(f)[0])
    placed: dict[str, list[str]] = {}
    missing: dict[str, int] = {}
    for requested in sorted(request.objects, key=_rank):
        for _ in range(requested.count):
            name = _place(f, requested, placed)
            if name is None:
                missing[requested.label] = missing.get(requested.label, 0) + 1
            else:
                placed.setdefault(requested.category, []).append(name)
    scene = Scene(
        architecture=f.plan.architecture(choose_finishes(rng, request.room)),
        objects=tuple(f.objects),
        supports=tuple(f.supports),
    )
    check_scene(scene)
    return scene, missing


def _rank(requested: RequestedObject) -> tuple[int, int]:
    """Large objects of the floor first, then what stands by them, on them, at last what hangs."""
    mount = {"floor": 0, "wall": 2, "surface": 3, "ceiling": 1}[category(requested.category).mount]
    place = 1 if requested.place in ("beside", "before", "around", "under") else 0
    order = _ORDER.index(requested.category) if requested.category in _ORDER else len(_ORDER)
    return (10 if requested.place == "on" else 0) + 3 * mount + place, order


def _place(f: Furnisher, requested: RequestedObject, placed: dict[str, list[str]]) -> str | None:
    """Place one object: where the prompt says, else where people put such objects."""
    item = _chosen(f, requested)
    if item is None:
        return None
    hosts = _least_used(f, placed.get(requested.target, []))
    mount = category(requested.category).mount
    ways: list[Callable[[], str | None]] = []
    for host in hosts:
        if requested.place == "on":
            ways.append(partial(_on, f, item, host))
        elif requested.place in ("beside", "before", "around", "under"):
            ways.append(partial(_by, f, item, host, requested))
        elif requested.place == "above":
            ways.append(partial(_above, f, item, host))
    if mount == "surface" or requested.place == "on":
        ways.append(lambda: _on_anything(f, item))
    elif mount == "wall":
        ways.append(lambda: _on_a_wall(f, item))
    elif mount == "ceiling":
        ways.append(lambda: groups.ceiling_light(f))
    if mount == "floor" or requested.category == "mirror":
        ways.append(lambda: _on_floor(f, item, requested, placed))
    return next((name for way in ways if (name := way())), None)


def _least_used(f: Furnisher, hosts: list[str]) -> list[str]:
    """Hosts that hold or have beside them the fewest objects come first: a lamp on each night stand."""
    load = {h: sum(s.parent == h for s in f.supports) for h in hosts}
    return sorted(hosts, key=lambda h: load[h])


def _chosen(f: Furnisher, requested: RequestedObject) -> Item | None:
    """A shape of the category, with the attributes asked for where there is one; of a set, always the same shape."""
    before = [o for o in f.objects if o.category == requested.category]
    if before and requested.count > 1:
        return replace(f.items[before[-1].id])

    def has(words: tuple[str, ...]) -> Callable[[Shape], bool]:
        return lambda s: all(w in f"{s.caption} {s.style}".lower() for w in words) and s.size_m[2] < 2.3

    if requested.category == "television":  # one that stands by itself
        standing = f.pick("television", where=lambda s: s.size_m[0] > 0.12 and s.size_m[1] < 1.2)
        if standing is not None:
            return standing
    if requested.category == "plant" and requested.label in ("plant", "plants") and requested.place != "on":
        tall = f.pick("plant", where=lambda s: s.size_m[2] > TALL_PLANT_M and s.size_m[2] < 2.3)
        if tall is not None:
            return tall
    tries = [requested.appearance, *((w,) for w in requested.appearance), ()]
    named = tuple(requested.label.split())
    for words in (*((*t, *named) for t in tries), *tries):
        item = f.pick(requested.category, where=has(words))
        if item is not None:
            return item
    return None


def _on_floor(f: Furnisher, item: Item, requested: RequestedObject, placed: dict[str, list[str]]) -> str | None:
    name = requested.category
    if name == "rug":
        if placed.get("sofa") and (rug := groups.rug_before(f, placed["sofa"][0])):
            return rug
        return f.stand(item, f.rng.normal(0.0, 0.2, 2), 0.0) or f.anywhere(item)
    if name in ("chair", "stool", "bench") and placed.get("table"):
        return _by(f, item, placed["table"][0], replace(requested, place="around"))
    if name in ("office chair", "chair") and placed.get("desk"):
        return _by(f, item, placed["desk"][0], replace(requested, place="around")) or f.anywhere(item, margin_m=0.1)
    if name == "coffee table" and placed.get("sofa"):
        return _by(f, item, placed["sofa"][0], replace(requested, place="before"))
    if name == "night stand" and placed.get("bed"):
        return _by(f, item, placed["bed"][0], replace(requested, place="beside"))
    if name == "armchair":
        return _gathered(f, item, placed)
    if name in ("floor lamp", "plant", "basket", "trash can", "side table"):
        near = placed.get("armchair", []) + placed.get("sofa", [])
        near = near or [host for kind in _COMPANIONS for host in placed.get(kind, [])]
        beside = (_by(f, item, host, replace(requested, place="beside")) for host in near)
        found = next((n for n in beside if n), None)
        return found or f.against_wall(item, free_front_m=0.0, gap_m=0.08, corner=True)
    if name == "table":
        return groups._table_with_room(f, item, np.zeros(2)) or f.anywhere(item, margin_m=0.2)
    at_wall = name in _AT_WALLS
    front = _FREE_FRONT_M.get(name, 0.5)
    placed_at = f.against_wall(item, free_front_m=front) if at_wall else f.anywhere(item, margin_m=0.15)
    if placed_at and name == "desk":
        f.forget_last_zone()  # its chair stands there
    return placed_at or f.against_wall(item, free_front_m=0.2) or f.anywhere(item)


def _gathered(f: Furnisher, item: Item, placed: dict[str, list[str]]) -> str | None:
    """Armchairs in a half circle that opens to the room: around the sofa's table, any other, or around a corner."""
    others = placed.get("armchair", [])
    table = [] if placed.get("chair") else placed.get("table", [])
    hosts = placed.get("coffee table") or placed.get("sofa") or placed.get("side table") or table
    if hosts:
        body = f.object(hosts[0])
        goal = body.pose.position[:2]
        spread = np.linspace(-2.6, 2.6, 14)
        radius = float(np.hypot(*body.size_m[:2]) / 2 + item.size_m[0] / 2 + 0.35)
        front = body.pose.yaw_rad
        for turn in sorted(spread, key=lambda a: abs(abs(a) - 1.1)):
            for reach in (radius, radius + 0.3):
                xy = goal + reach * groups.heading(front + float(turn))
                if name := f.stand(item, xy, float(front + turn + np.pi)):
                    return name
    if others:
        first = f.object(others[0])
        for side in (1.0, -1.0):
            for apart in (1.25, 1.5, 1.8, 2.2):
                xy = groups.local_xy(f, others[0], 0.15, side * apart)
                if name := f.stand(item, xy, first.pose.yaw_rad - side * 0.45):
                    return name
    return f.against_wall(item, free_front_m=0.5, gap_m=0.25) or f.anywhere(item, margin_m=0.2)


def _by(f: Furnisher, item: Item, host_id: str, requested: RequestedObject) -> str | None:
    """Beside, before or around a host, facing it where people sit at it."""
    host = f.object(host_id)
    depth, width = host.size_m[0] / 2, host.size_m[1] / 2
    turns = {
        "beside": (np.pi / 2, -np.pi / 2),
        "before": (0.0,),
        "around": (0.0, np.pi, np.pi / 2, -np.pi / 2),
        "under": (0.0, np.pi),
    }[requested.place]
    seats = requested.place == "around" or requested.category in ("chair", "office chair", "armchair")
    for gap in (0.06, 0.25, 0.45, -0.12) if not seats else (-0.15, 0.0, 0.1, 0.3):
        spots = [(turn, slide) for slide in (0.0, 0.5, -0.5, 0.85, -0.85) for turn in turns]
        for turn, slide in spots:
            reach = abs(np.cos(turn)) * depth + abs(np.sin(turn)) * width
            own = item.size_m[0] / 2 if seats or requested.place == "before" else item.size_m[1] / 2
            out = float(reach + own + (0.35 if requested.place == "before" and not seats else gap))
            along = width if abs(np.cos(turn)) > 0.5 else depth
            back = -depth * 0.6 if requested.place == "beside" and abs(np.sin(turn)) > 0.5 else 0.0
            ahead = float(np.cos(turn) * out - np.sin(turn) * slide * along + back)
            left = float(np.sin(turn) * out + np.cos(turn) * slide * along)
            yaw = host.pose.yaw_rad + (turn + np.pi if seats else 0.0)
            xy = groups.local_xy(f, host_id, ahead, left)
            if name := f.stand(item, xy, float(yaw), beside=(host_id,) if seats else (), in_zone=True):
                return name
    return None


def _on(f: Furnisher, item: Item, host_id: str) -> str | None:
    for _ in range(8):
        if name := groups.on_top(f, host_id, item, f.rng.uniform(-0.8, 0.8, 2), 0.0):
            return name
    for index, face in enumerate(f.surfaces(host_id)):
        scale = f.object(host_id).pose.scale[:2]
        middle = face.polygon[:, :2].mean(axis=0) * scale
        if name := f.rest(item, host_id, index, middle):
            return name
    return None


def _on_anything(f: Furnisher, item: Item) -> str | None:
    """On the carrier that people would choose: tables before shelves, the larger first."""
    liked = ("tv stand",) if item.category == "television" else ("desk",) if item.category == "monitor" else ()
    hosts = [
        o for o in f.objects if category(o.category).supports_objects and o.category not in ("rug", "stool", "chair")
    ]
    ranked = sorted(hosts, key=lambda o: (o.category not in liked, -float(np.prod(o.size_m[:2]))))
    if item.category == "pillow":
        for host in ranked:
            if host.category in ("sofa", "bed", "armchair"):
                before = len(f.objects)
                pillows(f, host.id, 1)
                if len(f.objects) > before:
                    return f.objects[-1].id
        ranked = [o for o in ranked if o.category in ("sofa", "bed", "armchair")]
    else:
        ranked = [o for o in ranked if o.category not in ("sofa", "bed", "armchair")]
    return next((name for o in ranked if (name := _on(f, item, o.id))), None)


def _on_a_wall(f: Furnisher, item: Item) -> str | None:
    if item.category in ("window", "door"):
        return next((n for w in groups.long_walls(f) if (n := add_window(f, w))), None)
    for wall in groups.long_walls(f, float(item.size_m[1]) + 0.2):
        for _ in range(6):
            half = float(item.size_m[1]) / 2 + 0.1
            t = float(f.rng.uniform(half, max(wall.length_m - half, half)))
            z = max(groups.EYE_M, float(item.size_m[2]) / 2 + 0.05)
            if not groups._hidden(f, wall, t, item, z) and (name := f.hang(item, wall, t, z)):
                return name
    return None


def _above(f: Furnisher, item: Item, host_id: str) -> str | None:
    if category(item.category).mount == "ceiling":
        host = f.object(host_id)
        return f.hang_from_ceiling(item, host.pose.position[:2], host.pose.yaw_rad)
    at = groups.wall_at_back(f, host_id)
    if at is None:
        return None
    host = f.object(host_id)
    top = float(host.pose.position[2] + host.size_m[2] / 2)
    z = max(groups.EYE_M, top + 0.2 + float(item.size_m[2]) / 2)
    return next((n for dz in (0.0, 0.2, 0.4) if (n := f.hang(item, at[0], at[1], z + dz))), None)
