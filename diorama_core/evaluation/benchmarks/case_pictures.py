"""Pictures of single cases: the photo beside what was built from it, to see what the numbers stand for."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import UInt8

from diorama_core.errors import InputError
from diorama_core.evaluation.benchmarks.system import Show
from diorama_core.io.atomic import write_atomically
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.run import Built
from diorama_core.render.compare import side_by_side
from diorama_core.render.picture import picture
from diorama_core.synthesis.truth import TruthView

SIZE = (320, 240)
JPEG_QUALITY = 82


def case_writer(folder: Path, library: ShapeLibrary) -> Show:
    """What the system bench calls to have every case written into a folder, as `living-3-0.jpg`."""
    folder.mkdir(parents=True, exist_ok=True)

    def show(name: str, view: TruthView, results: tuple[Built | None, ...]) -> None:
        write_picture(folder / f"{name}.jpg", case_picture(view, results, library))

    return show


def case_picture(view: TruthView, results: Sequence[Built | None], library: ShapeLibrary) -> UInt8[np.ndarray, "h w 3"]:
    """The photo, then every result through its own camera and from outside; grey where nothing was built."""
    strip = cv2.resize(view.inputs.photo.rgb, SIZE, interpolation=cv2.INTER_AREA)
    for built in results:
        for look in ("photo", "orbit:30"):
            seen = np.full((SIZE[1], SIZE[0], 3), 128, np.uint8)
            if built is not None and (look != "photo" or built.scene.camera is not None):
                seen = picture(built.scene, library, view=look, size=SIZE, textures=built.textures)
            strip = side_by_side(strip, seen, gap=4)
    return strip


def write_picture(path: Path, rgb: UInt8[np.ndarray, "h w 3"]) -> None:
    """A PNG or JPEG, as the name says."""
    if path.suffix.lower() not in (".png", ".jpg", ".jpeg"):
        raise InputError(f"{path}: a picture is written as .png or .jpg; give such a name")
    quality = [] if path.suffix.lower() == ".png" else [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
    _, data = cv2.imencode(path.suffix.lower(), rgb[..., ::-1], quality)
    write_atomically(path, data.tobytes(), error=InputError)
