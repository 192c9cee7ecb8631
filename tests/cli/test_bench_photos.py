"""Where `diorama bench` writes its tables."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

import pytest

from diorama_app.cli.bench_photos import write_text


@pytest.mark.parametrize("inside", ["", "\nolder\n"])
def test_a_table_replaces_the_text_between_its_marks(tmp_path: Path, inside: str) -> None:
    page = tmp_path / "page.md"
    page.write_text(f"Before.\n<!-- bench photos -->\n{inside}<!-- end photos -->\nAfter.\n")
    write_text(Namespace(markdown=page, table="photos"), "| new |")
    assert page.read_text() == "Before.\n<!-- bench photos -->\n\n| new |\n\n<!-- end photos -->\nAfter.\n"


def test_a_file_without_marks_is_written_anew(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    write_text(Namespace(markdown=page, table="photos"), "| new |")
    assert page.read_text().strip() == "| new |"
