"""Features are made once a shape, and again where their file is damaged."""

from __future__ import annotations

import io
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.library.record import Shape
from diorama_core.retrieval import feature_cache
from diorama_core.retrieval.feature_cache import cached_features, has_features
from tests.app.small_room import PlainLibrary

VALUES = np.arange(12, dtype=np.float16).reshape(3, 4)


@pytest.fixture
def shape(monkeypatch: pytest.MonkeyPatch) -> Shape:
    monkeypatch.setattr(feature_cache, "_CACHE", type(feature_cache._CACHE)(8))
    return replace(PlainLibrary().shape("chair_a"), content_hash="abc")


def npy(value: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, value)
    return buffer.getvalue()


def found(shape: Shape, folder: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[np.ndarray, int]:
    """The features as a new process finds them, and how often they were made."""
    monkeypatch.setattr(feature_cache, "_CACHE", type(feature_cache._CACHE)(8))
    made: list[int] = []

    def make() -> np.ndarray:
        made.append(1)
        return VALUES.astype(np.float32)

    return cached_features("clip", shape, make, folder), len(made)


def test_features_are_made_once(shape: Shape, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert not has_features("clip", shape, tmp_path)
    for times in (1, 0):
        values, made = found(shape, tmp_path, monkeypatch)
        np.testing.assert_array_equal(values, VALUES)
        assert made == times
    assert has_features("clip", shape, tmp_path)


def test_what_has_no_hash_is_made_each_time(shape: Shape, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert [found(replace(shape, content_hash=""), tmp_path, monkeypatch)[1] for _ in range(2)] == [1, 1]


def lying() -> bytes:
    """A header that states more than any machine has."""
    buffer = io.BytesIO()
    np.lib.format.write_array_header_1_0(buffer, {"descr": "<f2", "fortran_order": False, "shape": (1 << 45, 4)})
    return buffer.getvalue()


@pytest.mark.parametrize(
    "damage",
    [b"", b"no array", npy(VALUES)[:-1], npy(VALUES[0]), npy(VALUES.astype(np.int32)), lying()],
    ids=["empty", "text", "cut", "one row", "integers", "huge"],
)
def test_damaged_files_are_made_again(
    damage: bytes, shape: Shape, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "clip" / "abc.npy"
    path.parent.mkdir()
    path.write_bytes(damage)
    values, made = found(shape, tmp_path, monkeypatch)
    np.testing.assert_array_equal(values, VALUES)
    assert made == 1
    assert found(shape, tmp_path, monkeypatch)[1] == 0, "the file is whole again"


def test_nobody_waits_for_a_pipe(shape: Shape, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "clip").mkdir()
    os.mkfifo(tmp_path / "clip" / "abc.npy")
    assert found(shape, tmp_path, monkeypatch)[1] == 1
