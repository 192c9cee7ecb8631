"""Depth pictures with known cameras, as scanner apps, benchmarks and data sets keep them in folders.

Each form is a small function from a folder to frames; `FRAME_FORMS` is their table.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float
from PIL import Image
from scipy.spatial.transform import Rotation

from diorama_core.errors import InputError
from diorama_core.importing.point_cloud import MAX_POINTS, PointCloud, ScanPhoto, Up
from diorama_core.io.bounded import read_bytes
from diorama_core.io.contained import ContainedFiles
from diorama_core.io.file_heads import FileHead
from diorama_core.multiview.posed_photos import OPENCV_FROM_OPENGL, read_poses
from diorama_core.perception.inputs.depth.voids import is_sure
from diorama_core.scene.types import Camera, Intrinsics

MAX_DEPTH_M = 6.0
"""Reliable range of a phone's depth sensor; farther values are guesses."""
MAX_FRAMES = 400
MILLIMETRE = 0.001
TUM_UNIT_M = 1 / 5000
TUM_APART_S = 0.03
"""Most seconds between a depth picture and the pose that is its own."""
KINECT = Intrinsics(640, 480, 525.0, 525.0, 319.5, 239.5)
"""What TUM RGB-D recommends where a sequence's own calibration is not at hand."""
MAX_TEXT_BYTES = 64_000_000
UP_Y, UP_Z = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class DepthFrame:
    """One depth picture."""

    depth: Path
    camera: Camera
    """Camera of the picture or of the depth; both share one view."""
    confidence: Path | None = None
    picture: Path | None = None
    unit_m: float = MILLIMETRE


@dataclass(frozen=True, eq=False)
class Frames:
    """All depth pictures of a folder."""

    frames: tuple[DepthFrame, ...]
    up: Up | None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class FrameForm:
    """A way in which folders hold depth pictures."""

    name: str
    tells: Callable[[FileHead], bool]
    read: Callable[[Path], Frames]


def polycam_frames(folder: Path) -> Frames:
    """`keyframes/depth`, `confidence` (0, 127, 255), cameras by name; the folder above or the keyframes themselves."""
    keyframes = folder / "keyframes" if (folder / "keyframes").is_dir() else folder
    files, frames = ContainedFiles(folder, InputError), {}
    for path in filter(files.holds, sorted((keyframes / "depth").glob("*.png"))):
        pictures = (keyframes / name / f"{path.stem}.jpg" for name in ("corrected_images", "images"))
        frames[path.stem] = (path, keyframes / "confidence" / path.name, first_of(files, *pictures))
    return _with_poses(keyframes, frames)


def scanner_app_frames(folder: Path) -> Frames:
    """`depth_00000.png`, `conf_00000.png` (0 to 2), `frame_00000.json` and `.jpg`."""
    files, frames = ContainedFiles(folder, InputError), {}
    for path in filter(files.holds, sorted(folder.glob("depth_*.png"))):
        number = path.stem.removeprefix("depth_")
        picture = first_of(files, folder / f"frame_{number}.jpg")
        frames[f"frame_{number}"] = (path, folder / f"conf_{number}.png", picture)
    return _with_poses(folder, frames)


def stray_frames(folder: Path) -> Frames:
    """`depth/000000.png`, `confidence/`, `camera_matrix.csv` of the film, `odometry.csv`; ARKit's world, +Y up."""
    K = numbers_of(folder / "camera_matrix.csv").reshape(3, 3)
    k = Intrinsics(round(2 * K[0, 2]), round(2 * K[1, 2]), K[0, 0], K[1, 1], K[0, 2], K[1, 2])
    files, frames = ContainedFiles(folder, InputError), []
    for row in numbers_of(folder / "odometry.csv", heading=True)[:, :9]:
        name = f"{int(row[1]):06d}.png"
        if files.holds(folder / "depth" / name):
            sure = first_of(files, folder / "confidence" / name)
            frames.append(DepthFrame(folder / "depth" / name, Camera(k, _pose(row[2:5], row[5:9])), sure))
    return Frames(tuple(frames), UP_Y)


def tum_frames(folder: Path) -> Frames:
    """`depth.txt` and `groundtruth.txt` with times; depth in 1/5000 m; the motion capture's world, +Z up."""
    poses = numbers_of(folder / "groundtruth.txt")
    listed = [line.split() for line in text_of(folder / "depth.txt").splitlines() if line and line[0] != "#"]
    pictures = [line.split() for line in text_of(folder / "rgb.txt").splitlines() if line and line[0] != "#"]
    files, frames = ContainedFiles(folder, InputError), []
    for time, name, *_ in listed:
        nearest = int(np.abs(poses[:, 0] - float(time)).argmin())
        depth = folder / name
        if abs(poses[nearest, 0] - float(time)) > TUM_APART_S or not files.holds(depth):
            continue
        shown = min(pictures, key=lambda p: abs(float(p[0]) - float(time)), default=None)
        picture = None if shown is None else first_of(files, folder / shown[1])
        camera = Camera(KINECT.resize(*size_of(depth)), _pose(poses[nearest, 1:4], poses[nearest, 4:8]))
        frames.append(DepthFrame(depth, camera, None, picture, TUM_UNIT_M))
    return Frames(tuple(frames), UP_Z, ("depth of TUM RGB-D, in 1/5000 m",))


def scannet_frames(folder: Path) -> Frames:
    """`depth/0.png` in millimetres, `pose/0.txt`, `intrinsic/intrinsic_depth.txt`; +Z up."""
    K = numbers_of(folder / "intrinsic" / "intrinsic_depth.txt")
    files, frames = ContainedFiles(folder, InputError), []
    for depth in sorted(filter(files.holds, (folder / "depth").glob("*.png")), key=lambda p: (len(p.stem), p.stem)):
        pose, picture = folder / "pose" / f"{depth.stem}.txt", folder / "color" / f"{depth.stem}.jpg"
        if files.holds(pose) and np.isfinite(T := numbers_of(pose).reshape(4, 4)).all():
            k = Intrinsics(*size_of(depth), K[0, 0], K[1, 1], K[0, 2], K[1, 2])
            frames.append(DepthFrame(depth, Camera(k, T), None, first_of(files, picture)))
    return Frames(tuple(frames), UP_Z)


def _has_folder(head: FileHead, folder: str) -> bool:
    return any(name.startswith(folder) or f"/{folder}" in name or f"_{folder}" in name for name in head.names)


def cloud_of_frames(folder: Path, form: FrameForm) -> PointCloud:
    """Points of all frames, as far as the sensor was sure of them.

    Raises:
        InputError: no depth has a camera, or a picture makes no sense.
    """
    frames = form.read(folder)
    if not frames.frames:
        raise InputError(f"{folder}: no depth has a camera of its name; export the scan again")
    used = frames.frames[:: -(-len(frames.frames) // MAX_FRAMES)]
    step = max(1, round(np.sqrt(len(used) * 256 * 192 / MAX_POINTS)))
    points = np.vstack([_points(frame, step) for frame in used])
    photos = tuple(ScanPhoto(f.picture, f.depth, f.camera, f.unit_m) for f in used if f.picture is not None)
    return PointCloud(points, frames.up, (f"{form.name}: {len(used)} frames with depth", *frames.notes), photos)


def read_depth(path: Path, unit_m: float = MILLIMETRE) -> Float[np.ndarray, "h w"]:
    """Depth along the viewing axis in metres, from a PNG or PGM; 0 where the sensor saw nothing."""
    return _picture(path).astype(np.float64) * unit_m


def _picture(path: Path) -> np.ndarray:
    with Image.open(path, formats=("PNG", "PPM")) as opened:
        return np.asarray(opened)


def size_of(depth: Path) -> tuple[int, int]:
    """Width and height of a depth picture."""
    with Image.open(depth, formats=("PNG", "PPM")) as opened:
        return opened.size


def first_of(files: ContainedFiles, *paths: Path) -> Path | None:
    """The first of the paths that is a file of the folder."""
    return next(filter(files.holds, paths), None)


def _points(frame: DepthFrame, step: int) -> Float[np.ndarray, "n 3"]:
    depth = read_depth(frame.depth, frame.unit_m)
    good = (depth > 0.05) & (depth < MAX_DEPTH_M)
    if frame.confidence is not None:
        sure = _picture(frame.confidence)
        if sure.shape != depth.shape:
            raise InputError(f"{frame.confidence.name} has another size than its depth; export the scan again")
        good &= is_sure(sure)
    rows, columns = np.nonzero(good)
    rows, columns = rows[::step], columns[::step]
    height, width = depth.shape
    k = frame.camera.intrinsics.resize(width, height)
    z = depth[rows, columns]
    local = np.column_stack([(columns + 0.5 - k.cx) / k.fx * z, (rows + 0.5 - k.cy) / k.fy * z, z])
    return local @ frame.camera.T_world_camera[:3, :3].T + frame.camera.position


def _with_poses(folder: Path, frame_files: dict[str, tuple[Path, Path, Path | None]]) -> Frames:
    poses, files = read_poses(folder), ContainedFiles(folder, InputError)
    frames = [
        DepthFrame(depth, p.camera, first_of(files, sure), picture)
        for p in poses.photos
        if Path(p.name).stem in frame_files
        for depth, sure, picture in (frame_files[Path(p.name).stem],)
    ]
    return Frames(tuple(frames), poses.up, poses.notes)


def _pose(position: Float[np.ndarray, "3"], quaternion: Float[np.ndarray, "4"]) -> Float[np.ndarray, "4 4"]:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = Rotation.from_quat(quaternion).as_matrix(), position
    return T


def text_of(path: Path) -> str:
    """A small text file; empty where there is none."""
    return (
        read_bytes(path, MAX_TEXT_BYTES, InputError).decode("utf-8", "replace")
        if ContainedFiles(path.parent, InputError).holds(path)
        else ""
    )


def numbers_of(path: Path, *, heading: bool = False) -> Float[np.ndarray, "n m"]:
    """Rows of numbers, by commas or blanks."""
    lines = [line for line in text_of(path).replace(",", " ").splitlines() if line.strip() and line.lstrip()[0] != "#"]
    if not lines[heading:]:
        raise InputError(f"{path} holds no numbers; export the scan again")
    return np.array([[float(v) for v in line.split()] for line in lines[heading:]])


SEVEN_SCENES = Intrinsics(640, 480, 585.0, 585.0, 320.0, 240.0)
"""What 7-Scenes' page gives for its depth."""
REPLICA = Intrinsics(1200, 680, 600.0, 600.0, 599.5, 339.5)
"""Intrinsics of NICE-SLAM's renderings of Replica, used where `cam_params.json` is absent."""
REPLICA_STEPS, MATTERPORT_STEPS = 6553.5, 4000.0
"""Steps of depth a metre."""


def seven_scenes_frames(folder: Path) -> Frames:
    """`frame-000000.depth.png` (or .pgm) in millimetres with `frame-000000.pose.txt`, also in folders `seq-01`."""
    files, frames = ContainedFiles(folder, InputError), []
    info = text_of(folder / "_info.txt") or text_of(folder / "info.txt")
    stated = re.search(r"m_calibrationDepthIntrinsic\s*=([^\n]*)", info)
    known = None if stated is None else np.array(stated[1].split(), float)
    for depth in _find(folder, files, "*.depth.png", "*.depth.pgm"):
        stem = depth.name.split(".")[0]
        pose = depth.with_name(f"{stem}.pose.txt")
        T = numbers_of(pose) if files.holds(pose) else np.full((4, 4), np.nan)
        if T.shape != (4, 4) or not np.isfinite(T).all():
            continue
        size = size_of(depth)
        k = SEVEN_SCENES.resize(*size)
        if known is not None and len(known) >= 7:
            k = Intrinsics(*size, known[0], known[5], known[2], known[6])
        pictures = (depth.with_name(f"{stem}.color.{ending}") for ending in ("png", "jpg"))
        frames.append(DepthFrame(depth, Camera(k, T), None, first_of(files, *pictures)))
    return Frames(tuple(frames), None, () if known is not None else ("the camera is 7-Scenes' own (585 pixels)",))


def replica_frames(folder: Path) -> Frames:
    """`results/depth000000.png` with a row of 16 numbers each in `traj.txt`; the scale in `cam_params.json`."""
    files = ContainedFiles(folder, InputError)
    rows = numbers_of(folder / "traj.txt")
    if rows.shape[1:] != (16,):
        raise InputError(f"{folder / 'traj.txt'} has not 16 numbers a row; take the one beside the pictures")
    k, steps = REPLICA, REPLICA_STEPS
    text = text_of(folder / "cam_params.json")
    if text:
        given = json.loads(text)["camera"]
        k = Intrinsics(given["w"], given["h"], *(float(given[key]) for key in ("fx", "fy", "cx", "cy")))
        steps = float(given["scale"])
    frames = []
    for depth, row in zip(_find(folder, files, "results/depth*.png"), rows, strict=False):
        picture = first_of(files, *depth.parent.glob(depth.stem.replace("depth", "frame") + ".*"))
        camera = Camera(k.resize(*size_of(depth)), row.reshape(4, 4))
        frames.append(DepthFrame(depth, camera, None, picture, 1 / steps))
    notes = () if text else ("the camera is that of NICE-SLAM's Replica (600 of 1200 pixels)",)
    return Frames(tuple(frames), None, notes)


def matterport_frames(folder: Path) -> Frames:
    """`undistorted_depth_images` in 1/4000 m, with cameras that look along -z in `undistorted_camera_parameters`."""
    files, frames = ContainedFiles(folder, InputError), []
    depths = {p.name: p for p in _find(folder, files, "undistorted_depth_images/**/*.png")}
    pictures = {p.name: p for p in _find(folder, files, "undistorted_color_images/**/*.jpg")}
    k = np.eye(3)
    for conf in _find(folder, files, "undistorted_camera_parameters/**/*.conf"):
        for words in (line.split() for line in text_of(conf).splitlines()):
            if words[:1] == ["intrinsics_matrix"]:
                k = np.array(words[1:10], float).reshape(3, 3)
            if words[:1] != ["scan"] or len(words) < 19 or words[1] not in depths:
                continue
            depth = depths[words[1]]
            T = np.array(words[3:19], float).reshape(4, 4) @ OPENCV_FROM_OPENGL
            camera = Camera(Intrinsics(*size_of(depth), k[0, 0], k[1, 1], k[0, 2], k[1, 2]), T)
            frames.append(DepthFrame(depth, camera, None, pictures.get(words[2]), 1 / MATTERPORT_STEPS))
    return Frames(tuple(frames), UP_Z, ("depth of Matterport3D, in 1/4000 m",))


def _find(folder: Path, files: ContainedFiles, *patterns: str) -> Iterator[Path]:
    return filter(files.holds, sorted(path for pattern in patterns for path in folder.rglob(pattern)))


def _has(head: FileHead, *words: str) -> bool:
    return head.is_folder and all(any(word in f"/{name}" for name in head.names) for word in words)


FRAME_FORMS = (
    FrameForm(
        "Polycam raw data",
        lambda h: h.is_folder and h.has(".png") and _has_folder(h, "depth/") and _has_folder(h, "cameras/"),
        polycam_frames,
    ),
    FrameForm(
        "3D Scanner App, all data", lambda h: h.is_folder and any(n.startswith("depth_") for n in h.names),
        scanner_app_frames,
    ),
    FrameForm(
        "Stray Scanner", lambda h: h.is_folder and {"odometry.csv", "camera_matrix.csv"} <= set(h.names), stray_frames
    ),
    FrameForm(
        "TUM RGB-D", lambda h: h.is_folder and {"depth.txt", "groundtruth.txt"} <= set(h.names), tum_frames
    ),
    FrameForm(
        "ScanNet frames",
        lambda h: h.is_folder and "intrinsic/intrinsic_depth.txt" in h.names and _has_folder(h, "pose/"),
        scannet_frames,
    ),
    FrameForm("7-Scenes, ScanNet frames", lambda h: _has(h, ".depth.p", ".pose.txt"), seven_scenes_frames),
    FrameForm("Replica frames", lambda h: _has(h, "/traj.txt", "/results/depth"), replica_frames),
    FrameForm(
        "Matterport3D frames",
        lambda h: _has(h, "/undistorted_depth_images/", "/undistorted_camera_parameters/"),
        matterport_frames,
    ),
)  # fmt: skip
"""The first that tells a folder is its form."""
