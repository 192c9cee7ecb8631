"""Folders as data sets lay them out give the room that their depth was made of."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from jaxtyping import Float
from PIL import Image
from scipy.spatial.transform import Rotation

from diorama_core.errors import InputError
from diorama_core.importing.depth_frames import KINECT
from diorama_core.importing.forms import open_form
from diorama_core.importing.point_files import read_points
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.types import Camera, Intrinsics
from tests.importing.scans import FROM_OPENCV, cameras, room_meshes

Shots = Sequence[tuple[Camera, Float[np.ndarray, "h w"]]]


@cache
def shots(k: Intrinsics) -> Shots:
    caster = MeshCaster([(m, np.eye(4)) for m in room_meshes()])
    posed = [Camera(k, c.T_world_camera) for c in cameras(6)]
    return [(camera, caster.buffers(camera).depth_m) for camera in posed]


def save(path: Path, depth: np.ndarray, steps: float, void: int = 0) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    whole = np.round(depth * steps).astype(np.uint16)
    whole[:2] = void
    Image.fromarray(whole).save(path, "PPM" if path.suffix == ".pgm" else "PNG")


def rows(T: np.ndarray) -> str:
    return "\n".join(" ".join(f"{v:.9g}" for v in row) for row in T) + "\n"


SMALL = Intrinsics(160, 120, 146.25, 146.25, 80.0, 60.0)


def seven_scenes(folder: Path) -> None:
    for n, (camera, depth) in enumerate(shots(SMALL)):
        save(folder / "seq-01" / f"frame-{n:06d}.depth.png", depth, 1000, 65535)
        (folder / "seq-01" / f"frame-{n:06d}.pose.txt").write_text(rows(camera.T_world_camera))


def older_scannet(folder: Path) -> None:
    k = Intrinsics(160, 120, 120.0, 121.0, 82.0, 59.0)
    folder.mkdir()
    (folder / "_info.txt").write_text(
        f"m_depthShift = 1000\nm_calibrationDepthIntrinsic = {k.fx} 0 {k.cx} 0 0 {k.fy} {k.cy} 0 0 0 1 0 0 0 0 1\n"
    )
    for n, (camera, depth) in enumerate(shots(k)):
        save(folder / f"frame-{n:06d}.depth.pgm", depth, 1000)
        pose = np.full((4, 4), -np.inf) if n == 2 else camera.T_world_camera
        (folder / f"frame-{n:06d}.pose.txt").write_text(rows(pose))


def replica(folder: Path) -> None:
    k = Intrinsics(150, 85, 75.0, 75.0, 74.9375, 42.4375)
    for n, (_, depth) in enumerate(shots(k)):
        save(folder / "results" / f"depth{n:06d}.png", depth, 6553.5)
    lines = [" ".join(f"{v:.9g}" for v in camera.T_world_camera.ravel()) for camera, _ in shots(k)]
    (folder / "traj.txt").write_text("\n".join(lines))


def scaled_replica(folder: Path) -> None:
    replica(folder)
    camera = {"w": 150, "h": 85, "fx": 75.0, "fy": 75.0, "cx": 74.9375, "cy": 42.4375, "scale": 5000.0}
    (folder / "cam_params.json").write_text(json.dumps({"camera": camera}))
    for n, (_, depth) in enumerate(shots(Intrinsics(150, 85, 75.0, 75.0, 74.9375, 42.4375))):
        save(folder / "results" / f"depth{n:06d}.png", depth, 5000.0)


def matterport(folder: Path) -> None:
    lines = [f"intrinsics_matrix {SMALL.fx} 0 {SMALL.cx} 0 {SMALL.fy} {SMALL.cy} 0 0 1"]
    for n, (camera, depth) in enumerate(shots(SMALL)):
        save(folder / "undistorted_depth_images" / f"a_d0_{n}.png", depth, 4000)
        T = camera.T_world_camera @ FROM_OPENCV
        lines.append(f"scan a_d0_{n}.png a_i0_{n}.jpg " + " ".join(f"{v:.9g}" for v in T.ravel()))
    (folder / "undistorted_camera_parameters").mkdir()
    (folder / "undistorted_camera_parameters" / "a.conf").write_text("\n".join(lines))


def scannet(folder: Path) -> None:
    for n, (camera, depth) in enumerate(shots(SMALL)):
        save(folder / "depth" / f"{n}.png", depth, 1000)
        (folder / "pose").mkdir(exist_ok=True)
        (folder / "pose" / f"{n}.txt").write_text(rows(camera.T_world_camera))
    (folder / "intrinsic").mkdir()
    K = np.eye(4)
    K[0, 0], K[1, 1], K[0, 2], K[1, 2] = SMALL.fx, SMALL.fy, SMALL.cx, SMALL.cy
    (folder / "intrinsic" / "intrinsic_depth.txt").write_text(rows(K))


def tum(folder: Path) -> None:
    listed, poses = [], []
    for n, (camera, depth) in enumerate(shots(KINECT.resize(160, 120))):
        save(folder / "depth" / f"{n}.png", depth, 5000)
        listed.append(f"{n}.0 depth/{n}.png")
        quaternion = Rotation.from_matrix(camera.T_world_camera[:3, :3]).as_quat()
        poses.append(" ".join(f"{v:.9g}" for v in (n + 0.01, *camera.position, *quaternion)))
    (folder / "depth.txt").write_text("# depth\n" + "\n".join(listed))
    (folder / "groundtruth.txt").write_text("# poses\n" + "\n".join(poses))


@pytest.mark.parametrize("write", [seven_scenes, older_scannet, replica, scaled_replica, matterport, scannet, tum])
def test_a_data_set_s_folder_is_a_room(tmp_path: Path, write: Callable[[Path], None]) -> None:
    write(tmp_path / "room")
    with open_form(tmp_path / "room") as (form, place):
        assert "frames" in form.name or form.name == "TUM RGB-D"
        points = read_points(place).points
    expected = np.array([m.bounds for m in room_meshes()])
    low, high = expected[:, 0].min(axis=0), expected[:, 1].max(axis=0)
    np.testing.assert_allclose(np.percentile(points, 0.2, axis=0), low, atol=0.06)
    np.testing.assert_allclose(np.percentile(points, 99.8, axis=0), high, atol=0.06)


@pytest.mark.parametrize(
    ("files", "line"),
    [
        (["images/scene_cam_00_geometry_hdf5/frame.0000.depth_meters.hdf5"], "Hypersim"),
        (["scene0000_00.sens"], "SensReader"),
        (["dslr/colmap/cameras.txt", "dslr/resized_images/a.JPG"], "COLMAP"),
        (["nyu_depth_v2_labeled.mat"], "MATLAB"),
        (["d-1.pgm", "r-1.ppm"], "depth pictures without cameras"),
    ],
)
def test_other_layouts_are_said(tmp_path: Path, files: list[str], line: str) -> None:
    for name in files:
        (tmp_path / "room" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "room" / name).write_bytes(b"x")
    with pytest.raises(InputError, match=line), open_form(tmp_path / "room"):
        pass
