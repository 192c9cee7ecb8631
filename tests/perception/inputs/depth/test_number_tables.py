"""Depth as text."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.errors import InputError
from diorama_core.perception.inputs.depth.number_tables import is_number_table, read_number_table
from diorama_core.perception.inputs.source import Source

ROW = ",".join(str(k / 10) for k in range(30))


def table(*rows: str) -> Source:
    return Source("\n".join(rows).encode(), "d.csv")


def test_rows_of_equal_length_are_a_map() -> None:
    values = read_number_table(table(*[ROW] * 30))
    assert values.shape == (30, 30)
    assert values[0, 29] == 2.9
    assert np.isnan(read_number_table(table(*[ROW.replace("0.0", "nan")] * 30))[0, 0])


@pytest.mark.parametrize("rows", [[ROW] * 5, ["0 0.1 0.2 0.3 0.4"] * 40, [ROW, *[ROW + ",1"] * 30], ["a" + ROW] * 30])
def test_other_texts_are_none(rows: list[str]) -> None:
    assert not is_number_table(table(*rows))


def test_a_damaged_row_is_refused_in_one_line() -> None:
    with pytest.raises(InputError, match="damaged"):
        read_number_table(table(*[ROW] * 30, "1,2"))
