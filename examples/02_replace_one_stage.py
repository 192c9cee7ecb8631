"""Replace one stage of the pipeline by your own: here, a camera that is simply held level at a known field of view.

python examples/own_stage.py room.jpg boxes.json level-room
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from diorama_core.artefacts import CameraEstimate, CameraHypothesis, Inputs
from diorama_core.library.catalogue import built_in_library
from diorama_core.perception.inputs import read_inputs
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.progress import Progress
from diorama_core.project.build import build_project
from diorama_core.project.storage import Project
from diorama_core.scene.types import Intrinsics


@dataclass(frozen=True)
class LevelCamera:
    """A camera on a tripod: level, straight into the room."""

    horizontal_fov_deg: float = 60.0

    def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
        photo = inputs.photo
        k = inputs.intrinsics or Intrinsics.from_fov(photo.width, photo.height, np.radians(self.horizontal_fov_deg))
        R_world_camera = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
        return CameraEstimate((CameraHypothesis(k, R_world_camera, 1.0),), confidence=0.5, source="assumed level")


def main() -> None:
    image, boxes, folder = (Path(argument) for argument in sys.argv[1:4])
    read = read_inputs(image, boxes=boxes)
    library = built_in_library()
    stages = replace(embedded_stages(read.inputs, library), camera=LevelCamera())
    built = build_project(Project.create(folder), read.inputs, library, stages=stages)
    print(f"{folder}: {len(built.scene.objects)} objects; camera {built.camera.source}")


if __name__ == "__main__":
    main()
