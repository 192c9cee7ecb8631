"""The reader of surfaces knows how a picture is turned, and where floor, wall and ceiling are behind furniture."""

from __future__ import annotations

import logging
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.evaluation.benchmarks.cases import Case, studio_of
from diorama_core.io import assets
from diorama_core.library.catalogue import built_in_library
from diorama_core.models.efficientnet import MAP_CHANNELS
from diorama_core.models.room_surfaces import (
    CELL_PX,
    OUTPUTS,
    SIDE_PX,
    backbone_maps,
    elevation_sines,
    network_size,
    own_surface_reader,
)
from diorama_core.scene.types import Camera
from tests.synthetic_rooms import look


@given(st.integers(40, 4000), st.integers(40, 4000))
def test_pictures_are_seen_in_sides_that_32_divides(height: int, width: int) -> None:
    h, w = network_size((height, width))
    assert h % 32 == w % 32 == 0
    assert max(h, w) == SIDE_PX
    shorter = min(height, width) / max(height, width) * SIDE_PX
    assert min(h, w) == 32 or abs(min(h, w) - shorter) <= 16


@given(st.floats(-40, 40), st.floats(-60, 60))
def test_elevations_are_those_of_the_lines_of_sight(yaw: float, pitch: float) -> None:
    camera = look(yaw, pitch, size=(640, 480))
    sines = elevation_sines(camera, (96, 128))
    ray = camera.rays(np.array([[(100 + 0.5) * 5, (20 + 0.5) * 5]]))[0]
    assert sines[20, 100] == pytest.approx(ray[2] / np.linalg.norm(ray), abs=1e-6)
    assert (np.diff(sines[:, 64]) < 0).all(), "higher rows look higher"


def test_maps_of_the_backbone_have_the_sizes_that_they_are_named_for() -> None:
    maps = backbone_maps(np.zeros((64, 96, 3), np.uint8))
    for name, channels in MAP_CHANNELS.items():
        stride = int(name.removeprefix("stride_"))
        assert maps[name].shape == (1, channels, 64 // stride, 96 // stride)


def test_a_rendered_room_is_read_behind_its_furniture() -> None:
    studio, cameras = studio_of(Case(3, "bedroom"), built_in_library(), (256, 192))
    camera = Camera(cameras[0].intrinsics.resize(256, 192), cameras[0].T_world_camera)
    rgb, ids = studio.photograph(camera, (256, 192))
    reader = own_surface_reader()
    assert reader is not None
    shares = reader.read(rgb, camera)
    np.testing.assert_allclose(shares.sum(axis=0), 1.0, atol=1e-4)
    cells = Camera(camera.intrinsics.resize(SIDE_PX // CELL_PX, SIDE_PX * 3 // 4 // CELL_PX), camera.T_world_camera)
    planes = studio.scene.architecture.planes
    shown = studio.empty_room_planes(cells)
    kind = np.array([OUTPUTS.index(p.role) for p in planes])[shown]
    right = shares.argmax(axis=0) == kind
    behind = np.kron(ids >= 0, np.ones((2, 2)))[::4, ::4].astype(bool)
    assert right.mean() > 0.9
    assert behind.mean() > 0.1
    assert right[behind].mean() > 0.8


def test_a_missing_head_is_one_line_in_the_log(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(assets, "FOLDER", tmp_path)
    with caplog.at_level(logging.WARNING):
        assert own_surface_reader.__wrapped__() is None
    assert "room-surfaces.onnx: is missing; restore it from the repository" in caplog.text


def test_other_weights_are_another_reader() -> None:
    reader = own_surface_reader()
    assert reader is not None
    assert replace(reader, weights="others") != reader
