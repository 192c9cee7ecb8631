"""Where the weights that come with Diorama lie; light to ask."""

from __future__ import annotations

from diorama_core.io.assets import asset

FOLDER = asset("models")
DETECTOR, NAMER, CARD = "room-detector.onnx", "room-namer.onnx", "recogniser.json"
OUTLINER = "room-outliner.onnx"
CLASS_TABLE, KIND_LAYER = "kinds-in-imagenet.txt", "kinds-in-photos.npz"


def has_own_recogniser() -> bool:
    """Whether the recogniser's weights are there: an installation may leave them out."""
    return all((FOLDER / name).is_file() for name in (DETECTOR, NAMER, CARD))
