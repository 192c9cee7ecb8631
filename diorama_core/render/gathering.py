"""The light that falls on what a view sees: gathered at every second pixel, freed of noise, spread to the rest.

Light changes slowly along a surface, so a quarter of the pixels tells it for all. A pixel takes it from the gathered
ones beside it that lie on its own smooth surface; the few that have none (twigs, wires, rims) gather for themselves.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float32, Int

from diorama_core.geometry.ray_scene import RayScene
from diorama_core.geometry.vectors import dot
from diorama_core.progress import SILENT, Progress
from diorama_core.render.filters import Neighbours
from diorama_core.render.lighting import TILE, Effort, Lighting, Spots, irradiance
from diorama_core.render.raycast import Grid, bands
from diorama_core.render.world import World
from diorama_core.workers import map_threads

Light = Float32[np.ndarray, "h w 3"]
SAME_TURN = 0.85
"""Least cosine between normals of one smooth surface."""
ENOUGH = 5.0
"""Weight of neighbours (of 16) from which on the light of a gathered pixel is free enough of noise."""
ALONE = Effort(window_rays=5, sky_rays=9)
"""Rays of a pixel that gathers for itself and has no neighbours to share samples with."""


def gather_light(
    world: World, blockers: RayScene, grid: Grid, light: Lighting, effort: Effort, progress: Progress = SILENT
) -> Light:
    """Light on every place of a grid; 0 where nothing is seen.

    Args:
        world: What surrounds the places.
        blockers: What stops the window's light.
        grid: The places.
        light: What lights the world.
        effort: Rays of each pixel that gathers.
        progress: Where it is reported and cancelling is noticed.
    """
    coarse = grid.part(slice(0, None, 2), slice(0, None, 2))
    rows = bands(coarse.found.shape[0])
    noisy = np.concatenate(
        map_threads(
            lambda band: _noisy(world, blockers, coarse.part(band), band, light, effort),
            rows,
            progress.part(0.0, 0.8),
            "gathering light",
        )
    )
    gathered = map_threads(lambda band: _gather(noisy, coarse, band), rows)
    smooth, sure = (np.concatenate([pair[k] for pair in gathered]) for k in (0, 1))
    spread = map_threads(lambda band: _spread(smooth, sure, coarse, grid, band), rows)
    fallen, known = (np.concatenate([pair[k] for pair in spread]) for k in (0, 1))
    pixels = np.argwhere(grid.found & ~known)
    groups = [group for group in np.array_split(pixels, 1 + len(pixels) // 4096) if len(group)]
    rest = progress.part(0.8, 1.0)
    lit = map_threads(lambda group: _alone(world, blockers, grid, group, light), groups, rest, "gathering light")
    for group, alone in zip(groups, lit, strict=True):
        fallen[group[:, 0], group[:, 1]] = alone
    return fallen


def _noisy(world: World, blockers: RayScene, grid: Grid, rows: slice, light: Lighting, effort: Effort) -> Light:
    """Light of some rows, every pixel with its own share of the samples."""
    is_hit = grid.found
    spots = _spots(grid, is_hit)
    pixels = np.argwhere(is_hit) + np.array([rows.start, 0])
    noisy = np.zeros(grid.points.shape, np.float32)
    noisy[is_hit] = np.add(*irradiance(world, blockers, spots, pixels, light, effort))
    return noisy


def _gather(
    noisy: Light, grid: Grid, rows: slice
) -> tuple[Float32[np.ndarray, "rows w 3"], Bool[np.ndarray, "rows w"]]:
    """Light of some rows without its noise, gathered over blocks from the rows and those around them.

    Returns:
        The light, and where it was gathered from enough neighbours to be free of noise.
    """
    halo = slice(max(0, rows.start - TILE), rows.stop + TILE)
    near = grid.part(halo)
    neighbours = Neighbours.of(near.points, near.normals, near.found, 4 * near.pixel_m)
    smooth = neighbours.mean(neighbours.mean(noisy[halo]))
    inner = slice(rows.start - halo.start, rows.stop - halo.start)
    return smooth[inner], neighbours.total[inner] >= ENOUGH


def _spread(
    smooth: Light, sure: Bool[np.ndarray, "h w"], coarse: Grid, grid: Grid, rows: slice
) -> tuple[Float32[np.ndarray, "rows columns 3"], Bool[np.ndarray, "rows columns"]]:
    """Light of the fine rows that belong to some coarse ones, and where the gathered pixels beside them tell it."""
    fine = grid.part(slice(2 * rows.start, 2 * rows.stop))
    total, mixed = np.zeros(fine.found.shape, np.float32), np.zeros(fine.points.shape, np.float32)
    for below, right in ((0, 0), (0, 1), (1, 0), (1, 1)):
        for dy in range(1 + below):
            for dx in range(1 + right):
                target = (slice(rows.start + dy, rows.stop + dy), slice(dx, None))
                h, w = (min(a, b) for a, b in zip(coarse.found[target].shape, fine.found[below::2, right::2].shape))
                here = (slice(below, below + 2 * h, 2), slice(right, right + 2 * w, 2))
                target = (slice(target[0].start, target[0].start + h), slice(dx, dx + w))
                fits = (sure[target] & _is_same_surface(fine.part(*here), coarse.part(*target))).astype(np.float32)
                total[here] += fits
                mixed[here] += fits[..., None] * smooth[target]
    return mixed / np.maximum(total, 1)[..., None], total > 0


def _is_same_surface(pixel: Grid, beside: Grid) -> Bool[np.ndarray, "h w"]:
    """True where the pixels beside continue the surfaces of the given ones."""
    leave = np.abs(dot(beside.points - pixel.points, pixel.normals))
    return beside.found & pixel.found & (leave < 3 * pixel.pixel_m) & (dot(beside.normals, pixel.normals) > SAME_TURN)


def _alone(
    world: World, blockers: RayScene, grid: Grid, pixels: Int[np.ndarray, "n 2"], light: Lighting
) -> Float32[np.ndarray, "n 3"]:
    """Light of pixels that no neighbour tells."""
    spots = _spots(grid, (pixels[:, 0], pixels[:, 1]))
    return np.add(*irradiance(world, blockers, spots, None, light, ALONE))


def _spots(grid: Grid, at: Bool[np.ndarray, "h w"] | tuple[np.ndarray, np.ndarray]) -> Spots:
    return Spots(grid.points[at], grid.normals[at], grid.flat_normals[at], grid.photographed[at])
