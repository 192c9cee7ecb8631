"""Confidence maps beside depth."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.perception.inputs.depth.confidence import is_confidence, without_unsure
from diorama_core.perception.inputs.depth.reading import DepthOptions, read_depth
from diorama_core.perception.inputs.source import read_source
from tests.perception.inputs.files import decoded, depth_png, npy

DEPTH = np.full((48, 64), 2500, np.uint16)
LEVELS = np.full((48, 64), 2, np.uint8)
LEVELS[:12] = 0
LEVELS[12:24] = 1


def write(path: Path, values: np.ndarray) -> None:
    path.parent.mkdir(exist_ok=True)
    if path.suffix == ".png":
        Image.fromarray(values).save(path)
    else:
        path.write_bytes(npy(values) if path.suffix == ".npy" else values.tobytes())


@pytest.mark.parametrize(
    ("depth", "confidence", "values"),
    [
        ("depth.png", "confidence.png", LEVELS),
        ("depth_0001.png", "confidence_0001.png", LEVELS * 127),
        ("a.png", "a_confidence.npy", LEVELS),
        ("a.png", "a.conf.bin", LEVELS),
        ("depth/000001.png", "confidence/000001.png", LEVELS),
    ],
)
def test_what_is_unsure_is_left_out_and_said(tmp_path: Path, depth: str, confidence: str, values: np.ndarray) -> None:
    (tmp_path / depth).parent.mkdir(exist_ok=True)
    (tmp_path / depth).write_bytes(depth_png(DEPTH))
    write(tmp_path / confidence, values)
    found, notes = read_depth(read_source(tmp_path / depth, "depth"), DepthOptions(1000.0), decoded(64, 48))
    assert (found[:12] == 0).all()
    assert (found[12:] == 2.5).all()
    assert notes[0] == f"25% of the depth is unsure by {Path(confidence).name}, and left out"


@pytest.mark.parametrize("values", [LEVELS[:10], np.full((48, 64), 0.5, np.float32), np.zeros((48, 64), np.uint8)])
def test_what_is_no_confidence_is_not_used_and_said(tmp_path: Path, values: np.ndarray) -> None:
    (tmp_path / "depth.png").write_bytes(depth_png(DEPTH))
    write(tmp_path / "confidence.npy", values)
    found, notes = without_unsure(read_source(tmp_path / "depth.png", "depth"), DEPTH)
    assert (found == DEPTH).all()
    assert "it was not used" in notes[0]


def test_depth_alone_stays_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "depth.png").write_bytes(depth_png(DEPTH))
    (tmp_path / "other_confidence.png").write_bytes(depth_png(DEPTH))
    assert without_unsure(read_source(tmp_path / "depth.png", "depth"), DEPTH)[1] == ()


@pytest.mark.parametrize(("name", "is_one"), [
    ("confidence.png", True), ("a/depthConfidence_01.tif", True), ("x.conf", True), ("confidence/000001.png", True),
    ("room_conf.png", True), ("conference_room.jpg", False), ("confidence.json", False), ("depth.png", False),
])  # fmt: skip
def test_confidence_is_known_by_its_name(name: str, is_one: bool) -> None:
    assert is_confidence(name) == is_one


def test_confidence_in_the_archive_of_the_depth(tmp_path: Path) -> None:
    np.savez(tmp_path / "d.npz", depth=DEPTH, confidence=LEVELS)
    found, notes = read_depth(read_source(tmp_path / "d.npz", "depth"), DepthOptions(1000.0), decoded(64, 48))
    assert (found[:12] == 0).all()
    assert "25% of the depth is unsure by its confidence" in notes[0]
    np.savez(tmp_path / "d.npz", depth=DEPTH, conf=LEVELS / 2.0)
    found, notes = read_depth(read_source(tmp_path / "d.npz", "depth"), DepthOptions(1000.0), decoded(64, 48))
    assert (found == 2.5).all()
    assert "its conf is no map of whole numbers" in notes[0]
