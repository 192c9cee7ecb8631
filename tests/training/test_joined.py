"""Two namers in one graph say the mean of what each says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from diorama_core.models.own_weights import CARD, DETECTOR, NAMER
from diorama_core.models.recogniser import Looks, Recogniser
from diorama_core.models.runtime import SessionPool
from diorama_core.training.detector import Detector
from diorama_core.training.export import export_detector, export_namer, write_card
from diorama_core.training.joined import join_namers
from diorama_core.training.naming import Namer

NAMES = ("bed", "chair", "table")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("namers")
    torch.manual_seed(2)
    export_detector(Detector(len(NAMES), width=8).eval(), folder / DETECTOR)
    write_card(folder / CARD, NAMES)
    for name, width in (("a.onnx", 8), ("b.onnx", 16)):  # they need not be alike
        export_namer(Namer(len(NAMES), width=width).eval(), folder / name)
    return folder


def looks(folder: Path, namer: Path, rng: np.random.Generator) -> Looks:
    (folder / NAMER).write_bytes(namer.read_bytes())
    rgb = rng.integers(0, 255, (120, 160, 3)).astype(np.uint8)
    boxes = np.array([[10.0, 20.0, 90.0, 100.0], [50.0, 5.0, 150.0, 60.0]])
    found = Recogniser.of(folder)
    return Recogniser(found.detector, found.namer, NAMES, found.form_values, pool=SessionPool()).look(rgb, boxes)


def test_the_joined_namer_says_the_mean(folder: Path) -> None:
    join_namers([folder / "a.onnx", folder / "b.onnx"], folder / "both.onnx")
    a, b, both = (looks(folder, folder / f"{name}.onnx", np.random.default_rng(3)) for name in ("a", "b", "both"))
    np.testing.assert_allclose(both.kinds, (a.kinds + b.kinds) / 2, atol=1e-5)
    np.testing.assert_allclose(both.forms, (a.forms + b.forms) / 2, atol=1e-5)
    assert np.abs(a.kinds - b.kinds).max() > 1e-3
