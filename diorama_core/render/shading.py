"""From rays to light: one shot of a world, with soft shadows, occlusion, one bounce, gloss and smooth edges."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float32, Int

from diorama_core.geometry.ray_scene import RayArray, RayScene
from diorama_core.geometry.vectors import dot, unit
from diorama_core.progress import SILENT, Progress
from diorama_core.render.filters import tone_mapped
from diorama_core.render.gathering import gather_light
from diorama_core.render.gloss import gloss_share
from diorama_core.render.lighting import Effort, Lighting, ambient, irradiance_without_shadows
from diorama_core.render.raycast import Grid, View, bands, pixel_centres, pixel_footprint
from diorama_core.render.world import Places, World
from diorama_core.workers import map_threads

BRIGHTEST = 2.0
"""Light beyond this is white anyway; unclipped it would eat away what it borders on."""
_SUBPIXELS = np.array([[-1, -3], [3, -1], [1, 3], [-3, 1]]) / 8.0
"""A square turned off the grid: near-level and near-upright edges get as many steps as slanted ones."""


@dataclass(frozen=True, eq=False)
class Shot:
    """A picture before the background is put in."""

    radiance: Float32[np.ndarray, "h w 3"]
    """Linear light, 0 where nothing is seen; already weighted by `coverage`."""
    coverage: Float32[np.ndarray, "h w"]
    """Share of the pixel that sees anything."""
    grid: Grid
    """What the middle of each pixel sees."""


def shoot(
    world: World, blockers: RayScene, view: View, light: Lighting, effort: Effort, progress: Progress = SILENT
) -> Shot:
    """The light that reaches every pixel of a view.

    Args:
        world: What is seen, and what shades and colours its neighbours.
        blockers: What casts the window's shadows (`World.shadow_caster`).
        view: The rays' source.
        light: What lights the world.
        effort: Rays per pixel.
        progress: Where it is reported and cancelling is noticed.

    Raises:
        Cancelled: when asked to stop.
    """
    rows = bands(view.height)
    parts = map_threads(lambda band: _first_sight(world, view, band), rows, progress.part(0.0, 0.15), "casting rays")
    grid = _grid(parts, view)
    fallen = gather_light(world, blockers, grid, light, effort, progress.part(0.15, 0.6))
    seen = map_threads(
        lambda pair: _radiance(world, pair[1].places, pair[1].rays, fallen[pair[0]][pair[1].found], light),
        list(zip(rows, parts, strict=True)),
        progress.part(0.6, 0.8),
        "shading",
    )
    radiance = np.zeros((*grid.found.shape, 3), np.float32)
    radiance[grid.found] = np.concatenate(seen)
    shot = Shot(radiance, grid.found.astype(np.float32), grid)
    return _with_smooth_edges(shot, world, view, light, fallen, progress.part(0.8, 1.0))


def light_map(
    world: World, blockers: RayScene, view: View, light: Lighting, effort: Effort
) -> Float32[np.ndarray, "h w 3"]:
    """The light that falls on what every pixel of a view sees, 0 where nothing is; arguments as for `shoot`.

    Args:
        world: Surfaces.
        blockers: What casts shadows.
        view: Of the picture.
        light: Sources.
        effort: Rays.
    """
    parts = map_threads(lambda band: _first_sight(world, view, band), bands(view.height))
    return gather_light(world, blockers, _grid(parts, view), light, effort, Progress())


@dataclass(frozen=True, eq=False)
class _Band:
    """What some rows of the picture see."""

    found: Bool[np.ndarray, "h w"]
    rays: RayArray
    places: Places
    depth: Float32[np.ndarray, "h w"]


def _first_sight(world: World, view: View, rows: slice) -> _Band:
    rays = view.rays(pixel_centres(view.width, rows.stop, rows.start))
    hits = world.caster.first_hits(rays)
    is_hit = hits.is_hit
    depth = np.where(is_hit, hits.distance, 0).astype(np.float32)
    places = world.places(rays[is_hit], hits.select(is_hit), pixel_footprint(view, depth)[is_hit])
    return _Band(is_hit, rays[is_hit], places, depth)


def _radiance(
    world: World, places: Places, rays: RayArray, fallen: Float32[np.ndarray, "n 3"], light: Lighting, depth: int = 0
) -> Float32[np.ndarray, "n 3"]:
    """Light that leaves places toward the viewer: diffuse, gloss, glow, and what shines through glass."""
    direction = unit(rays[:, 3:])
    base = places.albedo
    metal = places.metallic[:, None]
    fallen = _relight(places, fallen, light)
    out = base * (1 - metal) * fallen + places.emissive
    clear = np.flatnonzero(places.alpha < 0.999)
    if len(clear) and depth < 3:
        beyond = _beyond(world, places, rays, clear, light, depth)
        share = places.alpha[clear, None]
        out[clear] = out[clear] * share + beyond * (1 - share)
    gloss = _gloss(world, places, direction, fallen, light)
    if not light.relights:
        gloss[places.photographed] = 0  # their colours hold it already
    return (out + gloss).astype(np.float32)


def _relight(places: Places, fallen: Float32[np.ndarray, "n 3"], light: Lighting) -> Float32[np.ndarray, "n 3"]:
    """The light to multiply colours with: on photographed places only how much of it is held off, and lamps' light."""
    known = np.flatnonzero(places.photographed)
    if light.relights or not len(known):
        return fallen
    free = irradiance_without_shadows(places.points[known], places.normals[known], replace(light, direct=()))
    relit = fallen.copy()
    if light.direct:
        relit[known] = fallen[known] / free.mean(axis=1, keepdims=True)
    else:
        relit[known] = np.clip(fallen[known].mean(axis=1) / free.mean(axis=1), 0.0, 1.0)[:, None]
    return relit


def _gloss(
    world: World, places: Places, direction: np.ndarray, fallen: Float32[np.ndarray, "n 3"], light: Lighting
) -> Float32[np.ndarray, "n 3"]:
    """Mirrored surroundings, blurred toward the fallen light as roughness grows (Schlick's Fresnel)."""
    cosine = np.clip(-dot(places.normals, direction), 0, 1)[:, None]
    smooth = 1 - places.roughness[:, None]
    strength = gloss_share(places.albedo, places.metallic[:, None], smooth, cosine)
    shiny = np.flatnonzero((smooth[:, 0] > 0.45) | (places.metallic > 0.3))
    mirrored = fallen.copy()
    if len(shiny):
        normal = places.normals[shiny]
        away = direction[shiny] - 2 * dot(direction[shiny], normal)[:, None] * normal
        origin = places.points[shiny] + places.flat_normals[shiny] * 1e-3
        sharp = _environment(world, np.concatenate([origin, away], axis=1).astype(np.float32), light)
        blur = np.clip(places.roughness[shiny, None] * 1.4, 0, 1)
        mirrored[shiny] = sharp * (1 - blur) + fallen[shiny] * blur
    return (strength * mirrored).astype(np.float32)


def _environment(world: World, rays: RayArray, light: Lighting) -> Float32[np.ndarray, "n 3"]:
    """What a mirror sees along rays: surfaces in unshadowed light, the window, or the surroundings."""
    hits = world.caster.first_hits(rays)
    seen = ambient(rays[:, 3:], light).astype(np.float32) + _window_glare(rays, light)
    hit_rows = np.flatnonzero(hits.is_hit)
    if len(hit_rows):
        places = world.places(rays[hit_rows], hits.select(hit_rows))
        seen[hit_rows] = (
            0.85 * places.albedo * irradiance_without_shadows(places.points, places.normals, light) + places.emissive
        )
    return seen


def _window_glare(rays: RayArray, light: Lighting) -> Float32[np.ndarray, "n 3"]:
    """The bright rectangle itself, where a ray meets it."""
    across, upward = light.window_edges
    normal = np.cross(across, upward)
    slope = rays[:, 3:] @ normal
    distance = ((light.window_centre - rays[:, :3]) @ normal) / np.where(np.abs(slope) < 1e-9, 1e-9, slope)
    offset = rays[:, :3] + rays[:, 3:] * distance[:, None] - light.window_centre
    inside = (np.abs(offset @ across) < across @ across) & (np.abs(offset @ upward) < upward @ upward)
    return np.where((inside & (distance > 0))[:, None], 2.5 * light.window_irradiance, 0).astype(np.float32)


def _beyond(
    world: World, places: Places, rays: RayArray, clear: np.ndarray, light: Lighting, depth: int
) -> Float32[np.ndarray, "k 3"]:
    """What is seen through transparent places."""
    length = np.linalg.norm(rays[clear, 3:], axis=1, keepdims=True)
    direction = rays[clear, 3:] / length
    onward = np.concatenate([places.points[clear] + 2e-3 * direction, direction], axis=1).astype(np.float32)
    hits = world.caster.first_hits(onward)
    seen = np.broadcast_to(ambient(direction, light), direction.shape).astype(np.float32)
    hit_rows = np.flatnonzero(hits.is_hit)
    if len(hit_rows):
        behind = world.places(onward[hit_rows], hits.select(hit_rows))
        fallen = irradiance_without_shadows(behind.points, behind.normals, light)
        seen[hit_rows] = _radiance(world, behind, onward[hit_rows], fallen, light, depth + 1)
    return seen


def _with_smooth_edges(
    shot: Shot, world: World, view: View, light: Lighting, fallen: Float32[np.ndarray, "h w 3"], progress: Progress
) -> Shot:
    """Pixels at edges seen again through four more positions."""
    grid = shot.grid
    pixels = np.argwhere(np.concatenate(map_threads(lambda band: _edges(shot, band), bands(view.height))))
    if not len(pixels):
        return shot
    groups = np.array_split(pixels, 1 + len(pixels) // 4096)
    again = map_threads(
        lambda group: _resample(world, view, light, grid, fallen, group), groups, progress, "smoothing edges"
    )
    radiance, coverage = np.minimum(shot.radiance, BRIGHTEST), shot.coverage.copy()
    at, weight = (pixels[:, 0], pixels[:, 1]), 1 / (1 + len(_SUBPIXELS))
    radiance[at] += (1 - weight) * (np.concatenate([colour for colour, _ in again]) - radiance[at])
    coverage[at] += (1 - weight) * (np.concatenate([share for _, share in again]) - coverage[at])
    return Shot(radiance, coverage, grid)


def _resample(
    world: World,
    view: View,
    light: Lighting,
    grid: Grid,
    fallen: Float32[np.ndarray, "h w 3"],
    pixels: Int[np.ndarray, "n 2"],
) -> tuple[Float32[np.ndarray, "n 3"], Float32[np.ndarray, "n"]]:
    """Mean light and coverage of pixels over further positions; light falls as on the neighbour that fits best."""
    count = len(_SUBPIXELS)
    rays = view.rays((pixels[:, None, ::-1] + 0.5 + _SUBPIXELS).reshape(-1, 2))
    hits = world.caster.first_hits(rays)
    hit_rows = np.flatnonzero(hits.is_hit)
    chosen = hits.select(hit_rows)
    places = world.places(rays[hit_rows], chosen, pixel_footprint(view, chosen.distance[:, None])[:, 0])
    borrowed = _borrow(places, np.repeat(pixels, count, axis=0)[hit_rows], grid, fallen)
    seen = np.zeros((len(rays), 3), np.float32)
    seen[hit_rows] = np.minimum(_radiance(world, places, rays[hit_rows], borrowed, light), BRIGHTEST)
    share = hits.is_hit.reshape(-1, count).mean(axis=1)
    return seen.reshape(-1, count, 3).mean(axis=1), share.astype(np.float32)


def _edges(shot: Shot, rows: slice) -> Bool[np.ndarray, "rows w"]:
    """Pixels of some rows that lie beside a change of object, direction, depth or brightness."""
    near = slice(max(0, rows.start - 1), rows.stop + 1)
    grid = shot.grid.part(near)
    edge = np.zeros(grid.found.shape, bool)
    bright = tone_mapped(shot.radiance[near]).mean(axis=-1)
    for here, neighbour in (
        ((slice(None), slice(0, -1)), (slice(None), slice(1, None))),
        ((slice(0, -1), slice(None)), (slice(1, None), slice(None))),
    ):
        leap = np.abs(dot(grid.points[neighbour] - grid.points[here], grid.flat_normals[here]))
        differs = (
            (grid.instance[here] != grid.instance[neighbour])
            | (dot(grid.normals[here], grid.normals[neighbour]) < 0.9)
            | (leap > 4 * grid.pixel_m[here])
            | (np.abs(bright[here] - bright[neighbour]) > 0.07)
        )
        edge[here] |= differs
        edge[neighbour] |= differs
    return edge[rows.start - near.start : rows.stop - near.start]


def _borrow(
    places: Places, near: Int[np.ndarray, "n 2"], grid: Grid, fallen: Float32[np.ndarray, "h w 3"]
) -> Float32[np.ndarray, "n 3"]:
    """For places seen between pixels, the light on the best-fitting of the pixel and its four neighbours."""
    h, w = grid.found.shape
    best = np.full(len(near), np.inf, np.float32)
    taken = np.zeros(len(near), np.int64)
    points, normals = grid.points.reshape(-1, 3), grid.normals.reshape(-1, 3)
    instance, penalty = grid.instance.reshape(-1), np.where(grid.found, 0, 100).astype(np.float32).reshape(-1)
    scale = np.maximum(grid.depth[near[:, 0], near[:, 1]], 0.1)
    for dy, dx in ((0, 0), (-1, 0), (1, 0), (0, -1), (0, 1)):
        row, column = np.clip(near[:, 0] + dy, 0, h - 1), np.clip(near[:, 1] + dx, 0, w - 1)
        at = row * w + column
        apart = points.take(at, axis=0) - places.points
        turn = 1 - dot(normals.take(at, axis=0), places.normals)
        cost = 20 * np.sqrt(dot(apart, apart)) / scale + turn + penalty.take(at)
        cost += 2 * (instance.take(at) != places.instance)
        better = cost < best
        best, taken = np.where(better, cost, best), np.where(better, at, taken)
    return fallen.reshape(-1, 3).take(taken, axis=0)


def _grid(parts: list[_Band], view: View) -> Grid:
    is_hit = np.concatenate([p.found for p in parts])
    depth = np.concatenate([p.depth for p in parts])

    def image(name: str) -> np.ndarray:
        values = [getattr(p.places, name) for p in parts]
        empty = -1 if name == "instance" else 0
        whole = np.full((*is_hit.shape, *values[0].shape[1:]), empty, values[0].dtype)
        whole[is_hit] = np.concatenate(values)
        return whole

    points, normals, flat_normals, instance, photographed = map_threads(
        image, ("points", "normals", "flat_normals", "instance", "photographed")
    )
    return Grid(is_hit, points, normals, flat_normals, instance, depth, pixel_footprint(view, depth), photographed)
