"""A made room of boxes, photographed by cameras whose boxes are the cuboids' exact outlines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diorama_core.artefacts import DetectedObject
from diorama_core.geometry.projection import cuboid_corners, visible_bounds
from diorama_core.geometry.rotations import rotation_vector
from diorama_core.library.taxonomy import category
from diorama_core.multiview.joining import RoomPhoto, Sighted
from diorama_core.multiview.joint_fit import PosedBoxes
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.placement import FLOOR
from diorama_core.scene.types import Camera, Intrinsics
from diorama_core.synthesis.cameras import level_pose

K = Intrinsics(640, 480, 520.0, 520.0, 320.0, 240.0)


def turn_off_deg(a: Camera, b: Camera) -> float:
    """Angle between the directions of two cameras."""
    return float(np.degrees(np.linalg.norm(rotation_vector(a.T_world_camera[:3, :3].T @ b.T_world_camera[:3, :3]))))


@dataclass(frozen=True)
class Thing:
    kind: str
    centre: tuple[float, float, float]
    size_m: tuple[float, float, float]
    yaw_rad: float = 0.0


THINGS = (
    Thing("sofa", (0.5, 1.6, 0.42), (0.95, 2.0, 0.84), -np.pi / 2),
    Thing("armchair", (-1.2, 0.2, 0.45), (0.85, 0.8, 0.9), 0.5),
    Thing("armchair", (1.7, 0.1, 0.45), (0.85, 0.8, 0.9), 2.6),
    Thing("bookshelf", (-1.9, 1.5, 0.9), (0.32, 0.9, 1.8)),
)


def camera(x: float, y: float, target: tuple[float, float] = (0.0, 0.9), height_m: float = 1.5) -> Camera:
    yaw = float(np.arctan2(target[1] - y, target[0] - x))
    return Camera(K, level_pose(np.array([x, y, height_m]), yaw, 0.25))


CAMERAS = (camera(-0.4, -2.6), camera(2.2, -2.0), camera(-2.4, -1.6))


def photo(seen: Camera, things: tuple[Thing, ...] = THINGS, error_m: float = 0.25) -> tuple[RoomPhoto, list[int]]:
    """What a camera sees, read alone with an error along each ray; and which thing each box is of."""
    objects, alone, whose = [], [], []
    for number, thing in enumerate(things):
        corners = cuboid_corners(np.array([thing.centre]), np.array([thing.yaw_rad]), np.array([thing.size_m]))
        bounds, visible = visible_bounds(seen.to_camera(corners), seen.intrinsics)
        if not visible[0]:
            continue
        x1, y1, x2, y2 = (float(v) for v in bounds[0])
        mask = np.zeros((480, 640), bool)
        mask[int(y1) : int(y2), int(x1) : int(x2)] = True
        objects.append(DetectedObject(f"o{number}", thing.kind, thing.kind, (x1, y1, x2, y2), mask, number + 1, 0.5))
        ray = np.array(thing.centre) - seen.position
        centre = np.array(thing.centre) + error_m * ray / np.linalg.norm(ray)
        alone.append(Sighted(category(thing.kind), centre, thing.yaw_rad, np.array(thing.size_m), FLOOR))
        whose.append(number)
    observations = gather(tuple(objects), 640, 480)
    return RoomPhoto(PosedBoxes(seen, observations, np.zeros((len(objects), 4))), tuple(alone)), whose
