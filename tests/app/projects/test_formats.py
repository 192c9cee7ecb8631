"""The table of what can be exported from the page."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from diorama_app.projects.formats import EXPORT_FORMATS, GUIDES
from diorama_app.reconstruction.written_files import download_suffix
from diorama_core.export import export_scene
from diorama_core.export.gathering import ExportOptions
from tests.export.scenes import scene_of

DOCS = Path(__file__).resolve().parents[3] / "docs" / "export.md"


def test_every_format_has_a_guide_and_every_guide_a_format() -> None:
    assert GUIDES.keys() == EXPORT_FORMATS.keys()


def test_every_format_is_in_the_documentation() -> None:
    text = DOCS.read_text()
    assert [name for name in EXPORT_FORMATS if not re.search(rf"^\|.*`{name}`", text, re.MULTILINE)] == []


SELECTED = frozenset({"t"})


@pytest.mark.parametrize("name", EXPORT_FORMATS)
def test_every_format_is_written_with_the_choices_it_offers(name: str, tmp_path: Path) -> None:
    chosen, choices = EXPORT_FORMATS[name], GUIDES[name].choices
    if chosen.missing:
        pytest.skip(chosen.missing)
    options = ExportOptions(
        ceiling="ceiling" not in choices,
        only=SELECTED if "selection" in choices else None,
        max_texture_px=64 if "textures" in choices else None,
        compression="meshopt" if "compression" in choices else "none",
        bodies="welded" if "welded" in choices else "free",
    )
    scene, library = scene_of("primitives")
    written = export_scene(scene, library, tmp_path / f"room{download_suffix(chosen)}", chosen, options=options)
    assert (tmp_path / f"room{download_suffix(chosen)}").stat().st_size > 100
    assert all(plane.plane.role != "ceiling" for plane in written.planes) or "ceiling" not in choices
    if "selection" in choices:
        assert {o.id for o in written.objects} == SELECTED
        assert written.planes == ()
