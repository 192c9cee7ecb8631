"""The shapes the editor offers: the library it was started with, and models that people brought along, with their
names, their folders and the deleted ones.

A deleted model is listed nowhere, but stays in its library: scenes that hold it open as before, and it can be restored.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from diorama_core.errors import LibraryError
from diorama_core.io.atomic import write_json
from diorama_core.io.bounded import read_bytes, shorten
from diorama_core.io.text import clean_text
from diorama_core.library.catalogue import base_id
from diorama_core.library.record import LibraryView, Shape, ShapeLibrary, picture_of
from diorama_core.library.store import (
    CombinedLibrary,
    StoredLibrary,
    create_library,
    library_folder,
    list_libraries,
    open_library,
)

MAX_NAME = 80
"""Characters of a name or a folder that a person gives."""
MAX_BYTES = 16_000_000
"""Bytes of the document: some hundred thousand models."""


@dataclass(frozen=True)
class OwnModels:
    """What a person says of the models of a library."""

    names: dict[str, str] = field(default_factory=dict)
    """By shape id; a model without one has its caption."""
    folders: dict[str, str] = field(default_factory=dict)
    """By shape id; a model without one is in none."""
    deleted: tuple[str, ...] = ()
    """Ids, the last deleted last."""
    in_builds: bool = False
    """Whether builds and rooms made from words may use these models."""

    def rename(self, shape_id: str, name: str) -> OwnModels:
        """With a model's name; an empty one leaves it to the caption."""
        return replace(self, names=_with(self.names, shape_id, name))

    def file(self, shape_id: str, folder: str) -> OwnModels:
        """With a model in a folder, which is there as long as something is in it; an empty name is no folder."""
        return replace(self, folders=_with(self.folders, shape_id, folder))

    def without(self, shape_id: str) -> OwnModels:
        """With a model deleted."""
        return replace(self, deleted=(*(i for i in self.deleted if i != shape_id), shape_id))

    def restore(self, shape_id: str) -> OwnModels:
        """With a model deleted no more."""
        return replace(self, deleted=tuple(i for i in self.deleted if i != shape_id))

    def supersede(self, shape_id: str, by: str) -> OwnModels:
        """With a corrected model in the place of the one that it was made from."""
        known = self.without(shape_id).restore(by)
        return known.rename(by, self.names.get(shape_id, "")).file(by, self.folders.get(shape_id, ""))


class _File(BaseModel):
    model_config = ConfigDict(extra="ignore", strict=False)
    names: dict[str, str] = {}
    folders: dict[str, str] = {}
    deleted: tuple[str, ...] = ()
    in_builds: bool = False


def read_own_models(path: Path) -> OwnModels:
    """The document; of a file that is not there everything is as at first.

    Raises:
        LibraryError: it cannot be read; says which file.
    """
    try:
        about = path.stat()
    except OSError:
        return OwnModels()
    return _read(path, about.st_mtime_ns, about.st_size, about.st_ino)


@lru_cache(maxsize=8)
def _read(path: Path, written_ns: int, size: int, inode: int) -> OwnModels:
    """The document as it was written then; asked for at every redraw of a page."""
    try:
        return OwnModels(**dict(_File.model_validate_json(read_bytes(path, MAX_BYTES, LibraryError))))
    except ValidationError as error:
        raise LibraryError(f"{path} cannot be read ({shorten(str(error))}); delete it to start again") from error


def write_own_models(path: Path, models: OwnModels) -> None:
    """Keep the document; raises `LibraryError` when it cannot be written."""
    write_json(path, asdict(models), LibraryError, most=MAX_BYTES)


def _with(known: dict[str, str], shape_id: str, words: str) -> dict[str, str]:
    """The words of one model replaced, or taken away where there are none."""
    text = " ".join(clean_text(words).split())[:MAX_NAME].strip()
    rest = {key: value for key, value in known.items() if key != shape_id}
    return {**rest, shape_id: text} if text else rest


OWN = "my-models"
"""Name of the stored library that uploads go to."""
ORDER = "own-models.json"
"""Beside that library's shapes: what their owner says of them."""


class UserLibrary(LibraryView):
    """A `ShapeLibrary` that can grow while everything holds on to it."""

    def __init__(self, library: ShapeLibrary) -> None:
        self._library = library
        self._own: StoredLibrary | None = None
        self._lock = threading.Lock()
        self._combined = OWN in list_libraries()
        if self._combined:
            self._library = CombinedLibrary([library, open_library(OWN)])

    def __reduce__(self) -> tuple[Callable[[ShapeLibrary], ShapeLibrary], tuple[ShapeLibrary]]:
        """Other processes get what it holds now; it does not grow there."""
        return _identity, (self._library,)

    def own(self) -> StoredLibrary:
        """Where uploads are kept, made when there is none yet; raises `LibraryError` when it cannot be written."""
        with self._lock:
            if self._own is None:
                self._own = create_library(OWN)
                if not self._combined:  # another process may have made it since
                    self._library, self._combined = CombinedLibrary([self._library, self._own]), True
            return self._own

    def uploads(self) -> tuple[Shape, ...]:
        """The records of all uploads, deleted ones included."""
        known = self._own is not None or OWN in list_libraries()
        return self.own().shapes() if known else ()

    def has_own(self, shape_id: str) -> bool:
        """Whether a shape is one of the uploads."""
        return any(shape.id == shape_id for shape in self.uploads())

    @property
    def own_models(self) -> OwnModels:
        """What their owner says of the uploads; raises `LibraryError` when it cannot be read."""
        return read_own_models(library_folder(OWN) / ORDER)

    def keep_order(self, models: OwnModels) -> None:
        """Keep what their owner says of the uploads; raises `LibraryError` when it cannot be written."""
        write_own_models(library_folder(OWN) / ORDER, models)

    def offer(self) -> OfferedShapes:
        """What builds and words choose from: not the uploads, unless their owner asked for that."""
        models = self.own_models
        ids = models.deleted if models.in_builds else (s.id for s in self.uploads())
        return OfferedShapes(self, frozenset(ids))

    def thumbnail(self, shape_id: str) -> bytes | None:
        """The picture that came with the shape, where its library keeps one."""
        return picture_of(self._library, shape_id)


class ProjectShapes(UserLibrary):
    """What one editor offers: the shared library and, before all others, the shapes of the project that it shows."""

    def __init__(self, shared: UserLibrary) -> None:
        self.shared = shared
        self._library: ShapeLibrary = shared
        self._of_project: StoredLibrary | None = None

    def show(self, folder: Path) -> None:
        """Offer the shapes in a project's folder, where it has any, instead of those of the project before."""
        own = StoredLibrary(folder) if (folder / "library.sqlite").exists() else None
        self._of_project = own
        self._library = self.shared if own is None else CombinedLibrary([own, self.shared])

    def own(self) -> StoredLibrary:
        """Where uploads are kept; see `UserLibrary.own`."""
        return self.shared.own()

    def uploads(self) -> tuple[Shape, ...]:
        """The records of all uploads; see `UserLibrary.uploads`."""
        return self.shared.uploads()

    def offer(self) -> OfferedShapes:
        """What builds and words choose from: neither the project's own shapes nor, unless asked for, uploads."""
        own = () if self._of_project is None else self._of_project.shapes()
        return OfferedShapes(self, self.shared.offer().left_out | frozenset(s.id for s in own))


class OfferedShapes(LibraryView):
    """A library whose lists leave some shapes out; those are found by their ids all the same. A `ShapeLibrary`."""

    def __init__(self, library: ShapeLibrary, left_out: frozenset[str]) -> None:
        self._library = library
        self.left_out = left_out

    def shapes(self) -> tuple[Shape, ...]:
        """The records that are offered, in a stable order."""
        return tuple(s for s in self._library.shapes() if s.id not in self.left_out)

    def in_category(self, category: str) -> tuple[Shape, ...]:
        """The records of one canonical category that are offered."""
        return tuple(s for s in self._library.in_category(category) if s.id not in self.left_out)


def offer_shapes(library: ShapeLibrary) -> ShapeLibrary:
    """What builds and words choose from; all of a library to which nothing is added.

    Raises:
        LibraryError: what is said of the uploads cannot be read.
    """
    return library.offer() if isinstance(library, UserLibrary) else library


def _identity(library: ShapeLibrary) -> ShapeLibrary:
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
