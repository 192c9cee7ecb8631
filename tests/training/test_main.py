"""The training's commands fail with one line."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest
import torch

from diorama_core.errors import InputError
from diorama_core.training.__main__ import main
from diorama_core.training.pictures import PictureFiles
from diorama_core.training.shape_views import ShapeViewFiles
from diorama_core.training.surfaces import SurfaceFiles
from diorama_core.training.windows import WindowFiles


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ([], "training pictures"),
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


@pytest.mark.parametrize(
    ("read", "said"),
    [
        (PictureFiles.of, "training pictures"),
        (ShapeViewFiles.of, "training shapes"),
        (SurfaceFiles.read, "training surfaces"),
        (WindowFiles.of, "training windows"),
    ],
)
def test_a_folder_with_nothing_to_learn_from_says_how_to_make_it(
    read: Callable[[Path], object], said: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=said):
        read(tmp_path)
