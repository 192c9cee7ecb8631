"""The training's commands fail with one line."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
import torch

from diorama_core.training.__main__ import main


def test_training_without_pictures_says_how_to_make_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["training", "train", "namer", "--pictures", str(tmp_path), "--checkpoints", str(tmp_path / "c")]
    monkeypatch.setattr(sys, "argv", arguments)
    assert main() == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "training pictures" in line


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--workers", "0"], "at least one process"),
        pytest.param(
            ["--device", "cuda"],
            "no card",
            marks=pytest.mark.skipif(torch.cuda.is_available(), reason="there is a card here"),
        ),
    ],
)
def test_what_training_cannot_run_on_is_one_line(
    more: list[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    arguments = ["training", "train", "namer", "--pictures", str(tmp_path), "--checkpoints", str(tmp_path / "c")]
    monkeypatch.setattr(sys, "argv", [*arguments, *more])
    assert main() == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
