"""Homes of several rooms, made at random, and written as RoomPlan writes them: every wall inside with two faces, every
door inside in both. One file of the merged structure, or a file a room, each in its own frame.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.importing.roomplan_files import WORLD_TO_SCAN, Wall, _row

THICK_M, HEIGHT_M, RISE_M, DOOR_M = 0.12, 2.5, 2.8, (0.9, 2.05)
NAMES = ("livingRoom", "kitchen", "bedroom", "bathroom", "diningRoom", "bedroom", "bathroom", "unidentified")


@dataclass(frozen=True)
class MadeRoom:
    name: str
    storey: int
    low: np.ndarray
    high: np.ndarray

    @property
    def ring(self) -> np.ndarray:
        (x0, y0), (x1, y1) = self.low, self.high
        return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


@dataclass(frozen=True)
class MadeHome:
    rooms: tuple[MadeRoom, ...]
    doors: tuple[tuple[int, int, np.ndarray], ...]
    """Numbers of the two rooms, and the middle of the door in the home's own frame."""
    turn_rad: float
    shift: np.ndarray

    def placed(self, points: np.ndarray) -> np.ndarray:
        c, s = np.cos(self.turn_rad), np.sin(self.turn_rad)
        return points @ np.array([[c, s], [-s, c]]) + self.shift[:2]

    def floor_m(self, room: MadeRoom) -> float:
        return float(self.shift[2]) + RISE_M * room.storey


def made_home(seed: int) -> MadeHome:
    """A home of 3 to 8 rooms; from six on, of two storeys."""
    rng = np.random.default_rng(seed)
    count = 3 + seed % 6
    upper = count // 2 if count >= 6 else 0
    rooms: list[MadeRoom] = []
    for storey, wanted in enumerate((count - upper, upper)):
        cells = [(np.zeros(2), np.array([5.5 + 1.5 * wanted, 7.0]))] if wanted else []
        while len(cells) < wanted:
            number = int(np.argmax([np.prod(high - low) for low, high in cells]))
            low, high = cells.pop(number)
            axis = int(np.argmax(high - low))
            cut = low[axis] + (high - low)[axis] * rng.uniform(0.4, 0.6)
            first, second = high.copy(), low.copy()
            first[axis], second[axis] = cut - THICK_M / 2, cut + THICK_M / 2
            cells += [(low, first), (second, high)]
        rooms += [MadeRoom(NAMES[len(rooms) + k], storey, *cell) for k, cell in enumerate(cells)]
    doors = []
    for i, a in enumerate(rooms):
        for j, b in enumerate(rooms[:i]):
            at = _shared(a, b)
            if at is not None and a.storey == b.storey:
                doors.append((j, i, at))
    return MadeHome(tuple(rooms), tuple(doors), float(rng.uniform(-np.pi, np.pi)), rng.uniform(-2, 2, 3))


def _shared(a: MadeRoom, b: MadeRoom) -> np.ndarray | None:
    """The middle of the wall that two rooms share; None where no door fits."""
    for axis in (0, 1):
        for one, two in ((a, b), (b, a)):
            if abs(two.low[axis] - one.high[axis] - THICK_M) < 1e-6:
                low = max(a.low[1 - axis], b.low[1 - axis])
                high = min(a.high[1 - axis], b.high[1 - axis])
                if high - low > DOOR_M[0] + 0.3:
                    at = np.zeros(2)
                    at[axis], at[1 - axis] = one.high[axis] + THICK_M / 2, (low + high) / 2
                    return at
    return None


def _captured(home: MadeHome, number: int) -> dict:
    """What a phone saw of one room."""
    room = home.rooms[number]
    z, ring = home.floor_m(room), home.placed(room.ring)
    made = [Wall(a, b) for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True)]
    walls = [_row({"wall": {}}, (w.length, HEIGHT_M, 0.0), w.placed(w.length / 2, z + HEIGHT_M / 2)) for w in made]
    doors = []
    for pair in (d for d in home.doors if number in d[:2]):
        at = home.placed(pair[2][None])[0]
        away = [abs(w.along[0] * (at - w.start)[1] - w.along[1] * (at - w.start)[0]) for w in made]
        wall = made[int(np.argmin(away))]
        T = wall.placed(float((at - wall.start) @ wall.along), z + DOOR_M[1] / 2)
        row = _row({"door": {"isOpen": False}}, (*DOOR_M, 0.0), T)
        doors.append({**row, "parentIdentifier": walls[int(np.argmin(away))]["identifier"]})
    T = np.eye(4)
    T[2, 3] = z
    corners = [[float(x), float(y), 0.0] for x, y in ring]
    middle = np.array([*ring.mean(axis=0), z + 1.0])
    T_bed = np.eye(4)
    T_bed[:3, 0], T_bed[:3, 1], T_bed[:3, 2] = [0, 1, 0], [0, 0, 1], [1, 0, 0]
    T_bed[:3, 3] = [*ring.mean(axis=0), z + 0.4]
    return {
        "walls": walls,
        "doors": doors,
        "windows": [],
        "openings": [],
        "objects": [_row({"table": {}}, (1.0, 0.8, 0.7), T_bed, attributes={})],
        "floors": [_row({"floor": {}}, (1.0, 1.0, 0.0), T, polygonCorners=corners)],
        "sections": [{"label": room.name, "center": (WORLD_TO_SCAN[:3, :3] @ middle).tolist(), "story": room.storey}],
    }


def write_structure(path: Path, home: MadeHome) -> Path:
    """The merged home as one file."""
    parts = [_captured(home, k) for k in range(len(home.rooms))]
    path.write_text(json.dumps({"version": 2, **{key: [r for p in parts for r in p[key]] for key in parts[0]}}))
    return path


def write_rooms(folder: Path, home: MadeHome) -> Path:
    """A file a room, each in a frame of its own that its `referenceOriginTransform` is to."""
    rng = np.random.default_rng(7)
    for number in range(len(home.rooms)):
        part, angle = _captured(home, number), rng.uniform(-np.pi, np.pi)
        T = np.eye(4)  # y is up
        T[[0, 0, 2, 2], [0, 2, 0, 2]] = np.cos(angle), np.sin(angle), -np.sin(angle), np.cos(angle)
        T[:3, 3] = rng.uniform(-3, 3, 3)
        for row in (r for key, rows in part.items() if key != "sections" for r in rows):
            row["transform"] = (T @ np.reshape(row["transform"], (4, 4)).T).T.ravel().tolist()
        for row in part["sections"]:
            row["center"] = (T[:3, :3] @ row["center"] + T[:3, 3]).tolist()
        place = folder / f"{number}" / "room.json"
        place.parent.mkdir(parents=True)
        place.write_text(json.dumps({"version": 2, **part, "referenceOriginTransform": T.T.ravel().tolist()}))
    return folder
