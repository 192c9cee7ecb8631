"""Wavefront OBJ and MTL: how surfaces and materials are written, whatever format they are for.

A textured material keeps its colour in the picture, because many programs show `map_Kd` alone. Metallic and roughness
follow the common extension of MTL (`Pm`, `Pr`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
from jaxtyping import Float, Int

from diorama_core.export.pictures import Picture, TexturePictures, picture_suffix
from diorama_core.io.srgb import linear_to_srgb
from diorama_core.render.appearance import Colour, Material, Surface

DECIMALS = 5
"""A hundredth of a millimetre."""
DIELECTRIC_F0, METAL_F0 = 0.04, 0.5
"""Reflectance at normal incidence: of plastic, wood and lacquer, and of metals, whose own colour stays in `Kd`."""
MAX_EXPONENT = 1000.0
"""The largest `Ns` that the format allows."""
_MAP_KEYWORDS = {"normalTexture": "norm", "metallicRoughnessTexture": "map_Pr", "emissiveTexture": "map_Ke"}
ROWS_AT_ONCE = 100_000
_SPACE, _POINT, _MINUS, _NEWLINE, _ZERO = 32, 46, 45, 10, 48


class ObjText:
    """Surfaces as text of one OBJ, which counts its vertices through all of them."""

    def __init__(self, decimals: int = DECIMALS) -> None:
        self._decimals = decimals
        self._vertices = 1
        self._uvs = 1

    def add(self, surface: Surface, material: str | None = None) -> bytes:
        """The next surface: positions with colours where it has some, normals, texture coordinates, material, faces."""
        points = surface.vertices if surface.colours is None else np.hstack([surface.vertices, surface.colours])
        text = number_rows("v", points, self._decimals) + number_rows("vn", surface.normals, 4)
        if surface.uv is not None:
            text += number_rows("vt", surface.uv, 6)
        text += b"" if material is None else f"usemtl {material}\n".encode()
        text += self._faces(surface)
        self._vertices += len(surface.vertices)
        self._uvs += 0 if surface.uv is None else len(surface.uv)
        return text

    def _faces(self, surface: Surface) -> bytes:
        corners = surface.faces.astype(np.int64)
        if surface.uv is None:
            return index_rows("f %d//%d %d//%d %d//%d", np.repeat(corners + self._vertices, 2, axis=1))
        v, t = corners + self._vertices, corners + self._uvs
        return index_rows("f %d/%d/%d %d/%d/%d %d/%d/%d", np.stack([v, t, v], axis=2).reshape(-1, 9))


def obj_file(surface: Surface, materials: str | None = None, material: str | None = None) -> bytes:
    """One surface as a file.

    Args:
        surface: Its triangles.
        materials: Name of the material file beside it; None for none.
        material: Name of its material in that file.
    """
    head = b"" if materials is None else f"mtllib {materials}\n".encode()
    return head + ObjText().add(surface, material)


def hull_file(points: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> bytes:
    """A convex body as a file."""
    return number_rows("v", points, 7) + index_rows("f %d %d %d", faces.astype(np.int64) + 1)


def highlight(material: Material) -> tuple[float, float]:
    """Strength and exponent of Blinn-Phong's highlight (`Ks`, `Ns`) for a microfacet roughness.

    The exponent is that of the same slope distribution (Walter et al. 2007); the strength is the normalised lobe's, so
    that a rough surface, whose lobe covers everything, is not bleached by it.
    """
    exponent = min(2.0 / max(material.roughness, 0.05) ** 4 - 2.0, MAX_EXPONENT)
    return min((METAL_F0 if material.metallic > 0.5 else DIELECTRIC_F0) * (exponent + 2.0) / 8.0, 1.0), exponent


class MaterialFile:
    """The material file of some materials with the pictures beside it.

    Args:
        materials: Each once; surfaces refer to them by identity.
        pictures: Folder of the pictures, relative to the file, with its slash.
        display: Whether colours are written as display values (sRGB), for programs without linear light.
        maps: Whether pictures other than the colour's are written.
        made: Tinted and encoded pictures, shared with other material files that show the same ones.
    """

    def __init__(
        self,
        materials: Iterable[Material],
        *,
        pictures: str = "",
        display: bool = False,
        maps: bool = True,
        made: TexturePictures | None = None,
    ) -> None:
        self._made = TexturePictures() if made is None else made
        self._folder = pictures
        self._display = display
        self._files: dict[int, tuple[str, Picture]] = {}
        self._names: dict[int, str] = {}
        self._materials: dict[str, Material] = {}
        self._sources = tuple(materials)  # holding them keeps their ids from being reused
        for material in self._sources:
            name = self._free_name(re.sub(r"\s+", "_", material.name.strip()) or "material")
            self._names[id(material)] = name
            self._materials[name] = self._prepare(material if maps else replace(material, maps={}))

    def name(self, material: Material) -> str:
        """What the file calls a material: no spaces, unique."""
        return self._names[id(material)]

    def text(self) -> bytes:
        """The file."""
        return "\n".join(self._block(name, material) for name, material in self._materials.items()).encode()

    def pictures(self) -> Iterator[tuple[str, bytes]]:
        """Names, relative to the file, and contents of the pictures."""
        for name, picture in self._files.values():
            yield name, self._made.encoded(picture)

    def _free_name(self, stem: str) -> str:
        name, number = stem, 2
        while name in self._materials:
            name, number = f"{stem}_{number}", number + 1
        return name

    def _prepare(self, material: Material) -> Material:
        """The material as it is written; its pictures get their names."""
        if material.texture is not None:
            texture = self._made.tinted(material.texture, material.colour)
            material = replace(material, colour=(1.0, 1.0, 1.0), texture=texture)
        for picture in (material.texture, *(material.maps[k] for k in _MAP_KEYWORDS if k in material.maps)):
            if picture is not None and id(picture) not in self._files:
                name = f"{self._folder}{len(self._files):03d}{picture_suffix(picture)}"
                self._files[id(picture)] = (name, picture)
        return material

    def _block(self, name: str, material: Material) -> str:
        specular, shine = highlight(material)
        lines = [f"newmtl {name}", f"Kd {self._colour(material.colour)}", "Ks" + f" {specular:.4f}" * 3]
        lines += [f"Ns {shine:.1f}", f"d {material.alpha:.4f}"]
        lines += [
            f"Pr {material.roughness:.4f}",
            f"Pm {material.metallic:.4f}",
            f"illum {4 if material.alpha < 1 else 2}",
        ]
        if any(material.emissive):
            lines.append(f"Ke {self._colour(material.emissive)}")
        if material.texture is not None:
            lines.append(f"map_Kd {self._files[id(material.texture)][0]}")
        for slot, keyword in _MAP_KEYWORDS.items():
            if slot in material.maps:
                lines.append(f"{keyword} {self._files[id(material.maps[slot])][0]}")
        return "\n".join(lines) + "\n"

    def _colour(self, linear: Colour) -> str:
        values = linear_to_srgb(np.asarray(linear)) if self._display else linear
        return " ".join(f"{float(c):.6f}" for c in values)


def number_rows(prefix: str, values: Float[np.ndarray, "n k"], decimals: int) -> bytes:
    """Lines of a prefix and k numbers with a fixed count of decimals, columns padded with spaces.

    Args:
        prefix: Start of every line, such as `v`.
        values: Finite numbers.
        decimals: Digits behind the point, at least one.
    """
    if len(values) == 0:
        return b""
    scaled = np.rint(np.asarray(values, dtype=np.float64) * 10**decimals).astype(np.int64)
    size = np.abs(scaled)
    whole = max(1, len(str(int(size.max()) // 10**decimals)))
    width = whole + decimals + 3  # a space, a sign and the point
    text = np.full((*scaled.shape, width), _SPACE, dtype=np.uint8)
    text[..., width - 1 - decimals] = _POINT
    first = np.full(scaled.shape, width - decimals - 2)
    """Column of the foremost digit: at least one stands before the point."""
    for place in range(whole + decimals):
        size, digit = np.divmod(size, 10)
        column = width - 1 - place - (place >= decimals)
        text[..., column] = digit + _ZERO
        if place > decimals:
            leading = (digit == 0) & (size == 0)
            text[..., column][leading] = _SPACE
            first[~leading] = column
    negative = np.nonzero(scaled < 0)
    text[(*negative, first[negative] - 1)] = _MINUS
    rows = text.reshape(len(values), -1)
    head = np.broadcast_to(np.frombuffer(prefix.encode(), np.uint8), (len(values), len(prefix)))
    return np.concatenate([head, rows, np.full((len(values), 1), _NEWLINE, np.uint8)], axis=1).tobytes()


def index_rows(pattern: str, indices: Int[np.ndarray, "n k"]) -> bytes:
    """Lines made by a printf pattern with k places for integers."""
    parts = []
    for start in range(0, len(indices), ROWS_AT_ONCE):
        block = indices[start : start + ROWS_AT_ONCE]
        parts.append(((pattern + "\n") * len(block)) % tuple(block.reshape(-1).tolist()))
    return "".join(parts).encode()
