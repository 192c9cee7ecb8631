"""Pose templates by the content of their shapes: rendered when first asked for, then read back from disk."""

from __future__ import annotations

import os
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import UInt8, UInt16

from diorama_core.errors import InputError
from diorama_core.io.cache import LruCache
from diorama_core.io.derived import read_arrays, write_arrays
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.progress import SILENT, Progress
from diorama_core.render.templates import PAPER_GRID, TemplateGrid, Templates, render_templates

_FORMAT = "1"
"""Raised when what is rendered or how it is kept changes."""
_PNG = [cv2.IMWRITE_PNG_COMPRESSION, 1]


class TemplateCache:
    """Templates of the shapes that were asked for; safe to share between threads and processes.

    A shape's 180 views take some two megabytes on disk and forty in memory, so only the last few are cached there, and
    the oldest files go when the folder grows beyond its limit. A folder that cannot be written only costs time.

    Args:
        folder: Where files are kept; `templates` in the cache folder by default.
        cached: Shapes cached in memory.
        limit_bytes: Of all files together; by default four gigabytes, or `DIORAMA_TEMPLATES_GB`.
    """

    def __init__(self, folder: Path | None = None, *, cached: int = 8, limit_bytes: int | None = None) -> None:
        self.folder = folder or default_cache_dir() / "templates"
        self._limit_bytes = _default_limit() if limit_bytes is None else limit_bytes
        self._cached: LruCache[str, Templates] = LruCache(cached)

    def get(
        self, library: ShapeLibrary, shape: Shape, grid: TemplateGrid = PAPER_GRID, progress: Progress = SILENT
    ) -> Templates:
        """The views of one shape: from memory, from its file, or rendered now (by one thread; others wait for it).

        A shape without a content hash is rendered anew each time.

        Args:
            library: Where shapes come from.
            shape: Of the library.
            grid: Of views.
            progress: Reports and cancellation.

        Raises:
            LibraryError: when the shape is unknown or has no surface.
            Cancelled: on request.
        """
        if not shape.content_hash:
            return render_templates(library.mesh(shape.id), grid, progress)
        name = _name(shape, grid)

        def read_or_rendered() -> Templates:
            templates = self._read(name, grid)
            if templates is None:
                templates = render_templates(library.mesh(shape.id), grid, progress)
                self._write(name, templates)
            return templates

        return self._cached.get(name, read_or_rendered)

    def has(self, shape: Shape, grid: TemplateGrid = PAPER_GRID) -> bool:
        """Whether the views of a shape are on disk."""
        return (self.folder / _name(shape, grid)).exists()

    def _read(self, name: str, grid: TemplateGrid) -> Templates | None:
        arrays = read_arrays(self.folder / name, "centre", "size", "depth", "normals", mark_use=True)
        if arrays is None:
            return None
        centre, size, depth, normals = arrays
        try:
            return Templates(grid, centre, size, _planes(depth, grid), _planes(normals, grid))
        except (ValueError, cv2.error):
            return None  # damaged: it is rendered again

    def _write(self, name: str, templates: Templates) -> None:
        arrays = {
            "centre": templates.centre_object,
            "size": templates.size_m,
            "depth": _png(templates.depth_codes),
            "normals": _png(templates.normal_codes),
        }
        write_arrays(self.folder / name, arrays, limit_bytes=self._limit_bytes)


def _name(shape: Shape, grid: TemplateGrid) -> str:
    return f"{shape.content_hash}-{grid.key}.{_FORMAT}.npz"


def _default_limit() -> int:
    asked = os.environ.get("DIORAMA_TEMPLATES_GB", "4")
    try:
        return int(float(asked) * 2**30)
    except ValueError:
        raise InputError(f"DIORAMA_TEMPLATES_GB is {asked!r}; give a number of gigabytes") from None


def _png(codes: UInt16[np.ndarray, "v h w"]) -> UInt8[np.ndarray, "n"]:
    """All views, one below the other, as one picture."""
    return cv2.imencode(".png", codes.reshape(-1, codes.shape[-1]), _PNG)[1]


def _planes(png: UInt8[np.ndarray, "n"], grid: TemplateGrid) -> UInt16[np.ndarray, "v h w"]:
    """Undo `_png`; raises `ValueError` when the picture is not of this grid."""
    picture = cv2.imdecode(png, cv2.IMREAD_UNCHANGED)
    if picture is None:
        raise ValueError("damaged picture")
    return picture.reshape(len(grid), grid.size_px, grid.size_px)
