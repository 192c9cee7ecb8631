"""A composed room made ready to be a scene: a camera that shows what was asked for, and pictures of its planes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import UInt8

from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Scene
from diorama_core.synthesis import in_photo_world
from diorama_core.synthesis.finishes import finish_textures
from diorama_core.text.viewpoint import best_viewpoint

SIZE = (1024, 768)


def finished(
    scene: Scene, library: ShapeLibrary, size: tuple[int, int] = SIZE
) -> tuple[Scene, Mapping[str, UInt8[np.ndarray, "_ _ 3"]]]:
    """The room in the world of a camera that shows most of it, and its planes' pictures by name."""
    # Every room has doors and windows; a picture may do without.
    worth = {o.id: 0.2 if o.category in OPENING_CATEGORIES else 1.0 for o in scene.objects}
    scene = in_photo_world(replace(scene, camera=best_viewpoint(scene, library, size, worth)))
    textures = finish_textures(scene.architecture)
    planes = tuple(replace(p, texture=p.id if p.id in textures else None) for p in scene.architecture.planes)
    return replace(scene, architecture=replace(scene.architecture, planes=planes)), textures
