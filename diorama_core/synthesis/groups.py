"""Furniture as people arrange it: what belongs together, which way it faces, and how far apart it stands."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.editing.room_frame import WallLine
from diorama_core.synthesis.bodies import Item
from diorama_core.synthesis.furnisher import WALL_GAP_M, Furnisher

EYE_M = 1.55


def heading(yaw_rad: float) -> Float[np.ndarray, "2"]:
    """Unit direction of a heading."""
    return np.array([np.cos(yaw_rad), np.sin(yaw_rad)])


def local_xy(f: Furnisher, object_id: str, ahead_m: float, left_m: float) -> Float[np.ndarray, "2"]:
    """A place on the floor, in the frame of a placed object.

    Args:
        f: the furnisher of the room.
        object_id: of the object.
        ahead_m: along its front.
        left_m: to its left.
    """
    pose = f.object(object_id).pose
    yaw = pose.yaw_rad
    return pose.position[:2] + heading(yaw) * ahead_m + heading(yaw + np.pi / 2) * left_m


def long_walls(f: Furnisher, min_m: float = 0.0) -> list[WallLine]:
    """Walls from longest to shortest."""
    return [w for w in sorted(f.plan.walls, key=lambda w: -w.length_m) if w.length_m >= min_m]


def wall_at_back(f: Furnisher, object_id: str) -> tuple[WallLine, float] | None:
    """The wall a placed object stands against, and where along it."""
    edge = next(s for s in f.supports if s.child == object_id)
    if not edge.adheres_to:
        return None
    wall = f.plan.wall(edge.adheres_to[0])
    return wall, float((f.object(object_id).pose.position[:2] - wall.start) @ wall.direction)


def picture_above(f: Furnisher, object_id: str, *categories: str, gap_m: float = 0.22) -> str | None:
    """Something hung over furniture that stands at a wall: near eye height, never in the way."""
    at = wall_at_back(f, object_id)
    if at is None:
        return None
    below = f.object(object_id)
    top = float(below.pose.position[2] + below.size_m[2] / 2)
    widest = float(below.size_m[1])
    item = f.pick(*(categories or ("picture",)), where=lambda s: _hangable(s.size_m) and s.size_m[1] < widest)
    if item is None:
        return None
    centre = max(EYE_M, top + gap_m + item.size_m[2] / 2)
    return f.hang(item, at[0], at[1], centre)


def _hangable(size: tuple[float, float, float]) -> bool:
    return size[0] < 0.08 and size[2] < 1.0


def pictures(f: Furnisher, count: int, *categories: str) -> None:
    """Pictures and the like on free stretches of wall, their centres at eye height."""
    for _ in range(count):
        item = f.pick(*(categories or ("picture", "picture", "mirror", "clock")), where=lambda s: s.size_m[0] < 0.08)
        if item is None:
            return
        for _ in range(8):
            wall = f.plan.walls[int(f.rng.integers(len(f.plan.walls)))]
            if wall.length_m < item.size_m[1] + 0.4:
                continue
            t = float(f.rng.uniform(item.size_m[1] / 2 + 0.2, wall.length_m - item.size_m[1] / 2 - 0.2))
            high = 1.9 if item.category == "clock" else EYE_M + float(f.rng.uniform(-0.05, 0.1))
            if not _is_hidden(f, wall, t, item, high) and f.hang(item, wall, t, high):
                break


def _is_hidden(f: Furnisher, wall: WallLine, t: float, item: Item, centre_z: float) -> bool:
    """Whether something tall stands before that stretch of wall."""
    for other in f.objects:
        top = float(other.pose.position[2] + other.size_m[2] / 2)
        off = (other.pose.position[:2] - wall.start) @ wall.inward
        along = (other.pose.position[:2] - wall.start) @ wall.direction
        reach = (other.size_m[:2].max() + item.size_m[1]) / 2
        if top > centre_z - item.size_m[2] / 2 and off < 0.8 and abs(along - t) < reach and other.category != "window":
            return True
    return False


def storage(f: Furnisher, count: int, *categories: str) -> list[str]:
    """Cupboards, shelves and the like along the walls."""
    placed = []
    for _ in range(count):
        item = f.pick(*categories, where=lambda s: s.size_m[2] < f.plan.height_m - 0.1)
        name = f.against_wall(item, free_front_m=0.5) if item else None
        placed += [name] if name else []
    return placed


def corner_objects(f: Furnisher, count: int, *categories: str) -> None:
    """Plants, lamps and baskets in corners, else along a wall."""
    for _ in range(count):
        item = f.pick(*categories, where=lambda s: 0.2 < s.size_m[2] < f.plan.height_m - 0.3)
        if item is None:
            continue
        gap = 0.05 + float(f.rng.uniform(0.0, 0.1))
        f.against_wall(item, free_front_m=0.0, gap_m=gap, corner=True) or f.against_wall(
            item, free_front_m=0.0, gap_m=gap
        )


def seating(f: Furnisher) -> str | None:
    """A sofa at a wall, a rug that reaches under it, a low table on the rug, armchairs, lamps, a screen opposite."""
    sofa = _first_fit(f, "sofa", tries=4, free_front_m=0.9)
    if sofa is None:
        return None
    screen = _screen_opposite(f, sofa)
    if f.chance(0.75):
        rug_before(f, sofa)
    table = _low_table(f, sofa)
    _armchairs(f, sofa, table, facing_screen=screen is not None)
    _place_beside_sofa(f, sofa)
    if f.chance(0.8):
        picture_above(f, sofa)
    return sofa


def _first_fit(f: Furnisher, category: str, *, tries: int, free_front_m: float) -> str | None:
    for _ in range(tries):
        item = f.pick(category, where=lambda s: s.size_m[0] < 1.3)
        walls = [w for w in long_walls(f) if item is not None and w.length_m > item.size_m[1] + 0.4]
        for wall in walls[:3]:
            if item is None:
                continue
            for share in (0.5, 0.4, 0.6, 0.3, 0.7):
                t = wall.length_m * share + float(f.rng.uniform(-0.05, 0.05))
                t = float(np.clip(t, item.size_m[1] / 2 + 0.02, wall.length_m - item.size_m[1] / 2 - 0.02))
                placed = f.against_wall(item, walls=[wall], t_m=t, free_front_m=free_front_m)
                if placed:
                    f.forget_last_zone()
                    return placed
    return None


def rug_before(f: Furnisher, seat: str, shares: tuple[float, ...] = (0.45, 0.3, 0.2, 0.1, 0.0)) -> str | None:
    """A rug before a sofa or bed, as far under it as its legs allow."""
    item = f.pick("rug", where=lambda s: s.size_m[0] * s.size_m[1] > 1.8)
    if item is None:
        return None
    body = f.object(seat)
    yaw = body.pose.yaw_rad + np.pi / 2 * (item.size_m[0] > item.size_m[1])
    reach = float(item.size_m[:2].min())
    for share in shares:
        ahead = body.size_m[0] * (0.5 - share) + reach / 2 + 0.01
        placed = f.stand(item, local_xy(f, seat, ahead, 0.0), yaw)
        if placed:
            return placed
    return None


def _low_table(f: Furnisher, sofa: str) -> str | None:
    body = f.object(sofa)
    for _ in range(3):
        item = f.pick("coffee table")
        if item is None:
            return None
        for gap in (0.42, 0.36, 0.5, 0.6):
            ahead = body.size_m[0] / 2 + gap + item.size_m[0] / 2
            xy = local_xy(f, sofa, ahead, float(f.rng.uniform(-0.06, 0.06)))
            placed = f.stand(item, xy, body.pose.yaw_rad + np.pi * f.chance(0.5))
            if placed:
                return placed
    return None


def _screen_opposite(f: Furnisher, sofa: str) -> str | None:
    body = f.object(sofa)
    facing = heading(body.pose.yaw_rad)
    opposite = [w for w in f.plan.walls if w.inward @ facing < -0.9]
    item = f.pick("tv stand")
    if item is None:
        return None
    for wall in opposite:
        t = float((body.pose.position[:2] - wall.start) @ wall.direction)
        for shift in (0.0, 0.35, -0.35, 0.8, -0.8):
            at = t + shift
            if not item.size_m[1] / 2 + 0.02 < at < wall.length_m - item.size_m[1] / 2 - 0.02:
                continue
            placed = f.against_wall(item, walls=[wall], t_m=at, free_front_m=0.5)
            if placed:
                _television(f, placed, wall, at)
                return placed
    return None


def _television(f: Furnisher, stand: str, wall: WallLine, t: float) -> None:
    width = float(f.object(stand).size_m[1])
    flat = f.pick("television", where=lambda s: s.size_m[0] < 0.08 and s.size_m[1] < width + 0.3)
    if flat and f.chance(0.35):
        top = float(f.object(stand).size_m[2])
        if f.hang(flat, wall, t, top + 0.25 + flat.size_m[2] / 2):
            return
    item = f.pick("television", where=lambda s: s.size_m[0] > 0.12 and s.size_m[1] < width)
    if item:
        put_on(f, stand, item, np.zeros(2))


def put_on(f: Furnisher, parent: str, item: Item, share: Float[np.ndarray, "2"], turn_rad: float = 0.0) -> str | None:
    """Place on the highest open surface, at a share (-1 to 1 front-back and left-right) of the free half extents.

    Args:
        f: the furnisher of the room.
        parent: id of what carries it.
        item: the shape.
        share: -1 to 1, front-back and left-right.
        turn_rad: against the carrier.
    """
    for index, face in enumerate(f.surfaces(parent)):
        if face.interior:
            continue
        scale = f.object(parent).pose.scale[:2]
        low, high = face.polygon[:, :2].min(axis=0) * scale, face.polygon[:, :2].max(axis=0) * scale
        free = np.maximum((high - low) / 2 - item.size_m[:2] / 2 - 0.01, 0.0)
        placed = f.rest(item, parent, index, (low + high) / 2 + free * share, turn_rad)
        if placed:
            return placed
    return None


def _armchairs(f: Furnisher, sofa: str, table: str | None, *, facing_screen: bool) -> None:
    body = f.object(sofa)
    ahead = body.size_m[0] / 2 + 0.75
    goal = f.object(table).pose.position[:2] if table else local_xy(f, sofa, 1.0, 0.0)
    for side in f.rng.permutation([-1.0, 1.0])[: int(f.rng.integers(0, 3))]:
        item = f.pick("armchair")
        if item is None:
            return
        for out in (0.15, 0.3, 0.0):
            left = side * (body.size_m[1] / 2 + out + item.size_m[0] / 4)
            xy = local_xy(f, sofa, ahead, left)
            to_goal = goal - xy
            yaw = float(np.arctan2(to_goal[1], to_goal[0]) + f.rng.normal(0.0, 0.08))
            if f.stand(item, xy, yaw):
                break


def _place_beside_sofa(f: Furnisher, sofa: str) -> None:
    body = f.object(sofa)
    at = wall_at_back(f, sofa)
    if at is None:
        return
    for side in f.rng.permutation([-1.0, 1.0]):
        category = ("side table", "floor lamp", "plant")[int(f.rng.integers(3))]
        item = f.pick(category, where=lambda s: s.size_m[2] > 0.4 and s.size_m[1] < 0.8)
        if item is None:
            continue
        t = at[1] + side * (body.size_m[1] / 2 + item.size_m[1] / 2 + 0.06)
        f.against_wall(item, walls=[at[0]], t_m=t, free_front_m=0.0, gap_m=0.1) if _fits_wall(t, item, at[0]) else None


def _fits_wall(t: float, item: Item, wall: WallLine) -> bool:
    return bool(item.size_m[1] / 2 + WALL_GAP_M < t < wall.length_m - item.size_m[1] / 2 - WALL_GAP_M)


def dining(f: Furnisher, xy: Float[np.ndarray, "2"] | None = None, *, rug: bool = False) -> str | None:
    """A table, perhaps on a rug, with chairs drawn up to it, all of one kind, each facing it, and a lamp above."""
    for _ in range(4):
        item = f.pick("table", where=lambda s: 0.65 < s.size_m[2] < 0.85)
        if item is None:
            return None
        table = _table_with_room(f, item, xy, rug=rug)
        if table:
            break
    else:
        return None
    chairs_around(f, table)
    lamp = f.pick("ceiling lamp")
    if lamp and f.chance(0.7):
        f.hang_from_ceiling(lamp, f.object(table).pose.position[:2], f.object(table).pose.yaw_rad)
    return table


def _table_with_room(f: Furnisher, item: Item, xy: Float[np.ndarray, "2"] | None, *, rug: bool = False) -> str | None:
    """The table where there is space to sit around it, on a rug that carries all of it if there is such a one."""
    low, high = f.plan.outline.min(axis=0), f.plan.outline.max(axis=0)
    for attempt in range(24):
        yaw = float(f.rng.integers(2)) * np.pi / 2
        turned = item.size_m[:2] if yaw == 0.0 else item.size_m[1::-1]
        reach = turned / 2 + 0.6
        if (high - low <= 2 * reach).any():
            continue
        spot = xy if xy is not None and attempt < 2 else f.rng.uniform(low + reach, high - reach)
        sx, sy, sz = item.scale
        roomy = Item(item.shape, (sx * (1 + 1 / item.size_m[0]), sy * (1 + 1 / item.size_m[1]), sz))
        if f.is_free(roomy, spot, yaw):
            below = f.pick("rug", where=lambda s: bool((np.sort(s.size_m[:2]) > np.sort(item.size_m[:2]) + 0.2).all()))
            if rug and below:
                lengthwise = (below.size_m[0] > below.size_m[1]) == (item.size_m[0] > item.size_m[1])
                f.stand(below, spot, yaw + np.pi / 2 * (not lengthwise))
            placed = f.stand(item, spot, yaw)
            if placed:
                return placed
    return None


def chairs_around(f: Furnisher, table: str, most: int = 8) -> list[str]:
    """Chairs of one kind around a table, drawn up as far as the meshes allow, each facing it."""
    item = f.pick("chair")
    if item is None:
        return []
    body = f.object(table)
    round_table = f.library.shape(body.shape_id).symmetry >= 4
    placed = []
    for ahead, left, turn in _places(f, body.size_m, item, round_table)[:most]:
        into0 = float(f.rng.uniform(0.08, 0.26))
        for into in (into0, 0.1, 0.0, -0.08):
            direction = np.array([np.cos(turn), np.sin(turn)])
            spot = np.array([ahead, left]) + direction * (item.size_m[0] / 2 - into)
            xy = local_xy(f, table, float(spot[0]), float(spot[1]))
            yaw = body.pose.yaw_rad + turn + np.pi + float(f.rng.normal(0.0, 0.06))
            name = f.stand(item, xy, yaw, beside=(table,))
            if name:
                placed.append(name)
                break
    return placed


def _places(f: Furnisher, size: np.ndarray, chair: Item, round_table: bool) -> list[tuple[float, float, float]]:
    """Edge points of a table where chairs go (ahead, left) and the outward direction there."""
    if round_table:
        count = int(np.clip(np.pi * size[0] // (chair.size_m[1] + 0.25), 2, 6))
        begin = float(f.rng.uniform(0, 2 * np.pi))
        turns = [begin + 2 * np.pi * k / count for k in range(count)]
        return [(float(size[0] / 2 * np.cos(a)), float(size[0] / 2 * np.sin(a)), a) for a in turns]
    per_side = max(1, int((size[1] - 0.1) // (chair.size_m[1] + 0.12)))
    offsets = (np.arange(per_side) - (per_side - 1) / 2) * (size[1] / max(per_side, 1))
    sides = [(s * float(size[0]) / 2, float(o), 0.0 if s > 0 else np.pi) for s in (1.0, -1.0) for o in offsets]
    ends = [(0.0, s * float(size[1]) / 2, s * np.pi / 2) for s in (1.0, -1.0)] if f.chance(0.4) else []
    keep = len(sides) if f.chance(0.7) else max(1, len(sides) - 1)
    return [*sides[:keep], *ends]


def workplace(f: Furnisher) -> str | None:
    """A desk at a wall, turned so that one sits facing it, with a chair, a screen and what belongs to it."""
    item = f.pick("desk")
    if item is None:
        return None
    walls = long_walls(f, item.size_m[1] + 0.2)
    for candidate in [walls[int(k)] for k in f.rng.permutation(len(walls))]:
        desk = f.against_wall(item, walls=[candidate], free_front_m=0.85)
        if desk:
            f.forget_last_zone()
            _seat_at(f, desk)
            return desk
    return None


def _seat_at(f: Furnisher, desk: str) -> None:
    """The chair on the side where knees go: the front of a desk."""
    body = f.object(desk)
    item = f.pick("office chair", "office chair", "chair")
    if item is None:
        return
    for into in (0.25, 0.15, 0.05, -0.05, -0.15):
        xy = local_xy(f, desk, body.size_m[0] / 2 + item.size_m[0] / 2 - into, float(f.rng.uniform(-0.08, 0.08)))
        spread = 0.35 if item.category == "office chair" else 0.1
        if f.stand(item, xy, body.pose.yaw_rad + np.pi + float(f.rng.normal(0.0, spread)), beside=(desk,)):
            return


def sleeping(f: Furnisher) -> str | None:
    """A bed with its head at a wall, night stands beside it, a rug that reaches under it, a picture above."""
    bed = _bed(f)
    if bed is None:
        return None
    rug = f.chance(0.6)
    _night_stands(f, bed)
    if rug:
        rug_before(f, bed, shares=(0.3, 0.2, 0.1, 0.0))
    if f.chance(0.8):
        picture_above(f, bed)
    return bed


def _bed(f: Furnisher) -> str | None:
    for _ in range(5):
        item = f.pick("bed", where=lambda s: 0.4 < s.size_m[2] < 1.4)
        if item is None:
            return None
        for wall in long_walls(f, item.size_m[1] + 0.3):
            middles = (0.5, 0.4, 0.6) if item.size_m[1] > 1.3 else (0.0, 1.0)
            for share in middles:
                half = item.size_m[1] / 2 + 0.02
                t = float(np.clip(wall.length_m * share, half, wall.length_m - half))
                placed = f.against_wall(item, walls=[wall], t_m=t, free_front_m=0.5)
                if placed:
                    f.forget_last_zone()
                    return placed
    return None


def _night_stands(f: Furnisher, bed: str) -> list[str]:
    at = wall_at_back(f, bed)
    item = f.pick("night stand")
    if at is None or item is None:
        return []
    placed = []
    for side in (-1.0, 1.0):
        t = at[1] + side * (f.object(bed).size_m[1] / 2 + item.size_m[1] / 2 + 0.05)
        if _fits_wall(t, item, at[0]):
            name = f.against_wall(item, walls=[at[0]], t_m=t, free_front_m=0.25)
            placed += [name] if name else []
    return placed


def row_along_wall(f: Furnisher, wall: WallLine, categories: tuple[str, ...], start_m: float = 0.02) -> list[str]:
    """Units side by side along a wall, as in a kitchen.

    Args:
        f: the furnisher of the room.
        wall: where it is.
        categories: from left to right.
        start_m: from the wall's left end.
    """
    placed, t = [], start_m
    for category in categories:
        item = f.pick(category, where=lambda s: s.size_m[0] < 0.8)
        if item is None:
            continue
        middle = t + item.size_m[1] / 2
        if not _fits_wall(middle, item, wall):
            continue
        name = f.against_wall(item, walls=[wall], t_m=middle, free_front_m=0.7)
        if name:
            placed.append(name)
            t = middle + item.size_m[1] / 2 + 0.01
    return placed


def wall_shelf(f: Furnisher, wall: WallLine, t_m: float, bottom_m: float) -> str | None:
    """A shelf on a wall.

    Args:
        f: the furnisher of the room.
        wall: where it is.
        t_m: of its middle from the wall's left end.
        bottom_m: above the floor.
    """
    item = f.pick("shelves", where=lambda s: s.size_m[2] < 0.8)
    return f.hang(item, wall, t_m, bottom_m + item.size_m[2] / 2) if item else None


def ceiling_light(f: Furnisher) -> str | None:
    """A lamp in the middle of the ceiling."""
    if any(o.category == "ceiling lamp" for o in f.objects):
        return None
    item = f.pick("ceiling lamp", where=lambda s: s.size_m[2] < f.plan.height_m - 2.0)
    return f.hang_from_ceiling(item, f.plan.middle) if item else None
