"""Light in a room: a large soft window of light, the sky around it, and one bounce off what is near.

Per place, a few rays towards the window give soft shadows, and a few over the hemisphere give ambient occlusion
and bounced colour at once. The 16 pixels of every 4 x 4 block share one well-spread set of samples, a different
part each; `filters.spread` gathers the block again, so that every pixel has the whole set (interleaved sampling).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32, Int

from diorama_core.render.raycast import unit
from diorama_core.render.world import Places, World

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
    planes_block: bool = False
    """Whether walls stop the window's light; they do not where the room is drawn as a closed box."""


@dataclass(frozen=True)
class Effort:
    """How many rays each pixel spends."""

    window_rays: int = 2
    sky_rays: int = 4


def studio(bounds: Float[np.ndarray, "2 3"], toward_camera: Float[np.ndarray, "3"]) -> Lighting:
    """A warm soft box above and left of the viewer, under a cool sky: good for any room or single shape.

    Args:
        bounds: Corners of what is lit, metres.
        toward_camera: Horizontal direction from the room to the viewer.
    """
    centre, size = bounds.mean(axis=0), bounds[1] - bounds[0]
    radius = max(0.5 * float(np.linalg.norm(size)), 0.1)
    back = unit(np.array([toward_camera[0], toward_camera[1], 0.0]) + 1e-9)
    left = np.cross(back, [0.0, 0.0, 1.0])
    direction = unit(0.8 * back + 0.34 * left + 0.8 * np.array([0.0, 0.0, 1.0]))
    distance = 1.7 * radius
    across = unit(np.cross(direction, [0.0, 0.0, 1.0]))
    upward = np.cross(across, direction)
    return Lighting(
        window_centre=centre + direction * distance,
        window_edges=np.stack([across, upward]) * 0.42 * radius,
        window_irradiance=np.array([1.25, 1.18, 1.07]),
        reference_m=distance,
        sky=np.array([0.56, 0.585, 0.62]),
        ground=np.array([0.36, 0.345, 0.33]),
        reach_m=max(0.9 * radius, 0.05),
    )


def irradiance(
    world: World, blockers: World, places: Places, pixels: Int[np.ndarray, "n 2"], light: Lighting, effort: Effort
) -> tuple[Float32[np.ndarray, "n 3"], Float32[np.ndarray, "n 3"]]:
    """Noisy light that falls on places: from the window, and from everywhere else.

    Args:
        world: What surrounds the places.
        blockers: What stops the window's light.
        places: Where to gather.
        pixels: Row and column of each place, to choose its share of the samples.
        light: What lights the room.
        effort: Rays per place.
    """
    lane = _ORDER[(pixels[:, 0] % TILE) * TILE + pixels[:, 1] % TILE]
    origins = places.points + places.flat_normals * (1e-3 * max(light.reach_m, 0.2))
    window = np.zeros((len(lane), 3), np.float32)
    around = np.zeros((len(lane), 3), np.float32)
    for turn in range(effort.window_rays):
        sample = _hammersley(lane + turn * TILE * TILE, effort.window_rays * TILE * TILE)
        window += _from_window(blockers, origins, places.normals, sample, light)
    for turn in range(effort.sky_rays):
        sample = _hammersley(lane + turn * TILE * TILE, effort.sky_rays * TILE * TILE)
        around += _from_around(world, origins, places, sample, light)
    return window / max(effort.window_rays, 1), around / max(effort.sky_rays, 1)


def unshadowed(
    points: Float32[np.ndarray, "n 3"], normals: Float32[np.ndarray, "n 3"], light: Lighting
) -> Float32[np.ndarray, "n 3"]:
    """Light on places as if nothing were in the way: what bounced light is reckoned from."""
    to_window = light.window_centre - points
    distance = np.linalg.norm(to_window, axis=1, keepdims=True)
    cosine = np.maximum(np.sum(normals * to_window, axis=1, keepdims=True) / distance, 0)
    key = cosine * np.minimum((light.reference_m / distance) ** 2, 4.0) * light.window_irradiance
    return (0.6 * key + ambient(normals, light)).astype(np.float32)


def ambient(directions: Float[np.ndarray, "n 3"], light: Lighting) -> Float[np.ndarray, "n 3"]:
    """Radiance of the surroundings along directions: from the ground's colour to the sky's."""
    share = 0.5 + 0.5 * directions[:, 2:3]
    return light.ground * (1 - share) + light.sky * share


def _from_window(
    blockers: World, origins: np.ndarray, normals: np.ndarray, sample: np.ndarray, light: Lighting
) -> Float32[np.ndarray, "n 3"]:
    target = light.window_centre + (2 * sample - 1) @ light.window_edges
    ray = (target - origins).astype(np.float32)
    distance = np.linalg.norm(ray, axis=1)
    cosine = np.sum(normals * ray, axis=1) / distance
    lit = np.flatnonzero(cosine > 0)
    blocked = blockers.caster.occluded(np.concatenate([origins[lit], ray[lit]], axis=1), far=1.0)
    strength = np.zeros(len(ray), np.float32)
    strength[lit] = np.where(blocked, 0, cosine[lit] * np.minimum((light.reference_m / distance[lit]) ** 2, 4.0))
    return (strength[:, None] * light.window_irradiance).astype(np.float32)


def _from_around(
    world: World, origins: np.ndarray, places: Places, sample: np.ndarray, light: Lighting
) -> Float32[np.ndarray, "n 3"]:
    """Radiance along one cosine-weighted direction: the surroundings, or the colour of what is near."""
    direction = _cosine_directions(places.normals, sample)
    rays = np.concatenate([origins, direction], axis=1).astype(np.float32)
    hits = world.caster.first_hits(rays)
    radiance = ambient(direction, light).astype(np.float32)
    near = np.flatnonzero(hits.found & (hits.distance < light.reach_m))
    if len(near):
        chosen = type(hits)(hits.distance[near], hits.triangle[near], hits.barycentric[near])
        normals, colour = world.rough_look(chosen)
        normals = np.where(np.sum(normals * direction[near], axis=1, keepdims=True) > 0, -normals, normals)
        points = origins[near] + direction[near] * chosen.distance[:, None]
        bounced = 0.8 * colour * unshadowed(points, normals, light)
        fade = np.clip(chosen.distance / light.reach_m, 0, 1)[:, None] ** 2
        radiance[near] = bounced * (1 - fade) + radiance[near] * fade
    return radiance


def _cosine_directions(normals: Float32[np.ndarray, "n 3"], sample: Float[np.ndarray, "n 2"]) -> np.ndarray:
    """Directions over the hemisphere about normals, with density proportional to the cosine."""
    sign = np.where(normals[:, 2] >= 0, 1.0, -1.0).astype(np.float32)
    a = -1 / (sign + normals[:, 2])
    b = normals[:, 0] * normals[:, 1] * a
    tangent = np.stack([1 + sign * normals[:, 0] ** 2 * a, sign * b, -sign * normals[:, 0]], axis=1)
    bitangent = np.stack([b, sign + normals[:, 1] ** 2 * a, -normals[:, 1]], axis=1)
    radius, angle = np.sqrt(sample[:, :1]), 2 * np.pi * sample[:, 1:]
    up = np.sqrt(np.maximum(1 - sample[:, :1], 1e-6))
    return (tangent * radius * np.cos(angle) + bitangent * radius * np.sin(angle) + normals * up).astype(np.float32)


def _hammersley(index: Int[np.ndarray, "n"], count: int) -> Float[np.ndarray, "n 2"]:
    """Points of the Hammersley set of `count`, in an order whose sixteenths are each well spread."""
    golden = (index * 0.6180339887498949) % 1.0
    bits = index.astype(np.uint32)
    reversed_bits = np.zeros(len(index))
    scale = 0.5
    for _ in range(12):
        reversed_bits += scale * (bits & 1)
        bits >>= 1
        scale *= 0.5
    return np.stack([(reversed_bits + 0.5 / count) % 1.0, golden], axis=1)
