"""Small pictures of shapes, made once: kept in memory and, by content, on disk."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

from PIL import Image, ImageDraw

from diorama_core.io.cache import LruCache
from diorama_core.io.derived import derive
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary, record_of
from diorama_core.progress import SILENT, Progress
from diorama_core.render.appearance import Paint
from diorama_core.render.views import PAGE, render_shape

CAPTION_PX = 18
INK = (60, 60, 60)
_CACHE: LruCache[str, bytes] = LruCache(2048)
_VERSION = 1
"""Raise it when the picture of the same shape changes: the light, the view, the background."""


def thumbnail(
    library: ShapeLibrary, shape_id: str, size: int = 160, folder: Path | None = None, *, paint: Paint = (None, None)
) -> bytes:
    """A square PNG of a shape on a transparent background.

    Made once per content and size; shapes without a content hash are not written to disk.

    Args:
        library: Where the shape is.
        shape_id: Which shape; `LibraryError` when unknown.
        size: Side in pixels.
        folder: Where pictures are kept; by default `thumbnails` in the cache folder.
        paint: Overrides of the main material: colour (sRGB) and finish; painted pictures are kept in memory only.
    """
    shape = record_of(library, shape_id)
    if not shape.content_hash or paint != (None, None):
        return _CACHE.get(f"{id(library)} {shape_id} {size} {paint}", lambda: _render(library, shape_id, size, paint))
    name = f"{shape.content_hash}-{_VERSION}-{size}.png"
    path = (folder or default_cache_dir() / "thumbnails") / name
    return _CACHE.get(name, lambda: derive(path, lambda: _render(library, shape_id, size), _whole_png))


def _whole_png(data: bytes) -> bytes:
    """The bytes; raises `ValueError` when they are not all of a PNG."""
    if not (data.startswith(b"\x89PNG\r\n\x1a\n") and data.endswith(b"IEND\xaeB`\x82")):
        raise ValueError("it is no whole PNG")
    return data


def shape_sheet(
    library: ShapeLibrary, shapes: Sequence[Shape], size: int = 240, columns: int = 6, progress: Progress = SILENT
) -> Image.Image:
    """A page with every shape's picture, taken from the kept ones or rendered now, over its id and size.

    Args:
        library: Where the shapes are.
        shapes: What to show, in order.
        size: Side of one picture in pixels.
        columns: Pictures side by side.
        progress: Reports and cancellation.
    """
    rows = max(-(-len(shapes) // columns), 1)
    page = Image.new("RGB", (columns * size, rows * (size + CAPTION_PX)), PAGE)
    draw = ImageDraw.Draw(page)
    for number, shape in enumerate(shapes):
        progress.report(number / len(shapes), f"pictures: {number} of {len(shapes)}")
        left, top = (number % columns) * size, (number // columns) * (size + CAPTION_PX)
        picture = Image.open(io.BytesIO(thumbnail(library, shape.id, size)), formats=("PNG",)).convert("RGBA")
        page.paste(picture, (left, top), picture)
        x, y, z = shape.size_m
        words = f"{shape.id}  {x:.2f} x {y:.2f} x {z:.2f}"
        draw.text((left + 4, top + size + 2), _fit(draw, words, size - 8), fill=INK)
    return page


def _fit(draw: ImageDraw.ImageDraw, words: str, width_px: int) -> str:
    """The words, or as many of their letters as fit."""
    while words and draw.textlength(words) > width_px:
        words = words[:-1]
    return words.rstrip()


def _render(library: ShapeLibrary, shape_id: str, size: int, paint: Paint = (None, None)) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(render_shape(library, shape_id, (size, size), paint=paint)).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()
