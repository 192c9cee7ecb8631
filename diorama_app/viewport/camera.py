"""The camera of one browser's 3D view: where it stands, where it looks and what it sees, and places to look at a room
from that show all of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import viser
from jaxtyping import Float

from diorama_core.geometry.rotations import quaternion_wxyz, rotation_from_quaternion
from diorama_core.scene.types import Camera, Intrinsics, Scene

DEFAULT_FOV_RAD = np.radians(50.0)
NARROW_FOV_RAD = np.radians(7.0)
"""Field of view along an axis: from far away, lines that are parallel in the room nearly are on the screen."""
USUAL_ASPECT = 0.93
"""Aspect ratio of the 3D view between the panels in a window of 1280 x 720."""
AROUND_FOV_RAD = float(np.radians(65.0))
"""Vertical field of view of who looks around from one place."""
ARM_M = 0.002
"""Distance of the point about which the view then turns: the eye stays where it is."""
MARGIN = 0.04
"""Share of the view that is left free on every side."""
COVERED = 0.2
"""Share of half the view's height that the tools cover at the top."""


def room_view(scene: Scene, aspect: float = USUAL_ASPECT) -> tuple[Float[np.ndarray, 3], Float[np.ndarray, 3]]:
    """A place above and behind the photo's camera, and the point to look at, that show the whole room."""
    points = _points(scene)
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    back = np.array([-0.45, -1.0, 0.62])
    if scene.camera is not None:
        flat = (scene.camera.position - centre) * (1.0, 1.0, 0.0)
        if np.linalg.norm(flat) > 0.3:
            flat /= np.linalg.norm(flat)
            back = flat + 0.35 * np.array([-flat[1], flat[0], 0.0]) + np.array([0.0, 0.0, 0.62])
    return _far_enough(points, centre, back / np.linalg.norm(back), aspect)


def side_view(
    scene: Scene, back: Float[np.ndarray, 3], aspect: float = USUAL_ASPECT
) -> tuple[Float[np.ndarray, 3], Float[np.ndarray, 3]]:
    """A far place in the direction `back` of the room from which all of it is in a narrow view, and its middle."""
    points = _points(scene)
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    return _far_enough(points, centre, back / np.linalg.norm(back), aspect, float(NARROW_FOV_RAD))


def _far_enough(
    points: Float[np.ndarray, "n 3"],
    centre: Float[np.ndarray, 3],
    back: Float[np.ndarray, 3],
    aspect: float,
    fov_rad: float = float(DEFAULT_FOV_RAD),
) -> tuple[Float[np.ndarray, 3], Float[np.ndarray, 3]]:
    """The nearest place in the direction `back` from which all points are in view, and the point to look at.

    The point is moved across the view until as much is left free on either side; the tools cover a strip at the top.
    """
    right = np.cross(-back, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    up = np.cross(right, -back)
    half = np.tan(fov_rad / 2)
    across, down = half * max(aspect, 0.2) * (1 - MARGIN), half * (1 - MARGIN)
    local = points - centre
    x, y, near = local @ right, local @ up, local @ back
    # In view from the distance d: |x - x0| <= across (d - near), and likewise y.
    left, end = (x - across * near).min(), (x + across * near).max()
    low, high = (y - down * near).min(), (y + (down - COVERED * half) * near).max()
    distance = max((end - left) / (2 * across), (high - low) / (2 * down - COVERED * half), float(near.max()) + 0.3)
    x0 = (left + end) / 2
    y0 = (low + down * distance + high - (down - COVERED * half) * distance) / 2
    target = centre + x0 * right + y0 * up
    return target + back * distance, target


def _points(scene: Scene) -> Float[np.ndarray, "n 3"]:
    """Corners of everything in the room; of two metres of floor when there is nothing."""
    points = [o.corners_world for o in scene.objects] + [p.polygon for p in scene.architecture.planes]
    return np.concatenate(points) if points else np.array([[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]])


def bounds(scene: Scene) -> tuple[Float[np.ndarray, 3], Float[np.ndarray, 3]]:
    """Corners of the box around everything in the room; two metres on the floor when there is nothing."""
    points = _points(scene)
    return points.min(axis=0), points.max(axis=0)


def fitting_fov(width: float, height: float, fx: float, fy: float, cx: float, cy: float, aspect: float) -> float:
    """The vertical field of view (rad) whose frustum around the optical axis contains the whole photo.

    Args:
        width: in pixels.
        height: in pixels.
        fx: in pixels.
        fy: likewise.
        cx: of the principal point, pixels.
        cy: likewise.
        aspect: width over height of the view.
    """
    half_up = max(cy, height - cy) / fy
    half_across = max(cx, width - cx) / fx
    return float(2 * np.arctan(max(half_up, half_across / max(aspect, 1e-6))))


OTHER_SHAPE = 0.02
"""A change of a view's width over height by this share is worth another look."""
SAME_PLACE_M = 0.01

Place = tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]
"""Where the eye is, and the point that it looks at (m)."""


@dataclass(frozen=True)
class _Framed:
    """A view that was fitted into the page."""

    place: Callable[[float], Place]
    fov_rad: float
    position: Float[np.ndarray, 3]
    aspect: float


class ViewCamera:
    """Moves a browser's camera and tells where it is. Used from the UI thread only."""

    def __init__(self, viser_client: viser.ClientHandle, on_move: Callable[[bool], None]) -> None:
        """A camera that nothing has moved yet.

        Args:
            viser_client: the browser.
            on_move: told before every move whether the view then goes through the photo's camera.
        """
        self._viser_client = viser_client
        self._on_move = on_move
        self.through_photo = False
        """Whether the view was last sent to the photo's camera."""
        self._framed: _Framed | None = None
        """What is fitted into the view, until something else moves the camera."""

    @property
    def fov_rad(self) -> float:
        """Vertical field of view of this browser's 3D view."""
        return float(self._viser_client.camera.fov)

    @property
    def aspect(self) -> float:
        """Width over height of this browser's 3D view."""
        return float(self._viser_client.camera.aspect)

    @property
    def position(self) -> Float[np.ndarray, 3]:
        """The eye, in the world (m)."""
        return np.asarray(self._viser_client.camera.position, dtype=np.float64)

    @property
    def R_world_camera(self) -> Float[np.ndarray, "3 3"]:
        """The eye's axes (OpenCV) in the world."""
        return rotation_from_quaternion(np.asarray(self._viser_client.camera.wxyz))

    @property
    def target_point(self) -> Float[np.ndarray, 3]:
        """The point in the middle of the view."""
        return np.asarray(self._viser_client.camera.look_at, dtype=np.float64)

    def point_on_level(self, height_m: float) -> Float[np.ndarray, 3]:
        """Where the middle of the view meets a level plane; the target's place where it does not."""
        position, ahead = self.position, self.target_point - self.position
        along = (height_m - position[2]) / ahead[2] if abs(ahead[2]) > 1e-6 else -1.0
        point = position + along * ahead if along > 0 else self.target_point
        return np.array([point[0], point[1], height_m])

    def to_picture_camera(self, width: int, height: int) -> Camera:
        """This view as a camera for a picture of the given size (px), with the same vertical field of view."""
        focal = 0.5 * height / float(np.tan(0.5 * self.fov_rad))
        T_world_camera = np.eye(4)
        T_world_camera[:3, :3] = self.R_world_camera
        T_world_camera[:3, 3] = self.position
        return Camera(Intrinsics(width, height, focal, focal, width / 2, height / 2), T_world_camera)

    def move(
        self, position: Float[np.ndarray, 3], target: Float[np.ndarray, 3], fov_rad: float = float(DEFAULT_FOV_RAD)
    ) -> None:
        """Look from a place at a point, upright.

        Args:
            position: of the eye, world, metres.
            target: what it looks at, world, metres.
            fov_rad: vertical; None leaves it.
        """
        self._moves(through_photo=False)
        camera = self._viser_client.camera
        with self._viser_client.atomic():
            camera.fov = fov_rad
            camera.up_direction = (0.0, 0.0, 1.0)
            camera.position = position
            camera.look_at = target
        self._viser_client.flush()

    def frame(self, place: Callable[[float], Place], fov_rad: float = float(DEFAULT_FOV_RAD)) -> None:
        """Look from the place that suits this view's width over height; `frame_again` follows when that changes."""
        aspect = self.aspect
        position, target = place(aspect)
        self.move(position, target, fov_rad)
        self._framed = _Framed(place, fov_rad, position, aspect)

    def frame_again(self) -> None:
        """Fit what was framed into a view of another shape, unless a person has moved the camera since."""
        framed = self._framed
        if framed is None or abs(self.aspect / framed.aspect - 1.0) < OTHER_SHAPE:
            return
        if np.allclose(self.position, framed.position, atol=SAME_PLACE_M):
            self.frame(framed.place, framed.fov_rad)

    def look_through(self, camera: Camera, target_distance_m: float) -> None:
        """Look through the photo's camera, with the whole photo in view."""
        self._moves(through_photo=True)
        k, R = camera.intrinsics, camera.T_world_camera[:3, :3]
        handle = self._viser_client.camera
        with self._viser_client.atomic():
            handle.fov = fitting_fov(k.width, k.height, k.fx, k.fy, k.cx, k.cy, self.aspect)
            handle.up_direction = (0.0, 0.0, 1.0)
            handle.position = camera.position
            handle.look_at = camera.position + R[:, 2] * target_distance_m
            handle.wxyz = quaternion_wxyz(R)
        self._viser_client.flush()

    def look_around(self, position: Float[np.ndarray, 3]) -> None:
        """Look ahead from a place, level, with a target so near that dragging turns the head."""
        ahead = self.R_world_camera[:, 2] * (1.0, 1.0, 0.0)
        length = float(np.linalg.norm(ahead))
        ahead = ahead / length if length > 1e-6 else np.array([0.0, 1.0, 0.0])
        self.move(position, position + ARM_M * ahead, AROUND_FOV_RAD)
        self._moves(through_photo=True)

    def approach(self, target: Float[np.ndarray, 3], distance_m: float) -> None:
        """Look at a point from `distance_m`, keeping the direction of view."""
        back = self.position - self.target_point
        length = float(np.linalg.norm(back))
        back = back / length if length > 1e-6 else np.array([-0.5, -0.7, 0.5])
        self.move(target + back * distance_m, target, self.fov_rad)

    def screen_axis(self, side: str) -> tuple[Float[np.ndarray, 3], bool]:
        """The level world axis nearest to the screen's "right" (or to "away" from the eye), and if it runs backward."""
        right = self.R_world_camera[:, 0]
        # Straight from above, "away" is the screen's up.
        direction = right if side == "right" else np.cross((0.0, 0.0, 1.0), right)
        axis = int(np.abs(direction[:2]).argmax())
        unit = np.zeros(3)
        unit[axis] = 1.0
        return unit, bool(direction[axis] < 0)

    def _moves(self, *, through_photo: bool) -> None:
        self.through_photo = through_photo
        self._framed = None
        self._on_move(through_photo)
