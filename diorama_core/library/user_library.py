"""The shapes the editor offers: the library it was started with, and models that people brought along."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

import trimesh

from diorama_core.errors import LibraryError
from diorama_core.library.boards import base_id
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.store import CombinedLibrary, StoredLibrary, create_library, open_library, stored_libraries

OWN = "my-models"
"""Name of the stored library that uploads go to."""


class UserLibrary:
    """A `ShapeLibrary` that can grow while everything holds on to it."""

    def __init__(self, library: ShapeLibrary) -> None:
        self._library = library
        self._own: StoredLibrary | None = None
        self._lock = threading.Lock()
        self._combined = OWN in stored_libraries()
        if self._combined:
            self._library = CombinedLibrary([library, open_library(OWN)])

    def __repr__(self) -> str:
        return repr(self._library)

    def __reduce__(self) -> tuple[Callable[[ShapeLibrary], ShapeLibrary], tuple[ShapeLibrary]]:
        """Other processes get what it holds now; it does not grow there."""
        return _unchanged, (self._library,)

    def own(self) -> StoredLibrary:
        """Where uploads are kept, made when there is none yet; raises `LibraryError` when it cannot be written."""
        with self._lock:
            if self._own is None:
                self._own = create_library(OWN)
                if not self._combined:  # another process may have made it since
                    self._library, self._combined = CombinedLibrary([self._library, self._own]), True
            return self._own

    def has_own(self, shape_id: str) -> bool:
        """Whether a shape is one of the uploads."""
        known = self._own is not None or OWN in stored_libraries()
        return known and any(shape.id == shape_id for shape in self.own().shapes())

    def shapes(self) -> tuple[Shape, ...]:
        """All records, in a stable order."""
        return self._library.shapes()

    def shape(self, shape_id: str) -> Shape:
        """One record with its support surfaces."""
        return self._library.shape(shape_id)

    def in_category(self, category: str) -> tuple[Shape, ...]:
        """Records of one canonical category."""
        return self._library.in_category(category)

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        """Geometry only."""
        return self._library.mesh(shape_id)

    def parts(self, shape_id: str) -> trimesh.Scene:
        """Geometry with materials."""
        return self._library.parts(shape_id)

    def glb(self, shape_id: str) -> bytes:
        """`parts` as GLB."""
        return self._library.glb(shape_id)

    def thumbnail(self, shape_id: str) -> bytes | None:
        """The picture that came with the shape, where its library keeps one."""
        retained = getattr(self._library, "thumbnail", None)
        return None if retained is None else retained(shape_id)


class ProjectShapes(UserLibrary):
    """What one editor offers: the shared library and, before all others, the shapes of the project that it shows."""

    def __init__(self, shared: UserLibrary) -> None:
        self.shared = shared
        self._library: ShapeLibrary = shared

    def show(self, folder: Path) -> None:
        """Offer the shapes in a project's folder, where it has any, instead of those of the project before."""
        own = [StoredLibrary(folder)] if (folder / "library.sqlite").exists() else []
        self._library = CombinedLibrary([*own, self.shared]) if own else self.shared

    def own(self) -> StoredLibrary:
        """Where uploads are kept; see `UserLibrary.own`."""
        return self.shared.own()

    def has_own(self, shape_id: str) -> bool:
        """Whether a shape is one of the uploads."""
        return self.shared.has_own(shape_id)


def _unchanged(library: ShapeLibrary) -> ShapeLibrary:
    return library


class ShapeRecords:
    """A library's records as it lists them, by id: `ShapeLibrary.shape` may have to measure support surfaces first.

    Safe between threads.
    """

    def __init__(self, library: ShapeLibrary) -> None:
        self._library = library
        self._known: tuple[tuple[Shape, ...], dict[str, Shape]] = ((), {})

    def shape(self, shape_id: str) -> Shape:
        """The record without support surfaces; raises `LibraryError` when unknown."""
        listed, by_id = self._known
        shapes = self._library.shapes()
        if shapes is not listed and shapes != listed:
            by_id = {s.id: s for s in shapes}
            self._known = (shapes, by_id)
        if shape_id not in by_id and base_id(shape_id) in by_id:
            return self._library.shape(shape_id)
        if shape_id not in by_id:
            raise LibraryError(f"no shape is called '{shape_id}'")
        return by_id[shape_id]
