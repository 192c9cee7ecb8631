"""From rays to light: one shot of a world, with soft shadows, occlusion, one bounce, gloss and smooth edges."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Bool, Float, Float32, Int

from diorama_core.render.filters import spread, tone_mapped
from diorama_core.render.lighting import Effort, Lighting, ambient, irradiance, unshadowed
from diorama_core.render.raycast import Hits, RayArray, View, pixel_centres, unit
from diorama_core.render.world import Places, World

_SUBPIXELS = (np.stack(np.meshgrid(np.arange(3), np.arange(3)), axis=-1).reshape(-1, 2) - 1) / 3.0


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


def shoot(world: World, blockers: World, view: View, light: Lighting, effort: Effort) -> Shot:
    """The light that reaches every pixel of a view.

    Args:
        world: What is seen, and what shades and colours its neighbours.
        blockers: What casts the window's shadows.
        view: The rays' source.
        light: What lights the world.
        effort: Rays per pixel.
    """
    rays = view.rays(pixel_centres(view.width, view.height))
    hits = world.caster.first_hits(rays)
    found = hits.found
    radiance = np.zeros((*found.shape, 3), np.float32)
    if not found.any():
        return Shot(radiance, np.zeros(found.shape, np.float32))
    seen_rays, seen_hits = rays[found], _chosen(hits, found)
    places = world.places(seen_rays, seen_hits)
    grid = _grid(found, places, hits)
    pixel_m = _pixel_footprint(view, grid.depth)
    window, around = irradiance(world, blockers, places, np.argwhere(found), light, effort)
    noisy = np.zeros((*found.shape, 6), np.float32)
    noisy[found] = np.concatenate([window, around], axis=1)
    gathered = spread(noisy, grid.points, grid.normals, found, 3 * pixel_m)
    gathered = spread(gathered, grid.points, grid.normals, found, 3 * pixel_m)
    fallen = gathered[..., :3] + gathered[..., 3:]
    radiance[found] = _seen(world, places, seen_rays, fallen[found], light)
    shot = Shot(radiance, found.astype(np.float32))
    return _with_smooth_edges(shot, world, view, light, grid, fallen, pixel_m)


def _seen(
    world: World, places: Places, rays: RayArray, fallen: Float32[np.ndarray, "n 3"], light: Lighting, depth: int = 0
) -> Float32[np.ndarray, "n 3"]:
    """Light that leaves places toward the viewer: diffuse, gloss, glow, and what shines through glass."""
    direction = unit(rays[:, 3:])
    base = places.albedo
    metal = places.metallic[:, None]
    out = base * (1 - metal) * fallen + places.emissive
    out = out + _gloss(world, places, direction, fallen, light)
    clear = np.flatnonzero(places.alpha < 0.999)
    if len(clear) and depth < 3:
        beyond = _beyond(world, places, rays, clear, light, depth)
        share = places.alpha[clear, None]
        out[clear] = out[clear] * share + beyond * (1 - share)
    return out.astype(np.float32)


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
        places = world.places(rays[found], _chosen(hits, found))
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
        behind = world.places(onward[found], _chosen(hits, found))
        fallen = unshadowed(behind.points, behind.normals, light)
        seen[found] = _seen(world, behind, onward[found], fallen, light, depth + 1)
    return seen


def _with_smooth_edges(
    shot: Shot, world: World, view: View, light: Lighting, grid: _Grid, fallen: np.ndarray, pixel_m: np.ndarray
) -> Shot:
    """Pixels at edges seen again through nine positions; their light is taken from the neighbour that fits best."""
    rows, columns = np.nonzero(_edges(shot, grid, pixel_m))
    if not len(rows):
        return shot
    centres = np.stack([columns + 0.5, rows + 0.5], axis=1)
    positions = (centres[:, None] + _SUBPIXELS).reshape(-1, 2)
    rays = view.rays(positions)
    hits = world.caster.first_hits(rays)
    seen = np.zeros((len(rays), 3), np.float32)
    found = np.flatnonzero(hits.found)
    if len(found):
        places = world.places(rays[found], _chosen(hits, found))
        near = np.repeat(np.stack([rows, columns], axis=1), len(_SUBPIXELS), axis=0)[found]
        seen[found] = _seen(world, places, rays[found], _borrowed(places, near, grid, fallen), light)
    radiance, coverage = shot.radiance.copy(), shot.coverage.copy()
    tamed = np.minimum(seen, 1.5)
    radiance[rows, columns] = tamed.reshape(-1, len(_SUBPIXELS), 3).mean(axis=1)
    coverage[rows, columns] = hits.found.reshape(-1, len(_SUBPIXELS)).mean(axis=1)
    return Shot(radiance, coverage)


def _edges(shot: Shot, grid: _Grid, pixel_m: Float32[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
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
            | (leap > 4 * pixel_m[here])
            | (np.abs(bright[here] - bright[there]) > 0.05)
        )
        edge[here] |= differs
        edge[there] |= differs
    return edge


def _borrowed(
    places: Places, near: Int[np.ndarray, "n 2"], grid: _Grid, fallen: Float32[np.ndarray, "h w 3"]
) -> Float32[np.ndarray, "n 3"]:
    """For places seen between pixels, the light on the best-fitting of the nine pixels around."""
    h, w = grid.found.shape
    best = np.full(len(near), np.inf, np.float32)
    taken = np.zeros((len(near), 3), np.float32)
    scale = np.maximum(grid.depth[near[:, 0], near[:, 1]], 0.1)
    for dy in (0, -1, 1):
        for dx in (0, -1, 1):
            row, column = np.clip(near[:, 0] + dy, 0, h - 1), np.clip(near[:, 1] + dx, 0, w - 1)
            offset = np.linalg.norm(grid.points[row, column] - places.points, axis=1) / scale
            turn = 1 - np.sum(grid.normals[row, column] * places.normals, axis=1)
            other = grid.instance[row, column] != places.instance
            cost = 20 * offset + turn + 2.0 * other + 100.0 * ~grid.found[row, column]
            better = cost < best
            best = np.where(better, cost, best)
            taken = np.where(better[:, None], fallen[row, column], taken)
    return taken


def _grid(found: Bool[np.ndarray, "h w"], places: Places, hits: Hits) -> _Grid:
    def image(values: np.ndarray, empty: float = 0.0) -> np.ndarray:
        whole = np.full((*found.shape, *values.shape[1:]), empty, values.dtype)
        whole[found] = values
        return whole

    depth = np.where(found, hits.distance, 0).astype(np.float32)
    return _Grid(
        found,
        image(places.points),
        image(places.normals),
        image(places.flat_normals),
        image(places.instance, -1),
        depth,
    )


def _pixel_footprint(view: View, depth: Float32[np.ndarray, "h w"]) -> Float32[np.ndarray, "h w"]:
    """Width in metres that a pixel covers at its depth."""
    middle = np.array([[view.width / 2, view.height / 2], [view.width / 2 + 1, view.height / 2]])
    a, b = view.rays(middle).astype(np.float64)
    at_zero, per_metre = np.linalg.norm(b[:3] - a[:3]), np.linalg.norm(b[3:] - a[3:])
    return (at_zero + per_metre * depth).astype(np.float32)


def _chosen(hits: Hits, which: Float[np.ndarray, "*n"] | Bool[np.ndarray, "*n"]) -> Hits:
    return Hits(*(getattr(hits, f.name)[which] for f in fields(hits)))
