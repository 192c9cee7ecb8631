"""Depth Anything 3: metres from canonical depth and the focal length, no depth in the sky, normals from the depth."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from diorama_core.models.depth_anything import SIDE, DepthAnything3
from diorama_core.models.runtime import NetworkError, SessionPool
from diorama_core.scene.types import Intrinsics
from tests.models.tiny_networks import export

HEIGHT, WIDTH = 96, 128
FOCAL = 110.0
WALL_M = 4.0
CAMERA = Intrinsics(WIDTH, HEIGHT, FOCAL, FOCAL, WIDTH / 2, HEIGHT / 2)


class _Room(torch.nn.Module):
    """The signature of the published graph; it answers a wall below the sky, whatever the picture."""

    def __init__(self, sky_rows: int) -> None:
        super().__init__()
        k = CAMERA.scaled(SIDE, SIDE)
        self.register_buffer("depth", torch.full((1, 1, SIDE, SIDE), WALL_M * 300.0 / ((k.fx + k.fy) / 2)))
        sky = torch.zeros(1, 1, SIDE, SIDE)
        sky[:, :, :sky_rows] = 0.9
        self.register_buffer("sky", sky)

    def forward(self, image: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        nothing = 0.0 * image.mean()
        return self.depth + nothing, self.sky + nothing


@pytest.fixture
def rgb(rng: np.random.Generator) -> np.ndarray:
    return rng.integers(0, 255, (HEIGHT, WIDTH, 3)).astype(np.uint8)


def _network(folder: Path, sky_rows: int) -> DepthAnything3:
    example = (torch.zeros(1, 3, SIDE, SIDE),)
    graph = export(_Room(sky_rows), example, folder / "model.onnx", ["image"], ["depth", "sky"])
    return DepthAnything3(graph, pool=SessionPool())


def test_metres_follow_from_the_focal_length(tmp_path: Path, rgb: np.ndarray) -> None:
    network = _network(tmp_path, 0)
    seen = network.predict(rgb, CAMERA)
    assert seen.intrinsics == CAMERA
    np.testing.assert_allclose(seen.depth_m, WALL_M, rtol=1e-5)
    inner = seen.normals_camera[8:-8, 8:-8]
    np.testing.assert_allclose(inner, np.broadcast_to([0.0, 0.0, -1.0], inner.shape), atol=1e-5)
    longer = Intrinsics(WIDTH, HEIGHT, 2 * FOCAL, 2 * FOCAL, WIDTH / 2, HEIGHT / 2)
    np.testing.assert_allclose(network.predict(rgb, longer).depth_m, 2 * WALL_M, rtol=1e-5)


def test_the_sky_has_no_depth(tmp_path: Path, rgb: np.ndarray) -> None:
    seen = _network(tmp_path, SIDE // 2).predict(rgb, None)
    assert (seen.depth_m[: HEIGHT // 2 - 1] == 0).all()
    assert (seen.depth_m[HEIGHT // 2 + 1 :] > 0).all()
    assert seen.intrinsics.horizontal_fov_rad == pytest.approx(1.05)


def test_nothing_but_sky_is_one_clear_line(tmp_path: Path, rgb: np.ndarray) -> None:
    with pytest.raises(NetworkError, match="no geometry"):
        _network(tmp_path, SIDE).predict(rgb, None)


def test_the_picture_is_stretched_and_normalised(rgb: np.ndarray) -> None:
    grey = np.full_like(rgb, 128)
    pixels = DepthAnything3(Path("unused.onnx")).pixels(grey)
    assert pixels.shape == (1, 3, SIDE, SIDE)
    expected = (128 / 255 - np.array([0.485, 0.456, 0.406])) / np.array([0.229, 0.224, 0.225])
    np.testing.assert_allclose(pixels[0, :, 10, 10], expected, atol=1e-5)
