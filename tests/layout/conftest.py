from __future__ import annotations

import pytest

from diorama_core.synthesis.layout_rooms import BoxLibrary, box_library
from tests.layout.small_rooms import Room


@pytest.fixture(scope="session")
def library() -> BoxLibrary:
    return box_library()


@pytest.fixture
def room(library: BoxLibrary) -> Room:
    return Room(library)
