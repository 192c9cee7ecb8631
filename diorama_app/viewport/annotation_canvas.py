"""The photo shown flat in one browser, to draw boxes on, to click on, and to see outlines on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import viser
from jaxtyping import Bool, Float, UInt8

from diorama_app.viewport.camera import ViewCamera, screen_rays
from diorama_app.viewport.mesh_assets import reduced
from diorama_core.artefacts import Box, LabelledBox
from diorama_core.geometry.rotations import quaternion_wxyz

CENTRE = np.array([0.0, 0.0, 400.0])
"""Position of the photo, far above the room, while it is annotated."""
HEIGHT_M = 1.0
DISTANCE_M = 1.25
MARGIN = 1.04
FACING_SOUTH = quaternion_wxyz(np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]))
MASK_COLOUR = (255, 90, 20, 110)
BOX_COLOURS = ((47, 111, 214), (214, 84, 47), (38, 150, 96), (160, 80, 200), (200, 150, 20), (20, 150, 170))
LIFT_M = 0.002
"""Drawings lie this far in front of the photo."""
MIN_BOX_PX = 3

OnBox = Callable[[Box], None]
OnPoint = Callable[[float, float, bool], None]


@dataclass(frozen=True)
class FlatPhoto:
    """The photo on the canvas: where its pixels are in the world."""

    width_px: int
    height_px: int

    @property
    def width_m(self) -> float:
        """Width of the picture on the canvas."""
        return HEIGHT_M * self.width_px / self.height_px

    def to_world(self, pixels: Float[np.ndarray, "*n 2"], lift_m: float = 0.0) -> Float[np.ndarray, "*n 3"]:
        """Photo pixels on the canvas, `lift_m` in front of it."""
        u = np.asarray(pixels, dtype=np.float64) / (self.width_px, self.height_px) - 0.5
        y = np.full(u.shape[:-1], -lift_m)
        return CENTRE + np.stack([u[..., 0] * self.width_m, y, -u[..., 1] * HEIGHT_M], axis=-1)

    def to_pixels(
        self, origin: Float[np.ndarray, "3"], directions: Float[np.ndarray, "*n 3"]
    ) -> Float[np.ndarray, "*n 2"]:
        """Where rays from `origin` meet the canvas, in photo pixels (outside the photo too)."""
        along = np.where(np.abs(directions[..., 1]) < 1e-9, 1e-9, directions[..., 1])
        points = origin + directions * ((CENTRE[1] - origin[1]) / along)[..., None] - CENTRE
        u = np.stack([points[..., 0] / self.width_m, -points[..., 2] / HEIGHT_M], axis=-1) + 0.5
        return u * (self.width_px, self.height_px)

    def contains(self, x: float, y: float) -> bool:
        """Whether a pixel lies in the photo."""
        return 0 <= x < self.width_px and 0 <= y < self.height_px

    def box_around(self, pixels: Float[np.ndarray, "n 2"]) -> Box | None:
        """The box around points, cut at the photo's edges; None where less than `MIN_BOX_PX` is left."""
        size = np.array([self.width_px, self.height_px])
        (x1, y1), (x2, y2) = np.clip(pixels.min(axis=0), 0, size), np.clip(pixels.max(axis=0), 0, size)
        if x2 - x1 < MIN_BOX_PX or y2 - y1 < MIN_BOX_PX:
            return None
        return float(x1), float(y1), float(x2), float(y2)


class AnnotationCanvas:
    """Shows the photo flat and reports what is drawn and clicked on it. Used from the UI thread only."""

    def __init__(self, viser_client: viser.ClientHandle, camera: ViewCamera) -> None:
        self._viser_client = viser_client
        self._camera = camera
        self.photo: FlatPhoto | None = None
        """The photo on the canvas; None while the canvas is closed."""
        self._photo_nodes: list[viser.SceneNodeHandle] = []
        self._box_nodes: list[viser.SceneNodeHandle] = []
        self._rect: Any = None
        self._points: list[Any] = []
        self._before: tuple[np.ndarray, np.ndarray, float] | None = None
        """Position, target and field of view to go back to."""

    @property
    def is_open(self) -> bool:
        """Whether this browser shows the canvas."""
        return self.photo is not None

    def open(self, photo: UInt8[np.ndarray, "h w 3"], on_box: OnBox | None, on_point: OnPoint | None = None) -> None:
        """Show the photo flat, to draw on or to click on.

        Args:
            photo: the picture.
            on_box: told every rectangle drawn on it, in photo pixels.
            on_point: told every click on it (x, y in photo pixels) and whether it was without Shift.
        """
        if not self.is_open:
            camera = self._camera
            self._before = (camera.position, camera.target_point, camera.fov_rad)
        self.close()
        height, width = photo.shape[:2]
        flat = self.photo = FlatPhoto(width, height)
        self._photo_nodes = [self._add_picture("/board/photo", reduced(photo, 1600), flat, lift_m=0.0)]
        if on_box is not None:
            self._listen_for_boxes(flat, on_box)
        if on_point is not None:
            self._listen_for_points(flat, on_point)
        self._face(flat)

    def _listen_for_boxes(self, flat: FlatPhoto, on_box: OnBox) -> None:
        async def selected(event: viser.SceneRectSelectEvent) -> None:
            (x1, y1), (x2, y2) = event.screen_min, event.screen_max
            camera = self._camera
            screen = np.array([[x1, y1], [x2, y1], [x2, y2], [x1, y2]])
            rays = screen_rays(screen, camera.R_world_camera, camera.fov_rad, camera.aspect)
            box = flat.box_around(flat.to_pixels(camera.position, rays))
            if box is not None:
                on_box(box)

        self._rect = self._viser_client.scene.on_rect_select()(selected)

    def _listen_for_points(self, flat: FlatPhoto, on_point: OnPoint) -> None:
        def listener(part: bool) -> Any:
            async def clicked(event: viser.SceneClickEvent) -> None:
                x, y = flat.to_pixels(np.array(event.ray_origin), np.array(event.ray_direction))
                if flat.contains(x, y):
                    on_point(float(x), float(y), part)

            return clicked

        scene = self._viser_client.scene
        self._points = [scene.on_click()(listener(True)), scene.on_click(modifier="shift")(listener(False))]

    def show_mask(self, mask: Bool[np.ndarray, "h w"]) -> None:
        """Lay an outline over the photo on the canvas."""
        if self.photo is None:
            return
        tint = np.zeros((*mask.shape, 4), dtype=np.uint8)
        tint[mask] = MASK_COLOUR
        step = max(1, max(mask.shape) // 800)
        node = self._add_picture("/board/mask", np.ascontiguousarray(tint[::step, ::step]), self.photo, lift_m=LIFT_M)
        self._photo_nodes = [n for n in self._photo_nodes if n.name != node.name] + [node]

    def show_boxes(self, boxes: Sequence[LabelledBox], highlighted: int | None) -> None:
        """Draw the boxes over the photo on the canvas."""
        if self.photo is None:
            return
        for node in self._box_nodes:
            node.remove()
        self._box_nodes = []
        with self._viser_client.atomic():
            for index, box in enumerate(boxes):
                self._draw_box(self.photo, index, box, bold=index == highlighted)

    def _draw_box(self, flat: FlatPhoto, index: int, box: LabelledBox, *, bold: bool) -> None:
        x1, y1, x2, y2 = box.box
        corners = flat.to_world(np.array([[x1, y1], [x2, y1], [x2, y2], [x1, y2]]), lift_m=LIFT_M)
        scene = self._viser_client.scene
        self._box_nodes += [
            scene.add_line_segments(
                f"/board/box/{index}",
                points=np.stack([corners, np.roll(corners, -1, axis=0)], axis=1),
                colors=BOX_COLOURS[index % len(BOX_COLOURS)],
                thickness=4.5 if bold else 2.5,
                thickness_units="screen",
            ),
            scene.add_label(f"/board/name/{index}", box.label[:30], position=corners[0], anchor="bottom-left"),
        ]

    def leave(self) -> None:
        """Put the photo away and look at the room as before."""
        if not self.is_open:
            return
        self.close()
        if self._before is not None:
            self._camera.move(*self._before)

    def close(self) -> None:
        """Put the photo away."""
        if not self.is_open:
            return
        self.photo = None
        if self._rect is not None:
            self._viser_client.scene.remove_rect_select_callback(self._rect)
            self._rect = None
        for listener in self._points:
            self._viser_client.scene.remove_click_callback(listener)
        self._points = []
        for node in (*self._box_nodes, *self._photo_nodes):
            node.remove()
        self._photo_nodes, self._box_nodes = [], []

    def _add_picture(
        self, name: str, picture: UInt8[np.ndarray, "h w c"], flat: FlatPhoto, *, lift_m: float
    ) -> viser.ImageHandle:
        return self._viser_client.scene.add_image(
            name,
            picture,
            render_width=flat.width_m,
            render_height=HEIGHT_M,
            position=CENTRE - (0.0, lift_m, 0.0),
            wxyz=FACING_SOUTH,
            cast_shadow=False,
            receive_shadow=False,
        )

    def _face(self, flat: FlatPhoto) -> None:
        half_up, half_across = MARGIN * HEIGHT_M / 2, MARGIN * flat.width_m / 2
        fov = 2 * np.arctan(max(half_up, half_across / max(self._camera.aspect, 1e-6)) / DISTANCE_M)
        self._camera.move(CENTRE - (0.0, DISTANCE_M, 0.0), CENTRE, float(fov))
