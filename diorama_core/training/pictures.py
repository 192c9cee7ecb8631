"""Rendered pictures with a box and a category for everything that can be seen in them, one file for each room."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import cv2
import numpy as np
from jaxtyping import Float32, Int, Int8, Int32, UInt8
from PIL import Image

from diorama_core.errors import InputError, LibraryError, SceneError
from diorama_core.io.arrays import npz_bytes
from diorama_core.io.atomic import write_atomically
from diorama_core.library.form import MEASURED, form_at, value_indices
from diorama_core.library.record import ShapeLibrary
from diorama_core.models.images import box_geometry
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.values import ArrayValue
from diorama_core.synthesis import sample_cameras
from diorama_core.synthesis.cameras import CameraRanges
from diorama_core.synthesis.truth import Studio
from diorama_core.training.rooms import random_room

SIZE = (512, 384)
"""Width and height of the pictures."""
VIEWS = 6
CAMERAS = CameraRanges(height_m=(0.9, 1.9), pitch_rad=(-0.05, 0.5), roll_rad=0.03, fov_rad=(0.75, 1.45))
MIN_PIXELS = 85
MIN_SIDE_PX = 8
"""Least side, of 512 x 384: what is smaller is background."""
JPEG_QUALITY = 90
T = TypeVar("T")


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
    forms: Int8[np.ndarray, "n 7"]
    """Each object's form (`library.form.value_indices`); -1 where it has none or nobody noted it."""


def category_names(library: ShapeLibrary) -> tuple[str, ...]:
    """Every category of a library, in the order of the networks' outputs."""
    return tuple(sorted({s.category for s in library.shapes()}))


def make_pictures(folder: Path, library: ShapeLibrary, seeds: range, progress: Progress = SILENT) -> int:
    """Render the rooms of some seeds that are not in the folder yet.

    Args:
        folder: One file a room goes there.
        library: Where shapes come from.
        seeds: Of the rooms.
        progress: Reported after each room; honours cancelling, and the next call goes on.

    Returns:
        The number of rooms rendered now.
    """
    names = category_names(library)
    return make_files(
        folder, seeds, "room_{:06d}.npz".format, lambda seed: _pack(_photograph(seed, library, names)), progress
    )


def count_pictures(path: Path) -> int:
    """How many pictures a room's file has."""
    with np.load(path, allow_pickle=False) as saved:
        return int(saved["count"])


def read_picture(path: Path, k: int) -> LabelledPicture:
    """One picture of a room's file."""
    with np.load(path, allow_pickle=False) as saved:
        categories = saved[f"categories_{k}"]
        unknown = np.full((len(categories), len(MEASURED)), -1, np.int8)
        forms = saved.get(f"forms_{k}", unknown)
        return LabelledPicture(
            decode_picture(saved[f"jpeg_{k}"], path), saved[f"boxes_{k}"], categories, saved[f"pixels_{k}"], forms
        )


def read_boxes(path: Path, k: int) -> tuple[Float32[np.ndarray, "n 4"], Int[np.ndarray, "n"], tuple[int, int]]:
    """Boxes and categories of one picture of a room's file, and the picture's width and height."""
    with np.load(path, allow_pickle=False) as saved:
        boxes, categories, data = saved[f"boxes_{k}"], saved[f"categories_{k}"], saved[f"jpeg_{k}"]
    with Image.open(io.BytesIO(data.tobytes()), formats=["JPEG"]) as picture:
        return boxes, categories, picture.size


def encode_picture(rgb: UInt8[np.ndarray, "h w 3"]) -> UInt8[np.ndarray, "n"]:
    """A picture as JPEG."""
    ok, data = cv2.imencode(".jpg", rgb[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    if not ok:
        raise ValueError("the picture cannot be encoded")
    return data.ravel()


def decode_picture(data: UInt8[np.ndarray, "n"], path: Path) -> UInt8[np.ndarray, "h w 3"]:
    """The pixels of an encoded picture of a file.

    Raises:
        InputError: when it is damaged.
    """
    bgr = cv2.imdecode(data, cv2.IMREAD_COLOR)
    if bgr is None:
        raise InputError(f"{path}: a picture in it cannot be decoded; delete the file and render the room again")
    return np.ascontiguousarray(bgr[..., ::-1])


def _photograph(seed: int, library: ShapeLibrary, names: tuple[str, ...]) -> tuple[LabelledPicture, ...]:
    """No picture where the room cannot be furnished or photographed; it is not tried again."""
    try:
        scene = random_room(seed, library)
        cameras = sample_cameras(scene, library, seed, VIEWS, SIZE, CAMERAS)
    except (SceneError, LibraryError):
        return ()
    index = {name: k for k, name in enumerate(names)}
    kinds = np.array([index[o.category] for o in scene.objects], dtype=np.int64)
    forms = [value_indices(form_at(library, library.shape(o.shape_id), o.size_m)) for o in scene.objects]
    forms_of = np.array(forms, np.int8).reshape(-1, len(MEASURED))
    studio, pictures = Studio(scene, library), []
    for camera in cameras:
        rgb, ids = studio.photograph(camera, SIZE)
        boxes, visible, pixels = visible_boxes(ids, len(kinds))
        pictures.append(LabelledPicture(rgb, boxes, kinds[visible], pixels, forms_of[visible]))
    return tuple(pictures)


@dataclass(frozen=True)
class PictureFiles:
    """The pictures of a folder of rendered rooms."""

    pictures: tuple[tuple[Path, int], ...]
    """Each one's file and place in it."""

    @classmethod
    def of(cls, folder: Path) -> PictureFiles:
        """All pictures of a folder.

        Raises:
            InputError: where there is none.
        """
        pictures = tuple((path, k) for path in sorted(folder.glob("room_*.npz")) for k in range(count_pictures(path)))
        if not pictures:
            raise InputError(
                f"{folder}: no pictures are there; make some: python -m diorama_core.training pictures {folder}"
            )
        return cls(pictures)

    @property
    def rooms(self) -> tuple[Path, ...]:
        """The files, in order."""
        return tuple(dict.fromkeys(path for path, _ in self.pictures))

    def draw(self, rng: np.random.Generator) -> LabelledPicture:
        """A picture of chance."""
        return read_picture(*self.pictures[int(rng.integers(len(self.pictures)))])


@dataclass(frozen=True, eq=False)
class BoxStatistics:
    """Where boxes of every category lie, and so how often each is met."""

    geometry: tuple[Float32[np.ndarray, "_ 6"], ...]
    """For every category the `box_geometry` of its boxes."""

    @classmethod
    def of(cls, files: PictureFiles, kinds: int) -> BoxStatistics:
        """Statistics of all pictures of some files."""
        rows: list[list[np.ndarray]] = [[] for _ in range(kinds)]
        for path, k in files.pictures:
            boxes, categories, (width, height) = read_boxes(path, k)
            for box, category in zip(boxes, categories, strict=True):
                rows[int(category)].append(box_geometry(box, width, height))
        return cls(tuple(np.array(r, np.float32).reshape(-1, 6) for r in rows))

    @property
    def counts(self) -> Float32[np.ndarray, "k"]:
        """How often each category is seen."""
        return np.array([len(rows) for rows in self.geometry], np.float32)

    def draw(self, category: int, sides: tuple[float, float], rng: np.random.Generator) -> Float32[np.ndarray, "6"]:
        """A place and size of chance for a box of given proportions; of any category where this one is never met.

        Args:
            category: what it shows.
            sides: its width and height, to any scale.
            rng: the source of chance.
        """
        rows = self.geometry[category]
        if not len(rows):
            rows = self.geometry[int(np.argmax(self.counts))]
        row = rows[int(rng.integers(len(rows)))].copy()
        middle, shape = (row[3] + row[4]) / 2, float(np.log(sides[0] / sides[1]))
        row[3:] = middle + shape / 2, middle - shape / 2, shape
        return row


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


def _pack(pictures: tuple[LabelledPicture, ...]) -> bytes:
    arrays: dict[str, np.ndarray] = {"count": np.array(len(pictures))}
    for k, picture in enumerate(pictures):
        arrays |= {
            f"jpeg_{k}": encode_picture(picture.rgb),
            f"boxes_{k}": picture.boxes,
            f"categories_{k}": picture.categories,
            f"pixels_{k}": picture.pixels,
            f"forms_{k}": picture.forms,
        }
    return npz_bytes(arrays)


def make_files(
    folder: Path,
    items: Sequence[T],
    name_of: Callable[[T], str],
    made: Callable[[T], bytes],
    progress: Progress = SILENT,
) -> int:
    """Make the files of some items that are not in the folder yet.

    Args:
        folder: Is made where it is not there.
        items: Rooms' seeds, or shapes.
        name_of: The name of an item's file.
        made: Its content.
        progress: Reported before each item; honours cancelling, and the next call goes on.

    Returns:
        The number of files made now.
    """
    count = 0
    folder.mkdir(parents=True, exist_ok=True)
    for k, item in enumerate(items):
        target = folder / name_of(item)
        progress.report(k / len(items), target.stem)
        if not target.exists():
            write_atomically(target, made(item))
            count += 1
    return count
