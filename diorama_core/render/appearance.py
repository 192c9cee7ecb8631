"""How shapes and planes look: surfaces with smooth normals, texture coordinates and one material each.

The renderer and the exporters share this reading of a shape's `parts`, so that a picture and an exported file agree.
Colours are linear, as glTF states them; pictures (textures) are sRGB, as they come.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np
import trimesh
from jaxtyping import Float, Float32, Int, Int32, UInt8
from PIL import Image
from trimesh.visual.color import ColorVisuals
from trimesh.visual.material import PBRMaterial

from diorama_core.geometry.vectors import cross, dot, unique_rows, unit
from diorama_core.io.cache import LruCache
from diorama_core.library.paint import repaint
from diorama_core.library.photo_materials import PhotographedMaterial, Pictures, with_photo_materials
from diorama_core.library.stretch import EVEN, Scale, stretch_parts
from diorama_core.scene.types import Finish, PhotoMaterial

Colour = tuple[float, float, float]
NO_PICTURES: Pictures = {}
CREASE_RAD = np.radians(38.0)
"""Faces that meet at less than this are shaded as one smooth surface."""


@dataclass(frozen=True, eq=False)
class Material:
    """A physically based material (metallic and roughness), colours linear 0 to 1."""

    name: str = "material"
    colour: Colour = (0.8, 0.8, 0.8)
    alpha: float = 1.0
    metallic: float = 0.0
    roughness: float = 0.8
    emissive: Colour = (0.0, 0.0, 0.0)
    texture: UInt8[np.ndarray, "h w c"] | None = None
    """sRGB picture multiplied onto the colour; first row on top; may carry alpha."""
    maps: dict[str, UInt8[np.ndarray, "_ _ 3"]] = field(default_factory=dict)
    """Further glTF maps, kept for export: normalTexture, metallicRoughnessTexture, occlusionTexture, ..."""
    double_sided: bool = False
    photographed: bool = False
    """Whether the texture is a photograph that already holds the light of its room."""


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles of one material."""

    vertices: Float32[np.ndarray, "n 3"]
    normals: Float32[np.ndarray, "n 3"]
    faces: Int32[np.ndarray, "m 3"]
    material: Material
    uv: Float32[np.ndarray, "n 2"] | None = None
    """Texture coordinates, v upward (0 is the picture's last row)."""
    colours: Float32[np.ndarray, "n 3"] | None = None
    """Linear colours multiplied onto the material's."""
    name: str = "surface"
    light_uv: Float32[np.ndarray, "n 2"] | None = None
    """Second coordinates, without overlaps, v upward; None where nobody asked for them."""

    @property
    def area_m2(self) -> float:
        """Total area of the triangles."""
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


@runtime_checkable
class PartsSource(Protocol):
    """Where a shape's parts come from; every library is one."""

    def parts(self, shape_id: str) -> trimesh.Scene:
        """Geometry with materials, in the canonical frame."""
        ...


def shape_surfaces(
    library: PartsSource,
    shape_id: str,
    colour_srgb: Colour | None = None,
    finish: Finish | None = None,
    materials: tuple[PhotoMaterial, ...] = (),
    pictures: Pictures = NO_PICTURES,
    scale: Scale = EVEN,
) -> tuple[Surface, ...]:
    """A shape's surfaces in its canonical frame, in a stable order.

    Args:
        library: Where the shape is.
        shape_id: Which shape; `LibraryError` when unknown.
        colour_srgb: Override of the main material's colour; see `library.paint.repaint`.
        finish: Override of how it throws light back, likewise.
        materials: From the photo, over both where they match a slot.
        pictures: Their textures by name; a name always means the same picture.
        scale: By which they will be scaled, relative to an even scale: thin parts are made to keep their thickness.
    """
    parts = library.parts(shape_id)
    return _cached_surfaces(parts, (colour_srgb, finish), materials, pictures, scale)


Paint = tuple[Colour | None, Finish | None]
_Key = tuple[int, Paint, tuple[PhotoMaterial, ...], frozenset[str | None], Scale]

CACHE_BYTES = 256e6
"""Bytes of the surfaces that stay in memory: about a million triangles."""
PART_BYTES = 8000
"""Bytes of the objects around the arrays of a part (of 3,000 boxes, by tracemalloc)."""


def _bytes_of(entry: tuple[trimesh.Scene, tuple[Surface, ...]]) -> float:
    return float(sum(s.vertices.nbytes + s.normals.nbytes + s.faces.nbytes + PART_BYTES for s in entry[1]))


_CACHE: LruCache[_Key, tuple[trimesh.Scene, tuple[Surface, ...]]] = LruCache(CACHE_BYTES, _bytes_of)


GEOMETRY_BYTES = 64e6
"""Bytes of what is remembered of the parts' geometry, twice: their normals, and their vertices."""
_NORMALS: LruCache[bytes, np.ndarray] = LruCache(GEOMETRY_BYTES, lambda normals: float(normals.nbytes))
_SPLIT: LruCache[bytes, tuple[np.ndarray, np.ndarray]] = LruCache(
    GEOMETRY_BYTES, lambda found: float(found[0].nbytes + found[1].nbytes)
)


def _cached_surfaces(
    parts: trimesh.Scene, paint: Paint, materials: tuple[PhotoMaterial, ...], pictures: Pictures, scale: Scale
) -> tuple[Surface, ...]:
    """The surfaces of a scene of parts, read once while the same scene object keeps being asked for."""

    def read() -> tuple[trimesh.Scene, tuple[Surface, ...]]:
        shown = stretch_parts(parts, scale)
        shown = shown if paint == (None, None) else repaint(shown, *paint)
        shown = with_photo_materials(shown, materials, pictures) if materials else shown
        # Caching the scene, too, keeps its id from being given to another.
        return parts, tuple(s for s in _read_parts(shown) if len(s.faces))

    present = frozenset(m.texture for m in materials if m.texture in pictures)
    return _CACHE.get((id(parts), paint, materials, present, scale), read)[1]


def _read_parts(parts: trimesh.Scene) -> list[Surface]:
    materials: dict[int, Material] = {}
    surfaces = []
    for node in sorted(parts.graph.nodes_geometry):
        matrix, name = parts.graph[node]
        mesh = parts.geometry[name]
        if isinstance(mesh, trimesh.Trimesh):
            surfaces.append(_surface(mesh, np.asarray(matrix), str(name), materials))
    return surfaces


def _surface(
    mesh: trimesh.Trimesh, matrix: Float[np.ndarray, "4 4"], name: str, materials: dict[int, Material]
) -> Surface:
    """One mesh with its transform applied, split into vertices that have one normal each."""
    points = (np.asarray(mesh.vertices) @ matrix[:3, :3].T + matrix[:3, 3]).astype(np.float32)
    faces = np.asarray(mesh.faces, dtype=np.int32)
    if np.linalg.det(matrix[:3, :3]) < 0:
        faces = faces[:, ::-1]
    material, uv, colours = _compare(mesh, materials)
    per_corner = None if colours is None else colours[_colour_rows(mesh, colours, faces)]
    rows, index = _split(points, faces, uv, per_corner)
    return Surface(
        vertices=rows[:, :3],
        normals=unit(rows[:, 3:6]).astype(np.float32),
        faces=index,
        material=material,
        uv=rows[:, 6:8] if uv is not None else None,
        colours=rows[:, -3:] if colours is not None else None,
        name=name,
    )


def _split(
    points: Float32[np.ndarray, "n 3"],
    faces: Int32[np.ndarray, "m 3"],
    uv: Float32[np.ndarray, "n 2"] | None,
    colours: Float32[np.ndarray, "c 3"] | None,
) -> tuple[Float32[np.ndarray, "v k"], Int32[np.ndarray, "m 3"]]:
    """Place, normal, texture coordinates and colour of every vertex, and the faces between them.

    Remembered, since a shape is read again with each material that it gets.
    """
    form = _digest(points) + _digest(faces)
    key = b"".join([form, *(b"-" if column is None else _digest(column) for column in (uv, colours))])

    def make() -> tuple[np.ndarray, np.ndarray]:
        corners = faces.reshape(-1)
        columns = [points[corners], _NORMALS.get(form, lambda: smooth_corner_normals(points, faces))]
        columns += [uv[corners]] if uv is not None else []
        columns += [colours] if colours is not None else []
        rounded = np.round(np.concatenate(columns, axis=1), 5) + 0.0
        first, index = unique_rows(rounded)
        return rounded[first].astype(np.float32), index.reshape(-1, 3).astype(np.int32)

    return _SPLIT.get(key, make)


def _digest(array: np.ndarray) -> bytes:
    """Names an array's content; the faces of mirrored parts are a view from their other end."""
    return hashlib.sha256(np.ascontiguousarray(array).data).digest()


def _colour_rows(mesh: trimesh.Trimesh, colours: Float32[np.ndarray, "k 3"], faces: np.ndarray) -> np.ndarray:
    """For every corner the row of its colour: per vertex, or per face."""
    per_vertex = len(colours) == len(mesh.vertices) and mesh.visual.kind != "face"
    return faces.reshape(-1) if per_vertex else np.repeat(np.arange(len(faces)), 3)


ShapeAppearance = tuple[Material, Float32[np.ndarray, "n 2"] | None, Float32[np.ndarray, "k 3"] | None]


def _compare(mesh: trimesh.Trimesh, materials: dict[int, Material]) -> ShapeAppearance:
    """Material, texture coordinates and vertex or face colours of a mesh."""
    visual = mesh.visual
    if isinstance(visual, ColorVisuals):
        if visual.kind is None:
            return materials.setdefault(0, Material()), None, None
        rgba = np.asarray(visual.face_colors if visual.kind == "face" else visual.vertex_colors) / 255.0
        return Material(colour=(1.0, 1.0, 1.0), alpha=float(rgba[:, 3].min())), None, rgba[:, :3].astype(np.float32)
    source = visual.material
    if id(source) not in materials:
        materials[id(source)] = _material(source if isinstance(source, PBRMaterial) else source.to_pbr())
    uv = None if visual.uv is None else np.asarray(visual.uv, dtype=np.float32)
    return materials[id(source)], uv, None


def _material(source: PBRMaterial) -> Material:
    rgba = [1.0] * 4 if source.baseColorFactor is None else [float(c) / 255.0 for c in source.baseColorFactor]
    emissive = (0.0, 0.0, 0.0) if source.emissiveFactor is None else tuple(float(c) for c in source.emissiveFactor)
    names = ("normalTexture", "metallicRoughnessTexture", "occlusionTexture", "emissiveTexture")
    maps = {key: np.asarray(getattr(source, key).convert("RGB")) for key in names if getattr(source, key) is not None}
    return Material(
        name=source.name or "material",
        colour=(rgba[0], rgba[1], rgba[2]),
        alpha=1.0 if source.alphaMode in (None, "OPAQUE") else rgba[3],
        metallic=1.0 if source.metallicFactor is None else float(source.metallicFactor),
        roughness=1.0 if source.roughnessFactor is None else float(source.roughnessFactor),
        emissive=(emissive[0], emissive[1], emissive[2]),
        texture=_picture(source.baseColorTexture),
        maps=maps,
        double_sided=bool(source.doubleSided),
        photographed=isinstance(source, PhotographedMaterial),
    )


def _picture(image: Image.Image | None) -> UInt8[np.ndarray, "h w c"] | None:
    if image is None:
        return None
    mode = "RGBA" if image.mode in ("RGBA", "LA", "P") else "RGB"
    return np.asarray(image.convert(mode))


def smooth_corner_normals(
    vertices: Float32[np.ndarray, "n 3"], faces: Int32[np.ndarray, "m 3"]
) -> Float32[np.ndarray, "m*3 3"]:
    """A normal for every corner of every face: the area-weighted mean of the neighbours within the crease angle.

    Faces that lie within half that angle of their vertex's mean normal lie within it of each other, so where all do,
    the mean is the normal, and only at other vertices are faces compared pair by pair.
    """
    a, b, c = (vertices.take(faces[:, k], axis=0).astype(np.float64) for k in range(3))
    weighted = cross(b - a, c - a)
    normals = unit(weighted)
    owner = unique_rows(np.round(vertices, 5))[1].take(faces.reshape(-1))
    of_vertex = _sums(owner, np.repeat(weighted, 3, axis=0), int(owner.max(initial=-1)) + 1)
    from_mean = dot(np.repeat(normals, 3, axis=0), unit(of_vertex).take(owner, axis=0))
    creased = np.zeros(len(of_vertex), dtype=bool)
    creased[owner[from_mean <= np.cos(CREASE_RAD / 2)]] = True
    sums = of_vertex.take(owner, axis=0)
    rest = np.flatnonzero(creased.take(owner))
    sums[rest] = _crease_sums(owner[rest], rest // 3, weighted, normals, CREASE_RAD)
    lost = dot(sums, sums) < 1e-30
    sums[lost] = np.repeat(normals, 3, axis=0)[lost]
    return unit(sums).astype(np.float32)


def _crease_sums(
    owner: Int[np.ndarray, " n"],
    face: Int[np.ndarray, " n"],
    weighted: Float[np.ndarray, "m 3"],
    normals: Float[np.ndarray, "m 3"],
    crease_rad: float,
) -> Float[np.ndarray, "n 3"]:
    """Sums for corners of given vertices and faces of the faces at the vertex that meet theirs within the angle."""
    first, second = _pairs_of_equal(owner)
    first_face, second_face = face.take(first), face.take(second)
    near = dot(normals.take(first_face, axis=0), normals.take(second_face, axis=0)) > np.cos(crease_rad)
    first, second_face = first[near], second_face[near]
    return _sums(first, weighted.take(second_face, axis=0), len(owner))


def _sums(labels: Int[np.ndarray, " n"], vectors: Float[np.ndarray, "n 3"], count: int) -> Float[np.ndarray, "k 3"]:
    """Sum of the vectors of each label below `count`."""
    sums = np.empty((count, 3))
    for k in range(3):
        sums[:, k] = np.bincount(labels, vectors[:, k], minlength=count)
    return sums


def _pairs_of_equal(labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All ordered pairs of indices with equal labels, each index with itself included."""
    order = np.argsort(labels, kind="stable")
    counts = np.bincount(labels)
    starts = np.cumsum(counts) - counts
    size = counts[labels]
    first = np.repeat(np.arange(len(labels)), size)
    within = np.arange(len(first)) - np.repeat(np.cumsum(size) - size, size)
    return first, order[np.repeat(starts[labels], size) + within]
