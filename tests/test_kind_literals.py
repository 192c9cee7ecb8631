"""What is known of a kind is in its row of the table; see `scripts/kind_literals.py`."""

from __future__ import annotations

from pathlib import Path

import pytest

from scripts import kind_literals as script

ROOT = Path(__file__).resolve().parents[1]


def test_kinds_are_asked_of_the_table() -> None:
    assert script.complaints(ROOT) == []
    assert set(script.TABLES) <= set(script.checked(ROOT))


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A table of four kinds, and a module that names none."""
    for folder in ("diorama_core/library", "diorama_core/pose", "diorama_app"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "diorama_core/library/kinds.toml").write_text("[chair]\n[desk]\n[lamp]\n['tv stand']\n")
    (tmp_path / "diorama_core/library/kinds.py").write_text("KINDS = {'chair', 'desk', 'lamp'}\n")
    (tmp_path / "diorama_core/pose/turns.py").write_text("'chairs'\n")
    return tmp_path


def test_names_outside_the_library_count(checkout: Path) -> None:
    assert script.complaints(checkout, 0) == []
    (checkout / "diorama_core/pose/turns.py").write_text("x = y == 'chair' or y in ('desk', 'chair')\n")
    assert script.complaints(checkout, 3) == []
    assert ["3 names of kinds outside" in line for line in script.complaints(checkout, 2)] == [True]
    assert ["lower CEILING" in line for line in script.complaints(checkout, 100)] == [True]


@pytest.mark.parametrize(
    "code",
    [
        "SEATS = frozenset({'chair', 'desk', 'lamp'})",
        "SEATS: object = having('x') | with_kin('chair', 'desk', 'tv stand')",
        "LUMENS = {'chair': 1.0, 'desk': 2.0, 'lamp': 3.0}",
        "def f(x):\n    return x in ('chair', 'desk', 'lamp')",
    ],
)
def test_tables_of_kinds_are_named(checkout: Path, code: str) -> None:
    (checkout / "diorama_core/pose/turns.py").write_text(code + "\n")
    assert any(
        "diorama_core/pose/turns.py" in line and "table of kinds" in line for line in script.complaints(checkout)
    )
