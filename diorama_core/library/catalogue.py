"""The built-in library: records load at once, meshes are built on first use and cached in memory and on disk."""

from __future__ import annotations

import hashlib
import io
import json
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import cache, cached_property, lru_cache
from pathlib import Path
from pickle import PicklingError

import platformdirs
import trimesh
from PIL import Image

from diorama_core.errors import LibraryError
from diorama_core.io.bounded import parse_json
from diorama_core.io.cache import LruCache
from diorama_core.io.derived import derive
from diorama_core.io.glb import whole_glb
from diorama_core.library import furniture, taxonomy
from diorama_core.library.furniture.geometry_key import code_key, geometry_key
from diorama_core.library.furniture.latest import built_once
from diorama_core.library.furniture.materials import Material, picture_bytes
from diorama_core.library.furniture.measures import MARK, is_made, made_by_id
from diorama_core.library.furniture.model import Design, mesh_of, scene_of
from diorama_core.library.furniture.roles import with_roles
from diorama_core.library.furniture.solids import Solid
from diorama_core.library.record import Shape, SupportSurface, surface_from, surface_row, usual_contact_faces
from diorama_core.library.surfaces import SURFACES_VERSION, support_surfaces
from diorama_core.library.taxonomy import carries_things, column

GLB_VERSION = 1
"""Version of the models' files: raise it when what `_glb` writes for the same parts changes."""
BULK_DENSITY: Mapping[str, float] = column("density")
"""Kilograms per cubic metre of bounding box: a rough guess for physics, from weighing catalogues' furniture."""
SCENE_BYTES = 256e6
"""Bytes of the arrays of models that stay in memory."""
PAINTED_AT_ONCE = "plain"
"""Pictures of this kind are of one colour: nothing is gained by caching them."""
_ENDS = (b"\xff\xd9", b"IEND\xaeB`\x82")
"""Last bytes of whole JPEG and PNG files."""


def default_cache_dir() -> Path:
    """Where derived files live: `DIORAMA_CACHE` when set, else the user's cache folder."""
    return Path(folder) if (folder := os.environ.get("DIORAMA_CACHE")) else _users_cache_dir()


@cache
def _users_cache_dir() -> Path:
    return Path(platformdirs.user_cache_dir("diorama"))


def base_id(shape_id: str) -> str:
    """The listed shape that an id is derived from, made to measure or not; the id itself where it is not derived."""
    return shape_id.split(MARK)[0]


def built_in_library(cache_dir: Path | None = None) -> BuiltInLibrary:
    """The library that comes with Diorama, caching under `cache_dir` (default: `default_cache_dir()`).

    Who names no folder gets the one library of this process, with the shapes that others asked it for.
    """
    if cache_dir is None:
        return _library_of_process(furniture.designs, default_cache_dir())
    return _library_in(furniture.designs, cache_dir)


def _library_in(designs: Callable[[], tuple[Design, ...]], cache_dir: Path) -> BuiltInLibrary:
    return BuiltInLibrary(designs(), cache_dir / "shapes")


_library_of_process = lru_cache(maxsize=1)(_library_in)


@lru_cache(maxsize=2)
def _open(cache_dir: Path) -> BuiltInLibrary:
    """The library of a process that was sent one."""
    return built_in_library() if cache_dir == default_cache_dir() else built_in_library(cache_dir)


class BuiltInLibrary:
    """Shapes from parametric designs. Implements `ShapeLibrary`; safe to share between threads.

    `shapes` and `in_category` answer at once, without support surfaces; `shape` adds them, measuring on first use.
    """

    def __init__(self, designs: tuple[Design, ...], cache_dir: Path) -> None:
        self._designs = {d.id: d for d in designs}
        if len(self._designs) != len(designs):
            raise LibraryError("two built-in designs share an id; give each its own")
        self._records: dict[str, Shape] = {}
        """Records of the designs that were asked for: naming the geometry of all takes a fifth of a second."""
        self._folder = cache_dir
        self._pictures_folder = cache_dir / "pictures"
        self._solids: LruCache[str, list[tuple[Material, Solid]]] = LruCache(8)
        self._scenes: LruCache[str, trimesh.Scene] = LruCache(SCENE_BYTES, _bytes_of)
        self._meshes: LruCache[str, trimesh.Trimesh] = LruCache(256)
        self._glbs: LruCache[str, bytes] = LruCache(256)
        self._made: LruCache[str, Shape] = LruCache(4096)
        self._surfaces: LruCache[str, tuple[SupportSurface, ...]] = LruCache(4096)

    def __repr__(self) -> str:
        return f"BuiltInLibrary({len(self._designs)} shapes)"

    def __reduce__(self) -> tuple[Callable[[Path], BuiltInLibrary], tuple[Path]]:
        """Other processes open their own; raises `PicklingError` for one of designs that they cannot know."""
        if self._designs.keys() != {d.id for d in furniture.designs()}:
            raise PicklingError(f"{self!r} is not the library that comes with Diorama")
        return _open, (self._folder.parent,)

    def shapes(self) -> tuple[Shape, ...]:
        """All records in a stable order, without support surfaces."""
        return self._shapes

    @cached_property
    def _shapes(self) -> tuple[Shape, ...]:
        return tuple(self._record(shape_id) for shape_id in self._designs)

    def in_category(self, category: str) -> tuple[Shape, ...]:
        """Records of one canonical category, without support surfaces."""
        return tuple(self._record(d.id) for d in self._designs.values() if d.category == category)

    def shape(self, shape_id: str) -> Shape:
        """One record with its support surfaces; raises `LibraryError` when unknown."""
        record = self._find(shape_id)
        return replace(record, surfaces=self._surfaces.get(shape_id, lambda: self._measure(record)))

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        """Geometry only, one mesh in the canonical frame. Shared: do not change it."""
        self._find(shape_id)
        return self._meshes.get(shape_id, lambda: mesh_of(self._build(shape_id)))

    def parts(self, shape_id: str) -> trimesh.Scene:
        """Geometry with materials, in the canonical frame. Shared: do not change it."""
        self._find(shape_id)
        return self._scenes.get(shape_id, lambda: scene_with_pictures(self._build(shape_id), self._pictures_folder))

    def glb(self, shape_id: str) -> bytes:
        """`parts` as GLB, +Z up, metres; the same bytes every time."""
        record = self._find(shape_id)
        path = self._glb_path(record)
        return self._glbs.get(shape_id, lambda: derive(path, lambda: _glb(self.parts(record.id)), whole_glb))

    def is_built(self, shape_id: str) -> bool:
        """Whether the model and the support surfaces of a shape are on disk."""
        record = self._find(shape_id)
        return self._glb_path(record).is_file() and self._surfaces_path(record).is_file()

    def _glb_path(self, record: Shape) -> Path:
        return self._folder / f"{record.content_hash}.{GLB_VERSION}.glb"

    def _surfaces_path(self, record: Shape) -> Path:
        return self._folder / f"{record.content_hash}.{SURFACES_VERSION}.surfaces.json"

    def _build(self, shape_id: str) -> list[tuple[Material, Solid]]:
        """The latest solids, cached because a request for the mesh is usually followed by one for the materials."""
        return self._solids.get(shape_id, lambda: built_once(self._design(shape_id)))

    def _design(self, shape_id: str) -> Design:
        """A design, made to measure where the id says so (`furniture.measures`)."""
        base = self._designs[base_id(shape_id)]
        return made_by_id(shape_id, base) if is_made(shape_id) else base

    def _find(self, shape_id: str) -> Shape:
        if is_made(shape_id) and base_id(shape_id) in self._designs:
            return self._made.get(shape_id, lambda: _record(self._design(shape_id)))
        if shape_id not in self._designs:
            raise LibraryError(f"no shape is called '{shape_id}' in the built-in library; list them to see the names")
        return self._record(shape_id)

    def _record(self, shape_id: str) -> Shape:
        record = self._records.get(shape_id)
        if record is None:
            record = self._records.setdefault(shape_id, _record(self._designs[shape_id]))
        return record

    def _measure(self, record: Shape) -> tuple[SupportSurface, ...]:
        def measure() -> bytes:
            surfaces = support_surfaces(self.mesh(record.id), carries=carries_things(record.category))
            return json.dumps([surface_row(s, decimals=5) for s in surfaces]).encode()

        return derive(self._surfaces_path(record), measure, _surfaces_from_json)


def _bytes_of(scene: trimesh.Scene) -> float:
    return float(sum(g.vertices.nbytes * 3 + g.faces.nbytes for g in scene.geometry.values()))


def _record(design: Design) -> Shape:
    kind = taxonomy.category(design.category)
    return Shape(
        id=design.id,
        category=design.category,
        caption=design.caption,
        size_m=design.size_m,
        style=design.style,
        symmetry=design.symmetry,
        synonyms=kind.synonyms,
        contact_faces=usual_contact_faces(kind.mount),
        mass_kg=_mass_guess(design),
        content_hash=geometry_key(design),
    )


def _mass_guess(design: Design) -> float:
    if design.mass_kg is not None:
        return design.mass_kg
    x, y, z = design.size_m
    return round(max(BULK_DENSITY.get(design.category, 100.0) * x * y * z, 0.05), 2)


def _glb(scene: trimesh.Scene) -> bytes:
    data = scene.export(file_type="glb", include_normals=True)
    if not isinstance(data, bytes):
        raise LibraryError("a shape could not be written as GLB")
    return data


def _surfaces_from_json(data: bytes) -> tuple[SupportSurface, ...]:
    return tuple(map(surface_from, parse_json(data, "support surfaces", LibraryError)))


def scene_with_pictures(solids: Iterable[tuple[Material, Solid]], folder: Path) -> trimesh.Scene:
    """`scene_of` with roles, the materials' pictures from their files in a folder.

    Args:
        solids: One for each material.
        folder: Where pictures are cached; without access to it they are painted each time.
    """
    solids = list(solids)
    unpainted = [(replace(material, kind=PAINTED_AT_ONCE), solid) for material, solid in solids]
    scene = with_roles(scene_of(unpainted), [material for material, _ in solids])
    for mesh, (material, _) in zip(scene.geometry.values(), solids, strict=True):
        if material.kind != PAINTED_AT_ONCE:
            picture = Image.open(io.BytesIO(cached_picture(material, folder)), formats=("JPEG", "PNG"))
            picture.load()  # as in `with_roles`
            mesh.visual.material.baseColorTexture = picture
    return scene


@lru_cache(maxsize=512)
def cached_picture(material: Material, folder: Path) -> bytes:
    """`picture_bytes` from its file, which is renewed with the material and the code that paints."""
    name = hashlib.sha256(f"{_code()} {material.name} {material.kind} {material.colour}".encode()).hexdigest()[:32]
    return derive(folder / f"{name}.jpg", lambda: picture_bytes(material), _whole)


@cache
def _code() -> str:
    return code_key(picture_bytes)


def _whole(data: bytes) -> bytes:
    if not data.endswith(_ENDS):
        raise ValueError("the picture is cut off")
    return data
