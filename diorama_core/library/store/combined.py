"""Several libraries as one."""

from __future__ import annotations

import logging
from collections.abc import Sequence

from diorama_core.errors import LibraryError
from diorama_core.library.catalogue import base_id
from diorama_core.library.record import LibraryView, Shape, ShapeLibrary, picture_of

log = logging.getLogger(__name__)


class CombinedLibrary(LibraryView):
    """The shapes of several libraries, in their order. Implements `ShapeLibrary`.

    Where two of them use one id, the library named first keeps it, so that the id means the same wherever that library
    comes first; the other shape cannot be reached, which is logged once.
    """

    def __init__(self, libraries: Sequence[ShapeLibrary]) -> None:
        self._libraries = tuple(libraries)
        self._listed: tuple[tuple[Shape, ...], ...] = ()
        self._shapes: tuple[Shape, ...] = ()
        self._owner: dict[str, ShapeLibrary] = {}

    def __repr__(self) -> str:
        return " + ".join(map(repr, self._libraries))

    def __reduce__(self) -> tuple[type[CombinedLibrary], tuple[tuple[ShapeLibrary, ...]]]:
        """Other processes list it themselves."""
        return CombinedLibrary, (self._libraries,)

    def shapes(self) -> tuple[Shape, ...]:
        """All records, without support surfaces."""
        self._refresh()
        return self._shapes

    def in_category(self, category: str) -> tuple[Shape, ...]:
        """Records of one canonical category, without support surfaces."""
        self._refresh()
        return tuple(
            shape
            for library in self._libraries
            for shape in library.in_category(category)
            if self._owner.get(shape.id) is library
        )

    def thumbnail(self, shape_id: str) -> bytes | None:
        """The picture that came with the shape, where its library keeps one."""
        return picture_of(self._library_of(shape_id), shape_id)

    def is_built(self, shape_id: str) -> bool:
        """Whether what its library derives from the shape is on disk; stored libraries have it from the start."""
        built = getattr(self._library_of(shape_id), "is_built", None)
        return True if built is None else bool(built(shape_id))

    def _library_of(self, shape_id: str) -> ShapeLibrary:
        self._refresh()
        owner = self._owner.get(base_id(shape_id))
        if owner is None:
            raise LibraryError(f"no shape is called '{shape_id}' in {self!r}; list them to see the names")
        return owner

    def _refresh(self) -> None:
        """Follow the libraries, which may have grown."""
        listed = tuple(library.shapes() for library in self._libraries)
        if all(a is b or a == b for a, b in zip(listed, self._listed)) and len(listed) == len(self._listed):
            return
        owner: dict[str, ShapeLibrary] = {}
        retained: list[Shape] = []
        for library, shapes in zip(self._libraries, listed, strict=True):
            for shape in shapes:
                if owner.setdefault(shape.id, library) is library:
                    retained.append(shape)
                else:
                    log.warning("two shapes are called '%s'; the one of %r is used", shape.id, owner[shape.id])
        self._owner, self._shapes, self._listed = owner, tuple(retained), listed
