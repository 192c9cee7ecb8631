from __future__ import annotations

import time

import pytest

from diorama_app.session.shape_preparation import Preparer
from diorama_core.errors import LibraryError
from tests.app.small_room import PlainLibrary


class Counting(PlainLibrary):
    """Remembers what was asked of it; `broken` cannot be read."""

    def __init__(self) -> None:
        self.asked: list[str] = []

    def shape(self, shape_id: str):
        self.asked.append(shape_id)
        if shape_id == "broken":
            raise LibraryError("broken")
        return super().shape(shape_id)


def wait_for(preparer: Preparer, *ids: str) -> bool:
    end = time.monotonic() + 20.0
    while not preparer.ready(ids) and time.monotonic() < end:
        time.sleep(0.01)
    return preparer.ready(ids)


@pytest.fixture
def library() -> Counting:
    return Counting()


def test_shapes_become_ready_once_each_and_a_broken_one_stops_nothing(library: Counting) -> None:
    preparer = Preparer(library)
    assert preparer.ready([])
    assert not preparer.ready(["chair_a"])
    preparer.want(["broken", "chair_a", "chair_a"])
    preparer.want(["chair_a", "lamp_a"])
    assert wait_for(preparer, "chair_a", "lamp_a")
    assert not preparer.ready(["broken"])
    assert sorted(library.asked) == ["broken", "chair_a", "lamp_a"]
    preparer.stop()
    preparer._thread.join(5.0)
    assert not preparer._thread.is_alive()
