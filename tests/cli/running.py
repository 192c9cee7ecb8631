"""Commands that are run here, and what they print."""

from __future__ import annotations

import pytest

from diorama_app.cli import main


def told(capsys: pytest.CaptureFixture[str], words: list[str]) -> str:
    """What a command prints that succeeds."""
    capsys.readouterr()
    assert main(words) == 0
    return capsys.readouterr().out


def refused(capsys: pytest.CaptureFixture[str], words: list[str]) -> str:
    """The one line that a command says that fails, which prints nothing else."""
    capsys.readouterr()
    assert main(words) == 1
    said = capsys.readouterr()
    lines = [x for x in said.err.splitlines() if x.startswith("diorama:") and not x.startswith("diorama: note")]
    assert len(lines) == 1, said.err
    assert "Traceback" not in said.err
    assert said.out == ""
    return lines[0]
