from __future__ import annotations

import pytest

import diorama_core as diorama
from tests.cli.room_photo import BOXES, room_picture


@pytest.fixture(scope="session")
def room() -> diorama.Reconstruction:
    """A room built in memory from arrays."""
    return diorama.build(room_picture(), boxes=BOXES, profile="embedded")
