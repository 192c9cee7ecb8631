"""Cameras as people hold them: at eye height, from the side of the room, tilted a little down, never quite level."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.errors import SceneError
from diorama_core.geometry.planes import is_in_polygon
from diorama_core.geometry.rooms import room_around
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.raycast import MeshCaster
from diorama_core.render.slabs import plane_surfaces
from diorama_core.scene.types import Camera, Intrinsics, Plane, Scene

PROBE_SIZE = (64, 48)
CANDIDATES = 28
MIN_SHOWN = 6
MIN_FLOOR = 0.04
LARGEST_SHARE = 0.45
NEAR_SHARE = 0.1
"""A view with fewer objects, less floor, a larger object or more right before the lens is a last resort."""
UNDER_CEILING_M = 0.2
"""Nobody holds a camera nearer to a sloping ceiling."""


@dataclass(frozen=True)
class CameraRanges:
    """How people hold a camera; lowest and highest values."""

    height_m: tuple[float, float] = (1.3, 1.65)
    pitch_rad: tuple[float, float] = (0.1, 0.38)
    """Downward."""
    roll_rad: float = 0.015
    """Standard deviation."""
    fov_rad: tuple[float, float] = (1.0, 1.25)
    """Horizontal: phones, from normal to wide."""
    clearance_m: float = 0.25
    """From walls; furniture is kept twice as far."""


def sample_cameras(
    scene: Scene,
    library: ShapeLibrary,
    seed: int,
    count: int = 3,
    size: tuple[int, int] = (640, 480),
    ranges: CameraRanges | None = None,
) -> tuple[Camera, ...]:
    """Different views of a room, each the best of some that people might take.

    Views that show many objects, few of them cut off or very close, are preferred.

    Args:
        scene: A room from `furnish_room`.
        library: Where its shapes are.
        seed: Of the candidates.
        count: How many views.
        size: Width and height of the pictures.
        ranges: How the camera is held.

    Raises:
        SceneError: when nobody could stand in the room.
    """
    rng = np.random.default_rng((seed, 4711))
    caster = MeshCaster([*_meshes(scene, library), *((_plane_mesh(p), np.eye(4)) for p in scene.architecture.planes)])
    how, viewpoints = ranges or CameraRanges(), list[tuple[Camera, _Viewpoint]]()
    for closer in (1.0, 0.6, 0.3, 0.1):  # a full or narrow room lets nobody stand well clear of objects
        nearer = replace(how, clearance_m=closer * how.clearance_m)
        tried = [_candidate(scene, rng, size, nearer) for _ in range(CANDIDATES * max(1, count))]
        viewpoints += [(camera, _compare(scene, caster, camera)) for camera in tried if camera is not None]
        if len(viewpoints) >= 2 * count and sum(viewpoint.worth_it for _, viewpoint in viewpoints) >= count:
            break
    viewpoints.sort(key=lambda pair: -pair[1].score)
    chosen: list[Camera] = []
    # Two pictures that resemble each other are better than one of a cupboard's side.
    for worth_it in (True, False):
        for min_apart in (1.2, 0.6, 0.2, 0.0):
            for camera, viewpoint in viewpoints:
                apart = all(_apart(camera, c) > min_apart for c in chosen)
                if len(chosen) < count and apart and (viewpoint.worth_it or not worth_it):
                    chosen.append(camera)
    if len(chosen) < count:
        raise SceneError(f"no place for {count} cameras was found in the room; it is too full or too small")
    return tuple(chosen)


def _meshes(scene: Scene, library: ShapeLibrary) -> list[tuple[trimesh.Trimesh, Float[np.ndarray, "4 4"]]]:
    return [(library.mesh(o.shape_id), o.pose.matrix) for o in scene.objects]


def _plane_mesh(plane: Plane) -> trimesh.Trimesh:
    front, _ = plane_surfaces(plane)
    return trimesh.Trimesh(front.vertices, front.faces, process=False)


def _candidate(scene: Scene, rng: np.random.Generator, size: tuple[int, int], how: CameraRanges) -> Camera | None:
    floors = scene.architecture.by_role("floor")
    if not floors:
        raise ValueError("a room without a floor cannot be photographed")
    floor = floors[int(rng.integers(len(floors))) if len(floors) > 1 else 0]
    outline = floor.polygon[:, :2]
    low, high = outline.min(axis=0), outline.max(axis=0)
    position = rng.uniform(low, high)
    target = rng.normal((low + high) / 2, (high - low) / 6)
    height = float(floor.centre[2]) + rng.uniform(*how.height_m)
    pitch, fov = rng.uniform(*how.pitch_rad), rng.uniform(*how.fov_rad)
    roll = rng.normal(0.0, how.roll_rad)
    if not _is_inside(position, outline, how.clearance_m) or np.linalg.norm(target - position) < 1.0:
        return None
    eye = np.array([*position, height])
    ceilings = room_around(scene, eye).architecture.by_role("ceiling")
    if any(p.normal @ eye - p.offset < UNDER_CEILING_M for p in ceilings):
        return None
    for item in scene.objects:
        local = (eye - item.pose.position) @ item.pose.R_world_object
        if item.category != "rug" and (np.abs(local) < item.size_m / 2 + 2 * how.clearance_m).all():
            return None
    yaw = float(np.arctan2(target[1] - position[1], target[0] - position[0]))
    return Camera(Intrinsics.from_fov(*size, float(fov)), level_pose(eye, yaw, float(pitch), float(roll)))


def level_pose(
    eye: Float[np.ndarray, "3"], yaw_rad: float, pitch_down_rad: float, roll_rad: float = 0.0
) -> Float[np.ndarray, "4 4"]:
    """`T_world_camera` of a camera at `eye` looking along `yaw_rad`, tilted down and rolled clockwise.

    Args:
        eye: World, metres.
        yaw_rad: Heading, 0 along +X.
        pitch_down_rad: Below the horizon.
        roll_rad: Clockwise.
    """
    forward = np.array(
        [np.cos(yaw_rad) * np.cos(pitch_down_rad), np.sin(yaw_rad) * np.cos(pitch_down_rad), -np.sin(pitch_down_rad)]
    )
    right = np.array([np.sin(yaw_rad), -np.cos(yaw_rad), 0.0])
    down = np.cross(forward, right)
    c, s = np.cos(roll_rad), np.sin(roll_rad)
    T = np.eye(4)
    T[:3, :3] = np.stack([c * right + s * down, c * down - s * right, forward], axis=1)
    T[:3, 3] = eye
    return T


@dataclass(frozen=True)
class _Viewpoint:
    """What a quick look through a camera shows."""

    score: float
    """Higher is better."""
    worth_it: bool
    """Whether it shows a room: several objects, some floor, nothing that fills the view."""


def _compare(scene: Scene, caster: MeshCaster, camera: Camera) -> _Viewpoint:
    """How much a view shows: objects well inside the picture, not too near, with floor to stand on."""
    probe = Camera(camera.intrinsics.resize(*PROBE_SIZE), camera.T_world_camera)
    seen = caster.buffers(probe)
    count = len(scene.objects)
    pixels = np.bincount(seen.instance[seen.instance >= 0].ravel(), minlength=count)[:count]
    border = np.concatenate([seen.instance[0], seen.instance[-1], seen.instance[:, 0], seen.instance[:, -1]])
    cut = np.bincount(border[border >= 0], minlength=count)[:count] > 0
    total = PROBE_SIZE[0] * PROBE_SIZE[1]
    whole = (pixels >= 4) & ~cut
    near = float((seen.depth_m < 0.9).mean())
    biggest = float(pixels.max() / total) if count else 0.0
    floor = float((seen.instance == count).mean())
    shown = int((pixels >= 4).sum())
    score = whole.sum() + 0.3 * shown - 12 * near - 8 * max(biggest - 0.3, 0.0) + 4 * min(floor, 0.2)
    worth_it = shown >= MIN_SHOWN and floor >= MIN_FLOOR and biggest <= LARGEST_SHARE and near <= NEAR_SHARE
    return _Viewpoint(float(score), bool(worth_it))


def _apart(a: Camera, b: Camera) -> float:
    """Distance between two cameras, metres, a metre for every radian of turn."""
    turn = np.arccos(np.clip(a.T_world_camera[:3, 2] @ b.T_world_camera[:3, 2], -1, 1))
    return float(np.linalg.norm(a.position - b.position) + turn)


def _is_inside(point: np.ndarray, outline: Float[np.ndarray, "n 2"], margin_m: float) -> bool:
    """True for a point in an outline (concave allowed) and `margin_m` from its edges."""
    edges, offset = np.roll(outline, -1, axis=0) - outline, point - outline
    along = np.clip((offset * edges).sum(axis=1) / (edges * edges).sum(axis=1), 0, 1)
    distance = np.linalg.norm(offset - along[:, None] * edges, axis=1)
    return bool((distance >= margin_m).all() and is_in_polygon(point, outline))
