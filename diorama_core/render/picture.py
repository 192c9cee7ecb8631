"""Pictures of a whole scene: from the photo's camera, from above, from the front, or from around."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np
from jaxtyping import Float, Int32, UInt8

from diorama_core.errors import InputError, SceneError
from diorama_core.geometry.openings import with_openings
from diorama_core.geometry.ray_scene import RayScene
from diorama_core.geometry.vectors import unit
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import SILENT, Progress
from diorama_core.render.filters import as_bytes, tone_mapped
from diorama_core.render.lighting import Effort, Lighting, room_lighting, studio
from diorama_core.render.raycast import OrthographicView, PinholeView, View, bands, pixel_centres
from diorama_core.render.scene_light import with_settings
from diorama_core.render.shading import Shot, shoot
from diorama_core.render.world import World, scene_world
from diorama_core.scene.frames import UP_WORLD
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Camera, Intrinsics, Scene, rigid
from diorama_core.workers import map_threads

DEFAULT_SIZE = (1024, 768)
LARGEST_DEFAULT_PX = 1280
PICTURE_EFFORT = Effort(window_rays=2, sky_rays=4)
BACKGROUND_SRGB = (0.945, 0.94, 0.93)
ORBIT_ELEVATION_RAD = np.radians(35.0)
LOOK_FOV_RAD = float(np.radians(70.0))
"""Across; a phone's camera sees as much."""


def picture(
    scene: Scene,
    library: ShapeLibrary,
    *,
    view: str = "photo",
    size: tuple[int, int] | None = None,
    textures: Mapping[str, UInt8[np.ndarray, "_ _ _"]] | None = None,
    photographed: bool = True,
    light: Lighting | None = None,
    effort: Effort = PICTURE_EFFORT,
    progress: Progress = SILENT,
) -> UInt8[np.ndarray, "h w 3"]:
    """A rendered picture of the scene.

    Args:
        scene: What to show; hidden objects are left out.
        library: Where its shapes are.
        view: "photo" (the scene's own camera), "top" (from above without the ceiling), "front" (a plan of the
            elevation, from the photo's side), "orbit:DEG" (from outside, DEG degrees around from the front) or
            "look:X,Y,Z:X,Y,Z" (from a point of the world toward another, metres). Planes are not drawn from behind,
            so the room stays open toward the viewer.
        size: Width and height; None takes the photo's (reduced to 1280) or 1024 x 768.
        textures: Pictures of the planes by `Plane.texture`.
        photographed: Whether those pictures hold the light of the room, as rectified photos do; then they are only
            darkened where something stands in the way of the light, never lit a second time.
        light: None takes the scene's own, or else lights the room from above left of the viewer.
        effort: Rays per pixel.
        progress: Where it is reported and cancelling is noticed.

    Raises:
        InputError: for an unknown view or size.
        SceneError: for "photo" when the scene has no camera.
        Cancelled: when asked to stop.
    """
    progress.report(0.0, "gathering meshes and materials")
    source = scene_view(scene, view, size)
    without = _ids_seen_from_behind(scene, source)
    opened = with_openings(scene)
    world = scene_world(opened, library, textures=textures, photographed=photographed, without=without)
    lit_world, blockers = light_of(scene, opened, library, world, source)
    light = light or lit_world
    shot = shoot(world, blockers, source, light, effort, progress.part(0.1, 1.0))
    exposure = np.float32(scene.light_settings.exposure)
    return np.concatenate(map_threads(lambda band: _develop(shot, band, exposure), bands(source.height)))


def light_of(scene: Scene, opened: Scene, library: ShapeLibrary, world: World, view: View) -> tuple[Lighting, RayScene]:
    """The light of a scene as a person set it, or its own, and what casts shadows in it.

    Args:
        scene: As it is.
        opened: With openings in its walls (`with_openings`).
        library: Where its shapes are.
        world: Of the opened scene.
        view: Lights from above left of it a scene that has no light.
    """
    count = len(scene.objects)
    blockers = world.shadow_caster(without=range(count, count + len(scene.architecture.planes)))
    return with_settings(scene_lighting(scene, world, view), opened, library, _room_bounds(scene, world)), blockers


def instances_seen(
    scene: Scene, library: ShapeLibrary, *, view: str = "photo", size: tuple[int, int] | None = None
) -> Int32[np.ndarray, "h w"]:
    """What every pixel of a picture shows: index in `scene.objects`, planes after them, -1 for the background.

    Glass hides what is behind it; arguments and errors as for `picture`.

    Args:
        scene: As it is.
        library: Where shapes come from.
        view: Name of a view.
        size: Width and height in pixels.
    """
    source = scene_view(scene, view, size)
    world = scene_world(with_openings(scene), library, without=_ids_seen_from_behind(scene, source))
    hits = world.caster.first_hits(source.rays(pixel_centres(source.width, source.height)))
    shown = np.full(hits.is_hit.shape, -1, dtype=np.int32)
    shown[hits.is_hit] = world.instances(hits.triangle[hits.is_hit])
    return shown


def scene_lighting(scene: Scene, world: World, view: View) -> Lighting:
    """The light that a picture of a scene has: the scene's own, or from above left of the viewer."""
    bounds = _room_bounds(scene, world)
    return studio(bounds, -_axis(view)) if scene.light is None else room_lighting(bounds, scene.light)


def _develop(shot: Shot, rows: slice, exposure: np.float32) -> UInt8[np.ndarray, "rows w 3"]:
    """Some rows of the finished picture, the background behind what is seen."""
    coverage = shot.coverage[rows][..., None]
    radiance = shot.radiance[rows] / np.maximum(coverage, 1e-3) * exposure
    return as_bytes(tone_mapped(radiance) * coverage + np.asarray(BACKGROUND_SRGB) * (1 - coverage))


def scene_view(scene: Scene, view: str, size: tuple[int, int] | None = None) -> View:
    """The rays of a named view of a scene; see `picture` for the names and errors."""
    if size is not None and (min(size) < 1 or max(size) > 8192):
        raise InputError(f"a picture of {size[0]}x{size[1]} cannot be made; give a size from 1x1 to 8192x8192")
    if view == "photo":
        return PinholeView(_photo_camera(scene, size))
    width, height = size or DEFAULT_SIZE
    corners = _corners(scene)
    if view == "top":
        return _parallel(corners, looking_along(-UP_WORLD, up=np.array([0.0, 1.0, 0.0])), width, height)
    if view == "front":
        return _parallel(corners, looking_along(np.array([0.0, 1.0, 0.0])), width, height)
    if view.startswith("look:"):
        return PinholeView(_looking_camera(view, width, height))
    orbit = re.fullmatch(r"orbit:(-?\d+(?:\.\d+)?)", view)
    if orbit is None:
        raise InputError(
            f"there is no view {view!r}; choose photo, top, front, orbit:DEG (such as orbit:30) or look:X,Y,Z:X,Y,Z"
        )
    angle = np.radians(float(orbit.group(1)))
    back = np.array([np.sin(angle), -np.cos(angle), 0.0]) * np.cos(ORBIT_ELEVATION_RAD)
    forward = -(back + UP_WORLD * np.sin(ORBIT_ELEVATION_RAD))
    return PinholeView(framing_camera(corners, forward, width, height))


def looking_along(forward: Float[np.ndarray, "3"], up: Float[np.ndarray, "3"] = UP_WORLD) -> Float[np.ndarray, "3 3"]:
    """Camera axes (x right, y down, z forward) as columns, for a viewing direction."""
    z = unit(np.asarray(forward, dtype=np.float64))
    x = unit(np.cross(z, up))
    return np.stack([x, np.cross(z, x), z], axis=1)


def framing_camera(
    points: Float[np.ndarray, "n 3"],
    forward: Float[np.ndarray, "3"],
    width: int,
    height: int,
    *,
    fov_rad: float = np.radians(32.0),
    margin: float = 0.05,
) -> Camera:
    """A camera that looks along `forward` and has all points in its picture, as large as they fit.

    Args:
        points: What must be seen, in the world.
        forward: Viewing direction.
        width: Pixels across.
        height: Pixels down.
        fov_rad: Field of view of the picture's shorter side.
        margin: Share of the picture kept free on each side.
    """
    R = looking_along(forward)
    focal = 0.5 * min(width, height) / float(np.tan(0.5 * fov_rad))
    local = (np.asarray(points) - np.mean(points, axis=0)) @ R
    half = np.array([width, height]) * (0.5 - margin) / focal
    position = np.zeros(3)
    for axis in (0, 1):
        low, high = _tangent_fit(local[:, axis], local[:, 2], float(half[axis]))
        position[axis] = low
        position[2] = min(position[2], high) if axis else high
    T = rigid(R, np.mean(points, axis=0) + R @ position)
    return Camera(Intrinsics(width, height, focal, focal, width / 2, height / 2), T)


def _looking_camera(view: str, width: int, height: int) -> Camera:
    """The camera of "look:X,Y,Z:X,Y,Z"."""
    try:
        eye, target = (np.array([float(n) for n in part.split(",")]) for part in view.removeprefix("look:").split(":"))
        forward = target - eye
        sound = eye.shape == target.shape == (3,) and bool(np.isfinite(forward).all() and np.abs(forward).max() > 1e-6)
    except ValueError:
        sound = False
    if not sound:
        raise InputError(f"{view!r} is no view; give two points in metres, such as look:0,-2,1.6:0,2,0.8")
    R = looking_along(forward, UP_WORLD if np.abs(forward[:2]).max() > 1e-6 else np.array([0.0, 1.0, 0.0]))
    return Camera(Intrinsics.from_fov(width, height, LOOK_FOV_RAD), rigid(R, eye))


def _tangent_fit(across: np.ndarray, along: np.ndarray, slope: float) -> tuple[float, float]:
    """Where to stand so that |across - x| <= slope (along - z) for all points: x, and the largest z."""
    right = np.max(across - slope * along)
    left = np.min(across + slope * along)
    return 0.5 * (right + left), -(right - left) / (2 * slope)


def _photo_camera(scene: Scene, size: tuple[int, int] | None) -> Camera:
    """The scene's camera for a picture size; another aspect shows more of the room, never a stretched one."""
    if scene.camera is None:
        raise SceneError("the scene has no camera, so there is no photo view; choose top, front or orbit:DEG")
    k = scene.camera.intrinsics
    if size is None:
        shrink = min(1.0, LARGEST_DEFAULT_PX / max(k.width, k.height))
        size = (max(1, round(k.width * shrink)), max(1, round(k.height * shrink)))
    if abs(size[0] / k.width - size[1] / k.height) * max(k.width, k.height) < 1.0:
        return scene.camera.resize(*size)
    s = min(size[0] / k.width, size[1] / k.height)
    cx, cy = (size[0] - s * k.width) / 2 + s * k.cx, (size[1] - s * k.height) / 2 + s * k.cy
    return Camera(Intrinsics(size[0], size[1], s * k.fx, s * k.fy, cx, cy), scene.camera.T_world_camera)


def _parallel(
    corners: Float[np.ndarray, "n 3"], R_world_camera: Float[np.ndarray, "3 3"], width: int, height: int
) -> OrthographicView:
    local = corners @ R_world_camera
    low, high = local.min(axis=0), local.max(axis=0)
    extent = np.maximum(high - low, 0.1)
    T = rigid(R_world_camera, R_world_camera @ np.array([*(low + high)[:2] / 2, low[2] - 1.0]))
    return OrthographicView(T, width, height, float(max(extent[0] / width, extent[1] / height)) * 1.08)


def _corners(scene: Scene) -> Float[np.ndarray, "n 3"]:
    """Corners of everything that is shown; a unit box when the scene is empty."""
    points = [p.polygon for p in scene.architecture.planes]
    points += [o.corners_world for o in scene.objects if not o.hidden]
    return np.concatenate(points) if points else np.array([[-0.5, -0.5, 0.0], [0.5, 0.5, 1.0]])


def _room_bounds(scene: Scene, world: World) -> Float[np.ndarray, "2 3"]:
    corners = _corners(scene)
    return np.stack([corners.min(axis=0), corners.max(axis=0)]) if len(scene.architecture.planes) else world.bounds


def _axis(view: View) -> Float[np.ndarray, "3"]:
    T = view.camera.T_world_camera if isinstance(view, PinholeView) else view.T_world_camera
    return T[:3, 2] if abs(T[2, 2]) < 0.99 else -T[:3, 1]


def _viewer_direction(view: View, point_world: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    if isinstance(view, PinholeView):
        return view.camera.position - point_world
    return -view.T_world_camera[:3, 2]


def _ids_seen_from_behind(scene: Scene, view: View) -> frozenset[str]:
    """Ids of planes seen from behind, and of everything that hangs on them."""
    planes = scene.architecture.planes
    hidden = {p.id for p in planes if p.normal @ _viewer_direction(view, p.centre) < -1e-6}
    for edge in scene.supports:
        if edge.parent in hidden and edge.relation == "mounted on":
            hidden |= {edge.child, *descendants(scene, edge.child)}
    return frozenset(hidden)
