from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.errors import LibraryError
from diorama_core.library.store.features import FeatureMatrix
from diorama_core.library.store.vectors import LanceIndex, vector_index


def unit_rows(rng: np.random.Generator, *shape: int) -> np.ndarray:
    values = rng.standard_normal(shape)
    return values / np.linalg.norm(values, axis=-1, keepdims=True)


def names(count: int, start: int = 0) -> list[str]:
    return [f"shape{i}" for i in range(start, start + count)]


def test_features_come_back_after_reopening(tmp_path: Path, rng: np.random.Generator) -> None:
    first, second = unit_rows(rng, 5, 2, 16), unit_rows(rng, 3, 2, 16)
    matrix = FeatureMatrix(tmp_path / "f", 16, rows=2)
    matrix.append(names(5), first)
    matrix.append(names(3, 5), second)
    again = FeatureMatrix(tmp_path / "f", 16, rows=2)
    assert again.keys == tuple(names(8))
    assert np.allclose(again.values, np.concatenate([first, second]), atol=1e-3)
    assert again.position("shape6") == 6
    assert again.position("other") is None
    assert again.missing(["shape1", "x", "x", "y"]) == ["x", "y"]


@settings(max_examples=20)
@given(st.integers(1, 60), st.integers(1, 3), st.integers(1, 12), st.integers(0, 2**31))
def test_the_top_are_those_of_a_plain_comparison(count: int, rows: int, k: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    with TemporaryDirectory() as folder:
        matrix = FeatureMatrix(Path(folder) / "f", 24, rows)
        matrix.append(names(count), unit_rows(rng, count, rows, 24))
        query = unit_rows(rng, 24)
        exact = (matrix.values.astype(np.float32) @ query.astype(np.float32)).max(axis=1)
        found = matrix.top(query, k)
        best = np.sort(exact)[::-1][:k]
        assert [n.score for n in found] == pytest.approx(best, abs=1e-6)
        assert len({n.key for n in found}) == len(found) == min(k, count)
        among = rng.random(count) < 0.5
        allowed = {n.key for n in matrix.top(query, k, among)}
        assert allowed <= {f"shape{i}" for i in np.flatnonzero(among)}
        assert len(allowed) == min(k, int(among.sum()))


def test_which_row_was_best(tmp_path: Path) -> None:
    matrix = FeatureMatrix(tmp_path, 3, rows=3)
    matrix.append(["a"], np.eye(3)[None])
    assert matrix.top(np.array([0.0, 0.1, 0.9]), 1)[0].row == 2


def test_an_empty_matrix_finds_nothing(tmp_path: Path) -> None:
    assert FeatureMatrix(tmp_path, 8).top(np.ones(8), 5) == ()


def test_an_interrupted_append_is_undone(tmp_path: Path, rng: np.random.Generator) -> None:
    matrix = FeatureMatrix(tmp_path, 8)
    matrix.append(names(4), unit_rows(rng, 4, 8))
    values = tmp_path / "values.f16"
    values.write_bytes(values.read_bytes() + b"rows without keys")
    (tmp_path / "keys.txt").write_text("shape0\nshape1\nshape2\nshape3\nhalf a na")
    again = FeatureMatrix(tmp_path, 8)
    assert again.keys == tuple(names(4))
    again.append(["next"], unit_rows(rng, 1, 8))
    assert FeatureMatrix(tmp_path, 8).keys == (*names(4), "next")
    values.write_bytes(values.read_bytes()[:-5])
    assert FeatureMatrix(tmp_path, 8).keys == tuple(names(4))


def test_a_cleared_matrix_starts_again(tmp_path: Path, rng: np.random.Generator) -> None:
    matrix = FeatureMatrix(tmp_path, 8)
    matrix.append(names(4), unit_rows(rng, 4, 8))
    matrix.clear()
    assert len(matrix) == 0
    matrix.append(["a"], unit_rows(rng, 1, 8))
    assert FeatureMatrix(tmp_path, 8).keys == ("a",)


def test_wrong_features_are_refused(tmp_path: Path, rng: np.random.Generator) -> None:
    matrix = FeatureMatrix(tmp_path, 8)
    matrix.append(["a"], unit_rows(rng, 1, 8))
    with pytest.raises(LibraryError, match="there already"):
        matrix.append(["a"], unit_rows(rng, 1, 8))
    with pytest.raises(LibraryError, match="do not name"):
        matrix.append(["b", "c"], unit_rows(rng, 1, 8))
    with pytest.raises(LibraryError, match="finite"), np.errstate(over="ignore"):
        matrix.append(["b"], np.full((1, 8), 1e6))
    with pytest.raises(LibraryError, match="holds other features"):
        FeatureMatrix(tmp_path, 9)
    assert len(matrix) == 1


def test_small_matrices_need_no_index(tmp_path: Path, rng: np.random.Generator) -> None:
    matrix = FeatureMatrix(tmp_path, 8)
    matrix.append(names(10), unit_rows(rng, 10, 8))
    assert vector_index(matrix) is matrix


def test_the_index_finds_what_a_plain_comparison_finds(tmp_path: Path, rng: np.random.Generator) -> None:
    pytest.importorskip("lancedb", reason="needs LanceDB (pip install 'diorama[vector]')")
    kinds = unit_rows(rng, 20, 32)
    values = kinds[rng.integers(0, 20, 1500)] + 0.1 * rng.standard_normal((1500, 32))
    values /= np.linalg.norm(values, axis=-1, keepdims=True)
    matrix = FeatureMatrix(tmp_path, 32)
    matrix.append(names(1000), values[:1000])
    LanceIndex(matrix)
    matrix.append(names(500, 1000), values[1000:])
    index = vector_index(matrix, index_from=1000)
    assert isinstance(index, LanceIndex)
    recall = []
    for i in range(0, 1500, 100):
        exact, found = matrix.top(values[i], 10), index.top(values[i], 10)
        assert found[0] == exact[0]
        recall.append(len(set(found) & set(exact)) / 10)
    assert np.mean(recall) > 0.95
