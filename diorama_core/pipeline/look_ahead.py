"""Loading what a later stage will need, while the stages before it leave a processor idle."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from threading import Event, Thread
from typing import Protocol, runtime_checkable

from diorama_core.artefacts import LabelledBox
from diorama_core.errors import DioramaError

log = logging.getLogger(__name__)


@runtime_checkable
class LooksAhead(Protocol):
    """A stage that can load things before its turn; its result does not depend on whether it did."""

    def ahead(self, boxes: Sequence[LabelledBox]) -> Iterator[None]:
        """Load what these objects will need, one step at a time.

        Args:
            boxes: what was marked in the photo.
        """
        ...


@contextmanager
def looking_ahead(stage: object, boxes: Sequence[LabelledBox]) -> Iterator[None]:
    """While it lasts, a thread loads what the stage will need; it ends after the step that it is at.

    What cannot be loaded is left to the stage, which says what is wrong with it.
    """
    if not isinstance(stage, LooksAhead):
        yield
        return
    steps, over = stage.ahead(boxes), Event()

    def load() -> None:
        try:
            for _ in steps:
                if over.is_set():
                    return
        except DioramaError as error:
            log.debug("not loaded ahead: %s", error)

    thread = Thread(target=load, name="look-ahead")
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()
