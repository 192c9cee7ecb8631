"""Scans as RoomPlan writes them: the JSON of `CapturedRoom`, and `room.usdz` with its groups of parametric boxes.

A made room is known exactly: an L-shaped floor turned by an odd angle, walls, a door, a window, and furniture.
"""

from __future__ import annotations

import json
import uuid
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from diorama_core.importing.roomplan_parts import KINDS
from diorama_core.scene.types import Scene

WORLD_TO_SCAN = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, -1.0, 0, 0], [0, 0, 0, 1.0]])
"""+Z up to RoomPlan's +Y up."""
HEIGHT_M, FLOOR_M, TURN = 2.6, -1.31, 0.37
CORNERS = np.array([[0.0, 0.0], [4.2, 0.0], [4.2, 2.1], [2.6, 2.1], [2.6, 3.9], [0.0, 3.9]])
FURNITURE = (
    # category, width, height, depth, x, y, bottom, heading of the front in degrees
    ("bed", 1.60, 0.62, 2.05, 1.06, 2.6, 0.0, 0),
    ("storage", 1.20, 2.05, 0.60, 3.4, 0.30, 0.0, 90),
    ("storage", 1.30, 0.52, 0.42, 3.1, 1.89, 0.0, -90),
    ("television", 1.10, 0.65, 0.20, 3.1, 1.89, 0.52, -90),
    ("chair", 0.50, 0.88, 0.55, 2.0, 1.1, 0.0, 215),
    ("table", 1.40, 0.74, 0.80, 1.3, 0.75, 0.0, 90),
    ("sofa", 1.95, 0.84, 0.95, 1.0, 1.45, 0.0, 0),
    ("refrigerator", 0.70, 1.80, 0.68, 2.2, 3.5, 0.0, -90),
    ("washerDryer", 0.60, 0.86, 0.60, 1.5, 3.6, 0.0, -90),
    ("toilet", 0.40, 0.75, 0.68, 3.85, 1.2, 0.0, 180),
)
DOOR = (0, 1.0, 0.90, 2.05, 0.0)
"""Wall, metres from its start, width, height, sill."""
WINDOW = (5, 1.9, 1.20, 1.10, 0.9)


@dataclass(frozen=True)
class Wall:
    start: np.ndarray
    end: np.ndarray

    @property
    def length(self) -> float:
        return float(np.linalg.norm(self.end - self.start))

    @property
    def along(self) -> np.ndarray:
        return (self.end - self.start) / self.length

    def placed(self, t: float, z: float, off: float = 0.0) -> np.ndarray:
        """Transform of something in the wall: x along it, y up, z into the room; world with +Z up."""
        inward = np.array([-self.along[1], self.along[0]])
        T = np.zeros((4, 4))
        T[:2, 0], T[2, 1], T[:2, 2], T[3, 3] = -self.along, 1.0, inward, 1.0
        T[:3, 3] = [*(self.start + t * self.along + off * inward), z]
        return T


def turned(points: np.ndarray) -> np.ndarray:
    c, s = np.cos(TURN), np.sin(TURN)
    return points @ np.array([[c, s], [-s, c]])


def walls() -> list[Wall]:
    ring = turned(CORNERS)
    return [Wall(a, b) for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True)]


def furniture(row: tuple) -> tuple[str, np.ndarray, np.ndarray, float]:
    """Category, dimensions (width, height, depth), transform, and the heading of the front in the world."""
    kind, width, height, depth, x, y, bottom, degrees = row
    yaw = np.radians(degrees) + TURN
    front = np.array([np.cos(yaw), np.sin(yaw), 0.0])
    T = np.zeros((4, 4))
    T[:3, 2], T[:3, 1], T[3, 3] = front, [0, 0, 1], 1.0
    T[:3, 0] = np.cross(T[:3, 1], T[:3, 2])
    T[:3, 3] = [*turned(np.array([x, y])), FLOOR_M + bottom + height / 2]
    return kind, np.array([width, height, depth]), T, yaw


def _row(category: dict, size, T: np.ndarray, **more) -> dict:
    return {
        "identifier": str(uuid.uuid4()).upper(),
        "category": category,
        "confidence": {"high": {}},
        "dimensions": [float(v) for v in size],
        "transform": [float(v) for v in (WORLD_TO_SCAN @ T).T.ravel()],
        "parentIdentifier": None,
        "story": 0,
        **more,
    }


def write_json(path: Path, rows: tuple = FURNITURE, *, floors: bool = True) -> Path:
    made = walls()
    surfaces = {"curve": None, "completedEdges": [], "polygonCorners": []}
    z = FLOOR_M + HEIGHT_M / 2
    wall_rows = [_row({"wall": {}}, (w.length, HEIGHT_M, 0.0), w.placed(w.length / 2, z), **surfaces) for w in made]

    def opening(spec: tuple, category: dict) -> dict:
        number, t, width, height, sill = spec
        T = made[number].placed(t, FLOOR_M + sill + height / 2)
        row = _row(category, (width, height, 0.0), T, **surfaces)
        return {**row, "parentIdentifier": wall_rows[number]["identifier"]}

    flat = np.eye(4)
    flat[2, 3] = FLOOR_M
    corners = [[float(x), float(y), 0.0] for x, y in turned(CORNERS)]
    floor = _row({"floor": {}}, (4.2, 3.9, 0.0), flat, **{**surfaces, "polygonCorners": corners})
    document = {
        "version": 2,
        "identifier": str(uuid.uuid4()).upper(),
        "story": 0,
        "walls": wall_rows,
        "doors": [opening(DOOR, {"door": {"isOpen": False}})],
        "windows": [opening(WINDOW, {"window": {}})],
        "openings": [opening((2, 0.8, 0.8, 2.0, 0.0), {"opening": {}})],
        "objects": [_row({f[0]: {}}, f[1], f[2], attributes={}) for f in map(furniture, rows)],
        "floors": [floor] if floors else [],
        "sections": [{"label": "bedroom", "center": [1.0, 0.0, 1.0], "story": 0}],
    }
    path.write_text(json.dumps(document))
    return path


TO_SCAN = np.array(
    [
        [np.cos(TURN), -np.sin(TURN), 0.0, 1.2],
        [np.sin(TURN), np.cos(TURN), 0.0, -0.7],
        [0, 0, 1.0, FLOOR_M],
        [0, 0, 0, 1.0],
    ]
)
"""From a room's own frame to where the phone's session had it."""


def _upright(R: np.ndarray, place: np.ndarray) -> np.ndarray:
    """RoomPlan's axes (x along the width, y up, z out of the front) of something with our axes."""
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2], T[:3, 3] = R[:, 1], R[:, 2], R[:, 0], place
    return TO_SCAN @ T


def write_scan_of(path: Path, scene: Scene) -> Path:
    """The JSON that a phone would write of a room: what RoomPlan has no word for is not in it."""
    wall_rows = []
    for wall in scene.architecture.by_role("wall"):
        along = np.cross([0.0, 0.0, 1.0], wall.normal)
        low, high = (wall.polygon.min(axis=0), wall.polygon.max(axis=0))
        T = _upright(np.stack([wall.normal, along, [0.0, 0.0, 1.0]], axis=1), (low + high) / 2)
        wall_rows.append(_row({"wall": {}}, (np.ptp(wall.polygon @ along), high[2] - low[2], 0.0), T))
    floor = scene.architecture.floor
    corners = [[float(x), float(y), 0.0] for x, y in floor.polygon[:, :2]]
    rows: dict[str, list] = {"doors": [], "windows": [], "objects": []}
    for item in scene.objects:
        depth, width, height = item.size_m
        T = _upright(item.pose.R_world_object, item.pose.position)
        word = next((w for w, kinds in KINDS.items() if item.category in kinds and w != "stairs"), None)
        if item.category in ("door", "window"):
            rows[f"{item.category}s"].append(_row({item.category: {}}, (width, height, 0.0), T))
        elif word is not None:
            rows["objects"].append(_row({word: {}}, (width, height, depth), T, attributes={}))
    document = {"version": 2, "walls": wall_rows, "openings": [], **rows}
    document["floors"] = [_row({"floor": {}}, (1.0, 1.0, 0.0), TO_SCAN, polygonCorners=corners)]
    path.write_text(json.dumps(document))
    return path


def write_usdz(path: Path, rows: tuple = FURNITURE, *, baked: bool = False) -> Path:
    """Boxes below Parametric_grp; `baked`: points in the room's frame, without transforms."""
    from pxr import Gf, Usd, UsdGeom, UsdUtils

    layer = path.with_suffix(".usdc")
    stage = Usd.Stage.CreateNew(str(layer))
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, "/Room").GetPrim())
    for group in ("Parametric_grp", "Parametric_grp/Arch_grp", "Parametric_grp/Object_grp", "Section_grp"):
        UsdGeom.Xform.Define(stage, f"/Room/{group}")

    def mesh(name: str, points: np.ndarray, faces: list[list[int]], T: np.ndarray) -> None:
        made = UsdGeom.Mesh.Define(stage, f"/Room/Parametric_grp/{name}")
        M = WORLD_TO_SCAN @ T
        if baked:
            points = points @ M[:3, :3].T + M[:3, 3]
        else:
            made.AddTransformOp().Set(Gf.Matrix4d(*(float(v) for v in M.T.ravel())))
        made.CreatePointsAttr([Gf.Vec3f(*(float(v) for v in p)) for p in points])
        made.CreateFaceVertexCountsAttr([len(f) for f in faces])
        made.CreateFaceVertexIndicesAttr([i for f in faces for i in f])

    def box(name: str, size, T: np.ndarray) -> None:
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        mesh(name, signs * np.array(size) / 2, faces, T)

    thick, made = 0.1, walls()
    for number, wall in enumerate(made):
        T = wall.placed(wall.length / 2, FLOOR_M + HEIGHT_M / 2, -thick / 2)
        box(f"Arch_grp/Wall_{number}_grp/Wall{number}", (wall.length, HEIGHT_M, thick), T)
    for name, (number, t, width, height, sill) in (("Door0", DOOR), ("Window0", WINDOW)):
        T = made[number].placed(t, FLOOR_M + sill + height / 2, -thick / 2)
        box(f"Arch_grp/Wall_{number}_grp/{name}", (width, height, thick), T)
    ring = np.column_stack([turned(CORNERS), np.full(len(CORNERS), FLOOR_M)])
    mesh("Arch_grp/Floor_grp/Floor0", ring, [list(range(len(ring)))], np.eye(4))
    for number, row in enumerate(rows):
        kind, size, T, _ = furniture(row)
        name = kind[0].upper() + kind[1:]
        box(f"Object_grp/{name}_grp/{name}{number}", size, T)
    stage.GetRootLayer().Save()
    assert UsdUtils.CreateNewUsdzPackage(str(layer), str(path))
    layer.unlink()
    return path
