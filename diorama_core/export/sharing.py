"""Materials, pictures and surfaces of an export: each once, and fit to be written; names, each used once, because many
programs address nodes by name.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Integer

from diorama_core.export.pictures import Picture, shrink
from diorama_core.io.text import clean_text
from diorama_core.render.appearance import Material, Surface

MIN_AREA_M2 = 1e-12
"""Triangles smaller than this are not written: no format can shade them."""


class SharedAppearance:
    """Materials and pictures, each once, whatever number of shapes brings an equal one.

    Args:
        max_px: Longest side of a picture; larger ones are reduced. None leaves them.
    """

    def __init__(self, max_px: int | None) -> None:
        self._max_px = max_px
        self._materials: dict[Any, Material] = {}
        self._names: set[str] = set()
        self._pictures: dict[bytes, Picture] = {}
        self._read: dict[int, tuple[Picture, bytes]] = {}

    @property
    def materials(self) -> tuple[Material, ...]:
        """All materials so far; names are unique."""
        return tuple(self._materials.values())

    def surfaces(self, surfaces: Iterable[Surface]) -> tuple[Surface, ...]:
        """The surfaces with shared materials, without triangles that have no area, and with unit normals."""
        sound = (with_unit_normals(without_slivers(s)) for s in surfaces)
        return tuple(replace(s, material=self._material(s.material)) for s in sound if len(s.faces))

    def _material(self, source: Material) -> Material:
        texture = None if source.texture is None else self._digest(source.texture)
        maps = tuple((slot, self._digest(picture)) for slot, picture in sorted(source.maps.items()))
        values = (source.name, source.colour, source.alpha, source.metallic, source.roughness, source.emissive)
        key = (*values, source.double_sided, source.photographed, texture, maps)
        if key not in self._materials:
            self._materials[key] = replace(
                source,
                name=unique_name(source.name, self._names, " "),
                texture=None if texture is None else self._pictures[texture],
                maps={slot: self._pictures[digest] for slot, digest in maps},
            )
        return self._materials[key]

    def _digest(self, picture: Picture) -> bytes:
        if id(picture) not in self._read:
            digest = hashlib.sha256(f"{picture.shape}".encode() + np.ascontiguousarray(picture).tobytes()).digest()
            self._read[id(picture)] = (picture, digest)  # holding the picture keeps its id from being reused
            if digest not in self._pictures:
                self._pictures[digest] = shrink(picture, self._max_px)
        return self._read[id(picture)][1]


def without_slivers(surface: Surface) -> Surface:
    """The surface without triangles that have no area or name a vertex twice."""
    a, b, c = (surface.vertices[surface.faces[:, k]].astype(np.float64) for k in range(3))
    sound = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1) > MIN_AREA_M2
    if sound.all():
        return surface
    return without_unused(surface, surface.faces[sound])


def without_unused(surface: Surface, faces: Integer[np.ndarray, "..."]) -> Surface:
    """The surface with these faces alone, without the vertices that none of them uses."""
    return with_vertices(surface, *np.unique(faces, return_inverse=True))


def with_vertices(surface: Surface, rows: Integer[np.ndarray, " n"], faces: Integer[np.ndarray, "..."]) -> Surface:
    """The surface with these rows of its vertices, between which the faces are."""
    return replace(
        surface,
        vertices=surface.vertices[rows],
        normals=surface.normals[rows],
        faces=faces.reshape(-1, 3).astype(np.int32),
        uv=None if surface.uv is None else surface.uv[rows],
        colours=None if surface.colours is None else surface.colours[rows],
    )


def with_unit_normals(surface: Surface) -> Surface:
    """The surface with the normals that have no length, where creases cancel out, taken from a face at the vertex."""
    lengths = np.linalg.norm(surface.normals.astype(np.float64), axis=1)
    if (np.abs(lengths - 1.0) < 1e-4).all():
        return surface
    normals = np.divide(surface.normals, np.maximum(lengths, 1e-9)[:, None])
    lost = lengths < 0.5
    a, b, c = (surface.vertices[surface.faces[:, k]].astype(np.float64) for k in range(3))
    flat = np.cross(b - a, c - a)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    of_face = np.zeros_like(normals)
    for corner in range(3):
        of_face[surface.faces[:, corner]] = flat
    return replace(surface, normals=np.where(lost[:, None], of_face, normals).astype(np.float32))


class Labels:
    """Gives out names, slugs and keys, each of them unique among its kind."""

    def __init__(self) -> None:
        self._names, self._slugs, self._keys = set[str](), set[str](), set[str]()

    def name(self, text: str) -> str:
        """A readable name."""
        return unique_name(clean_text(text) or "object", self._names, " ")

    def slug(self, text: str) -> str:
        """An identifier of a node."""
        return unique_name(slug_of(text), self._slugs, "_")

    def key(self, text: str) -> str:
        """An identifier of a mesh."""
        return unique_name(slug_of(text), self._keys, "_")


def slug_of(text: str) -> str:
    """An ASCII identifier that resembles the text: a letter first, then letters, digits and underscores."""
    plain = re.sub(r"[^A-Za-z0-9]+", "_", text).strip("_")
    return plain if plain[:1].isalpha() else f"n_{plain}".rstrip("_")


def unique_name(text: str, taken: set[str], separator: str = " ") -> str:
    """The text, with a number where it was used before; `taken` is extended.

    Case is ignored, because some disks do so when files are named by it; `taken` holds case-folded names.
    """
    candidate, number = text, 2
    while candidate.casefold() in taken:
        candidate, number = f"{text}{separator}{number}", number + 1
    taken.add(candidate.casefold())
    return candidate
