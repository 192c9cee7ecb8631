from __future__ import annotations

import pytest

from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.small_rooms import Room


@pytest.fixture
def room() -> Room:
    """A room without objects."""
    return Room(box_library())
