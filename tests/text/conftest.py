"""The rooms that most tests of edits by words begin with."""

from __future__ import annotations

import pytest

from diorama_core.scene.types import Scene
from tests.text.edited import dining_room, living_room


@pytest.fixture(scope="session")
def living() -> Scene:
    return living_room()


@pytest.fixture(scope="session")
def dining() -> Scene:
    """A table on a rug with five chairs."""
    return dining_room()
