"""Photo-real pictures of synthetic rooms: a truth view through Blender's Cycles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import UInt8

from diorama_core.errors import SceneError
from diorama_core.export.cycles import cycles_picture
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Scene
from diorama_core.synthesis.finishes import finish_textures


def truth_picture(
    scene: Scene, library: ShapeLibrary, *, samples: int = 64, seed: int = 0
) -> UInt8[np.ndarray, "h w 3"]:
    """A path-traced picture of a scene from its own camera; minutes on a processor.

    Args:
        scene: A truth scene with its camera (`TruthView.scene`); planes named after finishes get their pictures.
        library: Where its shapes are.
        samples: Paths per pixel before the denoiser.
        seed: Of the paths.

    Raises:
        UnavailableError: when Blender's module is not installed, or fails.
        SceneError: when the scene has no camera.
    """
    if scene.camera is None:
        raise SceneError("the scene has no camera; render a truth view's scene")
    planes = tuple(replace(p, texture=p.id) for p in scene.architecture.planes)
    named = replace(scene, architecture=replace(scene.architecture, planes=planes))
    return cycles_picture(named, library, textures=finish_textures(scene.architecture), samples=samples, seed=seed)
