"""Where to stand in a composed room so that its picture shows what was asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.library.record import ShapeLibrary
from diorama_core.render.raycast import MeshCaster
from diorama_core.render.slabs import plane_surfaces
from diorama_core.scene.types import Camera, Intrinsics, Scene
from diorama_core.synthesis.cameras import level_pose

PROBE_PX = (96, 72)
EYE_M, FOV_RAD = 1.6, 1.45
"""Eye level, and a wide lens as estate agents use."""
PLACES = 9
"""A side of the grid of places."""
TURNS_RAD = (-0.35, -0.18, 0.0, 0.18, 0.35)
"""Away from the middle of what was asked for."""
WALL_CLEARANCE_M, OBJECT_CLEARANCE_M = 0.15, 0.35
LOWEST_PITCH_RAD, HIGHEST_PITCH_RAD = 0.1, 0.42
SEEN_PX = 5
"""Fewer pixels of the probe show nothing that could be found again."""
CUT_WORTH = 0.45
"""Worth of an object that the picture's rim cuts off, beside one that is seen whole."""
NEAR_M = 0.9


def best_viewpoint(scene: Scene, library: ShapeLibrary, size: tuple[int, int], weights: Mapping[str, float]) -> Camera:
    """The place, of all where one could stand, from which most is seen, and seen whole.

    Args:
        scene: a room with objects, walls that face it, and the floor at z = 0.
        library: where its shapes are.
        size: width and height of the picture.
        weights: by object id, how much it matters that it is seen; 0 where it is left out.
    """
    meshes = [(library.mesh(o.shape_id), o.pose.matrix) for o in scene.objects]
    planes = [(_front(scene, k), np.eye(4)) for k in range(len(scene.architecture.planes))]
    caster = MeshCaster([*meshes, *planes])
    worth = np.array([weights.get(o.id, 0.0) for o in scene.objects])
    best: tuple[float, Camera] | None = None
    for camera in _candidates(scene, size, worth):
        score = _score(caster, camera, worth)
        if best is None or score > best[0]:
            best = (score, camera)
    if best is None:
        raise ValueError("nobody could stand in this room")
    return best[1]


def _front(scene: Scene, index: int) -> trimesh.Trimesh:
    front, _ = plane_surfaces(scene.architecture.planes[index])
    return trimesh.Trimesh(front.vertices, front.faces, process=False)


def _candidates(scene: Scene, size: tuple[int, int], worth: Float[np.ndarray, " n"]) -> Iterator[Camera]:
    """From free places, toward the middle of what matters; ever nearer to furniture where a room is full."""
    floor = scene.architecture.floor
    outline = np.zeros((1, 2)) if floor is None else floor.polygon[:, :2]
    low, high = outline.min(axis=0) + WALL_CLEARANCE_M, outline.max(axis=0) - WALL_CLEARANCE_M
    middle = np.array([*(low + high) / 2, 0.6])
    if worth.sum() > 0:
        middle = np.average([o.pose.position for o in scene.objects], axis=0, weights=worth)
    for clearance in (OBJECT_CLEARANCE_M, 0.15, 0.0):
        free = [eye for eye in _places(low, high) if _stands_free(scene, eye, clearance)]
        for eye in free:
            away = middle - eye
            distance = float(np.hypot(*away[:2]))
            if distance < 0.8:
                continue
            pitch = float(np.clip(np.arctan2(-away[2], distance), LOWEST_PITCH_RAD, HIGHEST_PITCH_RAD))
            for turn in TURNS_RAD:
                T = level_pose(eye, float(np.arctan2(away[1], away[0])) + turn, pitch)
                yield Camera(Intrinsics.from_fov(*size, FOV_RAD), T)
        if free:
            return


def _places(low: Float[np.ndarray, "2"], high: Float[np.ndarray, "2"]) -> Iterator[Float[np.ndarray, "3"]]:
    for x in np.linspace(low[0], high[0], PLACES):
        for y in np.linspace(low[1], high[1], PLACES):
            yield np.array([x, y, EYE_M])


def _stands_free(scene: Scene, eye: Float[np.ndarray, "3"], clearance_m: float) -> bool:
    """Whether a person fits: inside the walls, and beside what reaches up to the eyes."""
    if any(p.normal @ eye - p.offset < 0.9 * WALL_CLEARANCE_M for p in scene.architecture.by_role("wall")):
        return False
    for item in scene.objects:
        local = np.abs((eye - item.pose.position) @ item.pose.R_world_object)
        if (local < item.size_m / 2 + clearance_m).all():
            return False
    return True


def _probe(camera: Camera) -> Camera:
    return Camera(camera.intrinsics.scaled(*PROBE_PX), camera.T_world_camera)


def _score(caster: MeshCaster, camera: Camera, worth: Float[np.ndarray, " n"]) -> float:
    seen = caster.buffers(_probe(camera))
    count = len(worth)
    pixels = np.bincount(seen.instance[seen.instance >= 0].ravel(), minlength=count)[:count]
    rim = np.concatenate([seen.instance[0], seen.instance[-1], seen.instance[:, 0], seen.instance[:, -1]])
    cut = np.bincount(rim[rim >= 0], minlength=count)[:count] > 0
    # What is hardly seen counts little: it would not be found again.
    clear = np.clip((pixels - SEEN_PX) / (4.0 * SEEN_PX), 0.0, 1.0) * np.where(cut, CUT_WORTH, 1.0)
    near = float((seen.depth_m < NEAR_M).mean())
    biggest = float(pixels.max(initial=0)) / (PROBE_PX[0] * PROBE_PX[1])
    return float(worth @ clear) - 6.0 * near - 4.0 * max(biggest - 0.35, 0.0)
