"""What the photo shows of every object's surfaces, as materials of its slots and their pictures."""

from __future__ import annotations

import re
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, replace

import cv2
import numpy as np
import trimesh
from jaxtyping import Bool, Float32, UInt8

from diorama_core.appearance.flat_faces import FlatFace, faces_of
from diorama_core.appearance.irradiance import irradiance_map
from diorama_core.appearance.light import SHINING, estimate_light
from diorama_core.appearance.matched_brightness import brighten, brightness_gains
from diorama_core.appearance.room_cues import SETTINGS, wall_shade, window_direction
from diorama_core.appearance.sets import share_materials
from diorama_core.appearance.surface_materials import (
    ROUGHNESS,
    SlotPixels,
    appearance_of,
    shade_of,
    slot_pixels,
    whole_pixels,
)
from diorama_core.appearance.surface_view import SurfaceView, surface_view
from diorama_core.artefacts import DetectedObject
from diorama_core.library.furniture.measures import MARK
from diorama_core.library.paint import physically_based
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.slots import Slot, slots_of
from diorama_core.library.stretch import relative_scale, stretch_parts
from diorama_core.library.taxonomy import LAMPS, SETS
from diorama_core.scene.types import Camera, PhotoMaterial, RoomLight, Scene, SceneObject
from diorama_core.workers import map_threads

Picture = UInt8[np.ndarray, "_ _ 3"]


@dataclass(frozen=True, eq=False)
class PhotoAppearance:
    """Materials by object id, and their pictures by name."""

    materials: Mapping[str, tuple[PhotoMaterial, ...]]
    pictures: Mapping[str, Picture]
    light: RoomLight | None = None
    """What the shades of the objects say of the room's light; None without a camera."""

    def apply(self, scene: Scene) -> Scene:
        """The scene with objects that show the photo's materials, in the photo's light."""
        objects = tuple(replace(o, photo_materials=self.materials.get(o.id, o.photo_materials)) for o in scene.objects)
        return replace(scene, objects=objects, light=self.light or scene.light)


@dataclass(frozen=True, eq=False)
class _Seen:
    """One object with everything of the photo that its look is read from."""

    item: SceneObject
    faces: tuple[FlatFace, ...]
    view: SurfaceView | None
    pixels: tuple[SlotPixels, ...]
    weaves: Mapping[str, Picture]
    """Textures that the slots have in the library, by the names of those that have one."""


def photo_appearance(
    rgb: UInt8[np.ndarray, "h w 3"],
    objects: tuple[DetectedObject, ...],
    scene: Scene,
    library: ShapeLibrary,
    illuminant_rgb: tuple[float, float, float] = (1.0, 1.0, 1.0),
) -> PhotoAppearance:
    """What the photo shows of the scene's objects.

    Args:
        rgb: The photo, as white light would have it.
        objects: What was found in it; those of the scene have their ids.
        scene: In the poses in which the photo shows it; without a camera nothing is taken.
        library: Where its shapes are.
        illuminant_rgb: Linear colour of the light that the photo was freed of; that of the scene's light.
    """
    if scene.camera is None:
        return PhotoAppearance({}, {})
    detected_by_id = {o.id: o for o in objects}
    camera = scene.camera
    seen = map_threads(
        lambda item: _observe(item, _parts(library, item), rgb, detected_by_id[item.id], objects, camera),
        [item for item in scene.objects if item.id in detected_by_id],
    )
    shades = [shade_of(s.view, p, rgb) for s in seen if s.view is not None for p in s.pixels]
    walls, window = wall_shade(rgb, objects, scene), window_direction(rgb, objects, scene)
    light = estimate_light(shades, walls, window)
    red, green, blue = (float(c) / max(illuminant_rgb) for c in illuminant_rgb)
    light = replace(light, colour=(red, green, blue))
    falls = irradiance_map(replace(scene, light=light), scene.camera, library)
    materials: dict[str, tuple[PhotoMaterial, ...]] = {}
    pictures: dict[str, Picture] = {}
    surfaces = map_threads(lambda one: _surfaces(one, rgb, falls), seen)
    for one, of_slots in zip(seen, surfaces, strict=True):
        made = [(_face_material(one.item, face), face.picture) for face in one.faces] + of_slots
        materials[one.item.id] = tuple(material for material, _ in made)
        pictures |= {m.texture: picture for m, picture in made if m.texture is not None and picture is not None}
    viewed = [(s.item.id, s.view.step, p) for s in seen if s.view is not None for p in s.pixels]
    shown = {(item_id, p.slot.name): float(p.near.sum()) * step**2 for item_id, step, p in viewed}
    materials = share_materials(materials, _sets(scene), shown)
    used = {m.texture for of_one in materials.values() for m in of_one}
    pictures = {name: picture for name, picture in pictures.items() if name in used}
    read = PhotoAppearance({key: value for key, value in materials.items() if value}, pictures, light)
    read_from = {s.item.id: _read_from(s, detected_by_id[s.item.id], objects) for s in seen}
    return _as_bright(read, rgb, read_from, scene, library)


def _as_bright(
    read: PhotoAppearance,
    rgb: UInt8[np.ndarray, "h w 3"],
    read_from: Mapping[str, Bool[np.ndarray, "h w"]],
    scene: Scene,
    library: ShapeLibrary,
) -> PhotoAppearance:
    """The materials as bright as the photo shows them in the scene's light, part of which they reflect themselves."""
    visible = {key: pixels for key, pixels in read_from.items() if key in read.materials}
    for _ in range(SETTINGS.brightness_rounds):
        gains = brightness_gains(rgb, visible, read.apply(scene), read.pictures, library)
        materials, pictures = brighten(read.materials, read.pictures, gains, _sets(scene))
        read = replace(read, materials=materials, pictures=pictures)
    return read


def _read_from(seen: _Seen, detected: DetectedObject, objects: tuple[DetectedObject, ...]) -> Bool[np.ndarray, "h w"]:
    """The pixels that show an object's materials: those of its slots' main colours, or all of a thing with faces."""
    if seen.faces or seen.view is None or not seen.pixels:
        return _inner(detected) & ~hiding(detected, objects)
    view, pixels = seen.view, np.zeros(detected.mask.shape, dtype=bool)
    near = np.kron(np.logical_or.reduce([p.near for p in seen.pixels]), np.ones((view.step, view.step), dtype=bool))
    labels_near = pixels[view.top : view.top + len(near), view.left : view.left + near.shape[1]]
    labels_near[:] = near[: labels_near.shape[0], : labels_near.shape[1]]
    return pixels


def _inner(detected: DetectedObject) -> Bool[np.ndarray, "h w"]:
    """The object's pixels without the outermost ones; of thin and small things fewer are left out."""
    mask, inner = detected.mask.astype(np.uint8), detected.mask
    for side in SETTINGS.edges_px:
        inner = np.asarray(cv2.erode(mask, np.ones((side, side), np.uint8)).astype(bool))
        if np.count_nonzero(inner) >= SETTINGS.min_inner * np.count_nonzero(mask):
            break
    return inner


def _sets(scene: Scene) -> list[list[str]]:
    """Ids of objects that are of one design, of kinds that come in sets."""
    sets: dict[str, list[str]] = {}
    for item in scene.objects:
        if item.category in SETS:
            sets.setdefault(item.shape_id.partition(MARK)[0], []).append(item.id)
    return [members for members in sets.values() if len(members) > 1]


def _parts(library: ShapeLibrary, item: SceneObject) -> trimesh.Scene:
    return stretch_parts(library.parts(item.shape_id), relative_scale(item.pose.scale))


def _observe(
    item: SceneObject,
    parts: trimesh.Scene,
    rgb: UInt8[np.ndarray, "h w 3"],
    detected: DetectedObject,
    objects: tuple[DetectedObject, ...],
    camera: Camera,
) -> _Seen:
    hidden = hiding(detected, objects)
    faces = faces_of(item, parts, rgb, hidden, detected, camera)
    visible = _inner(detected) & ~hidden
    slots = slots_of(parts)
    unhidden = visible if detected.mask_confidence >= 1.0 else _box_pixels(detected) & ~hidden
    view = surface_view(parts, slots, item.pose, camera, visible | unhidden)
    taken = {face.slot.name for face in faces}
    behind = _box_pixels(detected) & ~detected.mask & ~hiding(detected, objects, smaller_only=True)
    pixels = () if view is None else slot_pixels(view, slots, rgb, visible, unhidden, behind, taken)
    read = (p for p in pixels if p.slot.name not in taken)
    whole = tuple(p for p in read if view is not None and not _shines(item, p, view, rgb))
    if view is not None and not pixels and not faces and item.category not in LAMPS:
        whole = whole_pixels(view, slots, visible)
    weaves = {p.slot.name: _weave(parts, p.slot) for p in whole}
    return _Seen(item, faces, view, whole, {name: weave for name, weave in weaves.items() if weave is not None})


def _weave(parts: trimesh.Scene, slot: Slot) -> Picture | None:
    """The texture that a slot has in the library."""
    texture = physically_based(parts.geometry[slot.geometry[0]]).baseColorTexture
    return None if texture is None else np.asarray(texture.convert("RGB"))


def _shines(item: SceneObject, pixels: SlotPixels, view: SurfaceView, rgb: UInt8[np.ndarray, "h w 3"]) -> bool:
    """Whether what is seen in place of a lamp's metal or wood is its light: that is no colour of a material."""
    if item.category not in LAMPS or pixels.slot.role not in ("metal", "wood", "paint"):
        return False
    return bool(np.median(view.crop(rgb)[pixels.near].max(axis=1)) >= SHINING)


def _box_pixels(detected: DetectedObject) -> Bool[np.ndarray, "h w"]:
    inside = np.zeros(detected.mask.shape, dtype=bool)
    x1, y1, x2, y2 = (max(round(v), 0) for v in detected.box)
    inside[y1:y2, x1:x2] = True
    return inside


def _surfaces(
    seen: _Seen, rgb: UInt8[np.ndarray, "h w 3"], light: Float32[np.ndarray, "h w 3"]
) -> list[tuple[PhotoMaterial, Picture | None]]:
    made: list[tuple[PhotoMaterial, Picture | None]] = []
    if seen.view is None:
        return made
    for pixels in seen.pixels:
        slot = pixels.slot
        appearance = appearance_of(seen.view, pixels, rgb, light, seen.weaves.get(slot.name))
        texture = appearance.texture
        material = PhotoMaterial(
            slot=slot.name,
            colour=appearance.colour,
            texture=None if texture is None else texture_name(seen.item.id, slot.name, texture),
            tile_m=appearance.tile_m,
            roughness=appearance.roughness,
            metallic=ROUGHNESS[slot.role][1],
            main=slot.main,
        )
        made.append((material, appearance.texture))
    return made


def hiding(
    detected: DetectedObject, objects: tuple[DetectedObject, ...], *, smaller_only: bool = False
) -> Bool[np.ndarray, "h w"]:
    """Where other objects stand before one: smaller ones wherever they are, larger ones beside its own mask.

    Without the larger ones, which may as well lie below or stand behind it, it is where something surely does.
    """
    hidden, area = np.zeros(detected.mask.shape, dtype=bool), detected.pixels
    for other in objects:
        smaller = other.pixels < area
        if other.id != detected.id and (smaller or not smaller_only):
            hidden |= other.mask if smaller else other.mask & ~detected.mask
    radius = max(1, round(SETTINGS.mask_margin * max(hidden.shape)))
    return cv2.dilate(hidden.astype(np.uint8), np.ones((2 * radius + 1,) * 2, np.uint8)).astype(bool)


def _face_material(item: SceneObject, face: FlatFace) -> PhotoMaterial:
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
