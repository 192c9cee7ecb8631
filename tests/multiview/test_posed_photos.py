from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import InputError
from diorama_core.multiview.posed_photos import OPENCV_FROM_OPENGL, PosedPhoto, read_poses
from tests.multiview.colmap_files import write_colmap
from tests.multiview.rooms import CAMERAS

PHOTOS = tuple(PosedPhoto(f"views/{n}.jpg", camera) for n, camera in enumerate(CAMERAS))


def _same(found, *, names: bool = True) -> None:
    assert len(found.photos) == len(PHOTOS)
    for one, true in zip(found.photos, PHOTOS, strict=True):
        assert not names or one.name == true.name
        np.testing.assert_allclose(one.camera.T_world_camera, true.camera.T_world_camera, atol=1e-9)
        assert one.camera.intrinsics == true.camera.intrinsics


@pytest.mark.parametrize("kind", ["text", "binary"])
@pytest.mark.parametrize("place", [".", "sparse/0", "sparse"])
def test_colmap(tmp_path: Path, kind, place: str) -> None:
    write_colmap(tmp_path / place, PHOTOS, kind)
    found = read_poses(tmp_path)
    _same(found)
    assert not found.metric
    assert found.up is None


def test_colmap_s_own_library_reads_what_is_written(tmp_path: Path) -> None:
    pycolmap = pytest.importorskip("pycolmap", reason="needs pycolmap")
    write_colmap(tmp_path, PHOTOS, "binary")
    (tmp_path / "points3D.bin").write_bytes(bytes(8))
    if hasattr(pycolmap, "Rig"):  # newer ones also ask for rigs and frames, which they make up for older models
        (tmp_path / "points3D.txt").write_text("")
    model = pycolmap.Reconstruction(str(tmp_path))
    assert sorted(image.name for image in model.images.values()) == [p.name for p in PHOTOS]


def _transform(camera) -> list:
    return (camera.T_world_camera @ OPENCV_FROM_OPENGL).tolist()


def test_nerfstudio(tmp_path: Path) -> None:
    k = CAMERAS[0].intrinsics
    frames = [{"file_path": p.name, "transform_matrix": _transform(p.camera)} for p in PHOTOS]
    shared = {"fl_x": k.fx, "fl_y": k.fy, "cx": k.cx, "cy": k.cy, "w": k.width, "h": k.height}
    (tmp_path / "transforms.json").write_text(json.dumps({**shared, "frames": frames}))
    _same(read_poses(tmp_path))
    _same(read_poses(tmp_path / "transforms.json"))
    bent = {**shared, "k1": 0.4, "frames": frames}
    (tmp_path / "transforms.json").write_text(json.dumps(bent))
    assert "undistort" in read_poses(tmp_path).notes[0]


def test_arkit_frames_are_metric_with_y_up(tmp_path: Path) -> None:
    cameras = tmp_path / "keyframes" / "cameras"
    cameras.mkdir(parents=True)
    for number, photo in enumerate(PHOTOS):
        T, k = photo.camera.T_world_camera @ OPENCV_FROM_OPENGL, photo.camera.intrinsics
        row = {f"t_{i}{j}": float(T[i, j]) for i in range(3) for j in range(4)}
        row |= {"width": k.width, "height": k.height, "fx": k.fx, "fy": k.fy, "cx": k.cx, "cy": k.cy}
        (cameras / f"{number}.json").write_text(json.dumps(row))
        frame = {
            "cameraPoseARFrame": T.ravel().tolist(),
            "intrinsics": [k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1],
        }
        (tmp_path / f"frame_{number:05}.json").write_text(json.dumps(frame))
    scanner = read_poses(tmp_path)
    _same(scanner, names=False)
    for file in tmp_path.glob("frame_*.json"):
        file.unlink()
    polycam = read_poses(tmp_path)
    _same(polycam, names=False)
    assert polycam.metric
    np.testing.assert_array_equal(polycam.up, [0, 1, 0])


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("transforms.json", "{}"),
        ("transforms.json", '{"frames": []}'),
        ("transforms.json", '{"frames": [{"file_path": "a", "transform_matrix": [[1]], "fl_x": 1, "w": 4, "h": 3}]}'),
        ("frame_00000.json", '{"cameraPoseARFrame": [0]}'),
        ("notes.txt", ""),
    ],
)
def test_what_makes_no_sense_is_one_line(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=tmp_path.name):
        read_poses(tmp_path)


@pytest.mark.parametrize("damage", [lambda b: b[:40], lambda b: b"\xff" * len(b), lambda b: b""])
def test_a_damaged_model_is_one_line(tmp_path: Path, damage) -> None:
    write_colmap(tmp_path, PHOTOS, "binary")
    file = tmp_path / "images.bin"
    file.write_bytes(damage(file.read_bytes()))
    with pytest.raises(InputError):
        read_poses(tmp_path)
