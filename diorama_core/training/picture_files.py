"""Folders of rendered rooms, read a picture at a time: all of them together do not fit into memory."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float32

from diorama_core.errors import InputError
from diorama_core.models.images import box_geometry
from diorama_core.training.pictures import LabelledPicture, count_pictures, read_boxes, read_picture


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
