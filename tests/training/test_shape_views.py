"""Crops of single shapes look like crops of boxes in photos: the shape in the middle, cut and hidden at times."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.models.images import CROP_SIDE, MARGIN
from diorama_core.training import shape_views
from diorama_core.training.shape_views import ShapeViewFiles, ShapeViews, crop_before, make_shape_views, read_shape
from tests.primitives import PrimitiveLibrary

BLACK = np.zeros((60, 80, 3), np.uint8)


def files(folder: Path, width: int = 30, height: int = 60) -> ShapeViewFiles:
    """One white shape of these sides, with a soft shadow beside it."""
    rgba = np.zeros((1, 80, 80, 4), np.uint8)
    rgba[0, 10 : 10 + height, 20 : 20 + width] = 255
    rgba[0, 60:70, 55:70, 3] = 90
    views = ShapeViews(rgba, 2, np.array([1, -1, -1, 0, 3, -1, 1], np.int8))
    (folder / "shape_0000000000000000.npz").write_bytes(shape_views._pack(views))
    return ShapeViewFiles.of(folder)


Crop = tuple[np.ndarray, tuple[float, float], ShapeViews]


def crops(folder: Path, monkeypatch: pytest.MonkeyPatch, *, hidden: float = 0.0, cut: float = 0.0) -> list[Crop]:
    """Ten crops of the shape before black, all or none of them hidden or cut."""
    monkeypatch.setattr(shape_views, "HIDDEN", hidden)
    monkeypatch.setattr(shape_views, "CUT", cut)
    drawn = files(folder)
    return [crop_before(BLACK, drawn, np.random.default_rng(seed)) for seed in range(10)]


def test_the_shape_fills_its_box_and_the_margin_is_background(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for crop, sides, views in crops(tmp_path, monkeypatch):
        rows = np.flatnonzero((crop > 128).any(axis=(1, 2)))
        assert np.ptp(rows) == pytest.approx(CROP_SIDE / (1 + 2 * MARGIN), rel=0.2)
        assert sides[1] == 1.0
        assert 0.25 < sides[0] < 0.85
        assert views.category == 2


def test_what_the_border_cuts_is_grey_beyond_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for crop, _, _ in crops(tmp_path, monkeypatch, cut=1.0):
        edges = (crop[:, 0], crop[:, -1], crop[-1])
        assert any((edge == shape_views.FILL).all() for edge in edges)


def test_another_shape_may_stand_before_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    free, covered = (
        sum((crop > 128).sum() for crop, _, _ in crops(tmp_path, monkeypatch, hidden=hidden)) for hidden in (0.0, 1.0)
    )
    assert covered > free


def test_every_shape_is_rendered_once(tmp_path: Path) -> None:
    library = PrimitiveLibrary()
    assert make_shape_views(tmp_path, library) == len(library.shapes())
    assert make_shape_views(tmp_path, library) == 0
    views = read_shape(sorted(tmp_path.glob("shape_*.npz"))[0])
    assert views.rgba.shape == (shape_views.VIEWS, shape_views.SIDE, shape_views.SIDE, 4)
    assert (views.rgba[..., 3] >= shape_views.SOLID).any(axis=(1, 2)).all()
