"""The photo in one browser's 3D view: where it was taken, behind the model, over it, and pictures made on it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import viser
from jaxtyping import UInt8

from diorama_app.viewport.mesh_assets import reduced
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.scene.types import Camera

PYRAMID_SCALE = 0.22
OVERLAY_DEPTH_M = 0.12
LAYER_DEPTH_M = 0.11
"""Just in front of the photo that is laid over the model."""


class PhotoOverlay:
    """Places the photo in the room through its camera. Used from the UI thread only."""

    def __init__(self, viser_client: viser.ClientHandle) -> None:
        self._viser_client = viser_client
        self.opacity = 0.0
        """How much of the photo lies over the model, 0 to 1."""
        self._through_photo = False
        self._pyramid: viser.CameraFrustumHandle | None = None
        self._pyramid_of: tuple[Camera | None, UInt8[np.ndarray, "h w 3"] | None] = (None, None)
        self._overlay: viser.ImageHandle | None = None
        self._backdrop: viser.ImageHandle | None = None
        self._layer: viser.ImageHandle | None = None

    @property
    def comparing(self) -> bool:
        """Whether the photo lies over the model here."""
        return self._overlay is not None

    def camera_moved(self, through_photo: bool) -> None:
        """Hide the small pyramid in the view through it; take away the layer that only that view explains."""
        self._through_photo = through_photo
        if not through_photo:
            self.show_layer(None, None)
        self._show_pyramid()

    def show_camera(
        self, camera: Camera | None, photo: UInt8[np.ndarray, "h w 3"] | None, on_click: Callable[[], None]
    ) -> None:
        """The photo in a small pyramid where it was taken, out of the way of the view through it."""
        if self._pyramid is not None and self._pyramid_of[0] == camera and self._pyramid_of[1] is photo:
            return
        self._pyramid_of = (camera, photo)
        if self._pyramid is not None:
            self._pyramid.remove()
            self._pyramid = None
        if camera is None:
            return
        k = camera.intrinsics
        self._pyramid = self._viser_client.scene.add_camera_frustum(
            "/photo_camera",
            fov=k.vertical_fov_rad,
            aspect=k.width / k.height,
            scale=PYRAMID_SCALE,
            thickness=1.5,
            thickness_units="screen",
            color=(70, 78, 92),
            image=None if photo is None else reduced(photo, 512),
            wxyz=quaternion_wxyz(camera.T_world_camera[:3, :3]),
            position=camera.position,
            cast_shadow=False,
            receive_shadow=False,
        )

        async def clicked(event: viser.SceneNodePointerEvent[Any]) -> None:
            on_click()

        self._pyramid.on_click(clicked)
        self._show_pyramid()

    def _show_pyramid(self) -> None:
        if self._pyramid is not None and self._pyramid.visible == self._through_photo:
            self._pyramid.visible = not self._through_photo

    def show_backdrop(self, camera: Camera | None, photo: UInt8[np.ndarray, "h w 3"] | None, depth_m: float) -> None:
        """The photo as a backdrop at `depth_m` along its camera; none without a photo."""
        if self._backdrop is not None:
            self._backdrop.remove()
            self._backdrop = None
        if camera is not None and photo is not None:
            self._backdrop = self._add_picture("/photo_backdrop", camera, reduced(photo, 1280), depth_m)

    def show_overlay(self, camera: Camera | None, photo: UInt8[np.ndarray, "h w 3"] | None, opacity: float) -> None:
        """The photo, half transparent, in front of the model; none at opacity 0."""
        if self._overlay is not None:
            self._overlay.remove()
            self._overlay = None
        self.opacity = 0.0
        if camera is not None and photo is not None and opacity > 0.0:
            small = reduced(photo, 800)
            self.opacity = opacity
            alpha = np.full((*small.shape[:2], 1), round(255 * opacity), dtype=np.uint8)
            self._overlay = self._add_picture(
                "/photo_overlay", camera, np.concatenate([small, alpha], axis=2), OVERLAY_DEPTH_M
            )

    def show_layer(self, camera: Camera | None, picture: UInt8[np.ndarray, "h w 4"] | None) -> None:
        """A transparent picture over everything that is seen through the photo's camera; none without one."""
        if self._layer is not None:
            self._layer.remove()
            self._layer = None
        if camera is not None and picture is not None:
            self._layer = self._add_picture("/photo_evidence", camera, picture, LAYER_DEPTH_M)

    def _add_picture(
        self, name: str, camera: Camera, picture: UInt8[np.ndarray, "h w c"], depth_m: float
    ) -> viser.ImageHandle:
        k = camera.intrinsics
        centre_camera = np.array([(k.width / 2 - k.cx) / k.fx, (k.height / 2 - k.cy) / k.fy, 1.0]) * depth_m
        R = camera.T_world_camera[:3, :3]
        return self._viser_client.scene.add_image(
            name,
            picture,
            render_width=k.width / k.fx * depth_m,
            render_height=k.height / k.fy * depth_m,
            position=camera.position + R @ centre_camera,
            wxyz=quaternion_wxyz(R),
            cast_shadow=False,
            receive_shadow=False,
        )
