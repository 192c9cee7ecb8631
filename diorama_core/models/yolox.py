"""YOLOX: a light detector of 80 everyday classes."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float, Float32, UInt8

from diorama_core.models.boxes import Detections, clip, without_doubles
from diorama_core.models.runtime import GraphNetwork

_GREY = 114.0
_STRIDES = (8, 16, 32)

_NAMES = (
    "person,bicycle,car,motorcycle,airplane,bus,train,truck,boat,traffic light,fire hydrant,stop sign,"
    "parking meter,bench,bird,cat,dog,horse,sheep,cow,elephant,bear,zebra,giraffe,backpack,umbrella,handbag,"
    "tie,suitcase,frisbee,skis,snowboard,sports ball,kite,baseball bat,baseball glove,skateboard,surfboard,"
    "tennis racket,bottle,wine glass,cup,fork,knife,spoon,bowl,banana,apple,sandwich,orange,broccoli,carrot,"
    "hot dog,pizza,donut,cake,chair,couch,potted plant,bed,dining table,toilet,tv,laptop,mouse,remote,"
    "keyboard,cell phone,microwave,oven,toaster,sink,refrigerator,book,clock,vase,scissors,teddy bear,"
    "hair drier,toothbrush"
)
COCO_CLASSES: tuple[str, ...] = tuple(_NAMES.split(","))


@dataclass(frozen=True)
class Yolox(GraphNetwork):
    """Input: an upright RGB picture, eight bits, any size. Output: boxes in its pixels with `COCO_CLASSES` indices."""

    weights: str = "yolox"

    def detect(
        self, rgb: UInt8[np.ndarray, "h w 3"], threshold: float, iou: float = 0.45, *, across_classes: bool = True
    ) -> Detections:
        """Everything found with at least the given score (objectness times class probability).

        Args:
            rgb: the picture, 0 to 255.
            threshold: least score, 0 to 1.
            iou: overlap (intersection over union) from which the weaker of two boxes goes.
            across_classes: whether boxes of different classes count as overlapping.
        """
        session, name = self.session, self.session.picture_input
        side = session.side_px(name, 640)
        pixels, scale = letterbox(rgb, side)
        cells = sum((side // stride) ** 2 for stride in _STRIDES)
        raw = session.answer({name: pixels}, (1, cells, 5 + len(COCO_CLASSES)))[0]
        boxes = decode(raw, side) / scale
        scores = raw[:, 4:5] * raw[:, 5:]
        labels = scores.argmax(axis=1)
        best = scores[np.arange(len(scores)), labels]
        keep = np.flatnonzero(best >= threshold)
        detections = Detections(clip(boxes[keep], rgb.shape[1], rgb.shape[0]), best[keep], labels[keep])
        return without_doubles(detections, iou, across_classes=across_classes)


def letterbox(rgb: UInt8[np.ndarray, "h w 3"], side: int) -> tuple[Float32[np.ndarray, "1 3 side side"], float]:
    """BGR 0..255 in the upper left of a grey square, and how much the picture was scaled."""
    height, width = rgb.shape[:2]
    scale = min(side / height, side / width)
    size = (max(1, int(width * scale)), max(1, int(height * scale)))
    square = np.full((side, side, 3), _GREY, np.float32)
    square[: size[1], : size[0]] = cv2.resize(rgb, size, interpolation=cv2.INTER_LINEAR)[..., ::-1]
    return np.ascontiguousarray(square.transpose(2, 0, 1)[None]), scale


def decode(raw: Float[np.ndarray, "n 85"], side: int) -> Float[np.ndarray, "n 4"]:
    """Corner boxes in network pixels from offsets to grid cells and logarithms of sizes."""
    cells, strides = [], []
    for stride in _STRIDES:
        n = side // stride
        grid = np.stack(np.meshgrid(np.arange(n), np.arange(n)), axis=-1).reshape(-1, 2)
        cells.append(grid)
        strides.append(np.full(len(grid), stride))
    cell, stride_of = np.concatenate(cells), np.concatenate(strides)[:, None]
    centre = (raw[:, :2] + cell) * stride_of
    size = np.exp(np.minimum(raw[:, 2:4], 12.0)) * stride_of
    return np.concatenate([centre - size / 2, centre + size / 2], axis=1).astype(np.float64)
