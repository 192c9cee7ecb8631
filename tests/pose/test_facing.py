"""Where things usually face, seen from above."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import Cuboid
from diorama_core.pose.facing import WallSamples, facing_of
from diorama_core.scene.types import Camera, Intrinsics, yaw_rotation

NO_WALLS = WallSamples(np.zeros((0, 2)), np.zeros((0, 2)))
CAMERA = Camera(
    Intrinsics(640, 480, 500.0, 500.0, 320.0, 240.0),
    np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 1.4], [0, 0, 0, 1]]),
)
"""At the origin, looking along +Y."""


def cuboid(name: str, x: float, y: float, size=(0.7, 0.7, 1.8), turn_deg: float = -90.0) -> Cuboid:
    return Cuboid(name, yaw_rotation(np.deg2rad(turn_deg)), np.array([x, y, size[2] / 2]), np.array(size), 1.0)


def best_deg(kind: str, own: Cuboid, others: dict[str, Cuboid], carrier: Cuboid | None = None) -> int:
    """The heading of least cost, of four."""
    kinds = {c.object_id: name for name, c in others.items()} | {own.object_id: kind}
    cuboids = [own, *others.values()]
    found = facing_of(kind, own, cuboids, kinds, CAMERA, NO_WALLS, None, carrier=carrier)
    headings = np.arange(-180, 180, 90)
    cost = found.cost(np.array([yaw_rotation(np.deg2rad(h)) for h in headings]))
    return int(headings[int(cost.argmin())])


def test_storage_at_the_end_of_a_row_faces_as_the_row_does() -> None:
    fridge = cuboid("fridge", 2.0, 3.0)
    counter = cuboid("counter", 2.8, 1.5, (0.6, 2.4, 0.9), 180.0)
    assert best_deg("refrigerator", fridge, {"kitchen counter": counter}) == -180
    assert best_deg("refrigerator", fridge, {"table": counter}) != -180


def test_a_pillow_on_a_sofa_looks_across_its_length() -> None:
    sofa = cuboid("sofa", -2.0, 3.0, (0.9, 2.2, 0.8), 0.0)
    pillow = cuboid("pillow", -2.0, 3.3, (0.24, 0.48, 0.44), 90.0)
    assert best_deg("pillow", pillow, {"sofa": sofa}, sofa) == 0


@pytest.mark.parametrize("shelf_deg", [-90.0, 90.0])
def test_books_show_their_spines_as_their_shelf_its_front(shelf_deg: float) -> None:
    shelf = cuboid("shelf", -2.0, 2.5, (0.3, 1.0, 1.8), shelf_deg)
    books = cuboid("books", -2.0, 2.5, (0.2, 0.3, 0.25), 0.0)
    assert best_deg("books", books, {"bookshelf": shelf}, shelf) == -90
    assert best_deg("books", cuboid("books", 0.2, 2.5, (0.2, 0.3, 0.25)), {}) == -90, "toward the camera elsewhere"


@pytest.mark.parametrize("turn_deg", [0.0, 90.0])
def test_a_front_that_is_known_is_where_objects_face(turn_deg: float) -> None:
    known = replace(cuboid("desk", 0.0, 3.0, turn_deg=turn_deg), front_known=True)
    assert best_deg("desk", known, {}) == int(turn_deg)
