"""Windows of rendered objects: what a room gives, and that it goes on where it stopped."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.library.catalogue import built_in_library
from diorama_core.models.outliner import MARGIN, SIDE
from diorama_core.training import windows
from diorama_core.training.windows import WindowFiles, make_windows, read_windows


def test_objects_of_a_room_fill_the_middle_of_their_windows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(windows, "VIEWS", 1)
    assert make_windows(tmp_path, built_in_library(), range(3, 4)) == 1
    assert make_windows(tmp_path, built_in_library(), range(3, 4)) == 0
    found = read_windows(tmp_path / "windows_000003.npz")
    assert len(found.rgb) >= 3
    mine = found.share > 127
    edge = round(SIDE * MARGIN / (1 + 2 * MARGIN))
    wide = np.zeros((SIDE, SIDE), bool)
    wide[edge // 2 : -edge // 2, edge // 2 : -edge // 2] = True
    assert mine[:, wide].any(axis=1).all()
    assert mine[:, ~wide].mean() < 0.02
    seen, share = WindowFiles.of(tmp_path).batch(4, np.random.default_rng(0))
    assert seen.shape == (4, 4, SIDE, SIDE)
    assert share.shape == (4, SIDE, SIDE)
    assert 0.0 <= float(seen.min()) <= float(seen.max()) <= 1.0
