"""Depth pictures with known cameras, as scanner apps and benchmarks keep them in folders.

Polycam's raw data, 3D Scanner App's "all data", Stray Scanner, TUM RGB-D and ScanNet's exported frames. Each form is a
small function from a folder to frames; `FRAME_FORMS` is their table.
"""

from __future__ import annotations

from collections.abc import Callable
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
from diorama_core.multiview.posed_photos import read_poses
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
)  # fmt: skip


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
