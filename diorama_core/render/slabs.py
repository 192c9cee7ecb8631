"""Planes of the room as slabs: the face toward the room with its picture, and the thickness behind it."""

from __future__ import annotations

from dataclasses import replace

import manifold3d
import numpy as np
from jaxtyping import Float, Int, Int32, UInt8

from diorama_core.geometry.planes import plane_axes, plane_uv
from diorama_core.io.srgb import srgb_to_linear
from diorama_core.render.appearance import Material, Surface
from diorama_core.scene.types import Plane


def plane_surfaces(
    plane: Plane,
    texture: UInt8[np.ndarray, "h w c"] | None = None,
    *,
    photographed: bool = True,
    plain_photographed: bool = False,
) -> tuple[Surface, Surface]:
    """The face toward the room, textured where there is a picture, and the plain rest, extruded away from the room.

    Args:
        plane: Any polygon, concave ones included.
        texture: The plane's rectified picture, laid out as `geometry.planes.plane_uv` says.
        photographed: Whether that picture holds the light of the room, rather than the bare colour of the material.
        plain_photographed: Whether the plane's plain colour does.
    """
    polygon, count = plane.polygon, len(plane.polygon)
    inner = _triangles(plane)
    behind = polygon - plane.normal * plane.thickness
    plain = _plain_material(plane)
    bare = plane.finish is None
    face = replace(plain, photographed=plain_photographed and bare)
    face = face if texture is None else _material(plane, texture, photographed and bare)
    front = _surface(polygon, inner, plane.normal, face, plane_uv(plane))
    ring = np.arange(count)
    after = np.roll(ring, -1)
    walls, normals = [], []
    for i, j in zip(ring, after, strict=True):
        walls.append(np.stack([polygon[i], behind[i], behind[j], polygon[j]]))
        edge = polygon[j] - polygon[i]
        normals.append(np.cross(edge, plane.normal) / max(float(np.linalg.norm(edge)), 1e-9))
    sides = np.arange(count)[:, None, None] * 4 + np.array([[0, 1, 2], [0, 2, 3]])
    vertices = np.concatenate([behind, *walls])
    faces = np.concatenate([inner[:, ::-1], sides.reshape(-1, 3) + count])
    all_normals = np.concatenate([np.tile(-plane.normal, (count, 1)), np.repeat(normals, 4, axis=0)])
    return front, _surface(vertices, faces, all_normals, plain, None)


def _surface(
    vertices: Float[np.ndarray, "n 3"],
    faces: Int[np.ndarray, "m 3"],
    normals: Float[np.ndarray, "*n 3"],
    material: Material,
    uv: Float[np.ndarray, "n 2"] | None,
) -> Surface:
    return Surface(
        vertices=vertices.astype(np.float32),
        normals=np.broadcast_to(normals, vertices.shape).astype(np.float32),
        faces=faces.astype(np.int32),
        material=material,
        uv=None if uv is None or material.texture is None else uv.astype(np.float32),
    )


def _triangles(plane: Plane) -> Int32[np.ndarray, "m 3"]:
    """The polygon cut into triangles, counter-clockwise seen from inside the room."""
    axes = np.stack(plane_axes(plane.normal), axis=1)
    return np.asarray(manifold3d.triangulate([plane.polygon @ axes]), dtype=np.int32)


def _plain_material(plane: Plane) -> Material:
    red, green, blue = (float(c) for c in srgb_to_linear(np.asarray(plane.colour)))
    return Material(name=plane.role, colour=(red, green, blue), roughness=0.6 if plane.role == "floor" else 0.95)


def _material(plane: Plane, texture: UInt8[np.ndarray, "h w c"], photographed: bool) -> Material:
    name, white = f"{plane.role} {plane.id}", (1.0, 1.0, 1.0)
    return Material(name=name, colour=white, roughness=0.8, texture=texture, photographed=photographed)
