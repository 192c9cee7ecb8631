"""The photo's camera put right by hand: its field of view, how it is tilted against the floor, how high it stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_app.guest import Guest
from diorama_core.artefacts import Inputs
from diorama_core.errors import EditRefused, InputError
from diorama_core.geometry.held import Held
from diorama_core.progress import Progress
from diorama_core.scene.room_edits import floor_height, rescale_to_length
from diorama_core.scene.types import Camera, Intrinsics, Scene

LEAST_FOV_DEG, MOST_FOV_DEG = 15.0, 130.0
MOST_TILT_DEG, MOST_ROLL_DEG = 80.0, 45.0


def rebuild_with_camera(guest: Guest, fov_deg: float | None, held: Held | None) -> None:
    """Build the open project's scene anew with what a person says of its camera, as one undo step.

    Only what depends on the camera runs again: boxes and outlines stay. What was said holds for later builds, too.

    Args:
        guest: who asks.
        fov_deg: horizontal field of view; as it was when None.
        held: against the floor; as it was when None.
    """
    inputs = guest.room.document.inputs
    if inputs is None:
        raise EditRefused("the open scene was not built from this photo; build it first")
    if fov_deg is not None:
        check_fov(fov_deg)
        photo = inputs.photo
        seen = Intrinsics.from_fov(photo.width, photo.height, float(np.radians(fov_deg)))
        inputs = replace(inputs, intrinsics=seen)
    _rebuild(guest, inputs if held is None else replace(inputs, held=held))


def rebuild_as_found(guest: Guest) -> None:
    """Build the scene anew with the tilt that the photo tells, not what a person said."""
    inputs = guest.room.document.inputs
    if inputs is None or inputs.held is None:
        raise EditRefused("nobody said how this camera was held")
    _rebuild(guest, replace(inputs, held=None))


def _rebuild(guest: Guest, inputs: Inputs) -> None:
    room = guest.room
    project, draft = room.project, room.draft
    if project is None or not draft.from_project:
        raise EditRefused("the open scene was not built from this photo; build it first")
    told = replace(draft, inputs=inputs).to_build()

    def work(progress: Progress) -> None:
        from diorama_app.work import show_built
        from diorama_core.project.build import build_project

        room.saver.flush()
        built = build_project(project, told, room.library, progress=progress)
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
    rescale_room(guest, f"camera {height_m:.2f} m above the floor", now, height_m)


def rescale_room(guest: Guest, label: str, now_m: float, true_m: float) -> None:
    """Say how long something of the room is: everything takes that scale, and so does every later build."""
    room = guest.room
    height, inputs = camera_height_m(room.scene), room.document.inputs
    said = None if height is None or inputs is None else replace(inputs, camera_height_m=height * true_m / now_m)
    room.edit(label, lambda s: rescale_to_length(s, now_m, true_m), by=guest, inputs=said)


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
