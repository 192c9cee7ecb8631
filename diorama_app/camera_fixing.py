"""The photo's camera put right by hand: its field of view, how it is tilted against the floor, how high it stands."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_app.guest import Guest
from diorama_core.artefacts import CameraEstimate, Inputs
from diorama_core.errors import EditRefused, InputError
from diorama_core.progress import Progress
from diorama_core.protocols import CameraStage
from diorama_core.scene.room_edits import floor_height, rescale_to_length
from diorama_core.scene.types import Camera, Intrinsics, Scene

LEAST_FOV_DEG, MOST_FOV_DEG = 15.0, 130.0
MOST_TILT_DEG, MOST_ROLL_DEG = 80.0, 45.0
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Held:
    """How a camera is held against the floor."""

    tilt_rad: float
    """Downward, of the viewing direction."""
    roll_rad: float
    """Clockwise about the viewing direction, as the photographer sees it."""

    @classmethod
    def of(cls, R_world_camera: Float[np.ndarray, "3 3"]) -> Held:
        """How this camera is held."""
        right, forward = R_world_camera[:, 0], R_world_camera[:, 2]
        level, below = _level_axes(forward)
        return cls(float(-np.arcsin(np.clip(forward[2], -1, 1))), float(np.arctan2(right @ below, right @ level)))

    def rotation(self, heading: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
        """R_world_camera of a camera held so that looks along `heading`, whose height is not used."""
        flat = np.asarray(heading) * (1.0, 1.0, 0.0)
        flat = flat / np.linalg.norm(flat)
        forward = np.cos(self.tilt_rad) * flat - np.sin(self.tilt_rad) * UP
        level, below = _level_axes(forward)
        c, s = np.cos(self.roll_rad), np.sin(self.roll_rad)
        return np.column_stack([c * level + s * below, c * below - s * level, forward])


def _level_axes(forward: Float[np.ndarray, "3"]) -> tuple[np.ndarray, np.ndarray]:
    """Right and down of a camera that looks along `forward` and is not rolled."""
    level = np.cross(forward, UP)
    level = level / np.linalg.norm(level)
    return level, np.cross(forward, level)


@dataclass(frozen=True)
class HandHeldCamera:
    """A camera stage: what another one finds, but held against the floor as a person said."""

    stage: CameraStage
    held: Held

    def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
        """One reading: the other stage's best, tilted and rolled as given; its heading stays."""
        found = self.stage.estimate(inputs, progress)
        best = replace(found.best, R_world_camera=self.held.rotation(found.best.R_world_camera[:, 2]), score=1.0)
        return replace(found, hypotheses=(best,), confidence=1.0, source=f"{found.source}; tilt set by hand")


def rebuild_with_camera(guest: Guest, fov_deg: float | None, held: Held | None) -> None:
    """Build the open project's scene anew with what a person says of its camera, as one undo step.

    Only what depends on the camera runs again: boxes and outlines stay.

    Args:
        guest: who asks.
        fov_deg: horizontal field of view; as it was when None.
        held: against the floor; found from the photo when None.
    """
    room = guest.room
    project, draft = room.project, room.draft
    inputs = None if project is None else project.load_inputs()
    if project is None or inputs is None or not draft.from_project:
        raise EditRefused("the open scene was not built from this photo; build it first")
    if fov_deg is not None:
        check_fov(fov_deg)
        photo = inputs.photo
        seen = Intrinsics.from_fov(photo.width, photo.height, float(np.radians(fov_deg)))
        inputs = replace(inputs, intrinsics=seen)
    told = replace(inputs, boxes=draft.boxes) if draft.boxes else inputs

    def work(progress: Progress) -> None:
        from diorama_app.work import show_built
        from diorama_core.pipeline.profiles import stages_for
        from diorama_core.project.build import build_project

        stages = stages_for("auto", told, room.library)
        if held is not None:
            stages = replace(stages, camera=HandHeldCamera(stages.camera, held))
        room.saver.flush()
        built = build_project(project, told, room.library, stages=stages, progress=progress)
        message = "Built again with this camera. Undo brings back what was there."
        guest.post(
            lambda: show_built(room, draft, project, built.scene, own=True, message=message, label="set the camera")
        )

    room.jobs.start("build", "Building with this camera", work)


def trial_camera(camera: Camera, fov_deg: float, held: Held) -> Camera:
    """A camera at the same place with another field of view, held otherwise."""
    k, T = camera.intrinsics, np.array(camera.T_world_camera)
    T[:3, :3] = held.rotation(T[:3, 2])
    return Camera(Intrinsics.from_fov(k.width, k.height, float(np.radians(fov_deg))), T)


def set_camera_height(guest: Guest, height_m: float) -> None:
    """Say how high above the floor the photo was taken: everything takes that scale, at once."""
    now = camera_height_m(guest.room.scene)
    if now is None:
        raise EditRefused("this scene has no photo camera; build it from a photo first")
    guest.room.edit(f"camera {height_m:.2f} m above the floor", lambda s: rescale_to_length(s, now, height_m), by=guest)


def camera_height_m(scene: Scene) -> float | None:
    """How high the photo's camera is above the floor; None without one."""
    return None if scene.camera is None else float(scene.camera.position[2]) - floor_height(scene)


def check_fov(fov_deg: float) -> None:
    """Raises `InputError` when no camera sees so much or so little."""
    if not LEAST_FOV_DEG <= fov_deg <= MOST_FOV_DEG:
        raise InputError(f"a field of view of {fov_deg:g}° is no camera's; give {LEAST_FOV_DEG:g} to {MOST_FOV_DEG:g}°")


def checked_angles(tilt_deg: float, roll_deg: float) -> Held:
    """How a camera is held; raises `InputError` when nobody holds one so."""
    if abs(tilt_deg) > MOST_TILT_DEG or abs(roll_deg) > MOST_ROLL_DEG:
        raise InputError(
            f"tilted by {tilt_deg:g}° and rolled by {roll_deg:g}° is no photo of a room; "
            f"give up to {MOST_TILT_DEG:g}° and {MOST_ROLL_DEG:g}°"
        )
    return Held(float(np.radians(tilt_deg)), float(np.radians(roll_deg)))
