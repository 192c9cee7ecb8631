"""Replace one stage of the pipeline by your own: here, a camera that stands level and looks straight into the room.

A stage is an object with one method, described in `diorama_core/protocols.py`. This one asks the stage that it replaces
and changes the answer. Its settings are frozen fields, because results are cached under its `repr`.

    python examples/02_replace_one_stage.py room.jpg boxes.json level-room
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import diorama_core as diorama


@dataclass(frozen=True)
class LevelCamera:
    """The intrinsics of another camera stage, on a level tripod."""

    other: Any

    def estimate(self, inputs: Any, progress: Any) -> Any:
        found = self.other.estimate(inputs, progress)
        # Columns are the camera's axes in the world: x right, y down, z forward along the room's +Y.
        R_world_camera = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
        level = replace(found.best, R_world_camera=R_world_camera)
        source = replace(found.source, attitude_corrected=True)
        return replace(found, hypotheses=(level,), source=source)


def with_level_camera(stages: diorama.Stages) -> diorama.Stages:
    return replace(stages, camera=LevelCamera(stages.camera))


def main(photo: str, boxes: str, folder: str) -> None:
    room = diorama.build(photo, boxes=boxes, stages=with_level_camera, output=folder)
    print(f"{folder}: {len(room.scene.objects)} objects; {room.built.notes[0]}")


if __name__ == "__main__":
    main(*sys.argv[1:4])
