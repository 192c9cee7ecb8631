"""A run that stops goes on as if it had not; networks leave as graphs that answer as they did."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from diorama_core.errors import Cancelled, InputError
from diorama_core.models.own_weights import CARD, DETECTOR, NAMER
from diorama_core.models.recogniser import Recogniser, box_crop, box_geometry
from diorama_core.models.runtime import SessionPool
from diorama_core.progress import Progress
from diorama_core.training import pictures
from diorama_core.training.detector import Detector
from diorama_core.training.export import export_detector, export_namer, write_card
from diorama_core.training.naming import Namer
from diorama_core.training.train import (
    PictureFiles,
    Schedule,
    Trainer,
    category_counts,
    detector_trainer,
    namer_trainer,
)
from tests.training.test_augment import picture

KINDS = 5


@pytest.fixture
def files(tmp_path: Path) -> PictureFiles:
    for room in range(3):
        packed = pictures._packed(tuple(picture(10 * room + k) for k in range(2)))
        (tmp_path / f"room_{room:06d}.npz").write_bytes(packed)
    return PictureFiles(tuple(sorted(tmp_path.glob("room_*.npz"))))


def trainer(kind: str, files: PictureFiles, path: Path, steps: int) -> Trainer:
    schedule = Schedule(steps, 2, save_every=2)
    if kind == "detector":
        return detector_trainer(files, KINDS, schedule, path)
    return namer_trainer(files, KINDS, schedule, path, category_counts(files, KINDS))


@pytest.mark.parametrize("kind", ["detector", "namer"])
def test_a_run_goes_on_where_it_stopped(kind: str, files: PictureFiles, tmp_path: Path) -> None:
    whole = trainer(kind, files, tmp_path / "whole.pt", 4).run(Progress())
    first = trainer(kind, files, tmp_path / "parts.pt", 4)
    first.schedule = Schedule(4, 2, save_every=2)
    stop = Progress()
    learn = first._learn

    def learn_and_stop(batch: tuple[torch.Tensor, ...]) -> str:
        if first.step == 2:
            raise Cancelled("stopped")
        return learn(batch)

    first._learn = learn_and_stop
    with pytest.raises(Cancelled):
        first.run(stop)
    second = trainer(kind, files, tmp_path / "parts.pt", 4)
    assert second.step == 2
    resumed = second.run(Progress())
    for name, value in whole.state_dict().items():
        torch.testing.assert_close(resumed.state_dict()[name], value, msg=name)


def test_a_folder_without_pictures_is_one_clear_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="training pictures"):
        PictureFiles.of(tmp_path)


def test_exported_graphs_answer_as_the_networks_did(tmp_path: Path, rng: np.random.Generator) -> None:
    torch.manual_seed(0)
    detector, namer = Detector(KINDS, width=8).eval(), Namer(KINDS, width=8).eval()
    export_detector(detector, tmp_path / DETECTOR)
    export_namer(namer, tmp_path / NAMER)
    write_card(tmp_path / CARD, [f"kind {k}" for k in range(KINDS)])
    recogniser = Recogniser.of(tmp_path)
    rgb = rng.integers(0, 255, (90, 130, 3)).astype(np.uint8)
    box = np.array([10.0, 20.0, 70.0, 80.0])
    named = recogniser.name(rgb, box[None])
    crop = torch.from_numpy(box_crop(rgb, box).transpose(2, 0, 1)[None].astype(np.float32) / 255)
    where = torch.from_numpy(box_geometry(box, 130, 90)[None])
    with torch.no_grad():
        seen = namer(crop, where).softmax(dim=1)
        turned = namer(crop.flip(3), where * torch.tensor([-1.0, 1, 1, 1, 1, 1])).softmax(dim=1)
    np.testing.assert_allclose(named[0], ((seen + turned) / 2)[0].numpy(), atol=1e-4)
    pixels = torch.rand(1, 3, 64, 96)
    with torch.no_grad():
        rows = detector(pixels)
    graph = SessionPool().get(tmp_path / DETECTOR)
    found = graph.run({"pictures": pixels.numpy()}, {"rows": (1, None, None)})["rows"]
    np.testing.assert_allclose(found, rows.numpy(), atol=1e-4)
