from __future__ import annotations

import json

import pytest

from diorama_core.evaluation.reports.tables import Column, Row, Table, paper_rows

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
