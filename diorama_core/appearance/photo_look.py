"""What the photo shows of every object's surfaces, as materials of its slots and their pictures."""

from __future__ import annotations

import re
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.appearance.flat_faces import Face, faces_of
from diorama_core.artefacts import DetectedObject
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Camera, PhotoMaterial, Scene, SceneObject

MASK_MARGIN = 0.004
"""Widening of what stands before an object, as a share of the photo's longer side."""

Picture = UInt8[np.ndarray, "_ _ 3"]


@dataclass(frozen=True, eq=False)
class PhotoLook:
    """Materials by object id, and their pictures by name."""

    materials: Mapping[str, tuple[PhotoMaterial, ...]]
    pictures: Mapping[str, Picture]

    def applied(self, scene: Scene) -> Scene:
        """The scene with objects that show the photo's materials."""
        objects = tuple(replace(o, photo_materials=self.materials.get(o.id, o.photo_materials)) for o in scene.objects)
        return replace(scene, objects=objects)


def photo_look(
    rgb: UInt8[np.ndarray, "h w 3"], objects: tuple[DetectedObject, ...], scene: Scene, library: ShapeLibrary
) -> PhotoLook:
    """What the photo shows of the scene's objects.

    Args:
        rgb: The photo.
        objects: What was found in it; those of the scene have their ids.
        scene: In the poses in which the photo shows it; without a camera nothing is taken.
        library: Where its shapes are.
    """
    materials: dict[str, tuple[PhotoMaterial, ...]] = {}
    pictures: dict[str, Picture] = {}
    found = {o.id: o for o in objects}
    for item in scene.objects if scene.camera is not None else ():
        if item.id in found and scene.camera is not None:
            made = _of_object(item, rgb, found[item.id], objects, library, scene.camera)
            materials[item.id] = tuple(material for material, _ in made)
            pictures |= {m.texture: picture for m, picture in made if m.texture is not None}
    return PhotoLook({key: value for key, value in materials.items() if value}, pictures)


def _of_object(
    item: SceneObject,
    rgb: UInt8[np.ndarray, "h w 3"],
    found: DetectedObject,
    objects: tuple[DetectedObject, ...],
    library: ShapeLibrary,
    camera: Camera,
) -> list[tuple[PhotoMaterial, Picture]]:
    hidden = hiding(found, objects)
    faces = faces_of(item, library.parts(item.shape_id), rgb, hidden, found, camera)
    return [(_face_material(item, face), face.picture) for face in faces]


def hiding(found: DetectedObject, objects: tuple[DetectedObject, ...]) -> Bool[np.ndarray, "h w"]:
    """Where other objects stand before one: smaller ones wherever they are, larger ones beside its own mask."""
    hidden, area = np.zeros(found.mask.shape, dtype=bool), int(found.mask.sum())
    for other in objects:
        if other.id != found.id:
            hidden |= other.mask if other.mask.sum() < area else other.mask & ~found.mask
    radius = max(1, round(MASK_MARGIN * max(hidden.shape)))
    return cv2.dilate(hidden.astype(np.uint8), np.ones((2 * radius + 1,) * 2, np.uint8)).astype(bool)


def _face_material(item: SceneObject, face: Face) -> PhotoMaterial:
    red, green, blue = (float(c) / 255.0 for c in face.picture.reshape(-1, 3).mean(axis=0))
    return PhotoMaterial(
        slot=face.slot.name,
        colour=(red, green, blue),
        texture=texture_name(item.id, face.slot.name, face.picture),
        layout=face.layout,
        roughness=face.roughness,
        main=face.slot.main,
    )


def texture_name(object_id: str, slot: str, picture: Picture) -> str:
    """A file name for a slot's picture; another picture has another name, so that undo finds the one before."""
    words = re.sub(r"[^A-Za-z0-9]+", "-", f"{object_id} {slot}").strip("-")
    return f"{words[:80]}-{zlib.crc32(picture.tobytes()):08x}"
