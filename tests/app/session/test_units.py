from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_app.session.units import UNITS, format_length, parse_length, to_unit
from diorama_core.errors import InputError


@given(metres=st.floats(-50, 50), unit=st.sampled_from(UNITS))
def test_what_is_written_reads_as_the_same_length(metres: float, unit: str) -> None:
    assert parse_length(format_length(metres, unit), unit) == pytest.approx(metres, abs=1.1e-3)


@pytest.mark.parametrize(
    ("words", "unit", "metres"),
    [
        ("1.2", "m", 1.2),
        ("85", "cm", 0.85),
        ("85 cm", "m", 0.85),
        ("5' 3\"", "m", 1.6002),
        ("6ft 2in", "cm", 1.8796),
        ("5' 3 1/2\"", "m", 1.6129),
        ("5 3", "ft-in", 1.6002),
        ("5' 3", "ft-in", 1.6002),
        ("-40mm", "m", -0.04),
        ("1,25", "m", 1.25),
        (".95", "m", 0.95),
        ("-.5 m", "cm", -0.5),
        ("0.5+0.25", "m", 0.75),
        ("2 m - 30 cm + 5", "cm", 1.75),
        ("1' + 6\"", "m", 0.4572),
        ("5'-3\"", "m", 1.6002),
    ],
    ids=str,
)
def test_lengths_as_people_write_them(words: str, unit: str, metres: float) -> None:
    assert parse_length(words, unit) == pytest.approx(metres)


@pytest.mark.parametrize("words", ["", "-", "1+", "1++2", "0.5*2", "two", "1.2 parsecs", "3/0", "1.5.5", "."])
def test_what_is_no_length_is_said_so(words: str) -> None:
    with pytest.raises(InputError):
        parse_length(words, "m")


def test_fields_show_a_tenth_of_a_centimetre() -> None:
    assert to_unit(1.2346, "cm") == 123.5
    assert to_unit(1.2346, "m") == 1.235
