"""A camera whose tilt and roll a person has said."""

from __future__ import annotations

from dataclasses import dataclass, replace

from diorama_core.artefacts import CameraEstimate, Inputs
from diorama_core.geometry.camera_attitude import CameraAttitude
from diorama_core.progress import Progress
from diorama_core.protocols import CameraStage


@dataclass(frozen=True)
class GivenAttitudeCamera:
    """A camera stage that replaces the attitude of another stage's cameras by a given one."""

    stage: CameraStage
    camera_attitude: CameraAttitude

    def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
        """One reading: the other stage's best, tilted and rolled as given; its heading stays."""
        found = self.stage.estimate(inputs, progress)
        best = replace(
            found.best, R_world_camera=self.camera_attitude.rotation(found.best.R_world_camera[:, 2]), score=1.0
        )
        source = replace(found.source, attitude_corrected=True)
        return replace(found, hypotheses=(best,), confidence=1.0, source=source)


def with_given_attitude(stage: CameraStage, camera_attitude: CameraAttitude | None) -> CameraStage:
    """The stage with the given attitude, where there is one."""
    if camera_attitude is None or isinstance(stage, GivenAttitudeCamera):
        return stage
    return GivenAttitudeCamera(stage, camera_attitude)
