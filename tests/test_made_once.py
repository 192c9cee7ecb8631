from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

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
