"""Cameras and metric depth recovered from synthetic outputs with known answers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import UnavailableError
from diorama_core.models.depth import SIDE, DepthAnything3, Metric3d, Moge2, recover
from diorama_core.models.runtime import NetworkError, SessionPool
from diorama_core.scene.types import Intrinsics
from tests.models.tiny_networks import export

HEIGHT, WIDTH = 96, 128


def _room(focal: float) -> tuple[np.ndarray, np.ndarray]:
    """Points and normals of a floor 0.4 m below the camera and a wall 4 m ahead, through pixel centres."""
    x = (np.arange(WIDTH) + 0.5 - WIDTH / 2) / focal
    y = (np.arange(HEIGHT) + 0.5 - HEIGHT / 2) / focal
    rays = np.stack([*np.meshgrid(x, y), np.ones((HEIGHT, WIDTH))], axis=-1)
    floor = 0.4 / np.maximum(rays[..., 1], 1e-6)
    depth = np.minimum(floor, 4.0)
    normals = np.where((floor < 4.0)[..., None], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0])
    return rays * depth[..., None], normals


@given(
    focal=st.floats(60.0, 300.0),
    shift=st.floats(-0.9, 5.0),
    unit=st.floats(0.2, 5.0),
    flip=st.booleans(),
)
def test_camera_and_metres_come_back_from_affine_points(focal: float, shift: float, unit: float, flip: bool) -> None:
    points, normals = _room(focal)
    affine = points / unit
    affine[..., 2] -= shift * affine[..., 2].min()
    seen = recover(affine, -normals if flip else normals, np.ones((HEIGHT, WIDTH)), unit)
    assert seen.intrinsics.fx == pytest.approx(focal, rel=1e-3)
    np.testing.assert_allclose(seen.depth_m, points[..., 2], rtol=2e-3)
    np.testing.assert_allclose(seen.normals_camera, normals, atol=1e-6)


def test_noise_and_invalid_pixels_do_little_harm(rng: np.random.Generator) -> None:
    points, normals = _room(110.0)
    noisy = points * (1 + 0.01 * rng.normal(size=points.shape))
    validity = np.ones((HEIGHT, WIDTH))
    validity[:20, :30] = 0.1
    noisy[:20, :30] = np.nan
    noisy[..., 2] -= 0.5
    seen = recover(noisy, normals, validity, 1.0)
    assert seen.intrinsics.fx == pytest.approx(110.0, rel=0.05)
    assert (seen.depth_m[:20, :30] == 0).all()
    assert (seen.normals_camera[:20, :30] == 0).all()
    known = seen.depth_m > 0
    assert np.median(np.abs(seen.depth_m[known] / points[..., 2][known] - 1)) < 0.05


def test_a_given_focal_length_is_retained() -> None:
    points, normals = _room(110.0)
    points[..., 2] -= 0.7
    k = Intrinsics(WIDTH, HEIGHT, 110.0, 110.0, WIDTH / 2, HEIGHT / 2)
    seen = recover(points, normals, np.ones((HEIGHT, WIDTH)), 1.0, k)
    assert seen.intrinsics == k
    np.testing.assert_allclose(seen.depth_m, points[..., 2] + 0.7, rtol=2e-3)


def test_a_flat_wall_leaves_the_focal_length_open_and_gets_a_usual_one() -> None:
    points = _room(110.0)[0]
    points *= (4.0 / points[..., 2])[..., None]
    wall = np.broadcast_to([0.0, 0.0, -1.0], points.shape)
    seen = recover(points, wall, np.ones((HEIGHT, WIDTH)), 1.0)
    assert 0.4 * WIDTH < seen.intrinsics.fx < 1.6 * WIDTH


def test_a_picture_without_geometry_is_one_clear_line() -> None:
    points, normals = _room(110.0)
    with pytest.raises(UnavailableError, match="embedded"):
        recover(points, normals, np.zeros((HEIGHT, WIDTH)), 1.0)


class _Moge(torch.nn.Module):
    """MoGe-2's signature; its points are the room above, whatever the picture."""

    def __init__(self) -> None:
        super().__init__()
        points, normals = _room(110.0)
        points[..., 2] -= 0.5
        self.register_buffer("points", torch.from_numpy(points / 2.0).float()[None])
        self.register_buffer("normals", torch.from_numpy(normals).float()[None])

    def forward(self, image: torch.Tensor, num_tokens: torch.Tensor) -> tuple[torch.Tensor, ...]:
        nothing = 0.0 * image.mean(dim=1)[..., None] + 0.0 * num_tokens.float()
        valid = (image.mean(dim=1) >= 0).float()
        return self.points + nothing, self.normals + nothing, valid, torch.full((1,), 2.0) + 0.0 * nothing.sum()


def test_moge_end_to_end(tmp_path: Path) -> None:
    arguments = (torch.zeros(1, 3, HEIGHT, WIDTH), torch.tensor(1800))
    outputs = ["points", "normal", "mask", "metric_scale"]
    graph = export(_Moge(), arguments, tmp_path / "moge.onnx", ["image", "num_tokens"], outputs)
    picture = np.full((HEIGHT, WIDTH, 3), 90, np.uint8)
    seen = Moge2(graph, pool=SessionPool()).predict(picture, None)
    assert seen.depth_m.shape == (HEIGHT, WIDTH)
    assert seen.intrinsics.fx == pytest.approx(110.0, rel=1e-3)
    np.testing.assert_allclose(seen.depth_m, _room(110.0)[0][..., 2], rtol=2e-3)


class _Metric(torch.nn.Module):
    """Metric3D's signature: canonical depth that grows along x, normals toward the camera."""

    def forward(self, pixels: torch.Tensor) -> tuple[torch.Tensor, ...]:
        column = torch.arange(1064).float()[None, None, None, :].expand(1, 1, 616, 1064)
        depth = 2.0 + column / 1000 + 0.0 * pixels[:, :1]
        normal = torch.stack([0.0 * depth[:, 0], 0.0 * depth[:, 0], depth[:, 0]], dim=1)
        return depth, normal, depth


@pytest.mark.parametrize("size", [(300, 500), (500, 300)], ids=["wide", "tall"])
def test_metric3d_undoes_padding_scale_and_canonical_camera(tmp_path: Path, size: tuple[int, int]) -> None:
    names = ["predicted_depth", "predicted_normal", "normal_confidence"]
    graph = export(_Metric(), (torch.zeros(1, 3, 616, 1064),), tmp_path / "metric.onnx", ["pixel_values"], names)
    height, width = size
    k = Intrinsics(width, height, 400.0, 400.0, width / 2, height / 2)
    facade = Metric3d(graph, pool=SessionPool())
    seen = facade.predict(np.full((height, width, 3), 90, np.uint8), k)
    scale = min(616 / height, 1064 / width)
    left = (1064 - int(width * scale)) // 2
    inner = int(width * scale)
    columns = left + (np.arange(width) + 0.5) * inner / width - 0.5
    expected = (2.0 + columns / 1000) * (400.0 * inner / width) / 1000.0
    np.testing.assert_allclose(seen.depth_m, np.broadcast_to(expected, size), rtol=2e-3)
    np.testing.assert_allclose(seen.normals_camera, np.broadcast_to([0, 0, -1.0], (*size, 3)), atol=1e-6)
    assert seen.intrinsics == k
    assert facade.predict(np.zeros((height, width, 3), np.uint8), None).intrinsics.horizontal_fov_rad == pytest.approx(
        1.05
    )


FOCAL = 110.0
WALL_M = 4.0
CAMERA = Intrinsics(WIDTH, HEIGHT, FOCAL, FOCAL, WIDTH / 2, HEIGHT / 2)


class _Room(torch.nn.Module):
    """The signature of the published graph; it answers a wall below the sky, whatever the picture."""

    def __init__(self, sky_rows: int) -> None:
        super().__init__()
        k = CAMERA.resize(SIDE, SIDE)
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
