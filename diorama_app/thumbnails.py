"""Small pictures of shapes, rendered in the background and kept."""

from __future__ import annotations

import base64
import logging
import queue
import threading
import time
from collections.abc import Callable

from diorama_core.library.record import ShapeLibrary

log = logging.getLogger(__name__)

SIDE_PX = 112
TELL_EVERY_S = 0.25
BLANK = '<span class="blank"></span>'


class Thumbnails:
    """Asks for a picture return at once: an `<img>` when it is there, a blank until then."""

    def __init__(self, library: ShapeLibrary, on_ready: Callable[[], None]) -> None:
        self._library = library
        self._on_ready = on_ready
        self._images: dict[str, str] = {}
        self._asked: set[str] = set()
        self._queue: queue.LifoQueue[str | None] = queue.LifoQueue()
        self._stopping = False
        self._thread: threading.Thread | None = None

    def html(self, shape_id: str) -> str:
        """HTML of the shape's picture. Called from the desk."""
        if shape_id in self._images:
            return self._images[shape_id]
        if shape_id not in self._asked:
            self._asked.add(shape_id)
            self._queue.put(shape_id)
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, daemon=True, name="thumbnails")
                self._thread.start()
        return BLANK

    def stop(self) -> None:
        """End the thread."""
        self._stopping = True
        self._queue.put(None)

    def _work(self) -> None:
        from diorama_core.render.thumbnails import thumbnail  # only once pictures are asked for

        told = time.monotonic()
        while not self._stopping:
            shape_id = self._queue.get()
            if shape_id is None:
                return
            try:
                picture = thumbnail(self._library, shape_id, size=SIDE_PX)
            except Exception:
                log.exception("no thumbnail of %s", shape_id)
                self._images[shape_id] = BLANK
                continue
            self._images[shape_id] = f'<img alt="" src="{_data_uri(picture)}">'
            if time.monotonic() - told > TELL_EVERY_S or self._queue.empty():
                told = time.monotonic()
                self._on_ready()


def _data_uri(png: bytes) -> str:
    return "data:image/png;base64," + base64.b64encode(png).decode()
