"""Photos with known cameras: COLMAP models (text and binary), nerfstudio's `transforms.json`, and ARKit frames as
Polycam (`keyframes/cameras/*.json`) and 3D Scanner App (`frame_*.json`) export them.

COLMAP: https://colmap.github.io/format.html. nerfstudio: https://docs.nerf.studio/quickstart/data_conventions.html.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from io import TextIOWrapper
from itertools import islice
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from jaxtyping import Float
from PIL import Image
from scipy.spatial.transform import Rotation

from diorama_core.errors import InputError
from diorama_core.io.bounded import megabytes, read_json, shorten
from diorama_core.io.contained import ContainedFiles
from diorama_core.multiview.camera_changes import quarters_of
from diorama_core.multiview.lens import STRAIGHT, Lens
from diorama_core.scene.types import Camera, Intrinsics, rigid

MAX_BYTES = 512_000_000
MAX_PHOTOS = 10_000
MAX_NAME_BYTES = 4096
OPENCV_FROM_OPENGL = np.diag([1.0, -1.0, -1.0, 1.0])
MODELS: Mapping[int, tuple[str, int]] = {
    0: ("SIMPLE_PINHOLE", 3),
    1: ("PINHOLE", 4),
    2: ("SIMPLE_RADIAL", 4),
    3: ("RADIAL", 5),
    4: ("OPENCV", 8),
    5: ("OPENCV_FISHEYE", 8),
    6: ("FULL_OPENCV", 12),
}
"""COLMAP's camera models by number, with how many parameters each has."""
_ONE_FOCAL = ("SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL")


@dataclass(frozen=True, eq=False)
class PosedPhoto:
    """Where one photo was taken."""

    name: str
    """The file's path as the poses name it."""
    camera: Camera
    """In the world of the poses."""
    lens: Lens = STRAIGHT
    """What it bends."""


@dataclass(frozen=True, eq=False)
class Poses:
    """Cameras of a set of photos, in one world."""

    photos: tuple[PosedPhoto, ...]
    metric: bool
    """Whether lengths are metres."""
    up: Float[np.ndarray, "3"] | None
    """Direction against gravity, where the format says it."""
    notes: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()
    """Photos that were looked at and have no camera; the notes say why."""
    stored_pixels: bool = False
    """Whether the cameras are those of pictures as they are stored, whatever turn their headers ask for."""


def read_poses(path: Path, photos: Sequence[Path] = ()) -> Poses:
    """Cameras from a file or a folder: `transforms.json`, a COLMAP model, or a folder of ARKit frames.

    Args:
        path: The file or the folder.
        photos: Where a file names no sizes, they are those of the photos of its names.

    Raises:
        InputError: nothing of the kind is there, or it makes no sense.
    """
    read = _reader_of(path, photos)
    try:
        poses = read()
    except KeyError as error:
        missing = shorten(str(error.args[0]) if error.args else "")
        raise InputError(f"{path}: the cameras cannot be read: there is no {missing!r}; export them again") from error
    except (LookupError, ValueError, TypeError, AttributeError, ArithmeticError, struct.error, OSError) as error:
        raise InputError(f"{path}: the cameras cannot be read ({shorten(str(error))}); export them again") from error
    if not poses.photos:
        raise InputError(f"{path} holds no camera")
    return poses


def _reader_of(path: Path, pictures: Sequence[Path]) -> Callable[[], Poses]:
    if path.is_file() and path.suffix.lower() == ".json":
        return partial(_nerfstudio, path, pictures)
    for name in ("transforms.json", "transforms_train.json"):
        if (path / name).is_file():
            return partial(_nerfstudio, path / name, pictures)
    for folder in (path, path / "sparse" / "0", path / "sparse"):
        for ending, reader in ((".bin", _colmap_binary), (".txt", _colmap_text)):
            if (folder / f"cameras{ending}").is_file() and (folder / f"images{ending}").is_file():
                return partial(reader, folder)
    if any(path.glob("frame_*.json")) or any(_polycam_files(path)):
        return partial(_arkit, path)
    raise InputError(f"{path}: there is no transforms.json, COLMAP model or folder of ARKit frames")


def _nerfstudio(path: Path, pictures: Sequence[Path] = ()) -> Poses:
    document = read_json(path, InputError, most=MAX_BYTES, advice="export it again")
    frames = document["frames"]
    if not isinstance(frames, list) or len(frames) > MAX_PHOTOS:
        raise ValueError(f"'frames' is no list of at most {MAX_PHOTOS}")
    photos = []
    for frame in frames:
        values = {**document, **frame}
        if "w" not in values or "h" not in values:
            values["w"], values["h"] = _size_of(path.parent, str(frame["file_path"]), pictures)
        if "fl_x" in values:
            fx = float(values["fl_x"])
            fy = float(values.get("fl_y", fx))
        else:
            fx = fy = 0.5 * float(values["w"]) / float(np.tan(float(values["camera_angle_x"]) / 2))
            if "camera_angle_y" in values:
                fy = 0.5 * float(values["h"]) / float(np.tan(float(values["camera_angle_y"]) / 2))
        k = _intrinsics(values["w"], values["h"], fx, fy, values.get("cx"), values.get("cy"))
        fisheye = "FISHEYE" in str(values.get("camera_model", "")).upper()
        radial = tuple(float(values.get(f"k{n}", 0.0)) for n in range(1, 5 if fisheye else 4))
        lens = Lens(radial, (float(values.get("p1", 0.0)), float(values.get("p2", 0.0))), fisheye)
        T = _rigid(np.asarray(frame["transform_matrix"], np.float64)) @ OPENCV_FROM_OPENGL
        photos.append(PosedPhoto(str(frame["file_path"]), Camera(k, T), lens))
    return Poses(tuple(photos), bool(document.get("metric", False)), None, _distortion(photos))


def _size_of(folder: Path, name: str, pictures: Sequence[Path]) -> tuple[int, int]:
    """Width and height of the picture that a frame names, with its ending or without; upright as it is shown.

    Raises:
        ValueError: there is no such picture.
    """
    plain = folder / name
    beside = [plain] if plain.is_file() else sorted(plain.parent.glob(f"{plain.name}.*"))
    named = [p for p in pictures if p.name == plain.name or p.stem == plain.stem or p.stem == plain.name]
    for path in (*named, *beside):
        try:
            with Image.open(path, formats=("JPEG", "PNG", "WEBP", "TIFF", "MPO", "HEIF")) as opened:
                width, height = opened.size
        except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
            continue
        return (height, width) if quarters_of(path) % 2 else (width, height)
    raise ValueError(f"it names no size of {name}, and there is no such photo")


def _colmap_text(folder: Path) -> Poses:
    cameras: dict[int, tuple[Intrinsics, Lens]] = {}
    for line in _lines(folder / "cameras.txt"):
        number, model, width, height, *parameters = line.split()
        cameras[int(number)] = _colmap_camera(model, int(width), int(height), [float(p) for p in parameters])
    photos: list[PosedPhoto] = []
    for line in islice(_lines(folder / "images.txt", keep_empty=True), 0, None, 2):  # every other line lists points
        if not line:
            continue
        if len(photos) == MAX_PHOTOS:
            raise ValueError(f"more than {MAX_PHOTOS} cameras")
        _, *numbers, camera, name = line.split(maxsplit=9)
        k, lens = cameras[int(camera)]
        photos.append(PosedPhoto(name, Camera(k, _colmap_pose([float(n) for n in numbers])), lens))
    return Poses(tuple(photos), False, None, _distortion(photos), stored_pixels=True)


def _lines(path: Path, *, keep_empty: bool = False) -> Iterator[str]:
    with _open(path) as data, TextIOWrapper(data, encoding="utf-8") as stream:
        for line in stream:
            text = line.strip()
            if not text.startswith("#") and (text or keep_empty):
                yield text


def _open(path: Path) -> BinaryIO:
    """A file that is not too large to be a list of cameras."""
    if path.stat().st_size > MAX_BYTES:
        raise ValueError(f"{path.name} has more than the {megabytes(MAX_BYTES)} that are read")
    return path.open("rb")


def _colmap_binary(folder: Path) -> Poses:
    cameras: dict[int, tuple[Intrinsics, Lens]] = {}
    photos = []
    with _open(folder / "cameras.bin") as stream:
        for _ in range(_count(stream)):
            number, model, width, height = struct.unpack("<iiQQ", stream.read(24))
            name, count = MODELS[model]
            parameters = struct.unpack(f"<{count}d", stream.read(8 * count))
            cameras[number] = _colmap_camera(name, width, height, list(parameters))
    with _open(folder / "images.bin") as stream:
        for _ in range(_count(stream)):
            _, *numbers, camera = struct.unpack("<i7di", stream.read(64))
            text = bytearray()
            while (byte := stream.read(1)) not in (b"\0", b""):
                text += byte
                if len(text) > MAX_NAME_BYTES:
                    raise ValueError("a photo's name does not end")
            (points,) = struct.unpack("<Q", stream.read(8))
            stream.seek(24 * points, 1)
            k, lens = cameras[camera]
            photos.append(PosedPhoto(text.decode(), Camera(k, _colmap_pose(numbers)), lens))
    return Poses(tuple(photos), False, None, _distortion(photos), stored_pixels=True)


def _count(stream: BinaryIO) -> int:
    (count,) = struct.unpack("<Q", stream.read(8))
    if count > MAX_PHOTOS:
        raise ValueError(f"more than {MAX_PHOTOS} cameras")
    return int(count)


def _colmap_camera(model: str, width: int, height: int, p: list[float]) -> tuple[Intrinsics, Lens]:
    """Intrinsics, and what the lens bends."""
    if model not in {name for name, _ in MODELS.values()}:
        raise ValueError(f"camera model {model} is not read")
    fx, fy, cx, cy = (p[0], p[0], p[1], p[2]) if model in _ONE_FOCAL else p[:4]
    rest = p[3:] if model in _ONE_FOCAL else p[4:]
    k = _intrinsics(width, height, fx, fy, cx, cy)
    if model in ("OPENCV", "FULL_OPENCV"):
        return k, Lens((*rest[:2], *rest[4:]), (rest[2], rest[3]))
    return k, Lens(tuple(rest), fisheye=model == "OPENCV_FISHEYE")


def _colmap_pose(numbers: list[float]) -> Float[np.ndarray, "4 4"]:
    """`T_world_camera` of a quaternion (w first) and a translation from the world to the camera."""
    w, x, y, z, *t = numbers
    return np.linalg.inv(rigid(Rotation.from_quat([x, y, z, w]).as_matrix(), np.array(t)))


def _polycam_files(path: Path) -> Iterator[Path]:
    for name in ("keyframes/corrected_cameras", "keyframes/cameras", "corrected_cameras", "cameras"):
        folder = path / name
        files = sorted(folder.glob("*.json")) if folder.is_dir() else []
        if files:
            yield from files
            return


def _arkit(path: Path) -> Poses:
    """ARKit's world is metric and +Y up; its cameras look along -z."""
    photos = []
    files = sorted(path.glob("frame_*.json")) or list(_polycam_files(path))
    if len(files) > MAX_PHOTOS:
        raise ValueError(f"more than {MAX_PHOTOS} cameras")
    for file in files:
        row = read_json(file, InputError, most=1_000_000, advice="export the scan again")
        if "cameraPoseARFrame" in row:
            T = np.asarray(row["cameraPoseARFrame"], np.float64).reshape(4, 4)
            K = np.asarray(row["intrinsics"], np.float64).reshape(3, 3)
            k = _intrinsics(*_size_beside(file, K), K[0, 0], K[1, 1], K[0, 2], K[1, 2])
        else:
            T = np.eye(4)
            T[:3] = [[float(row[f"t_{i}{j}"]) for j in range(4)] for i in range(3)]
            k = _intrinsics(row["width"], row["height"], row["fx"], row["fy"], row["cx"], row["cy"])
        photos.append(PosedPhoto(f"{file.stem}.jpg", Camera(k, _rigid(T) @ OPENCV_FROM_OPENGL)))
    return Poses(tuple(photos), True, np.array([0.0, 1.0, 0.0]))


def _size_beside(file: Path, K: Float[np.ndarray, "3 3"]) -> tuple[int, int]:
    """Size of the picture beside a frame's file; about twice its centre where it is not there."""
    picture = file.with_suffix(".jpg")
    if ContainedFiles(file.parent, InputError).holds(picture):
        try:
            with Image.open(picture, formats=("JPEG",)) as opened:
                return opened.size
        except Image.DecompressionBombError as error:
            raise ValueError(f"{picture.name} has more pixels than are read") from error
    return round(2 * float(K[0, 2])), round(2 * float(K[1, 2]))


def _intrinsics(width: Any, height: Any, fx: Any, fy: Any, cx: Any, cy: Any) -> Intrinsics:
    w, h = int(width), int(height)
    middle = (w / 2 if cx is None else float(cx), h / 2 if cy is None else float(cy))
    return Intrinsics(w, h, float(fx), float(fy), *middle)


def _rigid(T: Float[np.ndarray, "4 4"]) -> Float[np.ndarray, "4 4"]:
    if T.shape != (4, 4) or not np.isfinite(T).all() or abs(np.linalg.det(T[:3, :3]) - 1.0) > 1e-2:
        raise ValueError("a camera's matrix is no rotation and translation")
    return T


def _distortion(photos: Sequence[PosedPhoto]) -> tuple[str, ...]:
    bent = sum(photo.lens.bends for photo in photos)
    return (f"{bent} photos are undistorted before they are used",) if bent else ()
