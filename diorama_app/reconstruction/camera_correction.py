"""Corrections of the photo's camera: field of view, tilt and roll, height above the floor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_app.reconstruction.build_job import start_build
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.strings import N_, _
from diorama_core.artefacts import Inputs
from diorama_core.errors import EditRefused, InputError
from diorama_core.geometry.rotations import CameraAttitude
from diorama_core.scene.room_edits import floor_height, rescale_to_length
from diorama_core.scene.types import Camera, Intrinsics, Scene

MIN_FOV_DEG, MAX_FOV_DEG = 15.0, 130.0
MAX_TILT_DEG, MAX_ROLL_DEG = 80.0, 45.0

IMPOSSIBLE_ANGLES = N_(
    "a tilt of {tilt:g}° and a roll of {roll:g}° are not possible for a photo of a room; "
    "give up to {max_tilt:g}° and {max_roll:g}°"
)


def rebuild_with_camera(client: Client, fov_deg: float | None, camera_attitude: CameraAttitude | None) -> None:
    """Rebuild the open project's scene with a corrected camera, as one undo step.

    Only what depends on the camera runs again: boxes and outlines stay. The correction also applies to later builds.

    Args:
        client: the requesting client.
        fov_deg: horizontal field of view; as it was when None.
        camera_attitude: pitch and roll against the floor; as it was when None.
    """
    inputs = client.session.document.inputs
    if inputs is None:
        raise EditRefused("the open scene was not built from this photo; build it first")
    if fov_deg is not None:
        check_fov(fov_deg)
        photo = inputs.photo
        seen = Intrinsics.from_fov(photo.width, photo.height, float(np.radians(fov_deg)))
        inputs = replace(inputs, intrinsics=seen)
    _rebuild(client, inputs if camera_attitude is None else replace(inputs, camera_attitude=camera_attitude))


def rebuild_as_found(client: Client) -> None:
    """Rebuild the scene with the tilt estimated from the photo instead of a correction."""
    inputs = client.session.document.inputs
    if inputs is None or inputs.camera_attitude is None:
        raise EditRefused("no tilt was set by hand")
    _rebuild(client, replace(inputs, camera_attitude=None))


def _rebuild(client: Client, inputs: Inputs) -> None:
    message = _("Rebuilt with this camera. Undo restores the previous scene.")
    start_build(client.session, inputs, _("Building with this camera"), _("set the camera"), message)


def trial_camera(camera: Camera, fov_deg: float, camera_attitude: CameraAttitude) -> Camera:
    """A camera at the same position with another field of view and attitude."""
    k, T = camera.intrinsics, np.array(camera.T_world_camera)
    T[:3, :3] = camera_attitude.rotation(T[:3, 2])
    return Camera(Intrinsics.from_fov(k.width, k.height, float(np.radians(fov_deg))), T)


def set_camera_height(client: Client, height_m: float) -> None:
    """Set the camera's height above the floor; rescales the whole scene."""
    now = camera_height_m(client.session.scene)
    if now is None:
        raise EditRefused("this scene has no photo camera; build it from a photo first")
    rescale_room(client, _("camera {metres:.2f} m above the floor").format(metres=height_m), now, height_m)


def rescale_room(client: Client, label: str, now_m: float, true_m: float) -> None:
    """Set a true length; rescales the scene and every later build.

    Args:
        client: the browser that asked.
        label: what was measured.
        now_m: its length in the scene.
        true_m: its true length.
    """
    rescaled = rescale_inputs(client.session, true_m / now_m)
    client.session.edit(label, lambda s: rescale_to_length(s, now_m, true_m), by=client, inputs=rescaled)


def rescale_inputs(session: EditorSession, factor: float) -> Inputs | None:
    """What is said of the photo once everything is larger by a factor, so that later builds are; None without one."""
    height, inputs = camera_height_m(session.scene), session.document.inputs
    return None if height is None or inputs is None else replace(inputs, camera_height_m=height * factor)


def camera_height_m(scene: Scene) -> float | None:
    """Height of the photo's camera above the floor; None without a camera."""
    return None if scene.camera is None else float(scene.camera.position[2]) - floor_height(scene)


def check_fov(fov_deg: float) -> None:
    """Raises `InputError` when the field of view is not plausible."""
    if not MIN_FOV_DEG <= fov_deg <= MAX_FOV_DEG:
        message = _("a field of view of {fov:g}° is not possible; give {least:g} to {most:g}°")
        raise InputError(message.format(fov=fov_deg, least=MIN_FOV_DEG, most=MAX_FOV_DEG))


def check_angles(tilt_deg: float, roll_deg: float) -> CameraAttitude:
    """Camera attitude; raises `InputError` when it is not plausible."""
    if abs(tilt_deg) > MAX_TILT_DEG or abs(roll_deg) > MAX_ROLL_DEG:
        message = _(IMPOSSIBLE_ANGLES).format(
            tilt=tilt_deg, roll=roll_deg, max_tilt=MAX_TILT_DEG, max_roll=MAX_ROLL_DEG
        )
        raise InputError(message)
    return CameraAttitude(float(np.radians(tilt_deg)), float(np.radians(roll_deg)))
