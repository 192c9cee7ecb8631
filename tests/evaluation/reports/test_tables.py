"""Intervals hold the mean, narrow with more rooms, and need at least two."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.evaluation.reports.tables import Column, Row, Table, bootstrap_interval, paper_rows

TABLE = Table(
    "Pose",
    (Column("mean", better="↑"), Column("failures", "d", "↓"), Column("note")),
    (Row("ours", (0.123456, 3, "ok")), *paper_rows({"theirs": (0.5, None, None)})),
    "A note.",
)


def test_markdown_shows_numbers_as_their_columns_say() -> None:
    assert TABLE.to_markdown().splitlines() == [
        "### Pose",
        "",
        "| | mean ↑ | failures ↓ | note |",
        "|---|---:|---:|---:|",
        "| **ours** | 0.12 | 3 | ok |",
        "| theirs (paper, other dataset) | 0.50 | – | – |",
        "",
        "A note.",
    ]


def test_json_has_the_whole_numbers_and_says_whose_they_are() -> None:
    data = json.loads(json.dumps(TABLE.to_json()))
    ours = data["rows"][0]
    assert (ours["name"], ours["source"]) == ("ours", "measured")
    assert ours["values"] == {"mean": 0.123456, "failures": 3, "note": "ok"}
    assert data["rows"][1]["source"] == "paper, other dataset"
    assert data["columns"] == ["mean", "failures", "note"]


def test_a_measured_row_is_found_by_name_and_a_published_one_is_not() -> None:
    assert TABLE.row("ours")["failures"] == 3
    with pytest.raises(KeyError):
        TABLE.row("theirs")


def test_a_row_without_a_value_for_every_column_is_an_error() -> None:
    with pytest.raises(ValueError, match="zip"):
        Table("x", TABLE.columns, (Row("short", (1.0,)),)).to_markdown()


@given(st.lists(st.floats(0, 1), min_size=2, max_size=12), st.integers(1, 9))
def test_an_interval_lies_within_the_values(values: list[float], weight: int) -> None:
    low, high = bootstrap_interval(values, [weight] * len(values))
    assert min(values) - 1e-9 <= low <= high <= max(values) + 1e-9
    assert (low, high) == pytest.approx(bootstrap_interval(values))


def test_it_covers_the_mean_about_as_often_as_it_says() -> None:
    rng = np.random.default_rng(3)
    hits = 0
    for _ in range(60):
        low, high = bootstrap_interval(list(rng.normal(0.3, 0.1, 25)))
        hits += low <= 0.3 <= high
    assert 0.78 <= hits / 60 <= 1.0


def test_what_is_unknown_is_left_out_and_one_room_tells_nothing() -> None:
    assert bootstrap_interval([0.2, None, 0.4]) == bootstrap_interval([0.2, 0.4])
    assert bootstrap_interval([0.2]) is None
    assert bootstrap_interval([None, None]) is None
    assert bootstrap_interval([0.2, 0.3], [0.0, 0.0]) is None


def test_rooms_weigh_what_they_are_said_to() -> None:
    low, high = bootstrap_interval([0.0, 1.0, 1.0, 1.0], [1000.0, 1.0, 1.0, 1.0])
    assert low == pytest.approx(0.0, abs=0.01)
    assert high <= 1.0
