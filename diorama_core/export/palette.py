"""Few materials: equal ones are one, and plain colours are texels of one picture."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from diorama_core.io.srgb import linear_to_srgb, srgb_to_linear
from diorama_core.render.appearance import Material, Surface

SWATCH_PX = 8
"""Side of one colour, wide enough for a few levels of smaller pictures."""
FINENESS = 20
"""Steps of roughness and metalness; finer ones are not told apart."""


class GameMaterials:
    """The materials of a game's file.

    Args:
        materials: Those of the scene.
    """

    def __init__(self, materials: Iterable[Material]) -> None:
        materials = tuple(map(_without_flat_picture, materials))
        plain = sorted({_look(m) for m in materials if _is_plain(m)})
        side = 2 ** int(np.ceil(np.log2(max(len(plain), 1)) / 2))  # pictures have such sides
        self._uv = {look: ((k % side + 0.5) / side, 1.0 - (k // side + 0.5) / side) for k, look in enumerate(plain)}
        colours = np.zeros((side * side, 3), dtype=np.uint8)
        gloss = np.zeros((side * side, 3), dtype=np.uint8)
        for k, (*colour, metallic, roughness) in enumerate(plain):
            colours[k] = colour
            gloss[k] = 0, round(255 * roughness / FINENESS), round(255 * metallic / FINENESS)
        maps = {"metallicRoughnessTexture": _swatches(gloss, side)}
        self._palette = Material("palette", (1.0, 1.0, 1.0), 1.0, 1.0, 1.0, texture=_swatches(colours, side), maps=maps)
        self._palettes = {two: replace(self._palette, double_sided=two) for two in (False, True)}
        self._equal: dict[object, Material] = {}

    def merge(self, surfaces: Iterable[Surface]) -> tuple[Surface, ...]:
        """One surface a material."""
        by_material: dict[int, list[Surface]] = {}
        for surface in map(self._paint, surfaces):
            by_material.setdefault(id(surface.material), []).append(surface)
        return tuple(_join(some) for some in by_material.values())

    def _paint(self, surface: Surface) -> Surface:
        material = _without_flat_picture(surface.material)
        if _is_plain(material):
            uv = np.tile(np.array(self._uv[_look(material)], dtype=np.float32), (len(surface.vertices), 1))
            return replace(surface, material=self._palettes[material.double_sided], uv=uv)
        maps = tuple(sorted((slot, id(picture)) for slot, picture in material.maps.items()))
        values = (*_look(material), round(material.alpha, 2), material.emissive, material.double_sided)
        return replace(surface, material=self._equal.setdefault((*values, id(material.texture), maps), material))


def _without_flat_picture(material: Material) -> Material:
    """The material with the one colour of its picture in place of a picture that has no more."""
    picture = material.texture
    if picture is None or material.maps or picture.shape[2] != 3 or np.ptp(picture, axis=(0, 1)).max() > 0:
        return material
    shown = srgb_to_linear(picture[0, 0] / 255.0) * material.colour
    return replace(material, texture=None, colour=(float(shown[0]), float(shown[1]), float(shown[2])))


def _is_plain(material: Material) -> bool:
    return material.texture is None and not material.maps and material.alpha == 1.0 and not any(material.emissive)


def _look(material: Material) -> tuple[int, ...]:
    shown = np.round(255 * linear_to_srgb(np.clip(np.array(material.colour), 0.0, 1.0))).astype(int)
    return (*map(int, shown), round(FINENESS * material.metallic), round(FINENESS * material.roughness))


def _swatches(colours: np.ndarray, side: int) -> np.ndarray:
    return np.kron(colours.reshape(side, side, 3), np.ones((SWATCH_PX, SWATCH_PX, 1), dtype=np.uint8)).astype(np.uint8)


def _join(surfaces: list[Surface]) -> Surface:
    """Surfaces of one material as one; what some lack, colours or coordinates, is white or zero there."""
    if len(surfaces) == 1:
        return surfaces[0]

    def rows(values: Iterator[np.ndarray | None], width: int, missing: float) -> np.ndarray | None:
        colours = list(values)
        if all(v is None for v in colours):
            return None
        filled = [
            np.full((len(s.vertices), width), missing, dtype=np.float32) if v is None else v
            for v, s in zip(colours, surfaces, strict=True)
        ]
        return np.concatenate(filled)

    starts = np.cumsum([0, *(len(s.vertices) for s in surfaces[:-1])])
    return replace(
        surfaces[0],
        vertices=np.concatenate([s.vertices for s in surfaces]),
        normals=np.concatenate([s.normals for s in surfaces]),
        faces=np.concatenate([s.faces + k for s, k in zip(surfaces, starts, strict=True)]).astype(np.int32),
        uv=rows((s.uv for s in surfaces), 2, 0.0),
        colours=rows((s.colours for s in surfaces), 3, 1.0),
    )
