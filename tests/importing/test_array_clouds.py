"""Clouds as bare numbers become the same room as any others, and other arrays are no clouds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import InputError
from diorama_core.importing.forms import open_form
from diorama_core.importing.point_files import read_points
from tests.importing.scans import room_points

RANDOM = np.random.default_rng(0)
POINTS = RANDOM.permutation(room_points(count=12_000))
MANY = len(POINTS)


def dump(path: Path, *columns: np.ndarray) -> Path:
    np.column_stack(columns).astype("<f4").tofile(path)
    return path


def saved(path: Path, array: np.ndarray) -> Path:
    np.save(path, array)
    return path


def assert_room(path: Path, points: np.ndarray = POINTS) -> None:
    found = read_points(path)
    assert len(found.points) > 0.9 * MANY
    for share in (5, 50, 95):
        expected = np.percentile(points, share, axis=0) - np.median(points, axis=0)
        off = np.percentile(found.points, share, axis=0) - np.median(found.points, axis=0)
        assert off == pytest.approx(expected, abs=0.05)


@pytest.mark.parametrize("middle", [0.0, 1.0])
def test_dumps_of_floats_tell_their_width(tmp_path: Path, middle: float) -> None:
    points = POINTS - middle * POINTS.mean(axis=0)
    bright, ring = RANDOM.random(MANY), RANDOM.integers(0, 32, MANY)
    assert_room(dump(tmp_path / "xyz.bin", points))
    assert_room(dump(tmp_path / "kitti.bin", points, bright))
    assert_room(dump(tmp_path / "nuscenes.pcd.bin", points, 255 * bright, ring))
    assert_room(dump(tmp_path / "colours.bin", points, RANDOM.random((MANY, 3))))


def test_arrays_of_points(tmp_path: Path) -> None:
    assert_room(saved(tmp_path / "rows.npy", POINTS))
    assert_room(saved(tmp_path / "columns.npy", POINTS.T))
    colours = RANDOM.integers(0, 255, (MANY, 3))
    millimetres = saved(tmp_path / "mm.npy", np.column_stack([1000 * POINTS, colours]).astype(np.int32))
    assert_room(millimetres)
    assert any("millimetres" in note for note in read_points(millimetres).notes)
    fields = np.zeros(MANY, [("i", "u1"), ("x", "f4"), ("y", "f4"), ("z", "f8")])
    fields["x"], fields["y"], fields["z"] = POINTS.T
    assert_room(saved(tmp_path / "fields.npy", fields))
    np.savez_compressed(tmp_path / "several.npz", rgb=np.zeros((8, 8, 3), np.uint8), xyz=POINTS)
    assert_room(tmp_path / "several.npz")


def test_other_numbers_are_no_points(tmp_path: Path) -> None:
    others = (
        saved(tmp_path / "depth.npy", np.ones((480, 640), np.float32)),
        saved(tmp_path / "map.npy", np.ones((48, 64, 3), np.float32)),
        saved(tmp_path / "features.npy", np.ones((3000, 512), np.float32)),
    )
    for path in others:
        with pytest.raises(InputError, match="array of numbers"), open_form(path):
            pass
    dumps = {
        "millimetres.bin": (1000 + RANDOM.integers(0, 3000, 300_000)).astype(np.uint16).tobytes(),
        "metres.bin": (1 + RANDOM.random(100_000)).astype(np.float32).tobytes(),
        "bytes.bin": RANDOM.bytes(400_000),
    }
    for name, data in dumps.items():
        (tmp_path / name).write_bytes(data)
        with pytest.raises(InputError, match="holds no points"):
            read_points(tmp_path / name)


def test_a_header_that_promises_too_much_is_no_cloud(tmp_path: Path) -> None:
    data = saved(tmp_path / "rows.npy", POINTS).read_bytes()
    (tmp_path / "short.npy").write_bytes(data[:5000])
    with pytest.raises(InputError, match="holds no points"):
        read_points(tmp_path / "short.npy")
