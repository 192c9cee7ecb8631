"""`scripts/test` runs the browser tests by their folder: they are all in it, and nothing else is."""

from __future__ import annotations

from pathlib import Path

TESTS = Path(__file__).parent
MARK = "pytest.mark.browser"


def test_all_tests_with_a_browser_are_in_their_folder_and_marked() -> None:
    within = sorted((TESTS / "e2e").glob("test_*.py"))
    assert within
    assert [p.name for p in within if MARK not in p.read_text()] == []
    elsewhere = (p for p in TESTS.rglob("test_*.py") if p.parent != TESTS / "e2e" and p != Path(__file__))
    assert [p.name for p in elsewhere if MARK in p.read_text()] == []


def test_the_script_runs_both_halves() -> None:
    script = (TESTS.parent / "scripts" / "test").read_text()
    assert "pytest -q --ignore tests/e2e " in script
    assert "pytest -q tests/e2e " in script
