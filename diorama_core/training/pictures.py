"""Rendered pictures with a box and a category for everything that can be seen in them, one file for each room."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float32, Int, Int32, UInt8

from diorama_core.errors import InputError, LibraryError, SceneError
from diorama_core.io.atomic import write_atomically
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.scene.values import ArrayValue
from diorama_core.synthesis import sample_cameras
from diorama_core.synthesis.cameras import CameraRanges
from diorama_core.synthesis.truth import Studio
from diorama_core.training.rooms import varied_room

SIZE = (352, 264)
"""Width and height of the pictures."""
VIEWS = 6
CAMERAS = CameraRanges(height_m=(0.9, 1.9), pitch_rad=(-0.05, 0.5), roll_rad=0.03, fov_rad=(0.75, 1.45))
MIN_PIXELS = 40
MIN_SIDE_PX = 6
"""Of 352 x 264: what is smaller is background."""
JPEG_QUALITY = 90


@dataclass(frozen=True, eq=False)
class LabelledPicture(ArrayValue):
    """One picture and what is in it."""

    rgb: UInt8[np.ndarray, "h w 3"]
    boxes: Float32[np.ndarray, "n 4"]
    """x1, y1, x2, y2 of the visible part, pixels."""
    categories: Int[np.ndarray, "n"]
    """Index into `category_names`."""
    pixels: Int[np.ndarray, "n"]
    """Visible pixels of each object."""


def category_names(library: ShapeLibrary) -> tuple[str, ...]:
    """Every category of a library, in the order of the networks' outputs."""
    return tuple(sorted({s.category for s in library.shapes()}))


def make_pictures(folder: Path, library: ShapeLibrary, seeds: range, progress: Progress | None = None) -> int:
    """Render the rooms of some seeds that are not in the folder yet.

    Args:
        folder: One file a room goes there.
        library: Where shapes come from.
        seeds: Of the rooms.
        progress: Reported after each room; honours cancelling, and the next call goes on.

    Returns:
        The number of rooms rendered now.
    """
    progress, names, made = progress or Progress(), category_names(library), 0
    folder.mkdir(parents=True, exist_ok=True)
    for k, seed in enumerate(seeds):
        target = folder / f"room_{seed:06d}.npz"
        progress.report(k / len(seeds), f"room {seed}")
        if not target.exists():
            write_atomically(target, _packed(_photographed(seed, library, names)))
            made += 1
    return made


def read_room(path: Path) -> tuple[LabelledPicture, ...]:
    """The pictures of one room's file."""
    with np.load(path, allow_pickle=False) as saved:
        return tuple(
            LabelledPicture(
                _decoded(saved[f"jpeg_{k}"], path),
                saved[f"boxes_{k}"],
                saved[f"categories_{k}"],
                saved[f"pixels_{k}"],
            )
            for k in range(int(saved["count"]))
        )


def _decoded(data: UInt8[np.ndarray, "n"], path: Path) -> UInt8[np.ndarray, "h w 3"]:
    bgr = cv2.imdecode(data, cv2.IMREAD_COLOR)
    if bgr is None:
        raise InputError(f"{path}: a picture in it cannot be decoded; delete the file and render the room again")
    return np.ascontiguousarray(bgr[..., ::-1])


def _photographed(seed: int, library: ShapeLibrary, names: tuple[str, ...]) -> tuple[LabelledPicture, ...]:
    """No picture where the room cannot be furnished or photographed; it is not tried again."""
    try:
        scene = varied_room(seed, library)
        cameras = sample_cameras(scene, library, seed, VIEWS, SIZE, CAMERAS)
    except (SceneError, LibraryError):
        return ()
    index = {name: k for k, name in enumerate(names)}
    kinds = np.array([index[o.category] for o in scene.objects], dtype=np.int64)
    studio, pictures = Studio(scene, library), []
    for camera in cameras:
        rgb, ids = studio.photograph(camera, SIZE)
        boxes, visible, pixels = visible_boxes(ids, len(kinds))
        pictures.append(LabelledPicture(rgb, boxes, kinds[visible], pixels))
    return tuple(pictures)


def visible_boxes(
    ids: Int32[np.ndarray, "h w"], count: int
) -> tuple[Float32[np.ndarray, "n 4"], Int[np.ndarray, "n"], Int[np.ndarray, "n"]]:
    """Boxes of what is seen of each object, which objects these are, and their visible pixels."""
    boxes, visible, pixels = [], [], []
    for index in range(count):
        mask = (ids == index).astype(np.uint8)
        area = int(mask.sum())
        if area < MIN_PIXELS:
            continue
        x, y, w, h = cv2.boundingRect(mask)
        if min(w, h) < MIN_SIDE_PX:
            continue
        boxes.append((x, y, x + w, y + h))
        visible.append(index)
        pixels.append(area)
    table = np.array(boxes, np.float32).reshape(-1, 4)
    return table, np.array(visible, dtype=np.int64), np.array(pixels, dtype=np.int64)


def _packed(pictures: tuple[LabelledPicture, ...]) -> bytes:
    arrays: dict[str, np.ndarray] = {"count": np.array(len(pictures))}
    for k, picture in enumerate(pictures):
        ok, data = cv2.imencode(".jpg", picture.rgb[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
        if not ok:
            raise ValueError("the picture cannot be encoded")
        arrays |= {
            f"jpeg_{k}": data.ravel(),
            f"boxes_{k}": picture.boxes,
            f"categories_{k}": picture.categories,
            f"pixels_{k}": picture.pixels,
        }
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)  # type: ignore[arg-type]  # the keywords are names of arrays
    return buffer.getvalue()
