"""The photos in one browser's 3D view: where they were taken, behind the model, over it, and pictures made on it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import viser
from jaxtyping import UInt8

from diorama_app.viewport.mesh_assets import reduce
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.scene.types import Camera

PYRAMID_SCALE = 0.12
HOVERED_PX = 360
"""Longest side of its picture, which the page shows beside the pointer (`static/silhouettes.js`)."""
OVERLAY_DEPTH_M = 0.12
LAYER_DEPTH_M = 0.11
"""Just in front of the photo that is laid over the model."""


@dataclass(frozen=True, eq=False)
class PhotoCamera:
    """Where a photo was taken."""

    name: str
    """Its own among those of the scene; empty for the scene's own photo, else a suffix like "_2"."""
    camera: Camera
    photo: UInt8[np.ndarray, "h w 3"] | None
    on_click: Callable[[], None]


@dataclass(frozen=True, eq=False)
class _Pyramid:
    of: PhotoCamera
    handle: viser.CameraFrustumHandle

    def shows(self, other: PhotoCamera | None) -> bool:
        return other is not None and self.of.camera == other.camera and self.of.photo is other.photo


class PhotoOverlay:
    """Places the photo in the room through its camera. Used from the UI thread only."""

    def __init__(self, viser_client: viser.ClientHandle) -> None:
        self._viser_client = viser_client
        self.opacity = 0.0
        """How much of the photo lies over the model, 0 to 1."""
        self._through_photo = False
        self._pyramids: dict[str, _Pyramid] = {}
        self._pictures: dict[str, viser.ImageHandle] = {}
        """Pictures that are shown, by their nodes."""

    def camera_moved(self, through_photo: bool) -> None:
        """Hide the small pyramids in the view through one; take away the layer that only that view explains."""
        self._through_photo = through_photo
        if not through_photo:
            self.show_layer(None, None)
        self._show_pyramids()

    def show_cameras(self, cameras: Sequence[PhotoCamera]) -> None:
        """Small pyramids where photos were taken, out of the way of the view through one of them."""
        wanted = {c.name: c for c in cameras}
        for name in [n for n, p in self._pyramids.items() if not p.shows(wanted.get(n))]:
            self._pyramids.pop(name).handle.remove()
        for name, camera in wanted.items():
            if name not in self._pyramids:
                self._pyramids[name] = _Pyramid(camera, self._add_pyramid(camera))
        self._show_pyramids()

    def _add_pyramid(self, shown: PhotoCamera) -> viser.CameraFrustumHandle:
        camera = shown.camera
        k = camera.intrinsics
        handle = self._viser_client.scene.add_camera_frustum(
            f"/photo_camera{shown.name}",
            fov=k.vertical_fov_rad,
            aspect=k.width / k.height,
            scale=PYRAMID_SCALE,
            thickness=1.5,
            thickness_units="screen",
            color=(70, 78, 92),
            image=None if shown.photo is None else reduce(shown.photo, HOVERED_PX),
            wxyz=quaternion_wxyz(camera.T_world_camera[:3, :3]),
            position=camera.position,
            cast_shadow=False,
            receive_shadow=False,
        )

        async def click(event: viser.SceneNodePointerEvent[Any]) -> None:
            shown.on_click()

        handle.on_click(click)
        return handle

    def _show_pyramids(self) -> None:
        for pyramid in self._pyramids.values():
            if pyramid.handle.visible == self._through_photo:
                pyramid.handle.visible = not self._through_photo

    def show_backdrop(self, camera: Camera | None, photo: UInt8[np.ndarray, "h w 3"] | None, depth_m: float) -> None:
        """The photo as a backdrop at `depth_m` along its camera; none without a photo.

        Args:
            camera: the photo's.
            photo: RGB, upright.
            depth_m: from the camera.
        """
        self._show("/photo_backdrop", camera, None if photo is None else reduce(photo, 1280), depth_m)

    def show_overlay(self, camera: Camera | None, photo: UInt8[np.ndarray, "h w 3"] | None, opacity: float) -> None:
        """The photo, half transparent, in front of the model; none at opacity 0.

        Args:
            camera: the photo's.
            photo: RGB, upright.
            opacity: 0 to 1.
        """
        picture, self.opacity = None, 0.0
        if camera is not None and photo is not None and opacity > 0.0:
            small = reduce(photo, 800)
            self.opacity = opacity
            alpha = np.full((*small.shape[:2], 1), round(255 * opacity), dtype=np.uint8)
            picture = np.concatenate([small, alpha], axis=2)
        self._show("/photo_overlay", camera, picture, OVERLAY_DEPTH_M)

    def hide(self) -> None:
        """Show the photo neither behind the model nor over it."""
        self.show_backdrop(None, None, 1.0)
        self.show_overlay(None, None, 0.0)

    def show_layer(self, camera: Camera | None, picture: UInt8[np.ndarray, "h w 4"] | None) -> None:
        """A transparent picture over everything that is seen through the photo's camera; none without one."""
        self._show("/photo_evidence", camera, picture, LAYER_DEPTH_M)

    def _show(
        self, name: str, camera: Camera | None, picture: UInt8[np.ndarray, "h w c"] | None, depth_m: float
    ) -> None:
        """A picture in place of the one of this name, so far along its camera; none without one."""
        if name in self._pictures:
            self._pictures.pop(name).remove()
        if camera is None or picture is None:
            return
        k = camera.intrinsics
        centre_camera = np.array([(k.width / 2 - k.cx) / k.fx, (k.height / 2 - k.cy) / k.fy, 1.0]) * depth_m
        R = camera.T_world_camera[:3, :3]
        self._pictures[name] = self._viser_client.scene.add_image(
            name,
            picture,
            render_width=k.width / k.fx * depth_m,
            render_height=k.height / k.fy * depth_m,
            position=camera.position + R @ centre_camera,
            wxyz=quaternion_wxyz(R),
            cast_shadow=False,
            receive_shadow=False,
        )
