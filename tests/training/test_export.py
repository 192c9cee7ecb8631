"""Two namers in one graph say the mean of what each says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from diorama_core.errors import InputError
from diorama_core.io.assets import CARD, DETECTOR, NAMER
from diorama_core.library.form import MEASURED, VALUES
from diorama_core.models.recogniser import Looks, Recogniser
from diorama_core.models.runtime import SessionPool
from diorama_core.training.export import export_detector, export_namer, join_namers, write_card
from diorama_core.training.networks import Detector, Namer

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


def _of_fewer_attributes(path: Path, attributes: tuple[str, ...]) -> None:
    network = Namer(len(NAMES), width=8).eval()
    network.form = torch.nn.Linear(network.form.in_features, sum(len(VALUES[name]) for name in attributes))
    export_namer(network, path)


def test_a_namer_from_before_an_attribute_says_nothing_of_it(folder: Path) -> None:
    _of_fewer_attributes(folder / "earlier.onnx", MEASURED[:5])
    join_namers([folder / "a.onnx", folder / "earlier.onnx"], folder / "both.onnx")
    a, both = (looks(folder, folder / f"{name}.onnx", np.random.default_rng(3)) for name in ("a", "both"))
    known = sum(len(VALUES[name]) for name in MEASURED[:5])
    np.testing.assert_allclose(both.forms[:, known:], a.forms[:, known:], atol=1e-5)
    assert np.abs(both.forms[:, :known] - a.forms[:, :known]).max() > 1e-3
    np.testing.assert_allclose(both.forms.sum(axis=1), len(MEASURED), atol=1e-4)
    with pytest.raises(InputError, match="begin with a namer that tells every attribute"):
        join_namers([folder / "earlier.onnx", folder / "a.onnx"], folder / "both.onnx")


def test_numbers_of_no_attribute_are_refused(folder: Path) -> None:
    network = Namer(len(NAMES), width=8).eval()
    network.form = torch.nn.Linear(network.form.in_features, 5)
    export_namer(network, folder / "strange.onnx")
    with pytest.raises(InputError, match="5 numbers of form"):
        join_namers([folder / "strange.onnx"], folder / "both.onnx")
