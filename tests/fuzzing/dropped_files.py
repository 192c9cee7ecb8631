"""What is dropped on the page, alone or together, and what lies beside depth."""

from __future__ import annotations

import io

import numpy as np
import trimesh
from PIL import Image

from diorama_app.projects.dropped import interpret
from diorama_core.perception.inputs.depth.confidence import without_unsure
from diorama_core.perception.inputs.source import Source
from tests.fuzzing.form_files import OBJ_BACKWARDS, zipped

BOXES = b'[{"bbox": [5, 5, 40, 50], "class": "chair"}, {"bbox": [45, 8, 90, 60], "class": "table"}]'
DEPTH = np.full((48, 64), 2500, np.uint16)


def _encoded(values: np.ndarray, kind: str = "PNG") -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(values).save(buffer, kind)
    return buffer.getvalue()


def _npy(values: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, values)
    return buffer.getvalue()


def dropped_samples() -> tuple[bytes, ...]:
    """A photo with its files, a model and a scan, each alone and in archives."""
    rows = np.linspace(0, 255, 48)[:, None, None] * np.ones((1, 64, 3))
    photo, depth = _encoded(rows.astype(np.uint8), "JPEG"), _encoded(DEPTH)
    box = bytes(trimesh.creation.box((0.5, 0.4, 0.9)).export(file_type="glb"))
    return (
        BOXES, photo, depth, box, OBJ_BACKWARDS,
        zipped({"a.jpg": photo, "a.boxes.json": BOXES, "a.depth.png": depth}),
        zipped({"a.jpg": photo, "b.jpg": photo, "transforms.json": b'{"camera_angle_x": 1, "frames": []}'}),
        zipped({"pack/chair.glb": box, "pack/chair.obj": OBJ_BACKWARDS}),
    )  # fmt: skip


def read_dropped(data: bytes) -> object:
    """As the page does, with a photo open."""
    return interpret(data, "dropped", (64, 48))


def confidence_samples() -> tuple[bytes, ...]:
    """Levels and grey values in the containers that they come in."""
    levels = np.arange(DEPTH.size, dtype=np.uint8).reshape(DEPTH.shape) % 3
    return _encoded(levels), _encoded(levels * 127), _npy(levels), levels.tobytes()


def read_confidence(data: bytes) -> object:
    """Beside a depth map."""
    beside = Source(data, "confidence.png")
    return without_unsure(Source(b"", "depth.png", companions=(beside,)), DEPTH)
