"""Surfaces as Wavefront OBJ text and pictures as PNG, for the packages of simulators."""

from __future__ import annotations

import io

import numpy as np
from jaxtyping import Float, Int, UInt8
from PIL import Image

from diorama_core.io.srgb import linear_to_srgb
from diorama_core.render.appearance import Material, Surface


def obj_text(surface: Surface, material: str | None = None) -> str:
    """One surface as a Wavefront object: positions, normals, and texture coordinates where there are some.

    Args:
        surface: Its triangles.
        material: Name of its material, which lies in a file of that name beside it; None for none.
    """
    lines = [] if material is None else [f"mtllib {material}.mtl"]
    lines += [_rows("v", surface.vertices, 6), _rows("vn", surface.normals, 4)]
    corner = "%d/%d/%d" if surface.uv is not None else "%d//%d"
    if surface.uv is not None:
        lines.append(_rows("vt", surface.uv, 5))
    lines += [] if material is None else [f"usemtl {material}"]
    numbers = np.repeat(surface.faces.reshape(-1) + 1, corner.count("%"))
    return "\n".join(lines) + "\n" + _filled(f"f {corner} {corner} {corner}\n", len(surface.faces), numbers)


def hull_text(points: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> str:
    """A convex body as a Wavefront object."""
    lines = [_rows("v", points, 7)]
    lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    return "\n".join(lines) + "\n"


def material_text(name: str, material: Material, picture: str | None) -> str:
    """A material as Wavefront has it; `picture` is the file of its texture beside it."""
    red, green, blue = linear_to_srgb(np.asarray(material.colour, dtype=np.float64))
    lines = [f"newmtl {name}", f"Kd {red:.5f} {green:.5f} {blue:.5f}", f"d {material.alpha:.4f}", "Ks 0.1 0.1 0.1"]
    lines += [] if picture is None else [f"map_Kd {picture}"]
    return "\n".join(lines) + "\n"


def png_bytes(picture: UInt8[np.ndarray, "h w c"]) -> bytes:
    """A picture as PNG."""
    buffer = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(picture)).save(buffer, "PNG")
    return buffer.getvalue()


def _rows(word: str, values: np.ndarray, digits: int) -> str:
    row = f"{word}{f' %.{digits}f' * values.shape[1]}\n"
    return _filled(row, len(values), values.reshape(-1)).rstrip("\n")


def _filled(row: str, count: int, values: np.ndarray) -> str:
    """A row's format, repeated and filled at once: many times faster than row by row."""
    return (row * count) % tuple(values.tolist())
