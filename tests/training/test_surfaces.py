"""Rooms with known surfaces: what a picture of one says, and that a crop of it still says the truth."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from diorama_core.io.assets import SURFACES
from diorama_core.library.catalogue import built_in_library
from diorama_core.models.efficientnet import MAP_CHANNELS
from diorama_core.models.room_surfaces import CELL_PX, OUTPUTS, SurfaceReader
from diorama_core.models.runtime import SessionPool
from diorama_core.training import surfaces
from diorama_core.training.export import export_surfaces
from diorama_core.training.surfaces import SIZE, SurfaceFiles, SurfaceHead, make_surfaces, read_surfaces, surface_loss
from tests.synthetic_rooms import look

FLOOR, CEILING = OUTPUTS.index("floor"), OUTPUTS.index("ceiling")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("surfaces")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(surfaces, "VIEWS", 2)
        assert make_surfaces(folder, built_in_library(), range(3, 4)) == 1
        assert make_surfaces(folder, built_in_library(), range(3, 4)) == 0, "it is there"
    return folder


def test_floors_are_below_the_horizon_and_ceilings_above(folder: Path) -> None:
    pictures = read_surfaces(folder / "surfaces_000003.npz")
    assert len(pictures) == 2
    for picture in pictures:
        assert picture.rgb.shape == (SIZE[1], SIZE[0], 3)
        assert (picture.surface == FLOOR).mean() > 0.05
        assert (picture.rise[picture.surface == FLOOR] < 0).all()
        assert picture.rise[picture.surface == CEILING].mean() > 0.05, "a roof may come down below the eye"


def test_batches_are_what_the_head_takes_and_crops_stay_true(folder: Path) -> None:
    *maps, rise, shares = SurfaceFiles.read(folder).batch(6, np.random.default_rng(0))
    width, height = SIZE
    for part, (name, channels) in zip(maps, MAP_CHANNELS.items(), strict=True):
        stride = int(name.removeprefix("stride_"))
        assert part.shape == (6, channels, height // stride, width // stride)
    assert rise.shape == (6, height // CELL_PX, width // CELL_PX)
    whole = shares[:, FLOOR] == 1.0
    assert whole.any()
    assert float(rise[whole].max()) < 0.02, "elevations are cropped and mirrored with the picture"
    assert float(shares.sum(dim=1).max()) == pytest.approx(1.0)


def test_the_loss_is_least_for_the_truth_and_falls_while_it_learns(folder: Path) -> None:
    batch = SurfaceFiles.read(folder).batch(2, np.random.default_rng(1))
    height, width = (side // CELL_PX for side in (SIZE[1], SIZE[0]))
    strides = [*(int(name.removeprefix("stride_")) // CELL_PX for name in MAP_CHANNELS), 1, 1]
    *given, true = (
        part[..., : height // stride // 2, : width // stride // 2] for part, stride in zip(batch, strides, strict=True)
    )
    loss, right = surface_loss(20.0 * true, true)
    assert right == 1.0
    torch.manual_seed(0)
    head = SurfaceHead(16)
    optimiser = torch.optim.Adam(head.parameters(), 0.01)
    losses = []
    for _ in range(12):
        value, _ = surface_loss(head.logits(*given), true)
        optimiser.zero_grad()
        value.backward()
        optimiser.step()
        losses.append(float(value.detach()))
    assert loss < losses[-1] < 0.8 * losses[0]


def test_the_exported_head_answers_as_the_network_did(tmp_path: Path, rng: np.random.Generator) -> None:
    torch.manual_seed(1)
    head = SurfaceHead(16).eval()
    export_surfaces(head, tmp_path / SURFACES)
    reader = SurfaceReader(tmp_path / SURFACES, "test", SessionPool())
    for size in ((240, 320), (400, 300)):
        rgb = rng.integers(0, 255, (*size, 3)).astype(np.uint8)
        camera = look(10.0, 10.0, size=(size[1], size[0]))
        shares = reader.read(rgb, camera)
        assert shares.shape[1:] == ((96, 128) if size[0] < size[1] else (128, 96))
        np.testing.assert_allclose(shares.sum(axis=0), 1.0, atol=1e-3)
    turned = reader.read(rgb, look(10.0, -40.0, size=(300, 400)))
    assert np.abs(turned - shares).max() > 1e-3, "the camera counts"
