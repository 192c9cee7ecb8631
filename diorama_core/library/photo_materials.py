"""A shape with materials from the photo on its slots: one definition for pictures, exports and the browser."""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence

import numpy as np
import trimesh
from jaxtyping import Float, UInt8
from PIL import Image
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from diorama_core.io.srgb import srgb_to_linear
from diorama_core.library.paint import Colour, physically_based, recolour
from diorama_core.library.slots import Slot, match, place_vertices, rectangle_of, slots_of
from diorama_core.scene.types import PhotoMaterial

WARM, WARM_PALE, PALE = 0.12, 0.22, 0.85
"""By what share of red the blue of wood is lower at least; of pale colours, with red beyond the third, more."""

PATTERNED = 0.152
"""Deviation of luminance, as a share of its mean: of the library's grains, weaves and wickers at most 0.148, of its
stripes, checks, speckles and prints at least 0.155."""

Pictures = Mapping[str, UInt8[np.ndarray, "_ _ 3"]]


class PhotographedMaterial(PBRMaterial):  # type: ignore[misc]  # untyped base
    """A material whose picture holds the light of its room: it is shown as it is, not lit a second time."""


def with_photo_materials(parts: trimesh.Scene, materials: Sequence[PhotoMaterial], pictures: Pictures) -> trimesh.Scene:
    """The shape with the photo's materials on the slots that they match; the others keep their own.

    Args:
        parts: The shape, painted or not.
        materials: From the photo.
        pictures: Their textures by name; without one, a tiled material shows its colour, a face the shape's own.
    """
    slots = slots_of(parts)
    parts = with_own_corners(parts, [s for s in slots if s.name in match(slots, materials)])
    scene = parts.copy()
    for slot in slots:
        material = match(slots, materials).get(slot.name)
        if material is None or (material.layout != "tiled" and material.texture not in pictures):
            continue
        if material.texture not in pictures:
            _recolour(scene, slot, material)
            continue
        made = _picture(material, pictures[str(material.texture)])
        for name in slot.geometry:
            scene.geometry[name].visual = TextureVisuals(uv=_uv(parts, slot, name, material), material=made)
    return scene


def shows_wood(colour: Colour) -> bool:
    """Whether wood itself may have a colour (sRGB 0 to 1): white, grey, green or blue wood is painted."""
    red, green, blue = colour
    warm = WARM_PALE if red > PALE else WARM
    return red >= green >= blue and red - blue >= warm * red


def _recolour(scene: trimesh.Scene, slot: Slot, material: PhotoMaterial) -> None:
    """A material without a pattern: the slot's own grain or weave in the photo's colour.

    Painted wood has no grain, and stripes, checks or speckles of the library that the photo does not show are left out.
    """
    meshes = [scene.geometry[name] for name in slot.geometry]
    base = physically_based(meshes[0])
    made = recolour(base, material.colour)
    made.name = f"{material.slot} from the photo {zlib.crc32(repr((material, base.name)).encode()):08x}"
    made.metallicFactor, made.roughnessFactor = material.metallic, material.roughness
    painted = slot.role == "wood" and not shows_wood(material.colour)
    if painted or (slot.tile_m is not None and _is_patterned(base)):
        made.baseColorTexture = None
        made.baseColorFactor = [*(round(255 * float(c)) for c in srgb_to_linear(np.array(material.colour))), 255]
    for mesh in meshes:
        mesh.visual = TextureVisuals(uv=getattr(mesh.visual, "uv", None), material=made)


def _is_patterned(material: PBRMaterial) -> bool:
    """Whether a repeating texture is a pattern rather than a grain or a weave."""
    if material.baseColorTexture is None:
        return False
    luminance = np.asarray(material.baseColorTexture.convert("L"), dtype=np.float64)
    return bool(luminance.std() > PATTERNED * max(float(luminance.mean()), 1.0))


def _picture(material: PhotoMaterial, picture: UInt8[np.ndarray, "h w 3"]) -> PBRMaterial:
    """The material with its picture; one seen from one side is a photograph, a tiled one bare material."""
    kind = PBRMaterial if material.layout == "tiled" else PhotographedMaterial
    return kind(
        name=f"{material.slot} from the photo {material.texture}",
        baseColorTexture=Image.fromarray(picture),
        metallicFactor=material.metallic,
        roughnessFactor=material.roughness,
    )


def _uv(parts: trimesh.Scene, slot: Slot, name: str, material: PhotoMaterial) -> Float[np.ndarray, "n 2"]:
    if material.layout != "tiled":
        return rectangle_of(parts, slot, material.layout).uv(place_vertices(parts, name))
    return metric_uv(parts, slot, name) / material.tile_m


def has_metric_uv(parts: trimesh.Scene, slot: Slot, name: str) -> bool:
    """Whether a mesh has texture coordinates of its own whose size is known."""
    return getattr(parts.geometry[name].visual, "uv", None) is not None and slot.tile_m is not None


def metric_uv(parts: trimesh.Scene, slot: Slot, name: str) -> Float[np.ndarray, "n 2"]:
    """Texture coordinates of one mesh in metres at scale 1: its own, or each face's seen along its nearest axis.

    Without own ones the faces must not share vertices (`with_own_corners`).
    """
    mesh = parts.geometry[name]
    if has_metric_uv(parts, slot, name):
        return np.asarray(mesh.visual.uv, dtype=np.float64) * float(slot.tile_m or 1.0)
    points = place_vertices(parts, name)
    corners = points[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    axis = np.zeros(len(points), dtype=int)
    axis[mesh.faces] = np.abs(normals).argmax(axis=1)[:, None]
    across, up = np.array([1, 0, 0]), np.array([2, 2, 1])
    rows = np.arange(len(points))
    return np.stack([points[rows, across[axis]], points[rows, up[axis]]], axis=1)


def with_own_corners(parts: trimesh.Scene, slots: Sequence[Slot]) -> trimesh.Scene:
    """The shape such that meshes without metric texture coordinates have three vertices of their own for every face."""
    loose = [name for slot in slots for name in slot.geometry if not has_metric_uv(parts, slot, name)]
    if not loose:
        return parts
    scene = parts.copy()
    for name in loose:
        mesh = scene.geometry[name]
        corners = mesh.faces.reshape(-1)
        uv = getattr(mesh.visual, "uv", None)
        visual = mesh.visual
        if hasattr(visual, "material"):
            visual = TextureVisuals(uv=None if uv is None else np.asarray(uv)[corners], material=visual.material)
        elif visual.kind == "vertex":
            visual = trimesh.visual.ColorVisuals(vertex_colors=np.asarray(visual.vertex_colors)[corners])
        scene.geometry[name] = trimesh.Trimesh(
            np.asarray(mesh.vertices)[corners],
            np.arange(len(corners)).reshape(-1, 3),
            vertex_normals=np.asarray(mesh.vertex_normals)[corners],
            visual=visual,
            metadata=mesh.metadata,
            process=False,
        )
    return scene
