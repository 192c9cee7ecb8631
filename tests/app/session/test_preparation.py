from __future__ import annotations

import pytest

from diorama_app.session.preparation import Preparer
from diorama_core.errors import LibraryError
from tests.app.small_room import PlainLibrary
from tests.waiting import until


class Counting(PlainLibrary):
    """Remembers what was asked of it; `broken` cannot be read."""

    def __init__(self) -> None:
        self.asked: list[str] = []

    def shape(self, shape_id: str):
        self.asked.append(shape_id)
        if shape_id == "broken":
            raise LibraryError("broken")
        return super().shape(shape_id)


@pytest.fixture
def library() -> Counting:
    return Counting()


def test_shapes_become_ready_once_each_and_a_broken_one_stops_nothing(library: Counting) -> None:
    preparer = Preparer(library)
    assert preparer.ready([])
    assert not preparer.ready(["chair_a"])
    preparer.want(["broken", "chair_a", "chair_a"])
    preparer.want(["chair_a", "lamp_a"])
    until(lambda: preparer.ready(["chair_a", "lamp_a"]))
    assert not preparer.ready(["broken"])
    assert sorted(library.asked) == ["broken", "chair_a", "lamp_a"]
    preparer.stop()
    preparer._thread.join(60.0)
    assert not preparer._thread.is_alive()
