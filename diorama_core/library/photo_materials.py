"""A shape with materials from the photo on its slots: one definition for pictures, exports and the browser."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import trimesh
from jaxtyping import Float, UInt8
from PIL import Image
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from diorama_core.io.srgb import srgb_to_linear
from diorama_core.library.slots import Slot, matched, placed_vertices, rectangle_of, slots_of
from diorama_core.scene.types import PhotoMaterial

Pictures = Mapping[str, UInt8[np.ndarray, "_ _ 3"]]


class PhotographedMaterial(PBRMaterial):  # type: ignore[misc]
    """A material whose picture holds the light of its room: it is shown as it is, not lit a second time."""


def with_photo_materials(parts: trimesh.Scene, materials: Sequence[PhotoMaterial], pictures: Pictures) -> trimesh.Scene:
    """The shape with the photo's materials on the slots that they match; the others keep their own.

    Args:
        parts: The shape, painted or not.
        materials: From the photo.
        pictures: Their textures by name; without its texture a tiled material shows its colour, a face the shape's own.
    """
    slots = slots_of(parts)
    scene = parts.copy()
    for slot in slots:
        material = matched(slots, materials).get(slot.name)
        if material is None or (material.layout != "tiled" and material.texture not in pictures):
            continue
        made = _pbr(material, pictures)
        for name in slot.geometry:
            mesh = scene.geometry[name]
            uv = None if made.baseColorTexture is None else _uv(parts, slot, name, material)
            mesh.visual = TextureVisuals(uv=uv, material=made)
    return scene


def _pbr(material: PhotoMaterial, pictures: Pictures) -> PBRMaterial:
    """The material with its picture; a picture seen from one side is a photograph, a tiled one bare material."""
    picture = None if material.texture is None else pictures.get(material.texture)
    kind = PBRMaterial if material.layout == "tiled" else PhotographedMaterial
    name = f"{material.slot} from the photo"
    if picture is not None:
        return kind(
            name=f"{name} {material.texture}",
            baseColorTexture=Image.fromarray(picture),
            metallicFactor=material.metallic,
            roughnessFactor=material.roughness,
        )
    linear = srgb_to_linear(np.array(material.colour, dtype=np.float64))
    factor = [*(round(255 * float(c)) for c in linear), 255]
    return kind(
        name=f"{name} {'-'.join(map(str, factor[:3]))}",
        baseColorFactor=factor,
        metallicFactor=material.metallic,
        roughnessFactor=material.roughness,
    )


def _uv(parts: trimesh.Scene, slot: Slot, name: str, material: PhotoMaterial) -> Float[np.ndarray, "n 2"]:
    if material.layout != "tiled":
        return rectangle_of(parts, slot, material.layout).uv(placed_vertices(parts, name))
    return metric_uv(parts, slot, name) / material.tile_m


def metric_uv(parts: trimesh.Scene, slot: Slot, name: str) -> Float[np.ndarray, "n 2"]:
    """Texture coordinates of one mesh in metres at scale 1: the shape's own, or projected along each vertex' normal."""
    mesh = parts.geometry[name]
    own = getattr(mesh.visual, "uv", None)
    if own is not None and slot.tile_m is not None:
        return np.asarray(own, dtype=np.float64) * slot.tile_m
    points, axis = placed_vertices(parts, name), np.abs(mesh.vertex_normals).argmax(axis=1)
    across, up = np.array([1, 0, 0]), np.array([2, 2, 1])
    rows = np.arange(len(points))
    return np.stack([points[rows, across[axis]], points[rows, up[axis]]], axis=1)
