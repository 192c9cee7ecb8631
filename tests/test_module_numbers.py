"""Numbers of the reconstruction: the script counts what stands at the top of modules, and its ceilings hold."""

from __future__ import annotations

from pathlib import Path

from scripts import module_numbers as script

ROOT = Path(__file__).resolve().parents[1]

TEXT = '''
NEAR_M = 0.05
"""A reason."""
LOW, HIGH = 1, -2.0
SHARE: float = 1 / 3
NAME = "three"
EXACT = True


def f():
    inner = 4
'''


def test_numbers_at_the_top_of_a_module_are_counted():
    found = list(script.numbers_of("m", TEXT))
    assert [number.names for number in found] == [("NEAR_M",), ("LOW", "HIGH"), ("SHARE",)]


def test_names_with_other_values_elsewhere_are_ambiguous():
    of = script.numbers_of
    found = [*of("a", "NEAR_M = 0.05\nFAR_M = 2\n"), *of("b", "NEAR_M = 0.9\nFAR_M = 2\n")]
    assert list(script.ambiguous(found)) == ["NEAR_M"]


def test_the_ceilings_hold_and_are_not_higher_than_they_must_be():
    found = list(script.numbers(ROOT))
    assert len(found) <= script.MAX_NUMBERS, "put new numbers into the stage's settings"
    assert len(script.ambiguous(found)) <= script.MAX_AMBIGUOUS, "give one concept one name in one place"
    assert len(found) > script.MAX_NUMBERS - 60, f"lower MAX_NUMBERS to {len(found)}"
