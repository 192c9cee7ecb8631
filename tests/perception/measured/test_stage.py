from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.taxonomy import category
from diorama_core.perception.measured.boxes import TurnedExtent
from diorama_core.perception.measured.stage import extend_to_supporters
from diorama_core.scene.types import Support


def at(x: float, bottom: float, size) -> TurnedExtent:
    half = np.array([size[0] / 2, size[1] / 2])
    return TurnedExtent(
        0.0, np.array([x - half[0], 3 - half[1], bottom]), np.array([x + half[0], 3 + half[1], bottom + size[2]])
    )


EXTENTS = {
    "table": at(0.0, 0.0, (0.9, 1.6, 0.75)),
    "lamp": at(0.2, 0.8, (0.3, 0.3, 0.5)),
    "sofa": at(3.0, 0.05, (0.9, 2.0, 0.85)),
    "pillow": at(3.0, 0.5, (0.4, 0.4, 0.2)),
    "picture": at(-2.0, 1.4, (0.05, 0.6, 0.5)),
    "pendant": at(0.0, 2.1, (0.4, 0.4, 0.4)),
    "chair": at(-1.0, 0.1, (0.5, 0.5, 0.9)),
}
NAMES = {"pendant": "ceiling lamp"}
CATEGORIES = {key: category(NAMES.get(key, key)) for key in EXTENTS}
EDGES = (
    *(Support(key, "floor") for key in ("table", "sofa", "chair")),
    *(Support("lamp", "table"), Support("pillow", "sofa")),
    *(Support("picture", "wall", "mounted on"), Support("pendant", "ceiling", "mounted on")),
)


def test_boxes_reach_down_to_what_holds_them() -> None:
    boxes = extend_to_supporters(EXTENTS, CATEGORIES, EDGES)
    assert boxes["sofa"].low[2] == boxes["chair"].low[2] == 0.0
    assert boxes["lamp"].low[2] == EXTENTS["table"].high[2]
    assert boxes["pillow"].low[2] == pytest.approx(CATEGORIES["sofa"].seat_height_m)
    assert boxes["picture"].low[2] == 1.4
    assert boxes["lamp"].high[2] == EXTENTS["lamp"].high[2]
    flat = extend_to_supporters({"table": at(0, -0.3, (1, 1, 0.1))}, CATEGORIES, (Support("table", "floor"),))
    assert flat["table"].high[2] == pytest.approx(0.02)


def test_what_people_put_on_furniture_stays_where_it_was_seen_where_nothing_is_marked_below() -> None:
    extents = {"tray": at(0.0, 0.73, (0.36, 0.36, 0.04)), "cup": at(2.0, 0.1, (0.08, 0.08, 0.1))}
    names = {key: category(key) for key in extents}
    boxes = extend_to_supporters(extents, names, tuple(Support(key, "floor") for key in extents))
    assert boxes["tray"].low[2] == pytest.approx(0.73)
    assert boxes["cup"].low[2] == 0.0
