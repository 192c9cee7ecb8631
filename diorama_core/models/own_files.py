"""Networks that a person brings as ONNX files: what they answer is recognised by shapes.

Detectors: YOLO heads (raw YOLOX; YOLOv5 with objectness; YOLOv8 and later without) and DETR's (class logits and boxes
relative to the picture). Depth: one map in metres from pictures between 0 and 1.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float, UInt8
from scipy.special import softmax

from diorama_core.errors import InputError
from diorama_core.geometry.depth_grid import smooth_normals_camera
from diorama_core.io.bounded import read_bytes
from diorama_core.models.boxes import Detections, clip, corners, without_doubles
from diorama_core.models.images import IMAGENET_MEAN, IMAGENET_STD, normalise, resize
from diorama_core.models.runtime import SHARED_SESSIONS, Dims, GraphNetwork, NetworkError, Session, SessionPool
from diorama_core.models.seen_depth import SeenDepth
from diorama_core.models.store import sha256_of
from diorama_core.models.yolox import COCO_CLASSES, decode, letterbox
from diorama_core.scene.types import Intrinsics

SIDE_PX = 640
"""Side of the square that a detector is shown where its graph leaves that open."""
_STRIDES = (8, 16, 32)
_MAX_LABELS_BYTES = 1_000_000
_ANY: Dims = (..., None, None)


@dataclass(frozen=True)
class FileDetector:
    """Input: an upright RGB picture, eight bits, any size. Output: boxes in its pixels with indices of `labels`."""

    graph: Path = field(repr=False)
    labels: tuple[str, ...]
    weights: str
    """Identity of the file, for cache keys."""
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    @classmethod
    def of(cls, graph: Path) -> FileDetector:
        """The network in a file; its labels, one a line, in a text file of the same name beside it, or COCO's 80.

        Raises:
            InputError: when there is no such file, or the labels cannot be read.
        """
        _need(graph)
        beside = graph.with_suffix(".txt")
        labels = COCO_CLASSES
        if beside.is_file():
            text = read_bytes(beside, _MAX_LABELS_BYTES, InputError).decode(errors="replace")
            labels = tuple(line.strip() for line in text.splitlines() if line.strip())
        return cls(graph, labels, sha256_of(graph)[:12])

    def detect(self, rgb: UInt8[np.ndarray, "h w 3"], threshold: float, iou: float = 0.45) -> Detections:
        """Everything found with at least the given score.

        Args:
            rgb: the picture, 0 to 255.
            threshold: least score, 0 to 1.
            iou: overlap (intersection over union) from which the weaker of two boxes goes.

        Raises:
            NetworkError: when the outputs are those of no detector that is known, or of another number of labels.
        """
        session = self.pool.get(self.graph)
        read = self._detr if len(session.outputs) >= 2 else self._yolo
        boxes, scores = read(rgb, session, session.picture_input)
        best, labels = scores.max(axis=1), scores.argmax(axis=1)
        keep = np.flatnonzero(best >= threshold)
        detections = Detections(clip(boxes[keep], rgb.shape[1], rgb.shape[0]), best[keep], labels[keep])
        return without_doubles(detections, iou, across_classes=True)

    def _yolo(
        self, rgb: UInt8[np.ndarray, "h w 3"], session: Session, name: str
    ) -> tuple[Float[np.ndarray, "n 4"], Float[np.ndarray, "n c"]]:
        side, count = session.side_px(name, SIDE_PX), len(self.labels)
        bgr, scale = letterbox(rgb, side)
        unit = np.ascontiguousarray(bgr[:, ::-1]) / np.float32(255)
        raw = _rows(session.answer({name: unit}, _ANY))
        if raw.shape == (sum((side // s) ** 2 for s in _STRIDES), 5 + count):  # YOLOX: offsets to cells, other pixels
            raw = session.answer({name: bgr}, (1, *raw.shape))[0]
            return decode(raw, side) / scale, (raw[:, 4:5] * raw[:, 5:]).astype(np.float64)
        if raw.shape[0] == 4 + count:
            return corners(raw[:4].T) / scale, raw[4:].T
        if raw.shape[1] == 5 + count:
            return corners(raw[:, :4]) / scale, raw[:, 4:5] * raw[:, 5:]
        raise self._unknown([raw.shape])

    def _detr(
        self, rgb: UInt8[np.ndarray, "h w 3"], session: Session, name: str
    ) -> tuple[Float[np.ndarray, "n 4"], Float[np.ndarray, "n c"]]:
        side, count = session.side_px(name, SIDE_PX), len(self.labels)
        pixels = normalise(resize(rgb, (side, side)), IMAGENET_MEAN, IMAGENET_STD)
        feeds: dict[str, np.ndarray] = {name: pixels}
        for other in session.inputs:
            if other != name:  # DETR's pixel mask: everything is picture
                feeds[other] = np.ones((1, side, side), np.int64)
        outputs = session.run(feeds, dict.fromkeys(session.outputs[:2], _ANY))
        rows = [_rows(outputs[o]) for o in session.outputs[:2]]
        boxes = next((r for r in rows if r.shape[1] == 4 and r.min() >= 0 and r.max() <= 1), None)
        logits = next((r for r in rows if r is not boxes and r.shape[1] in (count, count + 1)), None)
        if boxes is None or logits is None:
            raise self._unknown([r.shape for r in rows])
        # With a class for nothing the classes exclude each other; without one each is asked by itself.
        scores = softmax(logits, axis=1)[:, :count] if logits.shape[1] > count else 1 / (1 + np.exp(-logits))
        return corners(boxes) * np.array([rgb.shape[1], rgb.shape[0]] * 2), scores

    def _unknown(self, shapes: list[tuple[int, ...]]) -> NetworkError:
        sizes = " and ".join(" x ".join(map(str, shape)) for shape in shapes)
        return NetworkError(
            self.graph,
            f"answers {sizes}, which is no YOLO or DETR detector of {len(self.labels)} labels; "
            f"put its labels, one a line, in {self.graph.with_suffix('.txt').name} beside it",
        )


@dataclass(frozen=True)
class FileDepth(GraphNetwork):
    """A network from a picture between 0 and 1 (stretched to its own size) to depth in metres."""

    usual_fov_rad: float = 1.05
    """Horizontal, of pictures whose camera is unknown."""

    @classmethod
    def of(cls, graph: Path) -> FileDepth:
        """The network in a file.

        Raises:
            InputError: when there is no such file.
        """
        _need(graph)
        return cls(graph, sha256_of(graph)[:12])

    def predict(self, rgb: UInt8[np.ndarray, "h w 3"], intrinsics: Intrinsics | None) -> SeenDepth:
        """Depth and normals, which follow from it; without intrinsics a usual field of view is assumed.

        Raises:
            NetworkError: when the network answers no map of depth.
        """
        height, width = rgb.shape[:2]
        k = intrinsics or Intrinsics.from_fov(width, height, self.usual_fov_rad)
        session, name = self.session, self.session.picture_input
        side = session.side_px(name, SIDE_PX)
        pixels = resize(rgb, (side, side)).astype(np.float32).transpose(2, 0, 1)[None] / np.float32(255)
        small = _rows(session.answer({name: np.ascontiguousarray(pixels)}, _ANY, gaps=True)).astype(np.float32)
        if min(small.shape) < 2 or not (np.isfinite(small) & (small > 0)).any():
            raise NetworkError(self.graph, "answers no depth in metres; give another file as --depth-network")
        depth = cv2.resize(np.where(small > 0, small, 0.0).astype(np.float32), (width, height))
        return SeenDepth(depth, smooth_normals_camera(depth, k).astype(np.float32), k)


def _rows(answer: np.ndarray) -> Float[np.ndarray, "n m"]:
    """Without the leading dimensions of size one."""
    return answer.reshape(-1, answer.shape[-1]).astype(np.float64)


def _need(graph: Path) -> None:
    if not graph.is_file():
        raise InputError(f"{graph}: there is no such file; give an ONNX graph or a network's id")
