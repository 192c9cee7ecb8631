"""`python -m diorama_app` prepares the shapes once and then serves, without a shell."""

from __future__ import annotations

from pathlib import Path

import pytest

from diorama_app import __main__ as program


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[list[str]]:
    """The commands that are run; none of them does anything."""
    commands: list[list[str]] = []
    monkeypatch.setenv("DIORAMA_CACHE", str(tmp_path))
    monkeypatch.setattr(program, "main", lambda command: commands.append([*command]) or 0)
    monkeypatch.setattr(program, "_prepare_views", lambda stamp: commands.append(["views"]) or program._note(stamp))
    return commands


def test_the_first_start_prepares_and_later_ones_serve_at_once(said: list[list[str]]) -> None:
    assert program.open_editor(["room", "--no-open"]) == 0
    assert said == [["library", "build"], ["views"], ["serve", "room", "--no-open"]]
    said.clear()
    program.open_editor([])
    assert said == [["serve"]]


def test_after_a_change_to_the_code_it_prepares_again(
    said: list[list[str]], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    program.open_editor([])
    monkeypatch.setattr(program, "_code_sum", lambda: 7)
    said.clear()
    program.open_editor([])
    assert said[0] == ["library", "build"]
    assert sorted(p.name for p in tmp_path.iterdir()) == [".shapes-00000007", ".views-00000007"]


def test_what_cannot_be_prepared_ends_it(said: list[list[str]], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(program, "main", lambda command: 1)
    assert program.open_editor([]) == 1


def test_help_prepares_nothing(said: list[list[str]]) -> None:
    assert program.open_editor(["--help"]) == 0
    assert said == [["serve", "--help"]]
