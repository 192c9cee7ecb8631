"""The recogniser that comes with Diorama: proposes boxes and names what is in them, with nothing downloaded.

Two small networks trained by `diorama_core.training` on rendered rooms; `assets/models` has their weights, how they
were made and how good they are.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float, Float32, UInt8
from scipy.special import expit, softmax

from diorama_core.errors import UnavailableError
from diorama_core.io import assets
from diorama_core.io.assets import CARD, DETECTOR, NAMER
from diorama_core.models.boxes import Detections, clip, join, without_doubles
from diorama_core.models.images import FILL, box_crop, box_geometry
from diorama_core.models.kind_evidence import KindEvidence, own_evidence, with_evidence
from diorama_core.models.runtime import SHARED_SESSIONS, SessionPool
from diorama_core.models.store import sha256_of
from diorama_core.scene.values import ArrayValue

STRIDES = (8, 16, 32)
SEEN_WITH = ((0.06, False), (0.12, True), (0.2, False))
"""Margins with which a box is looked at, as boxes are drawn more or less close, and whether the picture is mirrored."""
AREAS_PX = (320 * 256, 512 * 384)
"""The photo is looked at in each of these sizes: large things are found in the first, small ones in the second."""
DOUBLE_IOU, ALIKE_IOU = 0.4, 0.7
"""Overlap of two boxes of one object, and of two that are no choice."""
MIN_SCORE, MAX_OF_LOOK = 0.06, 400
"""Boxes of one look at a picture that are compared with those of the others."""


@dataclass(frozen=True, eq=False)
class Looks(ArrayValue):
    """What is in some boxes, as far as their pictures tell."""

    kinds: Float[np.ndarray, "n k"]
    """Probability of every category, all equally frequent."""
    forms: Float[np.ndarray, "n f"]
    """Probability of every value of every attribute of form (`library.form.VALUES`), one attribute after another."""


@dataclass(frozen=True)
class Recogniser:
    """Input: an upright RGB picture, eight bits, any size. Output: boxes in its pixels; probabilities of categories.

    Args:
        detector: graph from pictures to rows of score, sides and kinds.
        namer: graph from crops and box geometry to logits.
        categories: what the outputs stand for.
        form_values: number of values of each attribute of form.
        weights: identity of both, for cache keys.
        evidence: what a network that learnt from photos tells of the kinds; without it the namer decides alone.
    """

    detector: Path = field(repr=False)
    namer: Path = field(repr=False)
    categories: tuple[str, ...] = field(repr=False)
    form_values: tuple[int, ...] = field(repr=False)
    weights: str = "recogniser"
    areas_px: tuple[int, ...] = AREAS_PX
    evidence: KindEvidence | None = None
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    @classmethod
    def of(cls, folder: Path) -> Recogniser:
        """The recogniser of a folder with both graphs and their card.

        Raises:
            UnavailableError: when one is not there or damaged.
        """
        paths = [folder / name for name in (DETECTOR, NAMER, CARD)]
        absent = [p.name for p in paths if not p.is_file()]
        if absent:
            raise UnavailableError(f"{folder}: {', '.join(absent)} is missing; restore it from the repository")
        try:
            card = json.loads(paths[2].read_text(encoding="utf-8"))
            categories = tuple(str(c) for c in card["categories"])
            form_values = tuple(len(values) for values in card["forms"].values())
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise UnavailableError(f"{paths[2]}: cannot be read; restore it from the repository") from error
        return cls(paths[0], paths[1], categories, form_values, "".join(sha256_of(p)[:8] for p in paths[:2]))

    def propose(
        self, rgb: UInt8[np.ndarray, "h w 3"], threshold: float, most: int = 100, iou: float = DOUBLE_IOU
    ) -> Detections:
        """Boxes that may hold an object, best first, labels into `categories`; no two overlap by more than `iou`.

        Args:
            rgb: the picture, 0 to 255.
            threshold: least score, 0 to 1.
            most: boxes at most.
            iou: `DOUBLE_IOU` leaves one box of an object, `ALIKE_IOU` several to choose from where somebody points.
        """
        every = join([look for area in self.areas_px for look in self._propose(rgb, area)])
        detections = without_doubles(every.rows(every.scores >= threshold), iou, across_classes=True)
        return detections.rows(np.arange(min(most, len(detections))))

    def _propose(self, rgb: UInt8[np.ndarray, "h w 3"], area_px: int) -> list[Detections]:
        """What is seen in the picture at a size, as it is and mirrored."""
        pixels, scale = fit(rgb, area_px)
        height, width = pixels.shape[2:]
        end = round(rgb.shape[1] * scale)
        mirrored = np.concatenate([pixels[..., :end][..., ::-1], pixels[..., end:]], axis=3)
        both = np.ascontiguousarray(np.concatenate([pixels, mirrored]))
        rows = self.pool.get(self.detector).run({"pictures": both}, {"rows": (2, None, None)})["rows"]
        looks = []
        for k, seen in enumerate(rows.astype(np.float64)):
            centres, strides = places(width, height)
            scores = expit(seen[:, 0])
            best = np.flatnonzero(scores >= MIN_SCORE)
            best = best[np.argsort(-scores[best], kind="stable")][:MAX_OF_LOOK]
            reach = np.exp(np.minimum(seen[best, 1:5], 5.0)) * strides[best, None]
            boxes = np.concatenate([centres[best] - reach[:, :2], centres[best] + reach[:, 2:]], axis=1)
            if k == 1:
                boxes[:, [0, 2]] = end - boxes[:, [2, 0]]
            inside = clip(boxes / scale, rgb.shape[1], rgb.shape[0])
            looks.append(Detections(inside, scores[best], seen[best, 5:].argmax(axis=1)))
        return looks

    def name(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: Float[np.ndarray, "n 4"]) -> Float[np.ndarray, "n k"]:
        """Probability of every category for every box."""
        return self.look(rgb, boxes).kinds

    def look(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: Float[np.ndarray, "n 4"]) -> Looks:
        """What is in every box: the mean of what closer and wider crops tell, one of them mirrored."""
        if not len(boxes):
            return Looks(np.zeros((0, len(self.categories))), np.zeros((0, sum(self.form_values))))
        height, width = rgb.shape[:2]
        where = np.stack([box_geometry(box, width, height) for box in boxes])
        looks = [self._look(rgb, boxes, where, margin, mirrored) for margin, mirrored in SEEN_WITH]
        kinds = np.mean([k.kinds for k in looks], axis=0)
        if self.evidence is not None:
            kinds = with_evidence(kinds, self.evidence.log_likelihoods(rgb, boxes))
        return Looks(kinds, np.mean([k.forms for k in looks], axis=0))

    def _look(
        self,
        rgb: UInt8[np.ndarray, "h w 3"],
        boxes: Float[np.ndarray, "n 4"],
        where: Float32[np.ndarray, "n 6"],
        margin: float,
        mirrored: bool,
    ) -> Looks:
        crops = np.stack([box_crop(rgb, box, margin) for box in boxes]).transpose(0, 3, 1, 2).astype(np.float32) / 255.0
        if mirrored:
            crops, where = crops[..., ::-1], where * np.array([-1, 1, 1, 1, 1, 1], np.float32)
        inputs = {"crops": np.ascontiguousarray(crops), "geometry": where}
        shapes = {"kinds": (len(boxes), None), "forms": (len(boxes), None)}
        outputs = {k: v.astype(np.float64) for k, v in self.pool.get(self.namer).run(inputs, shapes).items()}
        return Looks(softmax(outputs["kinds"], axis=1), _form_probabilities(outputs["forms"], self.form_values))


def _form_probabilities(logits: Float[np.ndarray, "n f"], form_values: tuple[int, ...]) -> Float[np.ndarray, "n f"]:
    """Each attribute's values add up to 1."""
    ends = np.cumsum(form_values)[:-1]
    return np.concatenate([softmax(values, axis=1) for values in np.split(logits, ends, axis=1)], axis=1)


@cache
def own_recogniser() -> Recogniser:
    """The recogniser whose weights come with Diorama, with evidence from a network that learnt from photos.

    Raises:
        UnavailableError: when its own weights are not there or damaged.
    """
    alone = Recogniser.of(assets.FOLDER)
    return replace(alone, evidence=own_evidence(alone.categories))


def fit(rgb: UInt8[np.ndarray, "h w 3"], area_px: int) -> tuple[Float32[np.ndarray, "1 3 h2 w2"], float]:
    """The picture in about this many pixels, 0 to 1, grey at the right and bottom up to multiples of 32; its scale."""
    height, width = rgb.shape[:2]
    scale = float(np.sqrt(area_px / (width * height)))
    w, h = max(1, round(width * scale)), max(1, round(height * scale))
    square = np.full((-(-h // 32) * 32, -(-w // 32) * 32, 3), FILL, np.uint8)
    square[:h, :w] = cv2.resize(rgb, (w, h), interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)
    return np.ascontiguousarray(square.transpose(2, 0, 1)[None]).astype(np.float32) / np.float32(255), scale


def places(width: int, height: int) -> tuple[Float32[np.ndarray, "n 2"], Float32[np.ndarray, "n"]]:
    """Centres of the detector's places in pixels and their strides, in the order of its rows."""
    centres, strides = [], []
    for stride in STRIDES:
        x, y = np.meshgrid(np.arange(width // stride), np.arange(height // stride))
        centres.append((np.stack([x, y], axis=-1).reshape(-1, 2) + 0.5) * stride)
        strides.append(np.full(x.size, stride))
    return np.concatenate(centres).astype(np.float32), np.concatenate(strides).astype(np.float32)
