from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.library import furniture
from diorama_core.library.furniture import latest
from tests import shared_solids
from tests.made_once import FOLDER, made_once


def test_the_first_makes_it_and_the_others_read_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FOLDER, str(tmp_path))
    made: list[int] = []

    def make() -> np.ndarray:
        made.append(1)
        return np.arange(5.0)

    first, second = made_once("numbers", make), made_once("numbers", make)
    assert len(made) == 1
    assert first is not second, "nobody changes what another has"
    np.testing.assert_array_equal(first, second)
    assert made_once("others", lambda: 3) == 3


def test_without_a_shared_folder_everybody_makes_his_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(FOLDER, raising=False)
    assert made_once("numbers", lambda: 1) == 1
    assert made_once("numbers", lambda: 2) == 2


def test_what_fails_is_not_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FOLDER, str(tmp_path))
    with pytest.raises(ZeroDivisionError):
        made_once("number", lambda: 1 // 0)
    assert made_once("number", lambda: 1) == 1


def test_solids_that_were_read_are_those_that_were_built(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FOLDER, str(tmp_path))
    design = next(d for d in furniture.designs() if d.category == "bed")
    read, built = shared_solids.built_once(design), latest.built_once(design)
    assert len(list(tmp_path.glob("*.pickle"))) == 1
    assert [material for material, _ in read] == [material for material, _ in built]
    for (_, one), (_, other) in zip(read, built, strict=True):
        for name in ("vertices", "faces", "normals", "uv"):
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name), strict=True)
