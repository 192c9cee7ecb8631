"""`diorama bench`: other people's pictures by path, and tables into their place in a document."""

from __future__ import annotations

import json

import pytest

from diorama_app.cli import main


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--dataset", "ssdb"], "belong together"),
        (["--path", "."], "belong together"),
        (["--dataset", "ssdb", "--path", "not/there"], "no such folder"),
        (["--scenes", "0"], "at least one"),
    ],
)
def test_what_is_missing_is_said_in_one_line(words, said, capsys):
    assert main(["bench", "system", *words]) == 1
    error = capsys.readouterr().err
    assert said in error
    assert len(error.strip().splitlines()) == 1


def test_an_empty_copy_of_a_dataset_is_an_error(tmp_path, capsys):
    assert main(["bench", "system", "--dataset", "sunrgbd", "--path", str(tmp_path)]) == 1
    assert "no picture of sunrgbd" in capsys.readouterr().err


def test_tables_go_into_their_place(tmp_path, capsys):
    page = tmp_path / "page.md"
    page.write_text("# Page\n<!-- bench rooms -->\nold\n<!-- end rooms -->\nafter\n")
    results = tmp_path / "rooms.json"
    sheet = tmp_path / "sheet.png"
    words = ["--scenes", "1", "--markdown", str(page), "--json", str(results), "--sheet", str(sheet)]
    assert main(["bench", "rooms", *words]) == 0
    text = page.read_text()
    assert text.startswith("# Page\n<!-- bench rooms -->\n\n### Rooms")
    assert text.endswith("<!-- end rooms -->\nafter\n")
    assert "old" not in text
    document = json.loads(results.read_text())
    assert document["rooms"][0]["collisions"] == []
    assert len(document["views"]) == 3
    assert sheet.stat().st_size > 10_000
    assert "### Pictures" in capsys.readouterr().out
