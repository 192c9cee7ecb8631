"""Where another photo of a scene's room was taken, by the photos and surfaces that the scene has."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import FurtherPhoto, Inputs, Photo
from diorama_core.library.record import ShapeLibrary
from diorama_core.multiview.found_poses import UnposedPhoto
from diorama_core.multiview.registration import PlacedPhoto, registered_camera
from diorama_core.progress import Progress
from diorama_core.render.raycast import PinholeView
from diorama_core.render.world import scene_world
from diorama_core.scene.types import Camera, Scene

OWN = "/"
"""Name of the scene's own photo: no file's."""


def photos_of_scene(scene: Scene, inputs: Inputs, further: Sequence[FurtherPhoto]) -> tuple[FurtherPhoto, ...]:
    """All photos whose cameras are known, the scene's own first."""
    seen = tuple((o.id, o.box_px) for o in scene.objects if o.box_px is not None)
    return (FurtherPhoto(OWN, inputs, scene.camera, seen), *(p for p in further if p.camera is not None))


def camera_of(
    photo: FurtherPhoto,
    known: Sequence[FurtherPhoto],
    scene: Scene,
    library: ShapeLibrary,
    progress: Progress | None = None,
) -> Camera:
    """The camera of a photo in a scene.

    Args:
        photo: the photo.
        known: those whose cameras are known, the scene's own first (`photos_of_scene`).
        scene: its surfaces tell metres.
        library: where its shapes are.
        progress: reports and cancellation.

    Raises:
        UnavailableError: pycolmap is not installed.
        InputError: the photo does not join.
        Cancelled: on request.
    """
    caster = scene_world(scene, library).caster

    def depth_along(camera: Camera, pixels: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n"]:
        return caster.first_hits(PinholeView(camera).rays(pixels)).distance.astype(np.float64)

    placed = [PlacedPhoto(_unposed(p.name, p.inputs.photo, p.camera), p.camera) for p in known if p.camera is not None]
    given = photo.inputs.intrinsics
    focal = photo.inputs.photo.exif_focal_px if given is None else given.fx
    if focal is None:
        # Photos of one room are usually of one phone: of one size, they have one focal length.
        alike = [p.photo.focal_px for p in placed if p.photo.rgb.shape == photo.inputs.photo.rgb.shape]
        focal = alike[0] if alike else None
    return registered_camera(UnposedPhoto(photo.name, photo.inputs.photo.rgb, focal), placed, depth_along, progress)


def _unposed(name: str, photo: Photo, camera: Camera) -> UnposedPhoto:
    return UnposedPhoto(name, photo.rgb, camera.intrinsics.scaled(photo.width, photo.height).fx)
