"""Turn a photo into a scene and draw it from four sides.

The boxes say where the furniture is: a JSON list of `{"bbox": [x1, y1, x2, y2], "class": "chair"}` in pixels. Writes a
project folder, which `diorama serve` opens in the browser, and the four pictures in it.

    python examples/01_photo_to_scene.py room.jpg boxes.json my-room
"""

from __future__ import annotations

import sys
from pathlib import Path

from PIL import Image

import diorama_core as diorama

VIEWS = ("photo", "top", "front", "orbit:30")


def main(photo: str, boxes: str, folder: str) -> None:
    room = diorama.build(photo, boxes=boxes, output=folder)
    for item in room.scene.objects:
        x, y, z = item.size_m
        print(f"{item.id:<20} {item.shape_id:<28} {x:.2f} x {y:.2f} x {z:.2f} m")
    for view in VIEWS:
        name = view.replace(":", "_")
        Image.fromarray(diorama.render(room, view=view, size=(640, 480))).save(Path(folder) / f"{name}.png")


if __name__ == "__main__":
    main(*sys.argv[1:4])
