"""Light in a room: a large soft window of light, the sky around it, and one bounce off what is near.

Per place, a few rays towards the window give soft shadows, and a few over the hemisphere give ambient occlusion
and bounced colour at once. The 16 pixels of every 4 x 4 block share one well-spread set of samples, a different
part each; `filters.spread` gathers the block again, so that every pixel has the whole set (interleaved sampling).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from jaxtyping import Bool, Float, Float32, Int

from diorama_core.geometry.ray_scene import RayScene
from diorama_core.geometry.vectors import dot, facing, unit
from diorama_core.render.direct_light import DirectLight, Vectors
from diorama_core.render.world import World
from diorama_core.scene.types import RoomLight

TILE = 4
_ORDER = np.array([0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5])
"""Ordered-dither order of a 4 x 4 block: neighbours get samples that are far apart."""


@dataclass(frozen=True, eq=False)
class Lighting:
    """What lights the room. Colours are linear radiance or irradiance; 1 shows a white surface near white."""

    window_centre: Float[np.ndarray, "3"]
    window_edges: Float[np.ndarray, "2 3"]
    """Half edges of the emitting rectangle."""
    window_irradiance: Float[np.ndarray, "3"]
    """What a surface facing the window receives at `reference_m`."""
    reference_m: float
    sky: Float[np.ndarray, "3"]
    """From above."""
    ground: Float[np.ndarray, "3"]
    """From below."""
    reach_m: float = 2.5
    """Within this distance surfaces shade and colour one another."""
    inward: Float[np.ndarray, "3"] | None = None
    """Where a window in a wall sends its light, most straight ahead and none along the wall; None all around."""
    direct: tuple[DirectLight, ...] = ()
    """The sun and lamps, with their shadows."""
    relights: bool = False
    """Whether photographed surfaces are lit like all others: the light is not that of their photo."""


@dataclass(frozen=True)
class Effort:
    """How many rays each pixel spends."""

    window_rays: int = 2
    sky_rays: int = 4


@dataclass(frozen=True, eq=False)
class Spots:
    """Places to gather light at."""

    points: Vectors
    normals: Vectors
    """Smooth."""
    flat_normals: Vectors
    """Normals of the triangles."""
    photographed: Bool[np.ndarray, "n"] | None = None
    """Whose colours already hold the light of the room; None where no place's do."""


def studio(bounds: Float[np.ndarray, "2 3"], toward_camera: Float[np.ndarray, "3"]) -> Lighting:
    """A warm soft box above and left of the viewer, under a cool sky: good for any room or single shape.

    Args:
        bounds: Corners of what is lit, metres.
        toward_camera: Horizontal direction from the room to the viewer.
    """
    centre, radius, distance = _ball(bounds)
    back = unit(np.array([toward_camera[0], toward_camera[1], 0.0]) + 1e-9)
    left = np.cross(back, [0.0, 0.0, 1.0])
    direction = unit(0.8 * back + 0.34 * left + 0.8 * np.array([0.0, 0.0, 1.0]))
    across = unit(np.cross(direction, [0.0, 0.0, 1.0]))
    upward = np.cross(across, direction)
    return Lighting(
        window_centre=centre + direction * distance,
        window_edges=np.stack([across, upward]) * 0.32 * radius,
        window_irradiance=np.array([1.38, 1.3, 1.17]),
        reference_m=distance,
        sky=np.array([0.57, 0.59, 0.62]),
        ground=np.array([0.5, 0.475, 0.45]),
        reach_m=max(0.9 * radius, 0.05),
    )


MAX_BOUNCED = 0.8
"""Light that one ray brings from a near surface, at most: a bright spot met by a few rays would make specks."""
MEAN_IRRADIANCE = 0.885
"""Irradiance by the studio's light, averaged over all directions: pictures are as bright under any room's light."""
MIN_ELEVATION = 0.15
"""Sine of the least elevation of the light in pictures: from below, everything looks odd."""


def room_lighting(bounds: Float[np.ndarray, "2 3"], light: RoomLight) -> Lighting:
    """A room's own light, in white: a soft box where most of it comes from, and an even rest.

    The room's pictures are as white light would have them and not lit again, so that nothing else is tinted either.

    Args:
        bounds: Corners of what is lit, metres.
        light: As the photo tells it.
    """
    centre, radius, distance = _ball(bounds)
    x, y, z = light.direction
    direction = unit(np.array([x, y, max(z, MIN_ELEVATION)]))
    across = unit(np.cross(direction, [0.0, 0.0, 1.0]) + np.array([1e-6, 0.0, 0.0]))
    # A distant light of irradiance I has the mean I / 4 over all directions and the slope I / 2 (spherical harmonics).
    directed = 2.0 * light.strength * MEAN_IRRADIANCE
    even = (MEAN_IRRADIANCE - directed / 4) * np.ones(3)
    return Lighting(
        window_centre=centre + direction * distance,
        window_edges=np.stack([across, np.cross(across, direction)]) * 0.4 * radius,
        window_irradiance=directed * np.ones(3),
        reference_m=distance,
        sky=1.05 * even,
        ground=0.95 * even,
        reach_m=max(0.9 * radius, 0.05),
    )


def _ball(bounds: Float[np.ndarray, "2 3"]) -> tuple[Float[np.ndarray, "3"], float, float]:
    """Centre and radius of a ball around what is lit, and the distance of its window, metres."""
    radius = max(0.5 * float(np.linalg.norm(bounds[1] - bounds[0])), 0.1)
    return bounds.mean(axis=0), radius, 1.7 * radius


def irradiance(
    world: World,
    blockers: RayScene,
    spots: Spots,
    pixels: Int[np.ndarray, "n 2"] | None,
    light: Lighting,
    effort: Effort,
) -> tuple[Vectors, Vectors]:
    """Light that falls on places: from the window, and from everywhere else.

    Args:
        world: What surrounds the places.
        blockers: What stops the window's light.
        spots: Where to gather.
        pixels: Row and column of each place, to choose its share of a block's samples; the light is noisy until it
            is gathered over blocks. None gives all places the same few samples: no noise, but coarser shadows.
        light: What lights the room.
        effort: Rays per place.
    """
    sharing = 1 if pixels is None else TILE * TILE
    at = np.zeros((len(spots.points), 2), np.int64) if pixels is None else pixels % TILE
    lane = _ORDER[at[:, 0] * TILE + at[:, 1]]
    origins = spots.points + spots.flat_normals * np.float32(1e-3 * max(light.reach_m, 0.2))
    frames = _tangent_frames(spots.normals)
    window, around = (np.zeros((len(lane), 3), np.float32) for _ in range(2))
    for samples in _sample_sets(effort.window_rays, sharing):
        sample = samples.take(lane, axis=0)
        window += _from_window(blockers, origins, spots.normals, sample, light)
        for source in light.direct:
            window += source.falling(origins, spots.normals, sample)
    for samples in _sample_sets(effort.sky_rays, sharing):
        local = _cosine_directions(samples).take(lane, axis=0)
        direction = frames[0] * local[:, :1] + frames[1] * local[:, 1:2] + spots.normals * local[:, 2:]
        around += _from_around(world, origins, direction, light, None if light.relights else spots.photographed)
    return window / max(effort.window_rays, 1), around / max(effort.sky_rays, 1)


def irradiance_without_shadows(points: Vectors, normals: Vectors, light: Lighting) -> Vectors:
    """Light on places as if nothing stood in the way but of the sun and lamps: what bounced light is reckoned from."""
    to_window = light.window_centre.astype(np.float32) - points
    squared = dot(to_window, to_window)
    key = np.maximum(dot(normals, to_window), 0) * _key_strength(to_window, squared, light)
    fallen = key[:, None] * (0.6 * light.window_irradiance).astype(np.float32) + ambient(normals, light)
    middle = np.full((len(points), 2), 0.5, np.float32)
    for source in light.direct:
        fallen += source.falling(points, normals, middle)
    return fallen


def ambient(directions: Float[np.ndarray, "n 3"], light: Lighting) -> Float32[np.ndarray, "n 3"]:
    """Radiance of the surroundings along directions: from the ground's colour to the sky's."""
    share = 0.5 + 0.5 * directions[:, 2:3].astype(np.float32)
    return light.ground.astype(np.float32) + share * (light.sky - light.ground).astype(np.float32)


def _from_window(
    blockers: RayScene, origins: np.ndarray, normals: np.ndarray, sample: np.ndarray, light: Lighting
) -> Float32[np.ndarray, "n 3"]:
    target = light.window_centre.astype(np.float32) + (2 * sample - 1) @ light.window_edges.astype(np.float32)
    ray = target - origins
    key = np.maximum(dot(normals, ray), 0) * _key_strength(ray, dot(ray, ray), light)
    lit = np.flatnonzero(key > 0)
    blocked = blockers.is_occluded(np.concatenate([origins, ray], axis=1).take(lit, axis=0), far=1.0)
    key[lit[blocked]] = 0
    return key[:, None] * light.window_irradiance.astype(np.float32)


def _key_strength(ray: Vectors, squared: Float32[np.ndarray, "n"], light: Lighting) -> Float32[np.ndarray, "n"]:
    """What a surface facing the window would get along rays to it (of squared length), over the rays' length."""
    length = np.sqrt(squared)
    if light.inward is None:
        return np.minimum(np.float32(light.reference_m**2) / squared, 4.0) / length
    ahead = np.maximum(-(ray @ light.inward.astype(np.float32)), 0) / length
    near = squared + np.float32(4 * (light.window_edges**2).sum())  # close by, the window fills the view and no more
    return np.float32(light.reference_m**2) / near * ahead / length


def _from_around(
    world: World, origins: Vectors, direction: Vectors, light: Lighting, photographed: Bool[np.ndarray, "n"] | None
) -> Vectors:
    """Radiance along one direction each: the surroundings, or the colour of what is near.

    Photographed walls hold nothing off one another: the photo shows them in the light that the room leaves.
    """
    hits = world.caster.first_hits(np.concatenate([origins, direction], axis=1))
    radiance = ambient(direction, light)
    near = np.flatnonzero(hits.distance < light.reach_m)
    if photographed is not None and photographed.any():
        near = near[~(photographed[near] & world.is_photo(hits.triangle[near]))]
    if len(near):
        chosen, toward = hits.select(near), direction.take(near, axis=0)
        normals, colour = world.rough_appearance(chosen)
        normals = facing(normals, toward)
        points = origins.take(near, axis=0) + toward * chosen.distance[:, None]
        fade = (chosen.distance[:, None] / np.float32(light.reach_m)) ** 2
        bounced = np.minimum(np.float32(0.8) * colour * irradiance_without_shadows(points, normals, light), MAX_BOUNCED)
        radiance[near] += (1 - fade) * (bounced - radiance[near])
    return radiance


def _tangent_frames(normals: Float32[np.ndarray, "n 3"]) -> tuple[np.ndarray, np.ndarray]:
    """Two unit vectors across each normal (Duff and others, 2017: without branches or square roots)."""
    x, y, z = normals[:, 0], normals[:, 1], normals[:, 2]
    sign = np.where(z >= 0, np.float32(1), np.float32(-1))
    a = -1 / (sign + z)
    b = x * y * a
    return np.stack([1 + sign * x * x * a, sign * b, -sign * x], axis=1), np.stack([b, sign + y * y * a, -y], axis=1)


def _cosine_directions(sample: Float32[np.ndarray, "k 2"]) -> Float32[np.ndarray, "k 3"]:
    """Directions about +z with density proportional to the cosine."""
    radius, angle = np.sqrt(sample[:, 0]), 2 * np.pi * sample[:, 1]
    up = np.sqrt(np.maximum(1 - sample[:, 0], 1e-6))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), up], axis=1).astype(np.float32)


@cache
def _sample_sets(rays: int, sharing: int) -> tuple[Float32[np.ndarray, "sharing 2"], ...]:
    """For each ray of a pixel the samples of those that share; together they are one Hammersley set."""
    count = rays * sharing
    index = np.arange(count)
    golden = (index * 0.6180339887498949) % 1.0
    mirrored = sum(((index >> bit) & 1) / 2.0 ** (bit + 1) for bit in range(12))
    points = np.stack([(mirrored + 0.5 / count) % 1.0, golden], axis=1).astype(np.float32)
    return tuple(points.reshape(rays, sharing, 2))
