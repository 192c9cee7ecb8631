"""The room behind the furniture, on rooms whose geometry is known with and without what stands in them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.models.foreground import ForegroundNetwork
from diorama_core.models.seen_depth import SeenDepth
from diorama_core.perception.foundation.empty_room import EmptyRoomArchitecture
from diorama_core.progress import Progress
from diorama_core.provenance import DepthSource
from diorama_core.scene.types import Intrinsics
from tests.synthetic_rooms import Shot, box_room, cuboid, look, shoot

CAMERA = look(0, 12, 1.5, size=(320, 240))
ROOM = box_room(-1.9, 1.9, 4.2, 2.6)
ITEMS = (
    cuboid("wardrobe", (0.0, 3.7, 0.0), (0.7, 3.6, 2.5), -90),
    cuboid("chair", (-0.9, 2.2, 0.0), (0.5, 0.5, 0.9)),
)


@dataclass(frozen=True)
class _Painter:
    """Paints holes as the empty room looks."""

    empty: np.ndarray

    def fill(self, rgb: np.ndarray, hole: np.ndarray) -> np.ndarray:
        return np.where(hole[..., None], self.empty, rgb)


@dataclass(frozen=True)
class _DepthPrediction:
    """Sees the empty room's true depth where it was painted, in another unit than the photo's depth has."""

    shot: Shot
    unit: float

    def predict(self, rgb: np.ndarray, intrinsics: Intrinsics | None) -> SeenDepth:
        assert intrinsics == CAMERA.intrinsics
        assert np.abs(rgb.astype(int) - self.shot.inputs.photo.rgb).mean() < 30
        depth = (self.shot.inputs.depth_m * self.unit).astype(np.float32)
        return SeenDepth(depth, np.zeros((*depth.shape, 3), np.float32), intrinsics)


@dataclass(frozen=True)
class _Finds:
    """A foreground network that sees what it is told."""

    found: np.ndarray

    def mask(self, rgb: np.ndarray, threshold: float = 0.5) -> np.ndarray:
        return self.found


def _shots() -> tuple[Shot, Shot]:
    full, empty = shoot(CAMERA, ROOM, ITEMS), shoot(CAMERA, ROOM)
    return replace(full, inputs=replace(full.inputs, depth_source=DepthSource.NETWORK)), empty


def _back_wall_m(shot: Shot, stage: EmptyRoomArchitecture | PlanarRoom) -> float:
    """Distance of the wall ahead along +Y."""
    found = stage.reconstruct(shot.inputs, shot.objects, shot.geometry, Progress())
    ahead = [p for p in found.architecture.planes if p.role == "wall" and p.normal[1] < -0.9]
    return float(np.mean([p.polygon[:, 1].mean() for p in ahead]))


@pytest.mark.parametrize("unit", [1.0, 0.7])
def test_a_wall_behind_a_wardrobe_is_found_where_it_is(unit: float) -> None:
    full, empty = _shots()
    stage = EmptyRoomArchitecture(PlanarRoom(), _Painter(empty.inputs.photo.rgb), _DepthPrediction(empty, unit))
    assert _back_wall_m(full, stage) == pytest.approx(4.2, abs=0.08)


def test_what_no_mask_covers_is_found_by_the_foreground_networks() -> None:
    full, empty = _shots()
    unmasked = replace(full, objects=())
    painter, depth_prediction = _Painter(empty.inputs.photo.rgb), _DepthPrediction(empty, 1.0)
    finds: tuple[ForegroundNetwork, ...] = (_Finds(full.inputs.instances > 0),)
    assert _back_wall_m(unmasked, EmptyRoomArchitecture(PlanarRoom(), painter, depth_prediction)) < 4.0
    assert _back_wall_m(
        unmasked, EmptyRoomArchitecture(PlanarRoom(), painter, depth_prediction, finds)
    ) == pytest.approx(4.2, abs=0.08)


def test_a_foreground_that_takes_the_room_for_an_object_is_not_believed() -> None:
    full, _ = _shots()
    everything: tuple[ForegroundNetwork, ...] = (_Finds(np.ones((240, 320), dtype=bool)),)
    stage = EmptyRoomArchitecture(
        PlanarRoom(), _Painter(full.inputs.photo.rgb), _DepthPrediction(full, 1.0), everything
    )
    hole = stage.hole(full.inputs.photo.rgb, full.objects)
    assert hole.mean() < 0.9
    assert hole[full.inputs.instances > 0].all()


def test_an_empty_photo_is_left_alone() -> None:
    _, empty = _shots()
    stage = EmptyRoomArchitecture(PlanarRoom(), _Painter(empty.inputs.photo.rgb), _DepthPrediction(empty, 1.0))
    alone = PlanarRoom().reconstruct(empty.inputs, (), empty.geometry, Progress())
    assert stage.reconstruct(empty.inputs, (), empty.geometry, Progress()).source == alone.source
