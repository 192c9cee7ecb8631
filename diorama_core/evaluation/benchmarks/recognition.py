"""What each route finds in photos alone, and how it names what a person marked."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import Box, Inputs, LabelledBox, Photo
from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.photo_annotations import AnnotatedPhoto, picture_of, read_annotations
from diorama_core.evaluation.reports.tables import Column, Figure, Table, figures_table, mean
from diorama_core.library.taxonomy import broad
from diorama_core.models.boxes import overlaps
from diorama_core.perception.inputs import read_inputs
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import DetectionStage

BEST = 20
"""Boxes of a photo that are looked at, best first."""
LEVELS = (0.5, 0.3)
"""Intersection over union from which a box has found an object."""

CLICK_SPREAD = 0.12
"""How far from the middle of an object clicks fall, as a share of its box (standard deviation)."""
CLICKS_SEED = 0

Namer = Callable[[Photo, Float[np.ndarray, "n 4"]], Sequence[Sequence[str]]]
"""Names of what boxes hold, best first."""
Clicker = Callable[[Photo, Float[np.ndarray, "n 2"]], Sequence[Box | None]]
"""Boxes that clicks on pixels (x, y) of a photo mean."""


@dataclass(frozen=True)
class FoundBoxes:
    """What one route found in one photo."""

    objects: int
    """Annotated."""
    hits: tuple[int, ...]
    """Objects found, at each of `LEVELS`."""
    boxes: int
    """Among the `BEST`."""
    right: int
    """Boxes that found an object at the first level; each object counts once."""
    named: int
    """Found objects with the right kind, or the broader category that it belongs to."""
    seconds: float


@dataclass(frozen=True)
class NamedBoxes:
    """How annotated boxes of one photo were named."""

    objects: int
    first: int
    among_five: int
    seconds: float


@dataclass(frozen=True)
class ClickedBoxes:
    """The boxes that one click on each annotated object of one photo gave."""

    objects: int
    hits: tuple[int, ...]
    """Clicks whose box is right, at each of `LEVELS`."""
    none: int
    """Clicks that gave no box."""
    seconds: float


def _share(part: str, whole: str) -> Callable[[Sequence[Any]], float]:
    """A share of sums over photos."""
    return lambda photos: sum(getattr(p, part) for p in photos) / max(sum(getattr(p, whole) for p in photos), 1)


def _hits(words: str) -> Iterator[Figure]:
    """Objects that are met at each of `LEVELS`."""

    def share(k: int, photos: Sequence[FoundBoxes | ClickedBoxes]) -> float:
        return sum(p.hits[k] for p in photos) / max(sum(p.objects for p in photos), 1)

    return (Figure(Column(f"{words} at IoU {x}", ".3f", "↑"), partial(share, k)) for k, x in enumerate(LEVELS))


_OBJECTS = Figure(Column("objects", "d"), lambda photos: sum(p.objects for p in photos))
_SECONDS = Figure(Column("seconds a photo", ".2f", "↓"), lambda photos: mean(p.seconds for p in photos))
FOUND = (
    _OBJECTS,
    *_hits("found"),
    Figure(Column("boxes a photo", ".1f"), lambda photos: mean(p.boxes for p in photos)),
    Figure(Column("precision", ".3f", "↑"), _share("right", "boxes")),
    Figure(Column("kind right", ".3f", "↑"), _share("named", "right")),
    _SECONDS,
)
NAMED = (
    _OBJECTS,
    Figure(Column("first", ".3f", "↑"), _share("first", "objects")),
    Figure(Column("among five", ".3f", "↑"), _share("among_five", "objects")),
)
CLICKED = (_OBJECTS, *_hits("right"), Figure(Column("no box", ".3f", "↓"), _share("none", "objects")), _SECONDS)


def _table(title: str, photos_by_way: Mapping[str, Mapping[str, object]], figures: Sequence[Figure]) -> Table:
    return figures_table(title, ((way, tuple(photos.values())) for way, photos in photos_by_way.items()), figures)


@dataclass(frozen=True)
class RecognitionBench:
    """Results of all routes, by photo."""

    found: Mapping[str, Mapping[str, FoundBoxes]]
    named: Mapping[str, Mapping[str, NamedBoxes]]
    clicked: Mapping[str, Mapping[str, ClickedBoxes]]

    def tables(self) -> tuple[Table, ...]:
        """Routes to boxes, and ways to name given boxes."""
        return (
            _table(f"Objects found in photos alone, {BEST} best boxes", self.found, FOUND),
            _table("Names of boxes that a person drew", self.named, NAMED),
            _table("Boxes of objects that a person clicked once", self.clicked, CLICKED),
        )

    def to_json(self) -> dict[str, object]:
        """Tables and every photo."""
        return {
            "bench": "recognition",
            "tables": [t.to_json() for t in self.tables()],
            "photos": {route: {name: p.__dict__ for name, p in ps.items()} for route, ps in self.found.items()},
            "clicks": {way: {name: p.__dict__ for name, p in ps.items()} for way, ps in self.clicked.items()},
        }


def run(
    annotations: Path,
    photos: Path,
    routes: Mapping[str, DetectionStage],
    namers: Mapping[str, Namer],
    clickers: Mapping[str, Clicker],
    progress: Progress = SILENT,
) -> RecognitionBench:
    """Let every route look at every annotated photo that the folder has.

    Args:
        annotations: file as `adapters.photo_annotations` describes it.
        photos: folder of pictures named by id.
        routes: detectors by name.
        namers: ways to name given boxes, by name.
        clickers: ways from a click to a box, by name.
        progress: reports and cancellation.

    Raises:
        InputError: when the annotations cannot be read, or the folder has none of the photos.
    """
    known = read_annotations(annotations)
    present = {name: path for name in known if (path := picture_of(photos, name)) is not None}
    if not present:
        raise InputError(f"{photos}: none of the {len(known)} annotated photos is there; name pictures by their ids")
    boxes_by_route: dict[str, dict[str, FoundBoxes]] = {name: {} for name in routes}
    named: dict[str, dict[str, NamedBoxes]] = {name: {} for name in namers}
    clicked: dict[str, dict[str, ClickedBoxes]] = {name: {} for name in clickers}
    rng = np.random.default_rng(CLICKS_SEED)
    for k, (name, path) in enumerate(present.items()):
        progress.report(k / len(present), name)
        inputs, boxes = read_annotated_photo(path, known[name])
        for route, stage in routes.items():
            boxes_by_route[route][name] = _look(stage, inputs.photo, boxes, known[name])
        for way, namer in namers.items():
            named[way][name] = _name(namer, inputs.photo, boxes, known[name])
        spots = boxes[:, :2] + (boxes[:, 2:] - boxes[:, :2]) * rng.normal(0.5, CLICK_SPREAD, (len(boxes), 2))
        for way, clicker in clickers.items():
            clicked[way][name] = _click(clicker, inputs.photo, spots, boxes)
    return RecognitionBench(boxes_by_route, named, clicked)


def read_annotated_photo(path: Path, photo: AnnotatedPhoto) -> tuple[Inputs, Float[np.ndarray, "n 4"]]:
    """A photo as a build reads it, and the annotated boxes in its pixels."""
    inputs = read_inputs(path).inputs
    height, width = inputs.photo.rgb.shape[:2]
    scale = np.array([width, height, width, height]) / np.array([*photo.size, *photo.size])
    return inputs, np.array([t.bbox for t in photo.objects], dtype=float).reshape(-1, 4) * scale


def _look(stage: DetectionStage, photo: Photo, boxes: Float[np.ndarray, "n 4"], about: AnnotatedPhoto) -> FoundBoxes:
    begun = time.perf_counter()
    proposed = stage.detect(photo, (), Progress())[:BEST]
    seconds = time.perf_counter() - begun
    overlap = overlaps(np.array([b.box for b in proposed], dtype=float).reshape(-1, 4), boxes)
    hits = tuple(int((overlap.max(axis=0, initial=0.0) >= level).sum()) for level in LEVELS)
    right, named = 0, 0
    taken = np.zeros(len(boxes), dtype=bool)
    for row, box in zip(overlap, proposed, strict=True):
        free = np.where(taken, 0.0, row)
        if len(free) and free.max() >= LEVELS[0]:
            k = int(free.argmax())
            taken[k] = True
            right += 1
            named += _same_kind(box, about.objects[k].kind)
    return FoundBoxes(len(boxes), hits, len(proposed), right, named, seconds)


def _same_kind(box: LabelledBox, kind: str) -> bool:
    return box.category == kind or broad(kind) == box.category


def _name(namer: Namer, photo: Photo, boxes: Float[np.ndarray, "n 4"], about: AnnotatedPhoto) -> NamedBoxes:
    asked = [k for k, t in enumerate(about.objects) if t.nameable]
    begun = time.perf_counter()
    ranked = namer(photo, boxes[asked])
    seconds = time.perf_counter() - begun
    kinds = [about.objects[k].kind for k in asked]
    first = sum(r[0] == kind for r, kind in zip(ranked, kinds, strict=True))
    five = sum(kind in r[:5] for r, kind in zip(ranked, kinds, strict=True))
    return NamedBoxes(len(asked), first, five, seconds)


def _click(
    clicker: Clicker, photo: Photo, spots: Float[np.ndarray, "n 2"], boxes: Float[np.ndarray, "n 4"]
) -> ClickedBoxes:
    begun = time.perf_counter()
    meant = clicker(photo, spots)
    seconds = time.perf_counter() - begun
    right = [
        0.0 if box is None else float(overlaps(np.array([box]), true[None])[0, 0])
        for box, true in zip(meant, boxes, strict=True)
    ]
    hits = tuple(sum(share >= level for share in right) for level in LEVELS)
    return ClickedBoxes(len(boxes), hits, sum(box is None for box in meant), seconds)
