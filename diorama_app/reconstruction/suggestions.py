"""Likely boxes of a photo and likely names of a box, from the recogniser that comes with Diorama."""

from __future__ import annotations

import logging
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from diorama_core.artefacts import Box, LabelledBox, Photo
from diorama_core.errors import UnavailableError
from diorama_core.models.boxes import Detections
from diorama_core.models.own_weights import has_own_recogniser

log = logging.getLogger(__name__)

COUNT = 4
"""Names that are suggested for a box."""


class Suggestions:
    """What one photo shows, worked out in the background.

    Args:
        photo: the photo.
        on_ready: called from a thread when something that was asked for is there.
    """

    def __init__(self, photo: Photo, on_ready: Callable[[], None]) -> None:
        self.photo = photo
        self._on_ready = on_ready
        self._names: dict[Box, tuple[str, ...]] = {}
        self._boxes: tuple[LabelledBox, ...] | None = None
        self._faint: Detections | None = None
        self._asked: set[Box | None] = set()
        self._worker = ThreadPoolExecutor(1, "suggestions")

    def names(self, box: Box) -> tuple[str, ...]:
        """The likeliest names of a box, best first; nothing yet where they are still worked out."""
        if box not in self._names:
            self._ask(box, lambda: self._named(box))
        return self._names.get(box, ())

    def boxes(self) -> tuple[LabelledBox, ...]:
        """Likely objects with their names, best first; nothing yet where they are still worked out."""
        if self._boxes is None:
            self._ask(None, self._proposed)
        return self._boxes or ()

    def at(self, x: float, y: float, then: Callable[[LabelledBox | None], None]) -> None:
        """Tell what somebody means who clicks on a pixel of the photo.

        Args:
            x: column of the pixel.
            y: row of the pixel.
            then: told the box, with its likeliest name, or None where nothing is recognised; called from a thread.
        """

        def tell() -> None:
            try:
                then(self._clicked(x, y))
            except UnavailableError as error:
                log.warning("nothing is suggested: %s", error)
                then(None)

        self._worker.submit(tell)

    def _ask(self, key: Box | None, work_out: Callable[[], object]) -> None:
        """Work something out once; what cannot be had is not tried again at every redraw."""
        if key in self._asked or not has_own_recogniser():
            return
        self._asked.add(key)

        def work() -> None:
            try:
                work_out()
            except UnavailableError as error:
                log.warning("nothing is suggested: %s", error)
                return
            self._on_ready()

        self._worker.submit(work)

    def _named(self, box: Box) -> tuple[str, ...]:
        from diorama_core.models.recogniser import own_recogniser
        from diorama_core.perception.foundation.proposals import names_of

        if box not in self._names:
            self._names[box] = names_of(own_recogniser(), self.photo, np.array([box], dtype=float))[0][:COUNT]
        return self._names[box]

    def _proposed(self) -> None:
        from diorama_core.models.recogniser import own_recogniser
        from diorama_core.perception.foundation.proposals import LIKELY, OwnDetection
        from diorama_core.progress import Progress

        self._boxes = OwnDetection(own_recogniser(), LIKELY).detect(self.photo, (), Progress())

    def _clicked(self, x: float, y: float) -> LabelledBox | None:
        from diorama_core.models.recogniser import own_recogniser
        from diorama_core.perception.foundation.proposals import FAINT, MOST_FAINT, clicked_box

        if not has_own_recogniser():
            return None
        if self._faint is None:
            self._faint = own_recogniser().propose(self.photo.rgb, FAINT, MOST_FAINT)
        box = clicked_box(self._faint, x, y)
        if box is None:
            return None
        name = self._named(box)[0]
        return LabelledBox(box, name, name)
