"""A small picture of a box room with a chair-like thing, drawn by the test itself."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np

WIDTH, HEIGHT = 320, 240
BOXES = [{"bbox": [120, 110, 180, 200], "class": "chair"}, {"bbox": [200, 120, 300, 190], "class": "sofa"}]


def room_picture() -> np.ndarray:
    """Floor, back wall and side walls with visible edges, and two coloured boxes as furniture."""
    image = np.full((HEIGHT, WIDTH, 3), (200, 195, 190), np.uint8)
    back = np.array([[90, 50], [250, 50], [250, 140], [90, 140]])
    cv2.fillPoly(image, [np.array([[0, 240], [90, 140], [250, 140], [320, 240]])], (120, 95, 70))
    cv2.fillPoly(image, [np.array([[0, 0], [90, 50], [90, 140], [0, 240]])], (170, 165, 160))
    cv2.fillPoly(image, [np.array([[320, 0], [250, 50], [250, 140], [320, 240]])], (180, 175, 172))
    cv2.polylines(image, [back], True, (60, 60, 60), 1)
    for box in BOXES:
        x1, y1, x2, y2 = box["bbox"]
        cv2.rectangle(image, (x1 + 4, y1 + 3), (x2 - 4, y2 - 2), (60, 80, 140), -1)
    return image


def write_room(folder: Path, marked: int = len(BOXES)) -> tuple[Path, Path]:
    """The picture and the first of its boxes as files."""
    photo, boxes = folder / "room.png", folder / "boxes.json"
    cv2.imwrite(str(photo), room_picture()[..., ::-1])
    boxes.write_text(json.dumps(BOXES[:marked]))
    return photo, boxes
