"""Thumbnails: whole, centred, transparent around, and made once."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import LibraryError
from diorama_core.library.catalogue import built_in_library
from diorama_core.render import thumbnails
from diorama_core.render.thumbnails import shape_sheet, thumbnail
from tests.primitives import PrimitiveLibrary

LIBRARY = PrimitiveLibrary()


@pytest.mark.parametrize("shape_id", ["table", "chair", "ball", "print"])
def test_thumbnail_is_whole_and_fills_its_square(shape_id: str) -> None:
    image = Image.open(io.BytesIO(thumbnail(LIBRARY, shape_id, 96)))
    assert image.size == (96, 96)
    assert image.mode == "RGBA"
    opaque = np.asarray(image)[..., 3] > 250
    rows, columns = np.nonzero(opaque)
    assert rows.min() >= 1
    assert columns.min() >= 1
    assert max(rows.max(), columns.max()) <= 94
    assert max(np.ptp(rows), np.ptp(columns)) > 70


def test_there_is_a_soft_shadow_and_nothing_at_the_border() -> None:
    alpha = np.asarray(Image.open(io.BytesIO(thumbnail(LIBRARY, "chair", 96))))[..., 3]
    assert ((alpha > 20) & (alpha < 200)).sum() > 100
    border = np.concatenate([alpha[0], alpha[-1], alpha[:, 0], alpha[:, -1]])
    assert border.max() < 8


def test_made_once() -> None:
    assert thumbnail(LIBRARY, "ball", 64) is thumbnail(LIBRARY, "ball", 64)
    assert len(thumbnail(LIBRARY, "ball", 32)) < len(thumbnail(LIBRARY, "ball", 64))


def test_retained_on_disk_by_content(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    library = built_in_library(tmp_path / "shapes")
    first = thumbnail(library, "cup-mug-white", 48, tmp_path / "pictures")
    (retained,) = (tmp_path / "pictures").iterdir()
    assert retained.read_bytes() == first
    monkeypatch.setattr(thumbnails, "_CACHE", type(thumbnails._CACHE)(4))
    monkeypatch.setattr(thumbnails, "_render", lambda *_: pytest.fail("rendered again"))
    assert thumbnail(library, "cup-mug-white", 48, tmp_path / "pictures") == first


def test_a_folder_that_cannot_be_written_only_costs_time(tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    assert thumbnail(built_in_library(tmp_path), "cup-mug-stone", 40, blocked).startswith(b"\x89PNG")


def test_a_sheet_shows_every_shape(tmp_path: Path) -> None:
    library = built_in_library(tmp_path)
    shapes = library.in_category("plate")[:3]
    page = shape_sheet(library, shapes, 48, 2)
    assert page.size == (96, 2 * (48 + 18))
    red = np.asarray(page)[70:110, :, 0]
    assert np.ptp(red[:, 4:44]) > 20  # the third plate
    assert np.ptp(red[:, 52:92]) == 0  # nothing beside it


def test_unknown_shape_is_named() -> None:
    with pytest.raises(LibraryError, match="gone"):
        thumbnail(LIBRARY, "gone")
