"""The detector adapted to photos: read from its graph, taught, and moved halfway back."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
import torch

from diorama_core.models.runtime import SessionPool
from diorama_core.training import train
from diorama_core.training.adapting import Adaptation, MixedPictures, adapt_detector, load_detector, read_photos
from diorama_core.training.export import export_detector
from diorama_core.training.networks import Detector, detector_loss
from diorama_core.training.pictures import PictureFiles
from diorama_core.training.train import Schedule
from tests.training.test_augment import picture
from tests.training.test_train import KINDS, SMALL, files

__all__ = ["files"]
PICTURES = np.random.default_rng(3).random((1, 3, 64, 96)).astype(np.float32)


@pytest.fixture(scope="module")
def graph(tmp_path_factory: pytest.TempPathFactory) -> Path:
    torch.manual_seed(1)
    path = tmp_path_factory.mktemp("graph") / "before.onnx"
    export_detector(Detector(KINDS, width=8).eval(), path)
    return path


def rows_of(path: Path) -> np.ndarray:
    return SessionPool().get(path).run({"pictures": PICTURES}, {"rows": (1, None, None)})["rows"]


def test_a_graph_read_back_answers_as_it_did(graph: Path) -> None:
    with torch.no_grad():
        again = load_detector(graph, KINDS)(torch.from_numpy(PICTURES)).numpy()
    np.testing.assert_allclose(again, rows_of(graph), atol=1e-4)


def test_half_of_what_was_learnt_is_kept(graph: Path, files: PictureFiles, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(train, "SIZE", SMALL)
    monkeypatch.setattr("diorama_core.training.adapting.SIZE", SMALL)
    how = Adaptation(Schedule(steps=3, batch=2, rate=1e-2, seed=1), rise_steps=1)
    found: dict[float, dict[str, torch.nn.Parameter]] = {}

    def exported(network: torch.nn.Module, output: Path) -> None:
        found[float(output.name)] = dict(network.named_parameters())

    monkeypatch.setattr("diorama_core.training.adapting.export_detector", exported)
    for kept in (0.0, 0.5):
        adapt_detector(graph, [picture(1), picture(2)], files, KINDS, tmp_path / f"{kept}", replace(how, kept=kept))
    before = dict(load_detector(graph, KINDS).named_parameters())
    name = "box.weight"
    assert not torch.allclose(found[0.0][name], before[name], atol=1e-3)
    assert torch.allclose(found[0.5][name], (before[name] + found[0.0][name]) / 2, atol=2e-3)


def test_photos_and_rooms_are_mixed_in_the_wanted_share(files: PictureFiles) -> None:
    photo = picture(99)
    mixed = MixedPictures((photo,), files, 0.7)
    rng = np.random.default_rng(0)
    of_photos = np.mean([mixed.draw(rng) is photo for _ in range(300)])
    assert of_photos == pytest.approx(0.7, abs=0.1)


def test_what_has_no_category_is_learnt_as_a_box_only(tmp_path: Path) -> None:
    cv2.imwrite(str(tmp_path / "room.png"), np.full((120, 160, 3), 128, np.uint8))
    things = [{"bbox": [10, 10, 60, 60], "class": w, "kind": k} for w, k in (("chair", "chair"), ("thing", "object"))]
    (tmp_path / "a.json").write_text(json.dumps({"room": {"size": [160, 120], "things": things}}))
    labelled = read_photos(tmp_path / "a.json", tmp_path, ("bed", "chair"))["room"]
    assert labelled.categories.tolist() == [1, 2]
    rows = torch.zeros(1, 1, 7)
    box = torch.tensor([[[0.0, 0.0, 16.0, 16.0]]])
    place = torch.tensor([[8.0, 8.0]]), torch.tensor([8.0])
    assert detector_loss(rows, box, torch.tensor([[2]]), *place).kind == 0.0
    assert detector_loss(rows, box, torch.tensor([[1]]), *place).kind > 0.0
