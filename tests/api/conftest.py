from __future__ import annotations

import pytest

import diorama_core as diorama
from tests.cli.room_photo import BOXES, room_picture
from tests.few_shapes import stored_seats


@pytest.fixture(scope="session")
def room() -> diorama.Reconstruction:
    """A room built in memory from arrays, of few shapes."""
    return diorama.build(room_picture(), boxes=BOXES, profile="embedded", library=stored_seats())
