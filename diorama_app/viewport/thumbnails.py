"""Thumbnails of shapes: panels reference them, the browser fetches those that it shows."""

from __future__ import annotations

import hashlib
import logging
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor

from diorama_app.web.requests import PICTURES
from diorama_core.errors import DioramaError
from diorama_core.io.cache import LruCache
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.user_library import ShapeRecords
from diorama_core.scene.types import Finish

log = logging.getLogger(__name__)

Paint = tuple[tuple[float, float, float] | None, Finish | None]
"""Overrides of colour (sRGB, 0 to 1) and finish."""

OWN: Paint = (None, None)

SIDE_PX = 112
CACHE_SIZE = 1024
"""The oldest names of painted shapes are forgotten beyond so many."""

PAINTED_WAIT_S = 0.1
"""Pictures in another colour are not urgent: what a person does just now goes before them."""


class Thumbnails:
    """Hands out `<img>` elements at once and makes the pictures when a browser asks for them. Safe between threads."""

    def __init__(self, library: ShapeLibrary, records: ShapeRecords) -> None:
        self._library = library
        self._records = records
        self._own: dict[str, str] = {}
        self._painted: LruCache[str, tuple[str, Paint]] = LruCache(CACHE_SIZE)
        self._others: LruCache[str, Callable[[], bytes | None]] = LruCache(CACHE_SIZE)
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="thumbnails")

    def html(self, shape_id: str, paint: Paint = OWN) -> str:
        """HTML of the shape's picture, painted or in its own colours."""
        try:
            content = self._records.shape(shape_id).content_hash
        except DioramaError:
            return '<span class="blank"></span>'
        name = hashlib.sha256(f"{shape_id} {content} {paint}".encode()).hexdigest()[:20]
        if paint == OWN:
            self._own[name] = shape_id
        else:
            self._painted.get(name, lambda: (shape_id, paint))
        return f'<img alt="" loading="lazy" src="{PICTURES}{name}.png">'

    def picture_html(self, what: str, draw: Callable[[], bytes | None]) -> str:
        """HTML of a picture that is no shape's, drawn when a browser asks for it.

        Args:
            what: tells the picture from all others.
            draw: gives it as PNG; called on the thread that makes pictures.
        """
        name = hashlib.sha256(what.encode()).hexdigest()[:20]
        self._others.get(name, lambda: draw)
        return f'<img alt="" loading="lazy" src="{PICTURES}{name}.png">'

    def knows(self, name: str) -> bool:
        """Whether a page was given a picture of this name."""
        name = name.removesuffix(".png")
        return name in self._own or self._others.find(name) is not None or self._painted.find(name) is not None

    def png(self, name: str) -> Future[bytes | None]:
        """The picture called so, made beside everything else; None where there is none."""
        name = name.removesuffix(".png")
        draw = self._others.find(name)
        if draw is not None:
            return self._worker.submit(_png_or_none, draw)
        asked = (self._own[name], OWN) if name in self._own else self._painted.find(name)
        if asked is None:
            nothing: Future[bytes | None] = Future()
            nothing.set_result(None)
            return nothing
        return self._worker.submit(self._make, *asked)

    def stop(self) -> None:
        """End the thread; pictures that wait are not made."""
        self._worker.shutdown(wait=False, cancel_futures=True)

    def _make(self, shape_id: str, paint: Paint) -> bytes | None:
        from diorama_core.render.thumbnails import thumbnail  # only once pictures are asked for

        if paint != OWN:
            time.sleep(PAINTED_WAIT_S)
        return _png_or_none(lambda: thumbnail(self._library, shape_id, size=SIDE_PX, paint=paint))


def _png_or_none(draw: Callable[[], bytes | None]) -> bytes | None:
    try:
        return draw()
    except Exception:  # one picture is missing then; the page shows the name instead
        log.exception("a small picture could not be drawn")
        return None
