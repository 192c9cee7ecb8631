"""The page *What goes in* is made from the readers' own tables."""

from __future__ import annotations

from scripts.what_goes_in import PAGE, filled, tables


def test_the_page_is_up_to_date() -> None:
    page = PAGE.read_text()
    assert all(f"<!-- made: {name} -->" in page for name in tables())
    assert filled(page) == page, "run: python scripts/what_goes_in.py"
