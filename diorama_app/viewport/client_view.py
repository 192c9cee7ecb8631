"""One browser's view: camera, drawing board, notices. Has no state that must survive a reload."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import viser
from jaxtyping import Bool, Float, UInt8

from diorama_app.viewport.framing import DEFAULT_FOV_RAD
from diorama_app.viewport.mesh_assets import reduced
from diorama_core.artefacts import Box, LabelledBox
from diorama_core.geometry.rotations import quaternion_wxyz, rotation_from_quaternion
from diorama_core.scene.types import Camera, Intrinsics, Plane

BOARD_CENTRE = np.array([0.0, 0.0, 400.0])
"""Position of the photo, far above the room, while boxes are drawn on it."""
BOARD_HEIGHT_M = 1.0
BOARD_DISTANCE_M = 1.25
PYRAMID_SCALE = 0.22
BOX_COLOURS = ((47, 111, 214), (214, 84, 47), (38, 150, 96), (160, 80, 200), (200, 150, 20), (20, 150, 170))

PHOTO_LAYER_DEPTH_M = 0.11
"""Just in front of the photo that is laid over the model."""
PLANE_COLOURS = {"floor": (190, 120, 30), "wall": (30, 110, 220), "ceiling": (120, 80, 190)}
PLANE_LIFT_M = 0.01
TAPE_COLOUR = (200, 60, 110)
BRAND_COLOUR = (47, 111, 214)

NoticeKind = Literal["info", "good", "bad"]
OnBox = Callable[[Box], None]
OnPoint = Callable[[float, float, bool], None]


@dataclass(frozen=True)
class Board:
    """The photo on the drawing board: where its pixels are in the world."""

    width_px: int
    height_px: int

    @property
    def width_m(self) -> float:
        """Width of the picture on the board."""
        return BOARD_HEIGHT_M * self.width_px / self.height_px

    def to_world(self, pixels: Float[np.ndarray, "*n 2"], lift_m: float = 0.0) -> Float[np.ndarray, "*n 3"]:
        """Photo pixels on the board, `lift_m` in front of it."""
        u = np.asarray(pixels, dtype=np.float64) / (self.width_px, self.height_px) - 0.5
        y = np.full(u.shape[:-1], -lift_m)
        return BOARD_CENTRE + np.stack([u[..., 0] * self.width_m, y, -u[..., 1] * BOARD_HEIGHT_M], axis=-1)

    def to_pixels(
        self, origin: Float[np.ndarray, "3"], directions: Float[np.ndarray, "*n 3"]
    ) -> Float[np.ndarray, "*n 2"]:
        """Where rays from `origin` meet the board, in photo pixels (outside the photo too)."""
        along = np.where(np.abs(directions[..., 1]) < 1e-9, 1e-9, directions[..., 1])
        points = origin + directions * ((BOARD_CENTRE[1] - origin[1]) / along)[..., None] - BOARD_CENTRE
        u = np.stack([points[..., 0] / self.width_m, -points[..., 2] / BOARD_HEIGHT_M], axis=-1) + 0.5
        return u * (self.width_px, self.height_px)


def screen_rays(
    screen: Float[np.ndarray, "*n 2"], R_world_camera: Float[np.ndarray, "3 3"], fov_rad: float, aspect: float
) -> Float[np.ndarray, "*n 3"]:
    """World directions through points of the screen (0 to 1, from the top left) of a camera with this vertical view."""
    half = np.tan(fov_rad / 2)
    s = 2.0 * np.asarray(screen, dtype=np.float64) - 1.0
    camera = np.stack([s[..., 0] * half * aspect, s[..., 1] * half, np.ones(s.shape[:-1])], axis=-1)
    return camera @ np.asarray(R_world_camera).T


def fitting_fov(width: float, height: float, fx: float, fy: float, cx: float, cy: float, aspect: float) -> float:
    """The vertical field of view (rad) whose frustum around the optical axis contains the whole photo."""
    half_up = max(cy, height - cy) / fy
    half_across = max(cx, width - cx) / fx
    return float(2 * np.arctan(max(half_up, half_across / max(aspect, 1e-6))))


class ClientView:
    """What differs between browsers. Used from the UI thread only."""

    def __init__(self, viser_client: viser.ClientHandle) -> None:
        self._viser_client = viser_client
        self.board: Board | None = None
        self._board_nodes: list[viser.SceneNodeHandle] = []
        self._box_nodes: list[viser.SceneNodeHandle] = []
        self._pyramid: viser.CameraFrustumHandle | None = None
        self._pyramid_of: tuple[Camera | None, UInt8[np.ndarray, "h w 3"] | None] = (None, None)
        self.through_photo = False
        self._overlay: viser.ImageHandle | None = None
        self.overlay_opacity = 0.0
        """How much of the photo lies over the model, 0 to 1."""
        self._backdrop: viser.ImageHandle | None = None
        self._photo_layer: viser.ImageHandle | None = None
        self._planes: list[viser.SceneNodeHandle] = []
        self._tape: list[viser.SceneNodeHandle] = []
        self._rect: Any = None
        self._points: list[Any] = []
        self._before_board: tuple[np.ndarray, np.ndarray, float] | None = None

    @property
    def fov_rad(self) -> float:
        """Vertical field of view of this browser's 3D view."""
        return float(self._viser_client.camera.fov)

    @property
    def comparing(self) -> bool:
        """Whether the photo lies over the model here."""
        return self._overlay is not None

    @property
    def aspect(self) -> float:
        """Width over height of this browser's 3D view."""
        return float(self._viser_client.camera.aspect)

    def camera(self, width: int, height: int) -> Camera:
        """What is seen here, as a camera for a picture of this size with the same height of view."""
        handle = self._viser_client.camera
        focal = 0.5 * height / float(np.tan(0.5 * self.fov_rad))
        T_world_camera = np.eye(4)
        T_world_camera[:3, :3] = rotation_from_quaternion(np.asarray(handle.wxyz))
        T_world_camera[:3, 3] = handle.position
        return Camera(Intrinsics(width, height, focal, focal, width / 2, height / 2), T_world_camera)

    def notice(self, message: str, kind: NoticeKind = "info", seconds: float | None = None) -> None:
        """A short notice at the edge of the view; what went wrong stays longer."""
        seconds = seconds or (9.0 if kind == "bad" else 4.0)
        title = {"info": "Diorama", "good": "Done", "bad": "Could not do that"}[kind]
        colour = {"info": (47, 111, 214), "good": (38, 150, 96), "bad": (210, 62, 50)}[kind]
        self._viser_client.add_notification(title, message, color=colour, auto_close_seconds=seconds)

    def download(self, name: str, content: bytes) -> None:
        """Hand a file to the person."""
        self._viser_client.send_file_download(name, content, save_immediately=True)

    def move_camera(
        self, position: Float[np.ndarray, "3"], target: Float[np.ndarray, "3"], fov_rad: float = float(DEFAULT_FOV_RAD)
    ) -> None:
        """Look from a place at a point, upright."""
        self.through_photo = False
        self.show_photo_layer(None, None)
        self._show_pyramid()
        camera = self._viser_client.camera
        with self._viser_client.atomic():
            camera.fov = fov_rad
            camera.up_direction = (0.0, 0.0, 1.0)
            camera.position = position
            camera.look_at = target
        self._viser_client.flush()

    def look_through(self, camera: Camera, target_distance_m: float) -> None:
        """Look through the photo's camera, with the whole photo in view."""
        self.through_photo = True
        self._show_pyramid()
        k, R = camera.intrinsics, camera.T_world_camera[:3, :3]
        handle = self._viser_client.camera
        with self._viser_client.atomic():
            handle.fov = fitting_fov(k.width, k.height, k.fx, k.fy, k.cx, k.cy, self.aspect)
            handle.up_direction = (0.0, 0.0, 1.0)
            handle.position = camera.position
            handle.look_at = camera.position + R[:, 2] * target_distance_m
            handle.wxyz = quaternion_wxyz(R)
        self._viser_client.flush()

    def approach(self, target: Float[np.ndarray, "3"], distance_m: float) -> None:
        """Look at a point from `distance_m`, keeping the direction of view."""
        camera = self._viser_client.camera
        back = np.asarray(camera.position) - np.asarray(camera.look_at)
        length = float(np.linalg.norm(back))
        back = back / length if length > 1e-6 else np.array([-0.5, -0.7, 0.5])
        self.move_camera(target + back * distance_m, target, float(camera.fov))

    def screen_axis(self, side: str) -> tuple[Float[np.ndarray, "3"], bool]:
        """The level world axis nearest to the screen's "right" (or to "away" from the eye), and if it runs backward."""
        R = rotation_from_quaternion(np.asarray(self._viser_client.camera.wxyz))
        right = R[:, 0]
        # Straight from above, "away" is the screen's up.
        direction = right if side == "right" else np.cross((0.0, 0.0, 1.0), right)
        axis = int(np.abs(direction[:2]).argmax())
        unit = np.zeros(3)
        unit[axis] = 1.0
        return unit, bool(direction[axis] < 0)

    def show_measure(self, points: Sequence[tuple[float, float, float]], words: str) -> None:
        """A tape between measured points; none without points."""
        for node in self._tape:
            node.remove()
        self._tape = []
        scene = self._viser_client.scene
        for index, point in enumerate(points):
            self._tape.append(scene.add_icosphere(f"/tape/{index}", radius=0.025, color=TAPE_COLOUR, position=point))
        if len(points) == 2:
            ends = np.array(points)
            self._tape += [
                scene.add_line_segments(
                    "/tape/line", points=ends[None], colors=TAPE_COLOUR, thickness=4.0, thickness_units="screen"
                ),
                scene.add_label("/tape/length", words, position=ends.mean(axis=0), anchor="bottom-center"),
            ]

    def set_dark(self, dark: bool) -> None:
        """Dark or light panels."""
        set_theme(self._viser_client.gui, dark=dark)

    @property
    def target_point(self) -> Float[np.ndarray, "3"]:
        """The point in the middle of the view."""
        return np.asarray(self._viser_client.camera.look_at, dtype=np.float64)

    # -- the photo in the room ---------------------------------------------------------------------------------

    def show_photo_camera(
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
        if self._pyramid is not None and self._pyramid.visible == self.through_photo:
            self._pyramid.visible = not self.through_photo

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
        self.overlay_opacity = 0.0
        if camera is not None and photo is not None and opacity > 0.0:
            small = reduced(photo, 800)
            self.overlay_opacity = opacity
            alpha = np.full((*small.shape[:2], 1), round(255 * opacity), dtype=np.uint8)
            self._overlay = self._add_picture("/photo_overlay", camera, np.concatenate([small, alpha], axis=2), 0.12)

    def show_photo_layer(self, camera: Camera | None, picture: UInt8[np.ndarray, "h w 4"] | None) -> None:
        """A transparent picture over everything that is seen through the photo's camera; none without one."""
        if self._photo_layer is not None:
            self._photo_layer.remove()
            self._photo_layer = None
        if camera is not None and picture is not None:
            self._photo_layer = self._add_picture("/photo_evidence", camera, picture, PHOTO_LAYER_DEPTH_M)

    def show_planes(self, planes: Sequence[tuple[str, Plane]]) -> None:
        """The edges of planes, each with its name; none without planes."""
        for node in self._planes:
            node.remove()
        self._planes = []
        scene = self._viser_client.scene
        for number, (name, plane) in enumerate(planes):
            ends = plane.polygon + PLANE_LIFT_M * plane.normal
            colour = PLANE_COLOURS[plane.role]
            self._planes += [
                scene.add_line_segments(
                    f"/planes/{number}/edges",
                    points=np.stack([ends, np.roll(ends, -1, axis=0)], axis=1),
                    colors=colour,
                    thickness=3.0,
                    thickness_units="screen",
                ),
                scene.add_label(f"/planes/{number}/name", name, position=plane.centre + PLANE_LIFT_M * plane.normal),
            ]

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

    # -- the drawing board -------------------------------------------------------------------------------------

    @property
    def drawing(self) -> bool:
        """Whether this browser is at the drawing board."""
        return self.board is not None

    def open_board(
        self, photo: UInt8[np.ndarray, "h w 3"], on_box: OnBox | None, on_point: OnPoint | None = None
    ) -> None:
        """Show the photo flat, to draw on or to click on.

        Args:
            photo: the picture.
            on_box: told every rectangle drawn on it, in photo pixels.
            on_point: told every click on it (x, y in photo pixels) and whether it was without Shift.
        """
        self.close_board()
        camera = self._viser_client.camera
        self._before_board = (np.array(camera.position), np.array(camera.look_at), float(camera.fov))
        height, width = photo.shape[:2]
        board = self.board = Board(width, height)
        scene = self._viser_client.scene
        self._board_nodes = [
            scene.add_image(
                "/board/photo",
                reduced(photo, 1600),
                render_width=board.width_m,
                render_height=BOARD_HEIGHT_M,
                position=BOARD_CENTRE,
                wxyz=quaternion_wxyz(np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])),
                cast_shadow=False,
                receive_shadow=False,
            )
        ]

        async def selected(event: viser.SceneRectSelectEvent) -> None:
            box = self._box_of(event)
            if box is not None and on_box is not None:
                on_box(box)

        if on_box is not None:
            self._rect = scene.on_rect_select()(selected)
        if on_point is not None:
            self._listen_for_points(board, on_point)
        self._face_board(board)

    def _listen_for_points(self, board: Board, on_point: OnPoint) -> None:
        def listener(part: bool) -> Any:
            async def clicked(event: viser.SceneClickEvent) -> None:
                x, y = board.to_pixels(np.array(event.ray_origin), np.array(event.ray_direction))
                if 0 <= x < board.width_px and 0 <= y < board.height_px:
                    on_point(float(x), float(y), part)

            return clicked

        scene = self._viser_client.scene
        self._points = [scene.on_click()(listener(True)), scene.on_click(modifier="shift")(listener(False))]

    def show_mask(self, mask: Bool[np.ndarray, "h w"]) -> None:
        """Lay an outline over the photo on the board."""
        if self.board is None:
            return
        tint = np.zeros((*mask.shape, 4), dtype=np.uint8)
        tint[mask] = (255, 90, 20, 110)
        step = max(1, max(mask.shape) // 800)
        node = self._viser_client.scene.add_image(
            "/board/mask",
            np.ascontiguousarray(tint[::step, ::step]),
            render_width=self.board.width_m,
            render_height=BOARD_HEIGHT_M,
            position=BOARD_CENTRE - (0.0, 0.002, 0.0),
            wxyz=quaternion_wxyz(np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])),
            cast_shadow=False,
            receive_shadow=False,
        )
        if node not in self._board_nodes:
            self._board_nodes = [n for n in self._board_nodes if n.name != node.name] + [node]

    def leave_board(self) -> None:
        """Put the photo away and look at the room as before."""
        if self.board is None:
            return
        self.close_board()
        if self._before_board is not None:
            position, target, fov = self._before_board
            self.move_camera(position, target, fov)

    def close_board(self) -> None:
        """Put the photo away."""
        if self.board is None:
            return
        self.board = None
        if self._rect is not None:
            self._viser_client.scene.remove_rect_select_callback(self._rect)
            self._rect = None
        for listener in self._points:
            self._viser_client.scene.remove_click_callback(listener)
        self._points = []
        for node in (*self._box_nodes, *self._board_nodes):
            node.remove()
        self._board_nodes, self._box_nodes = [], []

    def show_boxes(self, boxes: Sequence[LabelledBox], highlighted: int | None) -> None:
        """Draw the boxes over the photo on the board."""
        if self.board is None:
            return
        for node in self._box_nodes:
            node.remove()
        self._box_nodes = []
        with self._viser_client.atomic():
            for index, box in enumerate(boxes):
                self._draw_box(self.board, index, box, bold=index == highlighted)

    def _draw_box(self, board: Board, index: int, box: LabelledBox, *, bold: bool) -> None:
        x1, y1, x2, y2 = box.box
        corners = board.to_world(np.array([[x1, y1], [x2, y1], [x2, y2], [x1, y2]]), lift_m=0.002)
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

    def _face_board(self, board: Board) -> None:
        half_up = BOARD_HEIGHT_M / 2 * 1.04
        half_across = board.width_m / 2 * 1.04
        fov = 2 * np.arctan(max(half_up, half_across / max(self.aspect, 1e-6)) / BOARD_DISTANCE_M)
        self.move_camera(BOARD_CENTRE - (0.0, BOARD_DISTANCE_M, 0.0), BOARD_CENTRE, float(fov))

    def _box_of(self, event: Any) -> Box | None:
        board, camera = self.board, self._viser_client.camera
        if board is None:
            return None
        low, high = event.screen_min, event.screen_max
        screen = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
        rays = screen_rays(screen, rotation_from_quaternion(camera.wxyz), camera.fov, camera.aspect)
        pixels = board.to_pixels(np.asarray(camera.position), rays)
        size = np.array([board.width_px, board.height_px])
        (x1, y1), (x2, y2) = np.clip(pixels.min(axis=0), 0, size), np.clip(pixels.max(axis=0), 0, size)
        return None if x2 - x1 < 3 or y2 - y1 < 3 else (float(x1), float(y1), float(x2), float(y2))


def set_theme(gui: viser.GuiApi, *, dark: bool) -> None:
    """The look of the panels."""
    gui.configure_theme(
        control_layout="floating", show_logo=False, show_share_button=False, brand_color=BRAND_COLOUR, dark_mode=dark
    )
