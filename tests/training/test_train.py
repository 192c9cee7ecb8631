"""A run that stops goes on as if it had not; networks leave as graphs that answer as they did."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest
import torch

from diorama_core.errors import Cancelled
from diorama_core.io.assets import CARD, DETECTOR, NAMER, OUTLINER
from diorama_core.models.images import box_crop, box_geometry
from diorama_core.models.outliner import SIDE, BoxOutliner, warp_to_photo, window
from diorama_core.models.recogniser import Recogniser
from diorama_core.models.runtime import SessionPool
from diorama_core.progress import Progress
from diorama_core.training import pictures, shape_views, train
from diorama_core.training.export import export_detector, export_namer, export_outliner, write_card
from diorama_core.training.networks import Detector, Namer, OutlineNetwork
from diorama_core.training.pictures import PictureFiles
from diorama_core.training.shape_views import ShapeViewFiles, ShapeViews
from diorama_core.training.train import (
    Schedule,
    Trainer,
    TrainingRun,
    detector_trainer,
    namer_trainer,
    outliner_trainer,
)
from diorama_core.training.windows import WindowFiles, Windows, _pack
from tests.training.test_augment import picture

KINDS = 5
SMALL = (96, 64)
"""Of the detector's pictures: what a step does to a network is the same with few pixels."""


@pytest.fixture
def files(tmp_path: Path) -> PictureFiles:
    for room in range(3):
        packed = pictures._pack(tuple(picture(10 * room + k) for k in range(2)))
        (tmp_path / f"room_{room:06d}.npz").write_bytes(packed)
    return PictureFiles.of(tmp_path)


def shape_files(folder: Path) -> ShapeViewFiles:
    rng = np.random.default_rng(5)
    for kind in (1, 3):
        rgba = rng.integers(0, 255, (2, 40, 40, 4)).astype(np.uint8)
        rgba[:, 8:32, 12:28, 3] = 255
        views = ShapeViews(rgba, kind, np.array([0, kind, -1, 0, 2, 1, -1], np.int8))
        (folder / f"shape_{kind:016d}.npz").write_bytes(shape_views._pack(views))
    return ShapeViewFiles.of(folder)


def window_files(folder: Path) -> WindowFiles:
    rng = np.random.default_rng(4)
    rgb = rng.integers(0, 255, (3, SIDE, SIDE, 3)).astype(np.uint8)
    share = (rgb[..., 0] > 127).astype(np.uint8) * 255
    (folder / "windows_000001.npz").write_bytes(_pack(Windows(rgb, share, np.ones(share.shape, bool))))
    return WindowFiles.of(folder)


def trainer(kind: str, files: PictureFiles, path: Path) -> Trainer:
    how = TrainingRun(Schedule(2, 2 if kind == "namer" else 1, save_every=1), path)
    if kind == "outliner":
        return outliner_trainer(window_files(path.parent), how)
    if kind == "detector":
        return detector_trainer(files, KINDS, how)
    return namer_trainer(files, shape_files(path.parent), KINDS, how)


@pytest.mark.parametrize("kind", ["detector", "namer", "outliner"])
def test_a_run_goes_on_where_it_stopped(
    kind: str, files: PictureFiles, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(train, "SIZE", SMALL)
    for network in (Detector, Namer, OutlineNetwork):
        monkeypatch.setattr(train, network.__name__, partial(network, width=8))
    whole = trainer(kind, files, tmp_path / "whole.pt").run(Progress())
    first = trainer(kind, files, tmp_path / "parts.pt")
    learn = first._learn

    def learn_and_stop(batch: tuple[torch.Tensor, ...]) -> str:
        if first.step == 1:
            raise Cancelled("stopped")
        return learn(batch)

    first._learn = learn_and_stop
    with pytest.raises(Cancelled):
        first.run(Progress())
    second = trainer(kind, files, tmp_path / "parts.pt")
    assert second.step == 1
    resumed = second.run(Progress())
    for name, value in whole.state_dict().items():
        torch.testing.assert_close(resumed.state_dict()[name], value, msg=name)


def test_exported_graphs_answer_as_the_networks_did(tmp_path: Path, rng: np.random.Generator) -> None:
    torch.manual_seed(0)
    detector, namer = Detector(KINDS, width=8).eval(), Namer(KINDS, width=8).eval()
    export_detector(detector, tmp_path / DETECTOR)
    export_namer(namer, tmp_path / NAMER)
    write_card(tmp_path / CARD, [f"kind {k}" for k in range(KINDS)])
    recogniser = Recogniser.of(tmp_path)
    rgb = rng.integers(0, 255, (90, 130, 3)).astype(np.uint8)
    box = np.array([10.0, 20.0, 70.0, 80.0])
    looks = recogniser.look(rgb, box[None])
    crop = torch.from_numpy(box_crop(rgb, box).transpose(2, 0, 1)[None].astype(np.float32) / 255)
    where = torch.from_numpy(box_geometry(box, 130, 90)[None])
    with torch.no_grad():
        seen, form = namer(crop, where)
        turned, turned_form = namer(crop.flip(3), where * torch.tensor([-1.0, 1, 1, 1, 1, 1]))
    named = (seen.softmax(dim=1) + turned.softmax(dim=1)) / 2
    tops = (form[:, :4].softmax(dim=1) + turned_form[:, :4].softmax(dim=1)) / 2
    np.testing.assert_allclose(looks.kinds[0], named[0].numpy(), atol=1e-3)
    np.testing.assert_allclose(looks.forms[0, :4], tops[0].numpy(), atol=1e-3)
    pixels = torch.rand(1, 3, 64, 96)
    with torch.no_grad():
        rows = detector(pixels)
    graph = SessionPool().get(tmp_path / DETECTOR)
    found = graph.run({"pictures": pixels.numpy()}, {"rows": (1, None, None)})["rows"]
    np.testing.assert_allclose(found, rows.numpy(), atol=5e-3)


def test_the_exported_outliner_answers_as_the_network_did(tmp_path: Path, rng: np.random.Generator) -> None:
    torch.manual_seed(0)
    network = OutlineNetwork(width=8).eval()
    export_outliner(network, tmp_path / OUTLINER)
    rgb, box = rng.integers(0, 255, (90, 130, 3)).astype(np.uint8), (10.0, 20.0, 70.0, 80.0)
    seen = torch.from_numpy(window(rgb, box)[None])
    with torch.no_grad():
        share = torch.sigmoid((network(seen) + network(seen.flip(3)).flip(2)) / 2)[0].numpy()
    (found,) = BoxOutliner.of(tmp_path).outlines(rgb, [box])
    np.testing.assert_allclose(found, warp_to_photo(share, box, box, (90, 130)), atol=1e-4)
