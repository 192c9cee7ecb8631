from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.taxonomy import category
from diorama_core.perception.measured.boxes import TurnedExtent
from diorama_core.perception.measured.stage import grounded, resting_heights, supporters
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


def found(**changed: TurnedExtent) -> dict[str, Support]:
    return {s.child: s for s in supporters(EXTENTS | changed, CATEGORIES)}


def test_every_object_is_held_by_what_it_touches() -> None:
    edges = found()
    assert {k: (e.parent, e.relation) for k, e in edges.items()} == {
        "table": ("floor", "placed on"),
        "lamp": ("table", "placed on"),
        "sofa": ("floor", "placed on"),
        "pillow": ("sofa", "placed on"),
        "picture": ("wall", "mounted on"),
        "pendant": ("ceiling", "mounted on"),
        "chair": ("floor", "placed on"),
    }


def test_beside_or_far_above_a_table_nothing_rests_on_it() -> None:
    assert found(lamp=at(0.7, 0.8, (0.3, 0.3, 0.5)))["lamp"].parent == "floor"
    assert found(lamp=at(0.2, 1.6, (0.3, 0.3, 0.5)))["lamp"].parent == "floor"


def test_a_larger_object_never_rests_on_a_smaller_one_so_there_is_no_cycle() -> None:
    edges = found(table=at(0.2, 0.9, (0.9, 1.6, 0.75)))
    for key in edges:
        trail = [key]
        while trail[-1] in edges:
            trail.append(edges[trail[-1]].parent)
            assert len(trail) <= len(edges) + 1, trail


def test_a_picture_that_stands_on_the_floor_is_still_the_walls() -> None:
    assert found(picture=at(-2.0, 0.0, (0.05, 0.6, 0.5)))["picture"].parent == "wall"


def test_objects_lie_on_tops_and_seats() -> None:
    sofa = CATEGORIES["sofa"]
    assert resting_heights(EXTENTS["sofa"], sofa) == pytest.approx([0.9, sofa.seat_height_m])
    assert resting_heights(at(0, 0, (0.9, 2, 0.3)), sofa) == pytest.approx([0.3])


def test_boxes_reach_down_to_what_holds_them() -> None:
    boxes = grounded(EXTENTS, CATEGORIES, supporters(EXTENTS, CATEGORIES))
    assert boxes["sofa"].low[2] == boxes["chair"].low[2] == 0.0
    assert boxes["lamp"].low[2] == EXTENTS["table"].high[2]
    assert boxes["pillow"].low[2] == pytest.approx(CATEGORIES["sofa"].seat_height_m)
    assert boxes["picture"].low[2] == 1.4
    assert boxes["lamp"].high[2] == EXTENTS["lamp"].high[2]
    flat = grounded({"table": at(0, -0.3, (1, 1, 0.1))}, CATEGORIES, (Support("table", "floor"),))
    assert flat["table"].high[2] == pytest.approx(0.02)


def test_what_people_put_on_furniture_stays_where_it_was_seen_where_nothing_is_marked_below() -> None:
    extents = {"tray": at(0.0, 0.73, (0.36, 0.36, 0.04)), "cup": at(2.0, 0.1, (0.08, 0.08, 0.1))}
    names = {key: category(key) for key in extents}
    edges = supporters(extents, names)
    assert {e.parent for e in edges} == {"floor"}
    boxes = grounded(extents, names, edges)
    assert boxes["tray"].low[2] == pytest.approx(0.73)
    assert boxes["cup"].low[2] == 0.0
