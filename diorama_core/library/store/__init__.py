"""Libraries on disk, by name: `built-in`, a stored one, or several joined by `+`."""

from __future__ import annotations

import os
import re
from pathlib import Path

import platformdirs

from diorama_core.errors import LibraryError
from diorama_core.library.library_names import BUILT_IN, ESCAPED_PLUS
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.store.combined import CombinedLibrary
from diorama_core.library.store.stored import StoredLibrary

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")

__all__ = [
    "BUILT_IN",
    "ESCAPED_PLUS",
    "CombinedLibrary",
    "StoredLibrary",
    "create_library",
    "libraries_folder",
    "library_folder",
    "list_libraries",
    "open_library",
]


def libraries_folder() -> Path:
    """Where stored libraries live: `DIORAMA_LIBRARIES` when set, else in the user's data folder."""
    return Path(os.environ.get("DIORAMA_LIBRARIES") or Path(platformdirs.user_data_dir("diorama")) / "libraries")


def list_libraries() -> tuple[str, ...]:
    """List the names of the stored libraries."""
    return tuple(sorted(path.parent.name for path in libraries_folder().glob("*/library.sqlite")))


def library_folder(name: str) -> Path:
    """The folder of a stored library, whether or not it is there.

    Args:
        name: One word, a folder among `libraries_folder()`; or a path, recognised by its slash.

    Raises:
        LibraryError: when the name is neither.
    """
    if "/" in name or os.sep in name:
        return Path(name.replace(ESCAPED_PLUS, "+")).expanduser()
    if name == BUILT_IN or not _NAME.fullmatch(name):
        raise LibraryError(
            f"a stored library cannot be called {name!r}; use letters, digits, '-', '_' and '.', or a path with a '/'"
        )
    return libraries_folder() / name


def create_library(name: str) -> StoredLibrary:
    """The stored library of that name, made when there is none, ready to take shapes in.

    Raises:
        LibraryError: when the name cannot be used or the folder cannot be written.
    """
    return StoredLibrary(library_folder(name), create=True)


def open_library(name: str, *, anew: bool = False) -> ShapeLibrary:
    """A library by name.

    Args:
        name: `built-in`; the name or the path of a stored library; or several joined by `+` (`built-in+mine`), of which
            the first wins where two shapes share an id.
        anew: With nothing in memory yet, for those who care what is on disk.

    Raises:
        LibraryError: when one of them does not exist.
    """
    libraries = [_single(part.strip(), anew) for part in name.split("+")]
    return libraries[0] if len(libraries) == 1 else CombinedLibrary(libraries)


def _single(name: str, anew: bool) -> ShapeLibrary:
    if name == BUILT_IN:
        # Takes a moment, so only when it is asked for.
        from diorama_core.library.catalogue import built_in_library, default_cache_dir

        return built_in_library(default_cache_dir() if anew else None)
    folder = library_folder(name)
    if not (folder / "library.sqlite").exists():
        known = ", ".join((BUILT_IN, *list_libraries()))
        raise LibraryError(f"there is no library {name!r}; available: {known}")
    return StoredLibrary(folder)
