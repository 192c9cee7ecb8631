"""Boxes and names from the recogniser that comes with Diorama, for a person to accept or correct, and what its namer
thinks of marked objects.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import Box, DetectedObject, LabelledBox, Photo, SeenKinds
from diorama_core.io.assets import has_own_recogniser
from diorama_core.library.labels import is_named, meanings
from diorama_core.library.taxonomy import ARCHITECTURE_WORDS, UNKNOWN
from diorama_core.models.boxes import Detections, areas, join, overlaps
from diorama_core.models.recogniser import ALIKE_IOU, Recogniser, own_recogniser
from diorama_core.progress import Progress
from diorama_core.protocols import DetectionStage
from diorama_core.retrieval.kinds_together import carriers, kinds_together
from diorama_core.retrieval.seen_kinds import as_it_looks

CONFIDENT, LIKELY = 0.65, 0.5
"""Scores from which a build uses a box unseen, and from which a person is shown one: of 37 photos, each held back from
what the detector learnt, .65 and .50 of such boxes are right."""
MOST, MOST_SHOWN = 20, 10
"""How many boxes a build uses at most, and how many a person is shown, who clicks on what is missing."""
MIN_SIDE_PX = 8.0
SAME_IOU = 0.5
"""Two boxes that overlap at least so much are one object's."""
SUGGESTIONS = 5
FAINT, MAX_FAINT = 0.3, 300
"""Score from which a box is worth a click on the object, and how many such boxes a photo has at most."""
CLICK_SPREAD = 0.25
"""How far from the middle of an object people click, as a share of its box (standard deviation)."""
SMALLER_FIRST = 0.3
"""Exponent of the box's area: of two that fit a click as well, the smaller is meant more often."""


@dataclass(frozen=True)
class OwnDetection:
    """Proposes boxes with the shipped detector and names them with the shipped namer."""

    recogniser: Recogniser
    threshold: float = CONFIDENT
    most: int = MOST

    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]:
        """Boxes of likely objects, best first; `words` is ignored.

        Args:
            photo, words, progress: as documented in `protocols.DetectionStage`.
        """
        progress.report(0.0, "Looking for furniture")
        detections = self.recogniser.propose(photo.rgb, self.threshold, self.most)
        large = np.flatnonzero(
            (detections.boxes[:, 2:] - detections.boxes[:, :2]).min(axis=1, initial=np.inf) >= MIN_SIDE_PX
        )
        detections = detections.rows(large)
        progress.report(0.6, f"Naming {len(detections)} boxes")
        names = names_of(self.recogniser, photo, detections.boxes)
        boxes = []
        for box, score, ranked in zip(detections.boxes, detections.scores, names, strict=True):
            name = next((n for n in ranked if n not in ARCHITECTURE_WORDS), "object")
            x1, y1, x2, y2 = (float(v) for v in box)
            boxes.append(LabelledBox((x1, y1, x2, y2), name, name, float(score), guessed=True))
        return tuple(boxes)


@dataclass(frozen=True)
class JoinedDetection:
    """Everyday objects from one detector, and what it does not know or see from the one that comes with Diorama."""

    everyday: DetectionStage
    own: OwnDetection

    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]:
        """Boxes of both, best first; of two that overlap the everyday detector's stays, since it learnt from photos.

        Args:
            photo, words, progress: as documented in `protocols.DetectionStage`.
        """
        everyday = self.everyday.detect(photo, words, progress.part(0.0, 0.5))
        own_boxes = self.own.detect(photo, words, progress.part(0.5, 1.0))
        return join_boxes(everyday, own_boxes)


def join_boxes(everyday: Sequence[LabelledBox], own_boxes: Sequence[LabelledBox]) -> tuple[LabelledBox, ...]:
    """Boxes of both, best first; of two that overlap the everyday detector's stays, since it learnt from photos."""
    known = np.array([b.box for b in everyday], dtype=float).reshape(-1, 4)
    boxes = np.array([b.box for b in own_boxes], dtype=float).reshape(-1, 4)
    overlap = overlaps(boxes, known).max(axis=1, initial=0.0)
    new = [box for box, shared in zip(own_boxes, overlap, strict=True) if shared < SAME_IOU]
    return tuple(sorted((*everyday, *new), key=lambda b: -b.score))


def count_left_out(stage: OwnDetection | JoinedDetection, photo: Photo) -> int:
    """How many likely objects a build did not use, because it takes only those of which the recogniser is sure."""
    own_stage = stage if isinstance(stage, OwnDetection) else stage.own
    likely = OwnDetection(own_stage.recogniser, LIKELY, own_stage.most).detect(photo, (), Progress())
    unsure = [box for box in likely if box.score < own_stage.threshold]
    known = () if isinstance(stage, OwnDetection) else stage.everyday.detect(photo, (), Progress())
    return len(join_boxes(known, unsure)) - len(known)


def clickable(recogniser: Recogniser, photo: Photo, known: Sequence[LabelledBox] = ()) -> Detections:
    """Boxes that a click on the photo may mean.

    Args:
        recogniser: finds also what is hardly worth to be shown.
        photo: the photo.
        known: what a network found in it, which learnt from photos: these boxes count as sure.
    """
    faint = recogniser.propose(photo.rgb, FAINT, MAX_FAINT, ALIKE_IOU)
    corners = np.array([k.box for k in known], dtype=float).reshape(-1, 4)
    return join((faint, Detections(corners, np.ones(len(known)), np.zeros(len(known), dtype=int))))


def find_clicked_box(detections: Detections, x: float, y: float) -> Box | None:
    """The box that somebody means who clicks at (x, y), in photo pixels; None where no box holds the pixel."""
    low, high = detections.boxes[:, :2], detections.boxes[:, 2:]
    offset = (np.array([x, y]) - (low + high) / 2) / np.maximum(high - low, 1.0)
    meant = detections.scores * np.exp(-np.sum(offset**2, axis=1) / (2 * CLICK_SPREAD**2))
    meant = meant / np.maximum(areas(detections.boxes), 1.0) ** SMALLER_FIRST
    holds = np.all(np.abs(offset) <= 0.5, axis=1)
    if not holds.any():
        return None
    x1, y1, x2, y2 = (float(v) for v in detections.boxes[np.argmax(np.where(holds, meant, -1.0))])
    return x1, y1, x2, y2


def names_of(
    recogniser: Recogniser, photo: Photo, boxes: Float[np.ndarray, "n 4"], known: Sequence[LabelledBox] = ()
) -> Sequence[tuple[str, ...]]:
    """For every box the likeliest categories, best first; all boxes of a photo are named together.

    Args:
        recogniser: looks at the boxes.
        photo: where they are.
        boxes: in photo pixels.
        known: what a network found in the photo; its words count for the boxes that are the same.
    """
    return rank_names(recogniser.categories, recogniser.name(photo.rgb, boxes), boxes, known)


def rank_names(
    categories: Sequence[str],
    seen: Float[np.ndarray, "n k"],
    boxes: Float[np.ndarray, "n 4"],
    known: Sequence[LabelledBox] = (),
) -> Sequence[tuple[str, ...]]:
    """For every box the likeliest categories, best first, given what all of them look like and what lies on what.

    Args:
        categories: names of the columns.
        seen: probabilities of the namer, as if all categories were equally frequent.
        boxes: in photo pixels.
        known: what a network found in the photo; its words count for the boxes that are the same.
    """
    alone = [
        as_it_looks(
            meanings(label, category), list(zip(categories, map(float, row), strict=True)), named=is_named(label)
        )
        for row, (label, category) in zip(seen, _words(boxes, known), strict=True)
    ]
    together = kinds_together(alone, carriers([(float(a), float(b), float(c), float(d)) for a, b, c, d in boxes]))
    return [tuple(sorted(kinds, key=lambda name: -kinds[name])[:SUGGESTIONS]) for kinds in together]


def _words(boxes: Float[np.ndarray, "n 4"], known: Sequence[LabelledBox]) -> list[tuple[str, str]]:
    """Label and category of the known box that is the same as each box; an unnamed object where none is."""
    nothing = UNKNOWN.name, UNKNOWN.name
    if not known:
        return [nothing] * len(boxes)
    shared = overlaps(boxes, np.array([k.box for k in known], dtype=float))
    same = [(int(row.argmax()), float(row.max())) for row in shared]
    return [(known[k].label, known[k].category) if share >= SAME_IOU else nothing for k, share in same]


@dataclass(frozen=True)
class OwnNaming:
    """Asks the shipped namer about every box."""

    recogniser: Recogniser

    def name(self, photo: Photo, objects: tuple[DetectedObject, ...], progress: Progress) -> tuple[SeenKinds, ...]:
        """Probabilities of all categories, as if all were equally frequent, and of all forms, for every object.

        Args:
            photo, objects, progress: as documented in `protocols.NamingStage`.
        """
        progress.report(0.0, f"Looking at {len(objects)} objects")
        boxes = np.array([item.box for item in objects], dtype=float).reshape(-1, 4)
        looks, names = self.recogniser.look(photo.rgb, boxes), self.recogniser.categories
        return tuple(
            SeenKinds(item.id, names, kinds, tuple(map(float, form)))
            for item, kinds, form in zip(objects, looks.kinds, looks.forms, strict=True)
        )


def own_naming() -> OwnNaming | None:
    """The namer that comes with Diorama; None where its weights were left out."""
    return OwnNaming(own_recogniser()) if has_own_recogniser() else None
