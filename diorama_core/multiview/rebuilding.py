"""A scene that was built anew from its own photo, with the other photos of the room that had joined the one before."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import UInt8

from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.errors import InputError
from diorama_core.library.record import ShapeLibrary
from diorama_core.multiview.adding import with_photo
from diorama_core.multiview.registration import photos_of_scene
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import LayoutStage
from diorama_core.scene.types import Camera, Scene


@dataclass(frozen=True, eq=False)
class Rebuilt:
    """A new scene with the photos that joined it again."""

    scene: Scene
    photos: tuple[FurtherPhoto, ...]
    """All of them, as they were ordered; without a camera those that do not join."""
    textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]]
    """Pictures that the scene names since."""
    left_out: tuple[str, ...]
    """Names of the photos that had joined and do not any more."""


def with_photos_again(
    scene: Scene,
    inputs: Inputs,
    before: Camera | None,
    photos: Sequence[FurtherPhoto],
    library: ShapeLibrary,
    choose: Callable[[Inputs], Stages],
    layout: Callable[[frozenset[str]], LayoutStage],
    progress: Progress = SILENT,
) -> Rebuilt:
    """The new scene with everything that the other photos show.

    Args:
        scene: as it was built from its own photo; nobody has changed it.
        inputs: that photo.
        before: the own photo's camera in the scene before.
        photos: the others, with their cameras in the scene before.
        library: where shapes come from.
        choose: the stages for a photo.
        layout: the optimiser, given the ids that are free to move.
        progress: reports and cancellation.

    Raises:
        Cancelled: on request.
        DioramaError: when a stage cannot do its work.
    """
    done: list[FurtherPhoto] = []
    textures: dict[str, UInt8[np.ndarray, "_ _ 3"]] = {}
    left_out: list[str] = []
    for photo, part in zip(photos, progress.parts(len(photos)), strict=True):
        if photo.camera is None:
            done.append(photo)
            continue
        try:
            if before is None or scene.camera is None:
                raise InputError("the scene has no camera")
            carried_photo = replace(photo, camera=transfer_camera(photo.camera, before, scene.camera), seen=())
            known = photos_of_scene(scene, inputs, done)
            ids = frozenset(o.id for o in scene.objects) | {p.id for p in scene.architecture.planes}
            added = with_photo(scene, known, carried_photo, ids, ids, library, choose, layout, part)
        except InputError:
            left_out.append(photo.name)
            done.append(replace(photo, camera=None, seen=()))
            continue
        scene, textures = added.scene, {**textures, **added.textures}
        done.append(added.photo)
    return Rebuilt(scene, tuple(done), textures, tuple(left_out))


def transfer_camera(camera: Camera, before: Camera, after: Camera) -> Camera:
    """A camera that is to another one as it was, when that one is found anew.

    Args:
        camera: in the world before, its floor at 0.
        before: the other one there.
        after: the other one in the world from now on; the heights of both above the floor tell the scale.
    """
    T = np.linalg.inv(before.T_world_camera) @ camera.T_world_camera
    height = float(before.position[2])
    T[:3, 3] *= float(after.position[2]) / height if height > 0.05 else 1.0
    return Camera(camera.intrinsics, after.T_world_camera @ T)
