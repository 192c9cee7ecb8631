"""The light from all sides of a room as an environment map."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from diorama_core.errors import ExportError
from diorama_core.export.files import write_whole
from diorama_core.export.gathering import ExportScene
from diorama_core.progress import SILENT, Progress
from diorama_core.render.panorama import panorama


def write_hdr(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write the radiance that comes to the middle of the room (`render.panorama`), as `Writer` says."""
    radiance = panorama(gathered.scene, gathered.library, textures=gathered.textures, progress=progress)
    good, content = cv2.imencode(".hdr", np.ascontiguousarray(radiance[..., ::-1]))
    if not good:
        raise ExportError(f"cannot write {path}: the picture could not be encoded")
    write_whole(Path(path), content.tobytes())
