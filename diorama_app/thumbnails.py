"""Small pictures of shapes, rendered in the background and kept."""

from __future__ import annotations

import base64
import logging
import queue
import threading
import time
from collections import OrderedDict
from collections.abc import Callable

from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Finish

log = logging.getLogger(__name__)

Paint = tuple[tuple[float, float, float] | None, Finish | None]
"""Overrides of colour (sRGB, 0 to 1) and finish."""

OWN: Paint = (None, None)
Picture = tuple[str, Paint]
"""Shape, and how it is painted."""

SIDE_PX = 112
KEPT = 1024
"""The oldest pictures are forgotten beyond so many; who asks again gets them again."""

PAINTED_WAIT_S = 0.1
"""Pictures in another colour are not urgent: what a person does just now goes before them."""
TELL_EVERY_S = 0.25
BLANK = '<span class="blank"></span>'


class Thumbnails:
    """Asks for a picture return at once: an `<img>` when it is there, a blank until then."""

    def __init__(self, library: ShapeLibrary, on_ready: Callable[[], None]) -> None:
        self._library = library
        self._on_ready = on_ready
        self._images: OrderedDict[Picture, str] = OrderedDict()
        self._asked: set[Picture] = set()
        self._queue: queue.LifoQueue[Picture | None] = queue.LifoQueue()
        self._stopping = False
        self._thread: threading.Thread | None = None

    def html(self, shape_id: str, paint: Paint = OWN) -> str:
        """HTML of the shape's picture, painted or in its own colours. Called from the desk.

        While a painted one is made, the shape's own is shown where that is there.
        """
        picture = (shape_id, paint)
        known = self._images.get(picture)
        if known is not None:
            return known
        if picture not in self._asked:
            self._asked.add(picture)
            self._queue.put(picture)
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, daemon=True, name="thumbnails")
                self._thread.start()
        return self._images.get((shape_id, OWN), BLANK)

    def stop(self) -> None:
        """End the thread."""
        self._stopping = True
        self._queue.put(None)

    def _work(self) -> None:
        from diorama_core.render.thumbnails import thumbnail  # only once pictures are asked for

        told = time.monotonic()
        while not self._stopping:
            asked = self._queue.get()
            if asked is None:
                return
            shape_id, paint = asked
            if paint != OWN:
                time.sleep(PAINTED_WAIT_S)
            try:
                picture = thumbnail(self._library, shape_id, size=SIDE_PX, paint=paint)
            except Exception:
                log.exception("no thumbnail of %s", shape_id)
                self._images[asked] = BLANK
                continue
            while len(self._images) >= KEPT:
                self._asked.discard(self._images.popitem(last=False)[0])
            self._images[asked] = f'<img alt="" src="{_data_uri(picture)}">'
            if time.monotonic() - told > TELL_EVERY_S or self._queue.empty():
                told = time.monotonic()
                self._on_ready()


def _data_uri(png: bytes) -> str:
    return "data:image/png;base64," + base64.b64encode(png).decode()
