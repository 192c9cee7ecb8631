"""Likely names for a box that was drawn, from the recogniser that comes with Diorama."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable

import numpy as np

from diorama_core.artefacts import Box, Photo
from diorama_core.errors import UnavailableError
from diorama_core.io.cache import LruCache
from diorama_core.models.own_weights import has_own_recogniser

log = logging.getLogger(__name__)

COUNT = 4
MAX_BOXES = 200
"""Boxes whose names are remembered."""


class Suggestions:
    """Names by photo and box, worked out in the background.

    Args:
        on_ready: called from a thread when names that were asked for are there.
    """

    def __init__(self, on_ready: Callable[[], None]) -> None:
        self._on_ready = on_ready
        self._known: LruCache[tuple[int, Box], tuple[str, ...]] = LruCache(MAX_BOXES)
        self._asked: set[tuple[int, Box]] = set()

    def of(self, photo: Photo, box: Box) -> tuple[str, ...]:
        """The likeliest names, best first; nothing yet where they are still worked out."""
        key = (id(photo.rgb), box)
        known = self._known.find(key)
        if known is not None:
            return known
        if key not in self._asked and has_own_recogniser():
            self._asked.add(key)
            threading.Thread(target=self._work_out, args=(key, photo, box), daemon=True, name="suggestions").start()
        return ()

    def _work_out(self, key: tuple[int, Box], photo: Photo, box: Box) -> None:
        from diorama_core.models.recogniser import own_recogniser
        from diorama_core.perception.foundation.proposals import names_of

        def names() -> tuple[str, ...]:
            return names_of(own_recogniser(), photo, np.array([box], dtype=float))[0][:COUNT]

        try:
            self._known.get(key, names)
        except UnavailableError as error:
            log.warning("no names are suggested: %s", error)
            return  # still among those asked for, so that it is not tried again at every redraw
        self._asked.discard(key)
        self._on_ready()
