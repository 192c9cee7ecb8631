"""A rendered room photographed from two places side by side; the scene is the truth without two things."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from diorama_core.artefacts import FurtherPhoto, Inputs, LayoutReport
from diorama_core.library.catalogue import built_in_library
from diorama_core.progress import Progress
from diorama_core.project.further_photos import note_placed
from diorama_core.project.storage import Project
from diorama_core.protocols import Preview
from diorama_core.scene.edits import remove
from diorama_core.scene.types import Camera, Scene
from diorama_core.synthesis import furnish_room
from diorama_core.synthesis.artefacts import photo_only
from diorama_core.synthesis.cameras import level_pose, sample_cameras
from diorama_core.synthesis.truth import Studio
from tests.made_once import made_once

SIZE = (640, 480)
SMALL = (400, 300)
"""Enough for what is built from a photo whose camera is known; to find a camera takes more."""
ASIDE_M = 0.45


@dataclass(frozen=True, eq=False)
class TwoPhotos:
    scene: Scene
    """In the first photo's world, with its camera, without what is missing."""
    first: Inputs
    second: Inputs
    camera: Camera
    """The second photo's, in that world."""
    missing: tuple[str, ...]
    """Categories of what both photos show and the scene has not."""


@cache
def two_photos(size: tuple[int, int] = SIZE) -> TwoPhotos:
    """Photos of so many pixels, the same in all processes of a run."""
    return made_once(f"two photos of {size[0]} x {size[1]}", lambda: _made(size))


def _made(size: tuple[int, int]) -> TwoPhotos:
    library = built_in_library()
    room = furnish_room(7006, "dining", library, clutter=1)
    camera = sample_cameras(room, library, 7006, 1, size)[0]
    studio, beside = Studio(room, library), camera_beside(camera, ASIDE_M)
    views = [studio.view(c, size, with_empty_room=False) for c in (camera, beside)]
    there = views[0].camera.T_world_camera @ np.linalg.inv(camera.T_world_camera) @ beside.T_world_camera
    seen = set(views[0].indices) & set(views[1].indices)
    items = views[0].scene.objects
    gone = [items[k] for k in sorted(seen) if items[k].category in ("chair", "picture")][:2]
    scene = remove(views[0].scene, [o.id for o in gone])
    return TwoPhotos(
        scene,
        photo_only(views[0]),
        photo_only(views[1]),
        Camera(beside.intrinsics, there),
        tuple(o.category for o in gone),
    )


def camera_beside(camera: Camera, aside_m: float) -> Camera:
    """A camera to the right of another one, at the same height, that looks at what is in its middle."""
    eye, ahead = camera.position, camera.T_world_camera[:3, 2]
    yaw, target = float(np.arctan2(ahead[1], ahead[0])), eye + 2.5 * ahead
    place = eye + aside_m * np.array([np.sin(yaw), -np.cos(yaw), 0.0])
    turned = float(np.arctan2(target[1] - place[1], target[0] - place[0]))
    return Camera(camera.intrinsics, level_pose(place, turned, -float(np.arcsin(ahead[2]))))


def project_of(photos: TwoPhotos, folder: Path) -> Project:
    """A project as a build of the first photo leaves it."""
    project = Project.create(folder, name=folder.name)
    project.save_inputs(photos.first)
    project.save_scene(photos.scene)
    note_placed(project, photos.scene)
    return project


def with_camera(photos: TwoPhotos) -> FurtherPhoto:
    return FurtherPhoto("beside", replace(photos.second, intrinsics=photos.camera.intrinsics), photos.camera)


class AsItIs:
    """The layout that leaves everything where it was put: what a layout does to rooms is tested elsewhere."""

    def optimise(self, scene: Scene, progress: Progress, preview: Preview | None = None) -> tuple[Scene, LayoutReport]:
        return scene, LayoutReport("as it is", {}, {}, 0.0)
