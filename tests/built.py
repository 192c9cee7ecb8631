"""What a build gives, made by hand from a scene alone."""

from __future__ import annotations

import numpy as np

from diorama_core.artefacts import ArchitectureEstimate, CameraEstimate, DepthMap, Inputs, ObjectGeometry, Photo
from diorama_core.perception.illuminant import Illuminant
from diorama_core.pipeline.run import Built
from diorama_core.provenance import (
    AttitudeSource,
    CameraSource,
    DepthSource,
    FocalSource,
    HeadingSource,
    RoomMethod,
    RoomSource,
    ScaleSource,
)
from diorama_core.scene.types import Camera, Intrinsics, Scene


def built_scene(scene: Scene) -> Built:
    """A scene with artefacts that say nothing: no detected objects, depth of nothing, a white photo."""
    width, height = (8, 6) if scene.camera is None else (scene.camera.intrinsics.width, scene.camera.intrinsics.height)
    camera = scene.camera or Camera(Intrinsics.from_fov(width, height, 1.0), np.eye(4))
    nothing = np.zeros((height, width), np.float32)
    photo = Photo(np.full((height, width, 3), 255, np.uint8), "white.png", (width, height))
    source = CameraSource(FocalSource.GIVEN, AttitudeSource.GIVEN, HeadingSource.GIVEN)
    return Built(
        scene=scene,
        camera=CameraEstimate((), 0.5, source),
        objects=(),
        geometry=ObjectGeometry(camera, (), (), ScaleSource.DEPTH),
        graph=None,
        architecture=ArchitectureEstimate(scene.architecture, (), 0.5, RoomSource(RoomMethod.DEPTH_PLANES)),
        depth=DepthMap(nothing, np.zeros((height, width, 3), np.float32), DepthSource.MEASURED),
        observed=scene,
        layout=None,
        textures={},
        illuminant=Illuminant(),
        inputs=Inputs(photo, depth_m=nothing, depth_source=DepthSource.MEASURED),
        runs=(),
    )
