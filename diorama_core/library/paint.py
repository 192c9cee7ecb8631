"""A shape in another colour or finish: one definition for pictures, exports and the browser."""

from __future__ import annotations

import numpy as np
import trimesh
from jaxtyping import UInt8
from PIL import Image
from trimesh.visual.material import PBRMaterial

from diorama_core.io.srgb import srgb_to_linear
from diorama_core.library.slots import PLAIN, material_key
from diorama_core.scene.types import Finish

Colour = tuple[float, float, float]
"""sRGB, 0 to 1."""
_DETAIL_MEAN = 0.8
"""Mean lightness of a texture turned into detail: leaves room for lighter threads and fibres."""
_METALLIC_ROUGHNESS: dict[Finish, tuple[float, float]] = {
    "matt": (0.0, 0.95),
    "satin": (0.0, 0.45),
    "gloss": (0.0, 0.12),
    "metal": (0.75, 0.35),
}
"""Metal keeps a little diffuse colour: where a viewer has no surroundings to mirror, pure metal is black."""


def repaint(parts: trimesh.Scene, colour: Colour | None, finish: Finish | None = None) -> trimesh.Scene:
    """The shape with its main material, the one that covers most area, in `colour` and `finish` (None: its own).

    The texture stays as light and dark detail, so wood keeps its grain and cloth its weave; legs, handles and screens
    keep their own material: a blue sofa still stands on wooden feet.
    """
    scene = parts.copy()
    main = _main_material(scene)
    new: PBRMaterial | None = None
    for mesh in scene.geometry.values():
        if material_key(mesh) != main or main is None:
            continue
        if main == PLAIN:
            mesh.visual = trimesh.visual.TextureVisuals(material=_override(physically_based(mesh), colour, finish))
            continue
        new = new or _override(physically_based(mesh), colour, finish)
        mesh.visual = trimesh.visual.TextureVisuals(uv=mesh.visual.uv, material=new)
    return scene


def main_rgb(parts: trimesh.Scene) -> tuple[int, int, int]:
    """The sRGB colour (0 to 255) of a shape's main material; grey where it has none."""
    main = _main_material(parts)
    meshes = (m for m in parts.geometry.values() if isinstance(m, trimesh.Trimesh) and material_key(m) == main)
    # Its module loads Open3D, which a page without painted shapes does without.
    from diorama_core.geometry.shape_appearance import material_rgb

    rgb_of_first = next((rgb for m in meshes if (rgb := material_rgb(m.visual)) is not None), None)
    return (
        (200, 200, 200) if rgb_of_first is None else (int(rgb_of_first[0]), int(rgb_of_first[1]), int(rgb_of_first[2]))
    )


def _main_material(scene: trimesh.Scene) -> str | None:
    areas: dict[str, float] = {}
    for mesh in scene.geometry.values():
        if isinstance(mesh, trimesh.Trimesh):
            key = material_key(mesh)
            areas[key] = areas.get(key, 0.0) + float(mesh.area)
    return max(areas, key=areas.__getitem__, default=None)


def physically_based(mesh: trimesh.Trimesh) -> PBRMaterial:
    """A mesh's material; a plain one for a mesh that only has colours."""
    material = getattr(mesh.visual, "material", None)
    if material is None:
        return PBRMaterial(baseColorFactor=mesh.visual.main_color, metallicFactor=0.0, roughnessFactor=0.7)
    return material if isinstance(material, PBRMaterial) else material.to_pbr()


def _override(source: PBRMaterial, colour: Colour | None, finish: Finish | None) -> PBRMaterial:
    coloured = source.copy() if colour is None else recolour(source, colour)
    if finish is not None:
        coloured.name = f"{coloured.name or 'material'} {finish}"
        coloured.metallicFactor, coloured.roughnessFactor = _METALLIC_ROUGHNESS[finish]
        coloured.metallicRoughnessTexture = None  # it would be multiplied onto both
    return coloured


def recolour(source: PBRMaterial, colour: Colour) -> PBRMaterial:
    """Recolour a material (sRGB 0 to 1); its texture stays as light and dark detail."""
    texture = source.baseColorTexture
    # A bright colour leaves its detail less room: a factor beyond 1 would be cut off and change the hue.
    mean = max(_DETAIL_MEAN, *(float(c) for c in colour))
    gain = 1.0 if texture is None else 1.0 / float(srgb_to_linear(np.array(mean)))
    # glTF's base colour factor is linear.
    linear = np.minimum(srgb_to_linear(np.array(colour, dtype=np.float64)) * gain, 1.0).tolist()
    return PBRMaterial(
        name=f"{source.name or 'material'} painted",
        baseColorFactor=[*(round(255 * c) for c in linear), _opacity(source)],
        baseColorTexture=None if texture is None else Image.fromarray(_detail(texture, mean)),
        metallicFactor=source.metallicFactor,
        roughnessFactor=source.roughnessFactor,
        doubleSided=source.doubleSided,
        emissiveFactor=source.emissiveFactor,
        alphaMode=source.alphaMode,
    )


def _opacity(source: PBRMaterial) -> int:
    factor = source.baseColorFactor
    return 255 if source.alphaMode != "BLEND" or factor is None else int(factor[3])


def _detail(texture: Image.Image, mean: float) -> UInt8[np.ndarray, "h w 3"]:
    """The texture's light and dark, without its colour, around a mean."""
    grey = np.asarray(texture.convert("L"), dtype=np.float64) / 255.0
    level = grey / max(float(grey.mean()), 1e-3) * mean
    return np.repeat(np.round(255 * np.clip(level, 0.0, 1.0)).astype(np.uint8)[..., None], 3, axis=2)
