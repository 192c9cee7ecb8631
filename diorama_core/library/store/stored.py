"""A library on disk: takes in what ingestion hands over, and gives it back as any other library does."""

from __future__ import annotations

import hashlib
import io
import threading
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np
import trimesh
from PIL import Image

from diorama_core.errors import LibraryError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import read_bytes
from diorama_core.io.cache import LruCache
from diorama_core.library.ingest.sink import Ingested
from diorama_core.library.record import Shape
from diorama_core.library.store.records import Records, StoredRow

MAX_MODEL_BYTES = 600_000_000
"""Bytes of one model as it is stored; ingestion makes none as large."""

_PICTURES = (
    "baseColorTexture", "metallicRoughnessTexture", "normalTexture", "occlusionTexture", "emissiveTexture", "image",
)  # fmt: skip
"""Pictures that a material may have."""


class StoredLibrary:
    """The shapes in one folder. Implements `ShapeLibrary` and `ShapeSink`; safe to share between threads.

    | in the folder    | what                                                          |
    |------------------|---------------------------------------------------------------|
    | `library.sqlite` | records, thumbnails, source keys                              |
    | `models/ab/*.glb`| geometry and materials, named by their content                |
    | `features/`      | feature matrices (`store.features`), made when first needed   |

    What another process adds meanwhile is seen at the next call.

    Args:
        folder: Of the library.
        create: Make it when it is absent; else that is a `LibraryError`.
    """

    def __init__(self, folder: Path, *, create: bool = False) -> None:
        self.folder = folder
        self._records = Records(folder / "library.sqlite", create=create)
        self._scenes: LruCache[str, trimesh.Scene] = LruCache(64)
        self._meshes: LruCache[str, trimesh.Trimesh] = LruCache(256)
        self._lock = threading.Lock()
        self._listed: dict[str | None, tuple[Shape, ...]] = {}
        self._listed_state = -1

    def __repr__(self) -> str:
        return f"StoredLibrary({self.folder.name!r}, {len(self)} shapes)"

    def __reduce__(self) -> tuple[Callable[[Path], StoredLibrary], tuple[Path]]:
        """Other processes open it themselves, once."""
        return _open, (self.folder,)

    def __len__(self) -> int:
        return self._records.count()

    def shapes(self) -> tuple[Shape, ...]:
        """All records by id, without support surfaces and guesses."""
        return self._list(None)

    def in_category(self, category: str) -> tuple[Shape, ...]:
        """Records of one canonical category by id, without support surfaces and guesses."""
        return self._list(category)

    def shape(self, shape_id: str) -> Shape:
        """One whole record; raises `LibraryError` when unknown."""
        return self._row(shape_id).record

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        """Geometry only, one mesh in the canonical frame. Shared: do not change it."""
        model = self._row(shape_id).model
        return self._meshes.get(model, lambda: _merge(self._scene(shape_id, model)))

    def parts(self, shape_id: str) -> trimesh.Scene:
        """Geometry with materials, in the canonical frame. Shared: do not change it."""
        return self._scene(shape_id, self._row(shape_id).model)

    def glb(self, shape_id: str) -> bytes:
        """`parts` as GLB, +Z up, metres: the bytes that were added."""
        return self._read(shape_id, self._row(shape_id).model)

    def thumbnail(self, shape_id: str) -> bytes | None:
        """The square PNG that came with the shape, if one did."""
        return self._row(shape_id).thumbnail

    def warnings(self, shape_id: str) -> tuple[str, ...]:
        """What was repaired or left out when the shape was taken in."""
        return self._row(shape_id).warnings

    def source_key(self, shape_id: str) -> str:
        """Names the state of the file that a shape came from; a corrected shape keeps it."""
        return self._row(shape_id).source_key

    def source_keys(self) -> frozenset[str]:
        """The source key of everything kept: what a resumed run need not read again."""
        return self._records.source_keys()

    def add(self, item: Ingested) -> None:
        """Keep one shape, durably; one with the same id is replaced."""
        self.add_all((item,))

    def add_all(self, items: Iterable[Ingested]) -> None:
        """Keep many shapes in one step, all or none of their records.

        Raises:
            LibraryError: when the folder cannot be written.
        """
        rows = [
            StoredRow(i.record, self._write(i.glb), i.source_key, tuple(i.warnings), i.thumbnail_png) for i in items
        ]
        self._unlink(self._records.put(rows))

    def remove(self, shape_ids: Sequence[str]) -> None:
        """Forget shapes and their models; unknown ids are none too many."""
        self._unlink(self._records.remove(shape_ids))

    def close(self) -> None:
        """Let the files go."""
        self._records.close()

    def _list(self, category: str | None) -> tuple[Shape, ...]:
        state = self._records.state()
        with self._lock:
            if state != self._listed_state:
                self._listed, self._listed_state = {}, state
            if category not in self._listed:
                self._listed[category] = self._records.summaries(category)
            return self._listed[category]

    def _row(self, shape_id: str) -> StoredRow:
        row = self._records.detail(shape_id)
        if row is None:
            raise LibraryError(
                f"no shape is called '{shape_id}' in the library '{self.folder.name}'; list them to see the names"
            )
        return row

    def _scene(self, shape_id: str, model: str) -> trimesh.Scene:
        return self._scenes.get(model, lambda: _load(self._read(shape_id, model), shape_id))

    def _model_path(self, model: str) -> Path:
        return self.folder / "models" / model[:2] / f"{model}.glb"

    def _read(self, shape_id: str, model: str) -> bytes:
        return read_bytes(self._model_path(model), MAX_MODEL_BYTES, LibraryError, f"add shape '{shape_id}' again")

    def _write(self, glb: bytes) -> str:
        """Keep a model under the hash of its bytes, and return that name."""
        model = hashlib.sha256(glb).hexdigest()[:32]
        path = self._model_path(model)
        try:
            if path.exists() and path.stat().st_size == len(glb):
                return model
            write_atomically(path, glb)
        except OSError as error:
            raise LibraryError(f"the library cannot be written in {self.folder} ({error.strerror})") from error
        return model

    def _unlink(self, models: Iterable[str]) -> None:
        for model in models:
            self._model_path(model).unlink(missing_ok=True)


@lru_cache(maxsize=4)
def _open(folder: Path) -> StoredLibrary:
    return StoredLibrary(folder)


def _load(glb: bytes, shape_id: str) -> trimesh.Scene:
    try:
        scene = trimesh.load_scene(io.BytesIO(glb), file_type="glb", process=False)
        _decode(scene)
    except Exception as error:  # a damaged file may fail in any way inside the loader
        raise LibraryError(f"the model of shape '{shape_id}' is damaged ({error}); add it again") from error
    return scene


def _decode(scene: trimesh.Scene) -> None:
    """Read the pictures of a scene's materials: threads that share it must not do so at the same time."""
    for mesh in scene.geometry.values():
        material = getattr(getattr(mesh, "visual", None), "material", None)
        for name in _PICTURES:
            picture = getattr(material, name, None)
            if isinstance(picture, Image.Image):
                picture.load()


def _merge(scene: trimesh.Scene) -> trimesh.Trimesh:
    vertices, faces, count = [np.zeros((0, 3))], [np.zeros((0, 3), np.int64)], 0
    for node in scene.graph.nodes_geometry:
        T, name = scene.graph[node]
        part = scene.geometry[name]
        if isinstance(part, trimesh.Trimesh):
            vertices.append(trimesh.transform_points(part.vertices, T))
            faces.append(np.asarray(part.faces) + count)
            count += len(part.vertices)
    return trimesh.Trimesh(np.concatenate(vertices), np.concatenate(faces), process=False)
