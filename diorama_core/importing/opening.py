"""A scene from a file, with its pictures, notes and photo."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from jaxtyping import UInt8

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.errors import InputError
from diorama_core.importing.marked import MarkedFile
from diorama_core.importing.restore import restore
from diorama_core.perception.inputs.photos.reading import read_photo
from diorama_core.perception.inputs.source import read_source
from diorama_core.scene.types import Architecture, Scene

MAX_PHOTO_PX = 8192
"""Longest side of a photo; a larger one does not fit its camera any more."""


@dataclass(frozen=True, eq=False)
class Opened:
    """A scene from a file."""

    scene: Scene
    textures: Mapping[str, UInt8[np.ndarray, "h w 3"]] = field(default_factory=dict)
    """Pictures of planes and of objects' materials, by name."""
    changes: tuple[str, ...] = ()
    """What the file has otherwise than it was written, one line each."""
    provenance: Mapping[str, Any] = field(default_factory=dict)
    """Where the scene came from, as the file says."""
    photo: Photo | None = None
    """The photo, where the file holds it."""
    boxes: tuple[LabelledBox, ...] = ()
    """What is marked in the photo."""

    @property
    def inputs(self) -> Inputs | None:
        """What a later build starts from: the photo and the scene's own camera."""
        if self.photo is None:
            return None
        camera = self.scene.camera
        return Inputs(self.photo, self.boxes, intrinsics=None if camera is None else camera.intrinsics)


def open_marked(file: MarkedFile) -> Opened:
    """The scene that Diorama wrote, as the file has it now; see `restore`."""
    restored_scene = restore(file)
    planes, textures = [], dict(file.material_pictures)
    for plane in restored_scene.scene.architecture.planes:
        picture = file.pictures.get(plane.id)
        if picture is not None:
            plane = replace(plane, texture=plane.texture or f"plane-{plane.id}")
            textures[str(plane.texture)] = picture
        planes.append(plane)
    scene = replace(restored_scene.scene, architecture=Architecture(tuple(planes)))
    photo, remarks = _photo(file, scene)
    return Opened(scene, textures, (*restored_scene.changes, *remarks), file.provenance, photo)


def _photo(file: MarkedFile, scene: Scene) -> tuple[Photo | None, tuple[str, ...]]:
    """The photo that the file holds, and what to know where it cannot be used."""
    name = str(file.provenance.get("photo") or "photo.jpg")
    if file.photo is None:
        return None, (
            f"{name} is not in the file; export it again with its photo",
        ) if "photo" in file.provenance else ()
    try:
        photo = read_photo(read_source(file.photo, "photo", name), MAX_PHOTO_PX).photo
    except InputError as error:
        return None, (f"the photo in the file cannot be read: {error}",)
    camera = scene.camera
    if camera is not None and (camera.intrinsics.width, camera.intrinsics.height) != (photo.width, photo.height):
        return None, (f"{name} is not of the camera's size; it was left out",)
    return photo, ()
