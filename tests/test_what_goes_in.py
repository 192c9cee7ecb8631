"""The page about what goes in is made from the readers' tables, and up to date."""

from __future__ import annotations

import re

from scripts import what_goes_in as page


def test_the_page_is_up_to_date() -> None:
    written = page.PAGE.read_text()
    assert page.filled(written) == written, "run scripts/what_goes_in.py"


def test_every_form_has_its_row() -> None:
    made = page.tables()
    assert {"photos", "boxes", "masks", "depth", "units", "models", "scenes"} <= set(made)
    assert all(len(re.findall(r"^\| ", made[name], re.MULTILINE)) > 3 for name in ("photos", "boxes", "masks", "depth"))
