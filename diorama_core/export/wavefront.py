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
    corner = (surface.faces + 1).astype(int)
    if surface.uv is None:
        corners = [f"{i}//{i}" for i in range(1, len(surface.vertices) + 1)]
    else:
        lines.append(_rows("vt", surface.uv, 5))
        corners = [f"{i}/{i}/{i}" for i in range(1, len(surface.vertices) + 1)]
    lines += [] if material is None else [f"usemtl {material}"]
    names = np.array(corners, dtype=object)[corner - 1]
    lines.append("\n".join(f"f {a} {b} {c}" for a, b, c in names.tolist()))
    return "\n".join(lines) + "\n"


def hull_text(points: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> str:
    """A convex body as a Wavefront object."""
    lines = [_rows("v", points, 7)]
    lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    return "\n".join(lines) + "\n"


def material_text(name: str, material: Material, picture: str | None) -> str:
    """A material as Wavefront has it; `picture` is the file of its texture beside it."""
    red, green, blue = linear_to_srgb(np.asarray(material.colour))
    lines = [f"newmtl {name}", f"Kd {red:.5f} {green:.5f} {blue:.5f}", f"d {material.alpha:.4f}", "Ks 0.1 0.1 0.1"]
    lines += [] if picture is None else [f"map_Kd {picture}"]
    return "\n".join(lines) + "\n"


def png_bytes(picture: UInt8[np.ndarray, "h w c"]) -> bytes:
    """A picture as PNG."""
    buffer = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(picture)).save(buffer, "PNG")
    return buffer.getvalue()


def _rows(word: str, values: np.ndarray, digits: int) -> str:
    buffer = io.StringIO()
    np.savetxt(buffer, values, fmt=f"{word} " + " ".join([f"%.{digits}f"] * values.shape[1]))
    return buffer.getvalue().rstrip("\n")
