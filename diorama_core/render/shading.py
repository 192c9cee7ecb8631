"""From rays to light: one shot of a world, with soft shadows, occlusion, one bounce, gloss and smooth edges."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from jaxtyping import Bool, Float32, Int

from diorama_core.render.filters import Neighbours, tone_mapped
from diorama_core.render.lighting import TILE, Effort, Lighting, ambient, irradiance, unshadowed
from diorama_core.render.raycast import RayArray, View, pixel_centres, unit
from diorama_core.render.world import Places, World

Item = TypeVar("Item")
Result = TypeVar("Result")
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


@dataclass(frozen=True, eq=False)
class _Grid:
    """The first places of all pixels, as images."""

    found: Bool[np.ndarray, "h w"]
    points: Float32[np.ndarray, "h w 3"]
    normals: Float32[np.ndarray, "h w 3"]
    flat_normals: Float32[np.ndarray, "h w 3"]
    instance: Int[np.ndarray, "h w"]
    depth: Float32[np.ndarray, "h w"]
    pixel_m: Float32[np.ndarray, "h w"]
    """Width that a pixel covers at its depth."""


def shoot(world: World, blockers: World, view: View, light: Lighting, effort: Effort) -> Shot:
    """The light that reaches every pixel of a view.

    Args:
        world: What is seen, and what shades and colours its neighbours.
        blockers: What casts the window's shadows.
        view: The rays' source.
        light: What lights the world.
        effort: Rays per pixel.
    """
    bands = _bands(view.height)
    parts = _each(lambda band: _lit_band(world, blockers, view, band, light, effort), bands)
    grid = _grid(parts, view)
    noisy = np.concatenate([p.light for p in parts])
    fallen = np.concatenate(_each(lambda band: _gathered(noisy, grid, band), bands))
    seen = _each(
        lambda pair: _seen(world, pair[1].places, pair[1].rays, fallen[pair[0]][pair[1].found], light),
        list(zip(bands, parts, strict=True)),
    )
    radiance = np.zeros((*grid.found.shape, 3), np.float32)
    radiance[grid.found] = np.concatenate(seen)
    shot = Shot(radiance, grid.found.astype(np.float32))
    return _with_smooth_edges(shot, world, view, light, grid, fallen)


@dataclass(frozen=True, eq=False)
class _Band:
    """Some rows of the picture: what they see and, noisy, the light that falls on it."""

    found: Bool[np.ndarray, "h w"]
    rays: RayArray
    places: Places
    light: Float32[np.ndarray, "h w 3"]
    depth: Float32[np.ndarray, "h w"]


def _lit_band(world: World, blockers: World, view: View, rows: slice, light: Lighting, effort: Effort) -> _Band:
    rays = view.rays(pixel_centres(view.width, rows.stop)[rows])
    hits = world.caster.first_hits(rays)
    found = hits.found
    places = world.places(rays[found], hits.chosen(found))
    window, around = irradiance(world, blockers, places, np.argwhere(found) + np.array([rows.start, 0]), light, effort)
    noisy = np.zeros((*found.shape, 3), np.float32)
    noisy[found] = window + around
    return _Band(found, rays[found], places, noisy, np.where(found, hits.distance, 0).astype(np.float32))


def _gathered(noisy: Float32[np.ndarray, "h w 3"], grid: _Grid, rows: slice) -> Float32[np.ndarray, "b w 3"]:
    """Light of some rows without its noise: gathered over blocks, twice, from the rows and those around them."""
    halo = slice(max(0, rows.start - TILE), rows.stop + TILE)
    neighbours = Neighbours.of(grid.points[halo], grid.normals[halo], grid.found[halo], 3 * grid.pixel_m[halo])
    smooth = neighbours.mean(neighbours.mean(noisy[halo]))
    return smooth[rows.start - halo.start : rows.stop - halo.start]


def _bands(height: int, rows: int = 48) -> list[slice]:
    """Rows in groups small enough for the processor's cache."""
    return [slice(start, min(start + rows, height)) for start in range(0, height, rows)]


def _each(work: Callable[[Item], Result], items: list[Item]) -> list[Result]:
    """Work on all items, two at a time; results in order, so that threads change nothing."""
    with ThreadPoolExecutor(max_workers=2) as pool:
        return list(pool.map(work, items))


def _seen(
    world: World, places: Places, rays: RayArray, fallen: Float32[np.ndarray, "n 3"], light: Lighting, depth: int = 0
) -> Float32[np.ndarray, "n 3"]:
    """Light that leaves places toward the viewer: diffuse, gloss, glow, and what shines through glass."""
    direction = unit(rays[:, 3:])
    base = places.albedo
    metal = places.metallic[:, None]
    fallen = _relit(places, fallen, light)
    out = base * (1 - metal) * fallen + places.emissive
    clear = np.flatnonzero(places.alpha < 0.999)
    if len(clear) and depth < 3:
        beyond = _beyond(world, places, rays, clear, light, depth)
        share = places.alpha[clear, None]
        out[clear] = out[clear] * share + beyond * (1 - share)
    return (out + _gloss(world, places, direction, fallen, light)).astype(np.float32)


def _relit(places: Places, fallen: Float32[np.ndarray, "n 3"], light: Lighting) -> Float32[np.ndarray, "n 3"]:
    """The light to multiply colours with: on photographed places only how much of it is held off."""
    known = np.flatnonzero(places.photographed)
    if not len(known):
        return fallen
    free = unshadowed(places.points[known], places.normals[known], light)
    share = np.clip(fallen[known].mean(axis=1) / free.mean(axis=1), 0.0, 1.0)
    relit = fallen.copy()
    relit[known] = share[:, None]
    return relit


def _gloss(
    world: World, places: Places, direction: np.ndarray, fallen: Float32[np.ndarray, "n 3"], light: Lighting
) -> Float32[np.ndarray, "n 3"]:
    """Mirrored surroundings, blurred toward the fallen light as roughness grows (Schlick's Fresnel)."""
    cosine = np.clip(-np.sum(places.normals * direction, axis=1, keepdims=True), 0, 1)
    smooth = 1 - places.roughness[:, None]
    f0 = 0.04 * (1 - places.metallic[:, None]) + places.albedo * places.metallic[:, None]
    fresnel = f0 + (np.maximum(smooth, f0) - f0) * (1 - cosine) ** 5
    strength = fresnel * np.where(places.metallic[:, None] > 0.5, 1, smooth)
    shiny = np.flatnonzero((smooth[:, 0] > 0.45) | (places.metallic > 0.3))
    mirrored = fallen.copy()
    if len(shiny):
        normal = places.normals[shiny]
        away = direction[shiny] - 2 * np.sum(direction[shiny] * normal, axis=1, keepdims=True) * normal
        origin = places.points[shiny] + places.flat_normals[shiny] * 1e-3
        sharp = _environment(world, np.concatenate([origin, away], axis=1).astype(np.float32), light)
        blur = np.clip(places.roughness[shiny, None] * 1.4, 0, 1)
        mirrored[shiny] = sharp * (1 - blur) + fallen[shiny] * blur
    return (strength * mirrored).astype(np.float32)


def _environment(world: World, rays: RayArray, light: Lighting) -> Float32[np.ndarray, "n 3"]:
    """What a mirror sees along rays: surfaces in unshadowed light, the window, or the surroundings."""
    hits = world.caster.first_hits(rays)
    seen = ambient(rays[:, 3:], light).astype(np.float32) + _window_glare(rays, light)
    found = np.flatnonzero(hits.found)
    if len(found):
        places = world.places(rays[found], hits.chosen(found))
        seen[found] = 0.85 * places.albedo * unshadowed(places.points, places.normals, light) + places.emissive
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
    found = np.flatnonzero(hits.found)
    if len(found):
        behind = world.places(onward[found], hits.chosen(found))
        fallen = unshadowed(behind.points, behind.normals, light)
        seen[found] = _seen(world, behind, onward[found], fallen, light, depth + 1)
    return seen


def _with_smooth_edges(
    shot: Shot, world: World, view: View, light: Lighting, grid: _Grid, fallen: Float32[np.ndarray, "h w 3"]
) -> Shot:
    """Pixels at edges seen again through four more positions."""
    pixels = np.argwhere(_edges(shot, grid))
    if not len(pixels):
        return shot
    groups = np.array_split(pixels, 1 + len(pixels) // 4096)
    again = _each(lambda group: _seen_again(world, view, light, grid, fallen, group), groups)
    radiance, coverage = np.minimum(shot.radiance, BRIGHTEST), shot.coverage.copy()
    at, weight = (pixels[:, 0], pixels[:, 1]), 1 / (1 + len(_SUBPIXELS))
    radiance[at] += (1 - weight) * (np.concatenate([colour for colour, _ in again]) - radiance[at])
    coverage[at] += (1 - weight) * (np.concatenate([share for _, share in again]) - coverage[at])
    return Shot(radiance, coverage)


def _seen_again(
    world: World,
    view: View,
    light: Lighting,
    grid: _Grid,
    fallen: Float32[np.ndarray, "h w 3"],
    pixels: Int[np.ndarray, "n 2"],
) -> tuple[Float32[np.ndarray, "n 3"], Float32[np.ndarray, "n"]]:
    """Mean light and coverage of pixels over further positions; light falls as on the neighbour that fits best."""
    count = len(_SUBPIXELS)
    rays = view.rays((pixels[:, None, ::-1] + 0.5 + _SUBPIXELS).reshape(-1, 2))
    hits = world.caster.first_hits(rays)
    found = np.flatnonzero(hits.found)
    places = world.places(rays[found], hits.chosen(found))
    borrowed = _borrowed(places, np.repeat(pixels, count, axis=0)[found], grid, fallen)
    seen = np.zeros((len(rays), 3), np.float32)
    seen[found] = np.minimum(_seen(world, places, rays[found], borrowed, light), BRIGHTEST)
    share = hits.found.reshape(-1, count).mean(axis=1)
    return seen.reshape(-1, count, 3).mean(axis=1), share.astype(np.float32)


def _edges(shot: Shot, grid: _Grid) -> Bool[np.ndarray, "h w"]:
    """Pixels beside a change of object, direction, depth or brightness."""
    edge = np.zeros(grid.found.shape, bool)
    bright = tone_mapped(shot.radiance).mean(axis=-1)
    for here, there in (
        ((slice(None), slice(0, -1)), (slice(None), slice(1, None))),
        ((slice(0, -1), slice(None)), (slice(1, None), slice(None))),
    ):
        leap = np.abs(np.einsum("ijk,ijk->ij", grid.points[there] - grid.points[here], grid.flat_normals[here]))
        differs = (
            (grid.instance[here] != grid.instance[there])
            | (np.einsum("ijk,ijk->ij", grid.normals[here], grid.normals[there]) < 0.9)
            | (leap > 4 * grid.pixel_m[here])
            | (np.abs(bright[here] - bright[there]) > 0.07)
        )
        edge[here] |= differs
        edge[there] |= differs
    return edge


def _borrowed(
    places: Places, near: Int[np.ndarray, "n 2"], grid: _Grid, fallen: Float32[np.ndarray, "h w 3"]
) -> Float32[np.ndarray, "n 3"]:
    """For places seen between pixels, the light on the best-fitting of the pixel and its four neighbours."""
    h, w = grid.found.shape
    best = np.full(len(near), np.inf, np.float32)
    taken = np.zeros((len(near), 3), np.float32)
    scale = np.maximum(grid.depth[near[:, 0], near[:, 1]], 0.1)
    for dy, dx in ((0, 0), (-1, 0), (1, 0), (0, -1), (0, 1)):
        row, column = np.clip(near[:, 0] + dy, 0, h - 1), np.clip(near[:, 1] + dx, 0, w - 1)
        apart = grid.points[row, column] - places.points
        offset = np.sqrt(np.einsum("ij,ij->i", apart, apart)) / scale
        turn = 1 - np.einsum("ij,ij->i", grid.normals[row, column], places.normals)
        other = grid.instance[row, column] != places.instance
        cost = 20 * offset + turn + 2.0 * other + 100.0 * ~grid.found[row, column]
        better = np.flatnonzero(cost < best)
        best[better] = cost[better]
        taken[better] = fallen[row[better], column[better]]
    return taken


def _grid(parts: list[_Band], view: View) -> _Grid:
    found = np.concatenate([p.found for p in parts])
    depth = np.concatenate([p.depth for p in parts])

    def image(name: str, empty: float = 0.0) -> np.ndarray:
        values = np.concatenate([getattr(p.places, name) for p in parts])
        whole = np.full((*found.shape, *values.shape[1:]), empty, values.dtype)
        whole[found] = values
        return whole

    return _Grid(
        found,
        image("points"),
        image("normals"),
        image("flat_normals"),
        image("instance", -1),
        depth,
        _pixel_footprint(view, depth),
    )


def _pixel_footprint(view: View, depth: Float32[np.ndarray, "h w"]) -> Float32[np.ndarray, "h w"]:
    """Width in metres that a pixel covers at its depth."""
    middle = np.array([[view.width / 2, view.height / 2], [view.width / 2 + 1, view.height / 2]])
    a, b = view.rays(middle).astype(np.float64)
    at_zero, per_metre = np.linalg.norm(b[:3] - a[:3]), np.linalg.norm(b[3:] - a[3:])
    return (at_zero + per_metre * depth).astype(np.float32)
