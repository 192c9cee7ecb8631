from __future__ import annotations

from pathlib import Path

import numpy as np
import torch

from diorama_core.models.gigapose import GigaPoseScale
from diorama_core.models.runtime import SessionPool
from tests.models.tiny_networks import export


class _Backbone(torch.nn.Module):
    def __init__(self) -> None:
        super().__init__()
        self.layer = torch.nn.Conv2d(3, 4, 14, stride=14)

    def forward(self, image: torch.Tensor) -> torch.Tensor:
        return self.layer(image)


class _Regressor(torch.nn.Module):
    """The first feature of the photo's patch over the template's; the angle is 30 degrees."""

    def forward(self, pairs: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        scale = pairs[:, :1] / pairs[:, 4:5]
        angle = torch.tensor([0.8660254, 0.5])
        return scale, angle[None] * torch.ones_like(scale)


def test_pairs_are_gathered_photo_first(tmp_path: Path, rng: np.random.Generator) -> None:
    torch.manual_seed(0)
    backbone = _Backbone().eval()
    features = export(backbone, (torch.zeros(1, 3, 224, 224),), tmp_path / "f.onnx", ["image"], ["features"])
    names = ["scale", "inplane"]
    dynamic = {name: {0: "n"} for name in ["pairs", *names]}
    regressor = export(_Regressor(), (torch.ones(4, 8),), tmp_path / "r.onnx", ["pairs"], names, dynamic)
    facade = GigaPoseScale(features, regressor, pool=SessionPool())
    crops = [rng.integers(0, 255, (224, 224, 3)).astype(np.uint8) for _ in range(2)]
    template, photo = facade.maps(crops)
    assert template.shape == (4, 16, 16)
    cells, others = np.array([[1, 2], [3, 4]]), np.array([[5, 6], [7, 8]])
    found = facade.turns(template, photo, cells, others)
    expected = [photo[0, 6, 5] / template[0, 2, 1], photo[0, 8, 7] / template[0, 4, 3]]
    np.testing.assert_allclose(found.scale, expected, rtol=1e-4)
    np.testing.assert_allclose(found.angle_rad, np.pi / 6, atol=1e-5)
    assert len(facade.turns(template, photo, cells[:0], others[:0]).scale) == 0
