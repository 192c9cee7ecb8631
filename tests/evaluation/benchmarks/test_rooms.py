from __future__ import annotations

import json

import numpy as np
import pytest

from diorama_core.evaluation.benchmarks.rooms import (
    SHEET_COLUMNS,
    THUMBNAIL,
    RoomsBench,
    rooms_table,
    sheet,
    views_table,
)
from diorama_core.synthesis.survey import RoomSurvey, ViewSurvey


def made(kind, **given):
    """A survey with plausible values for the fields that a test does not state."""
    defaults = {"int": 3, "float": 0.2, "str": "box"}
    values = {name: defaults.get(str(t).split("[")[0], ()) for name, t in kind.__annotations__.items()}
    return kind(**(values | given))


@pytest.fixture
def rooms() -> tuple[RoomSurvey, ...]:
    return (
        made(RoomSurvey, name="a", objects=10, depth=2, outline="box", collisions=(("x", "y"),), outside=()),
        made(RoomSurvey, name="b", objects=20, depth=3, outline="attic", collisions=(), outside=("z",)),
        made(RoomSurvey, name="c", objects=12, depth=2, outline="box", collisions=(), outside=()),
    )


@pytest.fixture
def views() -> tuple[ViewSurvey, ...]:
    good = made(ViewSurvey, name="good", asked=12, floor=0.2, largest=0.2, near=0.0, walls=3)
    return good, made(ViewSurvey, name="bad", asked=0, floor=0.0, largest=0.9, walls=1)


def test_rooms_are_counted(rooms) -> None:
    row = rooms_table(rooms).row("rooms")
    assert row["rooms"] == 3
    assert row["objects"] == "10 to 20, mean 14"
    assert row["outlines"] == "attic: 1, box: 2"
    assert (row["colliding pairs"], row["outside"]) == (1, 1)
    assert rooms_table(()).row("rooms")["objects"] == ""


def test_pictures_are_counted_and_the_faulty_named(rooms, views) -> None:
    row = views_table(views).row("pictures")
    assert row["pictures"] == 2
    assert row["objects asked for"] == "0 / 6 / 12"
    assert row["faulty"] == 1
    bench = RoomsBench(0, rooms, views)
    assert [name for name, _ in bench.faulty_views] == ["bad"]
    data = json.loads(json.dumps(bench.to_json()))
    assert [r["name"] for r in data["rooms"]] == ["a", "b", "c"]
    assert data["faulty_views"][0]["faults"]


def test_a_sheet_has_every_picture_in_rows() -> None:
    pictures = [np.full((THUMBNAIL[1], THUMBNAIL[0], 3), k * 10, np.uint8) for k in range(SHEET_COLUMNS + 1)]
    found = sheet(pictures, [f"p{k}" for k in range(len(pictures))])
    assert found.shape == (2 * THUMBNAIL[1], SHEET_COLUMNS * THUMBNAIL[0], 3)
    assert (found[THUMBNAIL[1] - 1, THUMBNAIL[0] + 5] == 10).all()
    assert (found[-1, -1] == 255).all()
    assert pictures[3].max() == 30, "names are written on copies"
