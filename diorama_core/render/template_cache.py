"""Pose templates by the content of their shapes: rendered when first asked for, then read back from disk."""

from __future__ import annotations

import io
import logging
import os
import tempfile
import threading
import zipfile
from collections import OrderedDict
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import UInt8, UInt16

from diorama_core.errors import InputError
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.render.templates import PAPER_GRID, TemplateGrid, Templates, render_templates

log = logging.getLogger(__name__)

_FORMAT = "1"
"""Raised when what is rendered or how it is kept changes."""
_PNG = [cv2.IMWRITE_PNG_COMPRESSION, 1]


class TemplateCache:
    """Templates of the shapes that were asked for; safe to share between threads and processes.

    A shape's 180 views take some two megabytes on disk and forty in memory, so only the last few are held, and the
    oldest files go when the folder grows beyond its limit. A folder that cannot be written only costs time.

    Args:
        folder: Where files are kept; `templates` in the cache folder by default.
        held: Shapes held in memory.
        limit_bytes: Of all files together; by default four gigabytes, or `DIORAMA_TEMPLATES_GB`.
    """

    def __init__(self, folder: Path | None = None, *, cached: int = 8, limit_bytes: int | None = None) -> None:
        self.folder = folder or default_cache_dir() / "templates"
        self._max_cached = cached
        self._limit_bytes = _default_limit() if limit_bytes is None else limit_bytes
        self._cached: OrderedDict[str, Templates] = OrderedDict()
        self._lock = threading.Lock()
        self._making: dict[str, threading.Lock] = {}

    def get(
        self, library: ShapeLibrary, shape: Shape, grid: TemplateGrid = PAPER_GRID, progress: Progress | None = None
    ) -> Templates:
        """The views of one shape: held, read, or rendered now (by one thread; others wait for it).

        A shape without a content hash is rendered anew each time.

        Raises:
            LibraryError: when the shape is unknown or has no surface.
            Cancelled: on request.
        """
        if not shape.content_hash:
            return render_templates(library.mesh(shape.id), grid, progress)
        name = f"{shape.content_hash}-{grid.key}.{_FORMAT}.npz"
        with self._lock:
            making = self._making.setdefault(name, threading.Lock())
        with making:
            found = self._recent(name) or self._read(name, grid)
            if found is None:
                found = render_templates(library.mesh(shape.id), grid, progress)
                self._write(name, found)
            self._cache(name, found)
        return found

    def has(self, shape: Shape, grid: TemplateGrid = PAPER_GRID) -> bool:
        """Whether the views of a shape are on disk."""
        return (self.folder / f"{shape.content_hash}-{grid.key}.{_FORMAT}.npz").exists()

    def _recent(self, name: str) -> Templates | None:
        with self._lock:
            return self._cached.get(name)

    def _cache(self, name: str, templates: Templates) -> None:
        with self._lock:
            self._cached[name] = templates
            self._cached.move_to_end(name)
            while len(self._cached) > self._max_cached:
                self._cached.popitem(last=False)
            self._making.pop(name, None)

    def _read(self, name: str, grid: TemplateGrid) -> Templates | None:
        path = self.folder / name
        try:
            with np.load(path, allow_pickle=False) as data:
                templates = Templates(
                    grid,
                    data["centre"],
                    data["size"],
                    _planes(data["depth"], grid),
                    _planes(data["normals"], grid),
                )
            os.utime(path)  # so that what is used is not the first to go
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, cv2.error):
            return None  # absent, or damaged: it is made again
        return templates

    def _write(self, name: str, templates: Templates) -> None:
        data = io.BytesIO()
        depth, normals = _png(templates.depth_codes), _png(templates.normal_codes)
        np.savez(data, centre=templates.centre_object, size=templates.size_m, depth=depth, normals=normals)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self._make_room(len(data.getvalue()))
            with tempfile.NamedTemporaryFile(dir=self.folder, delete=False) as part:
                part.write(data.getvalue())
            os.chmod(part.name, 0o644)  # the folder may be a cluster's
            os.replace(part.name, self.folder / name)  # so that no reader ever sees half a file
        except OSError as error:
            log.warning("cannot keep templates in %s (%s); they are rendered again each time", self.folder, error)

    def _make_room(self, coming_bytes: int) -> None:
        """Drop the files that were not used for longest until the coming one fits."""
        files = [(e.stat().st_mtime, e.stat().st_size, e.path) for e in os.scandir(self.folder) if e.is_file()]
        excess = sum(size for _, size, _ in files) + coming_bytes - self._limit_bytes
        for _, size, path in sorted(files):
            if excess <= 0:
                return
            Path(path).unlink(missing_ok=True)
            excess -= size


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
