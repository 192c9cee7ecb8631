"""A room's light as a file."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from diorama_core.export import export_scene
from diorama_core.render.panorama import panorama
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()
SCENE = furnished_room(LIBRARY)


def test_a_file_holds_the_radiance(tmp_path: Path) -> None:
    gathered = export_scene(SCENE, LIBRARY, tmp_path / "room.hdr", "hdr")
    read = cv2.imread(str(tmp_path / "room.hdr"), cv2.IMREAD_ANYDEPTH | cv2.IMREAD_COLOR)
    assert read.dtype == np.float32
    truth = panorama(gathered.scene, gathered.library)
    assert read.shape == truth.shape
    np.testing.assert_allclose(read[..., ::-1], truth, rtol=1e-6, atol=0.01)
