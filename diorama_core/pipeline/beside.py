"""Work beside a build: the processes that share it, and what a later stage needs, loaded while earlier ones leave a
processor idle.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from threading import Event, Thread
from typing import Protocol, runtime_checkable

from diorama_core.artefacts import LabelledBox
from diorama_core.errors import DioramaError
from diorama_core.processes import prepare


def prepare_processes() -> None:
    """Start them, unless they are there: what they need loads while the first stages leave a processor idle."""
    prepare(_load)


def _load() -> None:
    """Load what the work given to them needs."""
    import diorama_core.appearance.photo_appearance
    import diorama_core.pose.made_to_measure  # noqa: F401
    from diorama_core.io.large_libraries import load_open3d

    load_open3d()


log = logging.getLogger(__name__)


@runtime_checkable
class LooksAhead(Protocol):
    """A stage that can load things before its turn; its result does not depend on whether it did."""

    def ahead(self, boxes: Sequence[LabelledBox]) -> Iterator[None]:
        """Load what these objects will need, one step at a time."""
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
