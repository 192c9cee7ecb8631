"""Where the files lie that come with Diorama: networks of its own, shapes' parts, the example, pictures."""

from __future__ import annotations

from pathlib import Path

_INSTALLED = Path(__file__).resolve().parents[1] / "assets"
"""Where `setup.py` puts them in a wheel."""
_CHECKOUT = Path(__file__).resolve().parents[2] / "assets"


def asset(*parts: str) -> Path:
    """The path of a file or folder below `assets`, whether it is there or not."""
    return (_INSTALLED if _INSTALLED.is_dir() else _CHECKOUT).joinpath(*parts)


FOLDER = asset("models")
DETECTOR, NAMER, CARD = "room-detector.onnx", "room-namer.onnx", "recogniser.json"
OUTLINER = "room-outliner.onnx"
SURFACES = "room-surfaces.onnx"
CLASS_TABLE, KIND_LAYER = "kinds-in-imagenet.txt", "kinds-in-photos.npz"


def has_own_recogniser() -> bool:
    """Whether the recogniser's weights are there: an installation may leave them out."""
    return all((FOLDER / name).is_file() for name in (DETECTOR, NAMER, CARD))
