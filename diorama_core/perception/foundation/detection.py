"""Boxes and masks of the furniture, found by networks: boxes of any class with OWLv2, of everyday classes with YOLOX,
and masks from boxes with SAM 2.1 or SlimSAM.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt8

from diorama_core.artefacts import DetectedObject, Inputs, LabelledBox, Photo
from diorama_core.library.taxonomy import ARCHITECTURE_WORDS, CATEGORIES, UNKNOWN, broad, resolve
from diorama_core.models.boxes import Detections, without_doubles, without_parts_of_same
from diorama_core.models.owlv2 import BoxDetector
from diorama_core.models.own_files import FileDetector
from diorama_core.models.segment_anything import BoxSegmenter
from diorama_core.models.yolox import COCO_CLASSES, Yolox
from diorama_core.perception.masks import LOST_CONFIDENCE, Outlined, box_mask, outline_objects
from diorama_core.progress import Progress

INDOOR_WORDS: tuple[str, ...] = tuple(
    c.name for c in CATEGORIES if c is not UNKNOWN and c.name not in ARCHITECTURE_WORDS
)
"""What an open-vocabulary detector is asked for: one word for every category that a scene can hold. Synonyms compete
with each other at one threshold, cost a run of the text tower each, and find nothing that the library has shapes for.
"""
TEMPLATE = "a photo of {}"
MAX_OBJECTS = 40
"""No photo of a room has more that matter; what is beyond is noise of the least sure."""
MIN_SIDE_PX = 8.0
_WORDS = {
    "couch": "sofa",
    "potted plant": "plant",
    "dining table": "table",
    "tv": "television",
    "book": "books",
    "wine glass": "cup",
}
"""What YOLOX calls objects, in words that a person would choose for what is meant in a room."""
_IN_ROOM_NAMES = (
    "bench,chair,couch,potted plant,bed,dining table,toilet,tv,laptop,keyboard,microwave,oven,toaster,sink,"
    "refrigerator,book,clock,vase,teddy bear,bottle,wine glass,cup,bowl,suitcase"
)
_IN_ROOMS = frozenset(_IN_ROOM_NAMES.split(","))
"""The classes that a scene can hold; people, animals and vehicles are none of the furniture's business."""


@dataclass(frozen=True)
class OpenVocabularyDetection:
    """Any class, asked in words (paper, supplement A): suppression across classes, then of parts within a class."""

    detector: BoxDetector
    threshold: float = 0.2
    double_iou: float = 0.8
    part_share: float = 0.8
    """A box that lies within another of its class by more than this share of itself goes."""
    template: str = TEMPLATE
    """What the detector is asked for a class."""

    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]:
        """Boxes of all objects that match the words (a built-in indoor vocabulary without words), best first.

        Walls, floor and ceiling are never returned as objects.

        Args:
            photo, words, progress: as documented in `protocols.DetectionStage`.
        """
        asked = tuple(dict.fromkeys(w for w in words or INDOOR_WORDS if w.lower() not in ARCHITECTURE_WORDS))
        phrases = [self.template.format(w) for w in asked]
        detections = self.detector.detect(photo.rgb, phrases, self.threshold, progress.part(0.0, 0.9))
        progress.report(0.9, "Sorting out double boxes")
        detections = without_doubles(detections, self.double_iou, across_classes=True)
        return _label_boxes(detections, asked, self.part_share)


@dataclass(frozen=True)
class EverydayDetection:
    """YOLOX: a few megabytes, no words needed, 24 classes that belong in rooms."""

    detector: Yolox
    threshold: float = 0.35
    part_share: float = 0.8

    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]:
        """Boxes of everyday objects in the photo, best first; `words` is ignored.

        Args:
            photo, words, progress: as documented in `protocols.DetectionStage`.
        """
        progress.report(0.0, "Looking for furniture")
        detections = self.detector.detect(photo.rgb, self.threshold)
        inside = np.array([COCO_CLASSES[k] in _IN_ROOMS for k in detections.labels], dtype=bool)
        names = tuple(_WORDS.get(name, name) for name in COCO_CLASSES)
        return _label_boxes(detections.rows(np.flatnonzero(inside)), names, self.part_share)


@dataclass(frozen=True)
class FileDetection:
    """A detector that a person brings as a file; labels that name no kind of the library are left out."""

    detector: FileDetector
    threshold: float = 0.35
    part_share: float = 0.8

    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]:
        """Boxes of known kinds in the photo, best first; `words` is ignored.

        Args:
            photo, words, progress: as documented in `protocols.DetectionStage`.
        """
        progress.report(0.0, "Looking for furniture")
        detections = self.detector.detect(photo.rgb, self.threshold)
        names = tuple(_WORDS.get(name, name) for name in self.detector.labels)
        known = np.array([resolve(names[k]).exact for k in detections.labels], dtype=bool)
        return _label_boxes(detections.rows(np.flatnonzero(known)), names, self.part_share)


def _label_boxes(detections: Detections, names: tuple[str, ...], part_share: float) -> tuple[LabelledBox, ...]:
    """One box per object, in the project's categories."""
    categories = [resolve(name) for name in names]
    # A sofa found within a sectional sofa is its half: special kinds count as their broader one.
    families = [broad(r.category.name) for r in categories]
    order = {name: i for i, name in enumerate(dict.fromkeys(families))}
    kinds = np.array([order[families[k]] for k in detections.labels], dtype=int)
    alike = Detections(detections.boxes, detections.scores, kinds)
    whole = without_parts_of_same(alike, part_share)
    rows = [i for i in range(len(detections)) if any((whole.boxes == detections.boxes[i]).all(axis=1))]
    boxes = []
    for i in rows:
        name, resolution = names[detections.labels[i]], categories[detections.labels[i]]
        x1, y1, x2, y2 = (float(v) for v in detections.boxes[i])
        if min(x2 - x1, y2 - y1) < MIN_SIDE_PX:
            continue
        category = resolution.category.name if resolution.exact else UNKNOWN.name
        boxes.append(LabelledBox((x1, y1, x2, y2), category, name, float(detections.scores[i])))
    return tuple(boxes[:MAX_OBJECTS])


_MARGIN = 0.05
"""Share of a box's size by which its object may extend beyond it."""
_MIN_SHARE = 0.02
"""A mask that covers less of its box has lost the object."""


@dataclass(frozen=True)
class PromptedMasks:
    """The object stage with a segmenter that boxes prompt; masks that the user gave are taken as they are."""

    segmenter: BoxSegmenter

    def segment(self, inputs: Inputs, progress: Progress) -> tuple[DetectedObject, ...]:
        """One object per instance the user masked and per box no mask belongs to, in the order given."""
        return outline_objects(inputs, self._outline_boxes, progress)

    def _outline_boxes(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: list[LabelledBox], progress: Progress) -> Outlined:
        if not boxes:
            return []
        progress.report(0.0, "Outlining objects")
        results: Outlined = []
        masks = self.segmenter.masks(rgb, np.array([b.box for b in boxes]))
        for done, (box, prompted) in enumerate(zip(boxes, masks, strict=True)):
            progress.report(done / len(boxes), f"Outlining objects ({done + 1} of {len(boxes)})")
            mask = prompted.mask & box_mask(rgb.shape[:2], _widen_box(box, rgb.shape[1], rgb.shape[0]))
            whole = box_mask(rgb.shape[:2], box.box)
            lost = mask.sum() < _MIN_SHARE * whole.sum()
            sure = LOST_CONFIDENCE if lost else max(prompted.quality, LOST_CONFIDENCE)
            results.append((whole if lost else mask, sure, box.box))
        return results


def _widen_box(box: LabelledBox, width: int, height: int) -> tuple[float, float, float, float]:
    x1, y1, x2, y2 = box.box
    dx, dy = _MARGIN * (x2 - x1), _MARGIN * (y2 - y1)
    return max(0.0, x1 - dx), max(0.0, y1 - dy), min(float(width), x2 + dx), min(float(height), y2 + dy)
