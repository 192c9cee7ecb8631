"""Pictures for judging a scene by eye: beside its photo, and drawn over it."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Bool, Float, UInt8

from diorama_core.library.record import ShapeLibrary
from diorama_core.render.raycast import render_buffers
from diorama_core.scene.types import Camera, Scene

_EDGES = tuple((i, i | bit) for i in range(8) for bit in (1, 2, 4) if not i & bit)
"""Pairs of `box_corners` that share an edge."""
_NEAR_M = 0.05


def side_by_side(
    photo: UInt8[np.ndarray, "h w 3"], rendering: UInt8[np.ndarray, "k m 3"], gap: int = 8
) -> UInt8[np.ndarray, "h n 3"]:
    """The photo and a rendering of the same height next to one another."""
    height = photo.shape[0]
    width = max(1, round(rendering.shape[1] * height / rendering.shape[0]))
    resized = cv2.resize(rendering, (width, height), interpolation=cv2.INTER_AREA)
    return np.concatenate([photo, np.full((height, gap, 3), 255, np.uint8), resized], axis=1)


def overlay(
    photo: UInt8[np.ndarray, "h w 3"], scene: Scene, library: ShapeLibrary | None = None
) -> UInt8[np.ndarray, "h w 3"]:
    """Outlines of a scene over its photo: boxes of the objects with labels, edges of the planes.

    Args:
        photo: The picture the scene was made from, at any size.
        scene: Its camera must be set, else the photo comes back as it is.
        library: When given, the visible outlines of the posed shapes are drawn too.
    """
    drawn = photo.copy()
    if scene.camera is None:
        return drawn
    camera = Camera(scene.camera.intrinsics.scaled(photo.shape[1], photo.shape[0]), scene.camera.T_world_camera)
    line = max(1, round(max(photo.shape[:2]) / 700))
    for plane in scene.architecture.planes:
        for a, b in zip(plane.polygon, np.roll(plane.polygon, -1, axis=0), strict=True):
            _draw_segment(drawn, camera, a, b, (255, 255, 255), line)
    shown = [o for o in scene.objects if not o.hidden]
    for index, item in enumerate(shown):
        corners = item.corners_world
        for first, second in _EDGES:
            _draw_segment(drawn, camera, corners[first], corners[second], colour_of(index), line)
    if library is not None and shown:
        buffers = render_buffers([(library.mesh(o.shape_id), o.pose.matrix) for o in shown], camera)
        for index in range(len(shown)):
            _draw_outline(drawn, buffers.instance == index, colour_of(index), line + 1)
    for index, item in enumerate(shown):
        _draw_label(drawn, camera, item.label, item.pose.position, colour_of(index), line)
    return drawn


def colour_of(index: int) -> tuple[int, int, int]:
    """A bright colour for the index, unlike its neighbours'."""
    hue = np.uint8((index * 0.6180339887 % 1.0) * 179)
    pixel = cv2.cvtColor(np.array([[[hue, 200, 255]]], np.uint8), cv2.COLOR_HSV2RGB)[0, 0]
    return int(pixel[0]), int(pixel[1]), int(pixel[2])


def _draw_segment(
    image: UInt8[np.ndarray, "h w 3"],
    camera: Camera,
    a_world: Float[np.ndarray, "3"],
    b_world: Float[np.ndarray, "3"],
    colour: tuple[int, int, int],
    width: int,
) -> None:
    """A line in space, cut where it comes too near the camera."""
    ends = np.stack([a_world, b_world])
    depth = camera.to_camera(ends)[:, 2]
    if depth.max() <= _NEAR_M:
        return
    if depth.min() < _NEAR_M:
        behind = int(depth.argmin())
        share = (_NEAR_M - depth[behind]) / (depth[1 - behind] - depth[behind])
        ends[behind] += share * (ends[1 - behind] - ends[behind])
    pixels = np.clip(camera.project(ends), -20000, 20000)
    first, second = (tuple(int(v) for v in p) for p in np.rint(pixels))
    cv2.line(image, first, second, colour, width, cv2.LINE_AA)


def _draw_outline(
    image: UInt8[np.ndarray, "h w 3"], mask: Bool[np.ndarray, "h w"], colour: tuple[int, int, int], width: int
) -> None:
    contours, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    cv2.drawContours(image, contours, -1, colour, width, cv2.LINE_AA)


def _draw_label(
    image: UInt8[np.ndarray, "h w 3"],
    camera: Camera,
    text: str,
    position_world: Float[np.ndarray, "3"],
    colour: tuple[int, int, int],
    width: int,
) -> None:
    if camera.to_camera(position_world)[2] <= _NEAR_M:
        return
    x, y = np.rint(np.clip(camera.project(position_world), -20000, 20000)).astype(int)
    scale = 0.42 * width
    plain = text.encode("ascii", "replace").decode()
    for shade, thick in (((0, 0, 0), width + 2), (colour, width)):
        cv2.putText(image, plain, (int(x), int(y)), cv2.FONT_HERSHEY_SIMPLEX, scale, shade, thick, cv2.LINE_AA)
