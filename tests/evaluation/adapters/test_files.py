from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.files import R_ZUP_YUP, existing, read_json, read_matrix


def test_y_up_worlds_are_turned_upright() -> None:
    np.testing.assert_array_equal(R_ZUP_YUP @ [0, 1, 0], [0, 0, 1])
    np.testing.assert_array_equal(R_ZUP_YUP @ R_ZUP_YUP.T, np.eye(3))
    assert np.linalg.det(R_ZUP_YUP) == pytest.approx(1.0)


def test_errors_name_the_file_and_what_to_do(tmp_path: Path) -> None:
    (tmp_path / "broken.json").write_text("{")
    (tmp_path / "good.json").write_text('{"a": [1]}')
    assert read_json(tmp_path / "good.json") == {"a": [1]}
    with pytest.raises(InputError, match=r"broken\.json is not valid JSON .*download it again"):
        read_json(tmp_path / "broken.json")
    with pytest.raises(InputError, match=r"gone\.json: there is no such file"):
        read_json(tmp_path / "gone.json")


def test_matrices_have_the_shape_that_is_asked(tmp_path: Path) -> None:
    path = tmp_path / "K.txt"
    path.write_text("1 2 3\n4 5 6\n")
    np.testing.assert_array_equal(read_matrix(path, 2, 3), [[1, 2, 3], [4, 5, 6]])
    for rows, columns in ((3, 3), (3, 2)):
        with pytest.raises(InputError, match=f"expected {rows} x {columns} numbers, found 2 x 3"):
            read_matrix(path, rows, columns)
    path.write_text("1 two 3")
    with pytest.raises(InputError, match="expected 1 x 3 numbers"):
        read_matrix(path, 1, 3)
    with pytest.raises(InputError):
        read_matrix(tmp_path / "gone.txt", 1, 3)


def test_the_first_file_that_exists_is_taken(tmp_path: Path) -> None:
    (tmp_path / "b").touch()
    (tmp_path / "c").touch()
    assert existing(tmp_path, "a", "b", "c") == tmp_path / "b"
    with pytest.raises(InputError, match="none of a, d is there"):
        existing(tmp_path, "a", "d")
