"""The table of what can be exported from the page."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from diorama_app.formats import EXPORT_FORMATS, GUIDES
from diorama_core.progress import Progress
from tests.export.scenes import gathered

DOCS = Path(__file__).resolve().parents[2] / "docs" / "export.md"


def test_every_format_has_a_guide_and_every_guide_a_format() -> None:
    assert GUIDES.keys() == EXPORT_FORMATS.keys()


@pytest.mark.parametrize("name", EXPORT_FORMATS)
def test_every_format_is_in_the_documentation(name: str) -> None:
    assert re.search(rf"^\|.*`{name}`", DOCS.read_text(), re.MULTILINE), name


def test_the_viewer_is_written_by_its_place_in_the_table(tmp_path: Path) -> None:
    EXPORT_FORMATS["html"].writer()(gathered("primitives"), tmp_path / "room.html", Progress())
    assert (tmp_path / "room.html").read_text().startswith("<!")
