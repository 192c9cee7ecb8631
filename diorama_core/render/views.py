"""Views of single shapes: studio pictures with a contact shadow on nothing."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float, Float32, UInt8
from PIL import Image

from diorama_core.library.opening import OpenedShapes, can_open
from diorama_core.library.record import Shape, ShapeLibrary, record_of
from diorama_core.library.taxonomy import category
from diorama_core.render.appearance import Paint, shape_surfaces
from diorama_core.render.filters import as_bytes, tone_mapped
from diorama_core.render.lighting import TILE, Effort, Lighting, Spots, irradiance, studio
from diorama_core.render.picture import framing_camera
from diorama_core.render.raycast import PinholeView, pixel_centres
from diorama_core.render.shading import Shot, shoot
from diorama_core.render.world import PlacedSurface, World
from diorama_core.scene.types import Camera


@dataclass(frozen=True)
class StudioView:
    """Where the viewer stands: turned from the shape's front, and raised above its middle."""

    yaw_rad: float
    """Positive walks to the shape's own left (the viewer then sees its left side)."""
    elevation_rad: float


PAGE = (246, 245, 243)
EXPOSURE = 0.86
"""Keeps white shapes apart from a white page."""
STUDIO_EFFORT = Effort(window_rays=2, sky_rays=3)
THREE_QUARTER = StudioView(np.radians(32.0), np.radians(22.0))
FRONTAL = StudioView(np.radians(20.0), np.radians(6.0))
FROM_ABOVE = StudioView(np.radians(30.0), np.radians(48.0))


def usual_view(shape: Shape) -> StudioView:
    """The view in which a shape is best recognised: flat objects from above, hung objects from the front."""
    depth, width, height = shape.size_m
    if height < 0.12 * max(depth, width):
        return FROM_ABOVE
    hung = category(shape.category).mount == "wall"
    return FRONTAL if hung and depth < 0.4 * max(width, height) else THREE_QUARTER


def studio_camera(points: Float[np.ndarray, "n 3"], view: StudioView, width: int, height: int) -> Camera:
    """A camera that has all points of a shape in its picture, as large as they fit.

    Args:
        points: Of the shape, metres.
        view: Direction.
        width: In pixels.
        height: In pixels.
    """
    horizontal = np.array([np.cos(view.yaw_rad), np.sin(view.yaw_rad), 0.0]) * np.cos(view.elevation_rad)
    back = horizontal + np.array([0.0, 0.0, np.sin(view.elevation_rad)])
    return framing_camera(points, -back, width, height, fov_rad=np.radians(24.0), margin=0.06)


def render_shape(
    library: ShapeLibrary,
    shape_id: str,
    size: tuple[int, int] = (320, 320),
    view: StudioView | None = None,
    paint: Paint = (None, None),
    open_share: float = 0.0,
) -> UInt8[np.ndarray, "h w 4"]:
    """A shape in soft studio light on a transparent background, with the shadow it would cast where it stands.

    Args:
        library: Where the shape is.
        shape_id: Which shape; `LibraryError` when unknown.
        size: Width and height in pixels.
        view: Where the viewer stands; None takes the shape's usual view.
        paint: Overrides of the main material: colour (sRGB) and finish.
        open_share: How far doors, drawers and lids stand open, 0 to 1.

    Returns:
        Colours and opacity, not premultiplied, sRGB.
    """
    shape = record_of(library, shape_id)
    view = view or usual_view(shape)
    as_it_stands = library if open_share == 0.0 else OpenedShapes(library, open_share)
    alone = World([PlacedSurface(shape_surfaces(as_it_stands, shape_id, *paint), np.eye(4), 0)])
    camera = PinholeView(studio_camera(alone.vertices, view, *size))
    half = 0.5 * np.asarray(shape.size_m)
    light = studio(np.stack([-half, half]), -camera.camera.T_world_camera[:3, 2])
    shot = shoot(alone, alone.shadow_caster(), camera, light, STUDIO_EFFORT)
    hung = category(shape.category).mount in ("wall", "ceiling")
    shadow = np.zeros(shot.coverage.shape, np.float32) if hung else _shadow(shape, alone, light, camera)
    return _composite(shot, shadow)


def four_views(library: ShapeLibrary, shape_id: str, side_px: int = 360) -> Image.Image:
    """A page with a shape in its usual view, from the front and from its left; opened, or from above.

    Args:
        library: Where the shape is.
        shape_id: Which shape; `LibraryError` when unknown.
        side_px: Side of one view.
    """
    opens = can_open(library, shape_id)
    last = StudioView(THREE_QUARTER.yaw_rad, np.radians(35.0)) if opens else StudioView(0.0, np.radians(89.0))
    views = (None, StudioView(0.0, 0.0), StudioView(np.pi / 2, 0.0), last)
    page = Image.new("RGB", (2 * side_px, 2 * side_px), PAGE)
    for number, view in enumerate(views):
        share = 1.0 if opens and number == 3 else 0.0
        picture = Image.fromarray(render_shape(library, shape_id, (side_px, side_px), view, open_share=share))
        page.paste(picture, (number % 2 * side_px, number // 2 * side_px), picture)
    return page


def _shadow(shape: Shape, alone: World, light: Lighting, camera: PinholeView) -> Float32[np.ndarray, "h w"]:
    """How much darker the ground under the shape is than bare ground, 0 to 1; found at half size and smoothed."""
    width, height = max(camera.width // 2, 1), max(camera.height // 2, 1)
    rays = PinholeView(camera.camera.resize(width, height)).rays(pixel_centres(width, height))
    ground = -0.5 * shape.size_m[2]
    fall = np.minimum(rays[..., 5], -1e-6)
    points = rays[..., :3] + rays[..., 3:] * ((ground - rays[..., 2]) / fall)[..., None]
    near = (rays[..., 5] < -1e-6) & (np.linalg.norm(points[..., :2], axis=-1) < 4 * max(shape.size_m))
    up = np.broadcast_to(np.array([0, 0, 1], np.float32), points[near].shape)
    spots, pixels, nothing = Spots(points[near], up, up), np.argwhere(near), World([])
    shaded = np.add(*irradiance(alone, alone.shadow_caster(), spots, pixels, light, STUDIO_EFFORT))
    bare = np.add(*irradiance(nothing, nothing.shadow_caster(), spots, pixels, light, STUDIO_EFFORT))
    shadow = np.zeros((height, width), np.float32)
    shadow[near] = np.clip(1.0 - shaded.mean(axis=1) / bare.mean(axis=1), 0, 1)
    whole_blocks = cv2.blur(cv2.blur(shadow, (TILE, TILE)), (TILE, TILE))
    smooth = cv2.GaussianBlur(whole_blocks, (0, 0), max(1.0, width / 100)) * _vignette(width, height)
    return np.clip(0.8 * (cv2.resize(smooth, (camera.width, camera.height)) - 0.03), 0, 0.8)


def _vignette(width: int, height: int) -> Float32[np.ndarray, "h w"]:
    """1 inside, falling to 0 at the picture's border, so that no shadow is cut off."""
    x, y = (np.minimum(np.linspace(0, 1, n), np.linspace(1, 0, n)) for n in (width, height))
    return (np.clip(x / 0.12, 0, 1)[None, :] * np.clip(y / 0.12, 0, 1)[:, None]).astype(np.float32)


def _composite(shot: Shot, shadow: Float32[np.ndarray, "h w"]) -> UInt8[np.ndarray, "h w 4"]:
    """The shape over its shadow, as colour and opacity."""
    covered = shot.coverage[..., None]
    colour = tone_mapped(EXPOSURE * shot.radiance / np.maximum(covered, 1e-3))
    opacity = covered + shadow[..., None] * (1 - covered)
    straight = colour * covered / np.maximum(opacity, 1e-3)
    return np.concatenate([as_bytes(straight), as_bytes(opacity)], axis=-1)
