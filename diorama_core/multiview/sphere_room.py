"""The room around a 360 degree photo, from its floor and ceiling and their borders all the way round.

Seen from the camera, the room is at each azimuth one upright wall along an axis of the room: a wall at distance r is
seen up to the elevation atan(h cos(a) / r), a being the azimuth from its nearest point, and down to -atan(cos(a) / r);
the camera's height above the floor is 1, the ceiling is h above the camera. The sequence of walls that explains best
which parts of the picture are floor and ceiling (`models.room_surfaces`), and its edges, is found by dynamic
programming over azimuths and all heights of the ceiling at once (Flint et al. 2010, "A dynamic programming approach to
reconstructing building interiors"): a wall goes on, meets the next one in a corner, or ends before a farther one. It
is closed by going round twice. Distances are then refined together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Int, UInt8
from scipy.special import logit

QUARTER = np.pi / 2


@dataclass(frozen=True)
class SphereRoomSettings:
    """Numbers by which edges speak for a room."""

    columns: int = 360
    """Azimuths of the search."""
    nearest: float = 0.25
    farthest: float = 8.0
    """Distances of walls, in heights of the camera above the floor."""
    log_step: float = 0.04
    """Step of distances and heights."""
    log_heights: tuple[float, float] = (-1.2, 0.6)
    """Heights of the ceiling above the camera, in heights of the camera: a room of 2.2 m seen from 1.7 m, one of
    3.5 m from 1.2 m."""
    widest_rad: float = float(np.deg2rad(84.0))
    """Azimuth from a wall's nearest point up to which it is looked at: beyond, the corner with the next wall is far."""
    noise: float = 0.5
    """Change of colour that is no edge where a picture has none, CIELAB a pixel."""
    noise_px: float = 1.0
    shade_px: float = 5.0
    coarse_px: float = 2.5
    """Deviations of blurs at 1024 pixels around: against noise; of what is taken out as shade, which grows softly
    into corners; and of the edges in the search, for a step of it."""
    surface_weight: float = 0.1
    clearest_odds: float = 4.0
    most_wrong: float = 1.0
    """Gain of a degree of elevation where floor or ceiling is e times likelier than wall, in degrees of a perfect edge;
    logarithms of odds are clipped; and the cost of a border where the picture speaks wholly against it: a roof's
    slope is none of this model's ceilings, and the floor still tells where its wall is."""
    edge_weight: float = 0.5
    """Of edges beside that."""
    margin_rad: float = float(np.deg2rad(2.0))
    """Around what was marked: boxes are drawn, and the search looks, to about a degree."""
    before_cost: float = 1.0
    """Of a wall before what stands in the room, for each degree: as much as a perfect edge gains."""
    corner_cost: float = 4.0
    jump_cost: float = 12.0
    """Gain that a corner, and a wall that ends before a farther one (three corners), must gain: degrees of a perfect
    edge."""
    refining: tuple[float, ...] = (0.04, 0.02, 0.01, 0.005, 0.0025)
    rounds: int = 3
    """Steps of the refinement, in logarithms, and how often each is tried."""


SETTINGS = SphereRoomSettings()


@dataclass(frozen=True)
class SphereThing:
    """Extent of a thing on the sphere, in the room's frame; radians."""

    azimuth: float
    half_width: float
    low: float
    high: float
    """Elevations."""
    stands: bool
    """Whether it stands on the floor: then its lower end is where it does."""


@dataclass(frozen=True, eq=False)
class SphereRoom:
    """A room around the camera, whose height above the floor is 1."""

    outline: Float[np.ndarray, "n 2"]
    """Corners in plan, counter-clockwise, the camera at the origin."""
    ceiling: float
    """Height of the ceiling above the camera."""
    support: Float[np.ndarray, "n"]
    """Share of each wall's borders that was seen, 0 to 1, for the wall from each corner to the next; 0 if hidden."""


@dataclass(frozen=True)
class _Wall:
    """A wall as it is seen: from one azimuth on, up to that of the next one."""

    axis: int
    """Quarter turns of the direction to it from +X."""
    log_distance: float
    jumps: bool
    """True where it begins behind the end of the wall before it."""
    begins: float
    """Azimuth, used where it jumps."""


class _Edges:
    """Structure tensor of a level picture, to be asked for edges along curves."""

    def __init__(
        self,
        level: UInt8[np.ndarray, "h w 3"],
        settings: SphereRoomSettings,
        things: Sequence[SphereThing] = (),
        blur_px: float = 0.0,
    ) -> None:
        self.things = things
        height, self.width = level.shape[:2]
        scale = self.width / 1024
        pad = round(4 * settings.shade_px * scale)
        self.lab = cv2.cvtColor(level.astype(np.float32) / 255, cv2.COLOR_RGB2LAB)
        lab = np.concatenate([self.lab[:, -pad:], self.lab, self.lab[:, :pad]], axis=1)
        shade = cv2.GaussianBlur(lab, (0, 0), settings.shade_px * scale)
        lab = cv2.GaussianBlur(lab, (0, 0), settings.noise_px * scale) - shade
        latitude = np.pi * (0.5 - (np.arange(height) + 0.5) / height)
        east = np.gradient(lab, axis=1) / np.maximum(np.cos(latitude), 0.05)[:, None, None]
        north = -np.gradient(lab, axis=0)
        tensor = np.stack([(east * east).sum(-1), (east * north).sum(-1), (north * north).sum(-1)], axis=-1)
        if blur_px > 0:
            tensor = cv2.GaussianBlur(tensor, (0, 0), blur_px * scale)
        tensor = tensor[:, pad - 1 : self.width + pad + 1].astype(np.float32)
        self.usual = float(np.median(np.sqrt(tensor[..., 0] + tensor[..., 2])[np.abs(latitude) < np.pi / 3]))
        self.usual = max(self.usual, settings.noise)
        self._tensor = tensor

    def edge_strength(
        self, azimuth: Float[np.ndarray, "..."], tangent: Float[np.ndarray, "..."], slope: Float[np.ndarray, "..."]
    ) -> Float32[np.ndarray, "..."]:
        """Strength, 0 to 1, of edges that run along a curve.

        Args:
            azimuth: of its points.
            tangent: of their elevations.
            slope: change of elevation with azimuth there.
        """
        azimuth, tangent, slope = np.broadcast_arrays(azimuth, tangent, slope)
        elevation = np.arctan(tangent)
        tensor = self._sample(self._tensor, azimuth, elevation, 0.5)  # a column of padding, half a pixel
        # Azimuth grows to the left: the curve's normal in (east, north).
        across = np.stack([slope, np.cos(elevation)], axis=-1)
        across /= np.linalg.norm(across, axis=-1, keepdims=True)
        power = (
            tensor[..., 0] * across[..., 0] ** 2
            + 2 * tensor[..., 1] * across[..., 0] * across[..., 1]
            + tensor[..., 2] * across[..., 1] ** 2
        )
        share = power / np.maximum(tensor[..., 0] + tensor[..., 2], 1e-9)
        strength = np.sqrt(np.maximum(power, 0.0)) * share**2
        return (strength / (strength + self.usual)).astype(np.float32)

    def _sample(
        self,
        of: Float32[np.ndarray, "h w2 3"],
        azimuth: Float[np.ndarray, "..."],
        elevation: Float[np.ndarray, "..."],
        pad: float,
    ) -> Float32[np.ndarray, "..."]:
        x = np.mod(0.25 - azimuth / (2 * np.pi), 1.0) * self.width + pad
        y = (0.5 - elevation / np.pi) * (self.width / 2) - 0.5
        flat = (-1, azimuth.shape[-1])
        at = (x.reshape(flat).astype(np.float32), y.reshape(flat).astype(np.float32))
        return cv2.remap(of, *at, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).reshape(*azimuth.shape, 3)

    def border(
        self, azimuth: Float[np.ndarray, "..."], axis: int | Int[np.ndarray, "..."], reach: Float[np.ndarray, "..."]
    ) -> Float32[np.ndarray, "..."]:
        """Strength of the edges where a wall would meet the ceiling, or the floor.

        Args:
            azimuth: where.
            axis: of the wall.
            reach: its distance over the height of the plane above the camera; negative below.
        """
        off = azimuth - axis * QUARTER
        tangent = np.cos(off) / reach
        strength = self.edge_strength(azimuth, tangent, -np.sin(off) / reach / (1 + tangent**2))
        strength[self._occlusion_mask(azimuth, np.arctan(tangent))] = 0.0
        return strength

    def _occlusion_mask(
        self, azimuth: Float[np.ndarray, "..."], elevation: Float[np.ndarray, "..."]
    ) -> Bool[np.ndarray, "..."]:
        """Mask of directions in which a thing is in front of the room, so that edges are its own."""
        hidden, margin = np.zeros(elevation.shape, bool), SETTINGS.margin_rad
        for thing in self.things:
            beside = np.abs(np.angle(np.exp(1j * (azimuth - thing.azimuth)))) < thing.half_width + margin
            hidden |= beside & (elevation > thing.low - margin) & (elevation < thing.high + margin)
        return hidden

    def nearer_than_feet(
        self, azimuth: Float[np.ndarray, "n"], axis: int, distances: Float[np.ndarray, "r"]
    ) -> Bool[np.ndarray, "n r"]:
        """Mask of walls that would be nearer than the foot of a thing that stands on the floor.

        Args:
            azimuth: where.
            axis: of the wall.
            distances: of the wall, in heights of the camera.
        """
        elevation = -np.arctan(np.cos(azimuth - axis * QUARTER)[:, None] / distances)
        before = np.zeros(elevation.shape, bool)
        for thing in self.things:
            if thing.stands and thing.low < -SETTINGS.margin_rad:
                beside = np.abs(np.angle(np.exp(1j * (azimuth - thing.azimuth)))) < thing.half_width
                before |= beside[:, None] & (elevation < thing.low - SETTINGS.margin_rad)
        return before


class _Surfaces:
    """Where a level picture shows floor and ceiling, added up from the nadir and from the zenith."""

    def __init__(self, shares: Float32[np.ndarray, "3 h w"]) -> None:
        height = shares.shape[1]
        odds = logit(np.clip(shares[[0, 2]], 1e-6, 1 - 1e-6)).clip(-SETTINGS.clearest_odds, SETTINGS.clearest_odds)
        odds *= SETTINGS.surface_weight * 180.0 / height
        start = np.zeros((1, shares.shape[2]))
        below = np.concatenate([start, np.cumsum(odds[0, ::-1], axis=0)])[::-1]
        above = np.concatenate([start, np.cumsum(odds[1], axis=0)])
        self._gains = tuple(np.ascontiguousarray(g - g.max(axis=0), np.float32) for g in (below, above))

    def gain(
        self, azimuth: Float[np.ndarray, "n 1"], axis: int, reach: Float[np.ndarray, "1 r"]
    ) -> Float32[np.ndarray, "n r"]:
        """Gain of borders over the likeliest ones, at most 0.

        Args:
            azimuth: where.
            axis: of the wall.
            reach: its distance over the height of the plane above the camera; negative below.
        """
        table = self._gains[int(reach[0, 0] > 0)]
        elevation = np.arctan(np.maximum(np.cos(azimuth - axis * QUARTER), 0.02) / reach)
        height, width = len(table) - 1, table.shape[1]
        x = np.broadcast_to(np.mod(0.25 - azimuth / (2 * np.pi), 1.0) * width - 0.5, elevation.shape)
        y = (0.5 - elevation / np.pi) * height
        at = (x.astype(np.float32), y.astype(np.float32))
        gain = cv2.remap(table, *at, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        return np.asarray(np.maximum(gain, -SETTINGS.most_wrong), np.float32)


def room_on_sphere(
    level: UInt8[np.ndarray, "h w 3"],
    things: Sequence[SphereThing] = (),
    shares: Float32[np.ndarray, "3 h2 w2"] | None = None,
) -> SphereRoom:
    """The room that surfaces and edges of a picture speak for.

    Args:
        level: equirectangular, +Z up, the room's axes along x and y (`geometry.sphere`).
        things: what is in the room: its edges are not the room's, and no wall is before it.
        shares: probabilities of floor, wall and ceiling all round (`sphere_views.sphere_surfaces`); without them edges
            alone decide.
    """
    surfaces = None if shares is None else _Surfaces(shares)
    walls, log_height = _search_walls(_Edges(level, SETTINGS, things, SETTINGS.coarse_px), surfaces)
    fine = _Edges(level, SETTINGS, things)
    walls, log_height = _refine_walls(fine, walls, log_height)
    return _outline_room(fine, walls, log_height)


def _search_walls(edges: _Edges, surfaces: _Surfaces | None) -> tuple[tuple[_Wall, ...], float]:
    """The best closed sequence of walls, and the logarithm of the ceiling's height above the camera."""
    step, n = SETTINGS.log_step, SETTINGS.columns
    distances = np.arange(np.log(SETTINGS.nearest), np.log(SETTINGS.farthest), step)
    heights = np.arange(round(SETTINGS.log_heights[0] / step), round(SETTINGS.log_heights[1] / step) + 1, 2)
    azimuth = (np.arange(n) + 0.5) * 2 * np.pi / n
    low, count = int(-heights.max()), len(distances)
    wider = distances[0] + step * np.arange(low, count - int(heights.min()))
    evidence = np.zeros((n, len(heights), 4, count), np.float32)
    for axis in range(4):
        reaches = (-np.exp(distances)[None], np.exp(wider)[None])
        floor, ceiling = (SETTINGS.edge_weight * edges.border(azimuth[:, None], axis, reach) for reach in reaches)
        if surfaces is not None:
            floor, ceiling = (
                e + surfaces.gain(azimuth[:, None], axis, reach)
                for e, reach in zip((floor, ceiling), reaches, strict=True)
            )
        away = np.abs(np.angle(np.exp(1j * (azimuth - axis * QUARTER)))) > SETTINGS.widest_rad
        for at, m in enumerate(heights):
            shifted = ceiling[:, -m - low : -m - low + count]
            evidence[:, at, axis] = shifted + floor
            evidence[:, at, axis] -= SETTINGS.before_cost * edges.nearer_than_feet(azimuth, axis, np.exp(distances))
            evidence[away, at, axis] = -np.inf
    evidence *= 360 / n
    states, height = _best_path(evidence, azimuth)
    return _walls_of(states, azimuth, distances), float(heights[height] * step)


def _best_path(
    evidence: Float32[np.ndarray, "n m 4 r"], azimuth: Float[np.ndarray, "n"]
) -> tuple[Int[np.ndarray, "n 2"], int]:
    """Axis and distance at each azimuth, and which height, of the best way round."""
    n, heights, _, count = evidence.shape
    value = evidence[0].copy()
    came = np.zeros((2 * n, heights, 4, count), np.int16)
    here = np.arange(4 * count, dtype=np.int16).reshape(4, count)
    for turn in range(1, 2 * n):
        j = turn % n
        best, origin = value.copy(), np.broadcast_to(here, value.shape).copy()
        top = value.argmax(axis=2)
        farther = np.take_along_axis(value, top[..., None], 2) - SETTINGS.jump_cost
        better = farther > best
        best = np.where(better, farther, best)
        origin = np.where(better, (top + count * np.arange(4))[..., None].astype(np.int16), origin)
        edge = azimuth[j] - np.pi / n
        for axis in range(4):
            for other in ((axis + 1) % 4, (axis - 1) % 4):
                one, two = np.cos(edge - other * QUARTER), np.cos(edge - axis * QUARTER)
                if min(one, two) <= np.cos(SETTINGS.widest_rad):
                    continue
                # The walls meet where their distances along the ray are one.
                index = np.arange(count) + round(float(np.log(one / two)) / SETTINGS.log_step)
                fits = (index >= 0) & (index < count)
                met = value[:, other, index[fits]] - SETTINGS.corner_cost
                better = met > best[:, axis, fits]
                best[:, axis, fits] = np.where(better, met, best[:, axis, fits])
                origin[:, axis, fits] = np.where(better, other * count + index[fits], origin[:, axis, fits])
        came[turn] = origin
        value = best + evidence[j]
    height, state = divmod(int(value.reshape(heights, -1).argmax()), 4 * count)
    path = np.zeros(2 * n, int)
    for turn in range(2 * n - 1, -1, -1):
        path[turn] = state
        state = int(came[turn, height].reshape(-1)[state])
    middle = path[n // 2 : n // 2 + n]
    closed = np.roll(middle, n // 2)
    return np.column_stack([closed // count, closed % count]), height


def _walls_of(
    states: Int[np.ndarray, "n 2"], azimuth: Float[np.ndarray, "n"], distances: Float[np.ndarray, "r"]
) -> tuple[_Wall, ...]:
    begins = np.flatnonzero((states != np.roll(states, 1, axis=0)).any(axis=1))
    half = np.pi / len(azimuth)
    return tuple(
        _Wall(int(axis), float(distances[index]), bool(states[j - 1, 0] == axis), float(azimuth[j] - half))
        for j, (axis, index) in zip(begins, states[begins], strict=True)
    )


def _starts(walls: tuple[_Wall, ...]) -> Float[np.ndarray, "w"]:
    """Azimuths at which walls begin: where they meet the one before."""
    starts = []
    for wall, before in zip(walls, (walls[-1], *walls[:-1]), strict=True):
        if wall.jumps:
            starts.append(wall.begins)
            continue
        a, b = (np.exp(w.log_distance) * _axis_direction(w.axis) for w in (wall, before))
        starts.append(float(np.arctan2(*(a + b)[::-1])))
    return np.array(starts)


def _axis_direction(axis: int) -> Float[np.ndarray, "2"]:
    return np.rint([np.cos(axis * QUARTER), np.sin(axis * QUARTER)])


def _owners(walls: tuple[_Wall, ...], azimuth: Float[np.ndarray, "n"]) -> Int[np.ndarray, "n"] | None:
    """The wall that is seen at each azimuth; None where the walls do not follow one another round."""
    starts = np.mod(_starts(walls) - walls[0].begins, 2 * np.pi)
    starts[0] = 0.0 if not walls[0].jumps and starts[0] > np.pi else starts[0]
    if not (np.diff(starts) > 1e-6).all():
        return None
    return (np.searchsorted(starts, np.mod(azimuth - walls[0].begins, 2 * np.pi), side="right") - 1) % len(walls)


def _border_evidence(
    edges: _Edges, walls: tuple[_Wall, ...], log_height: float
) -> tuple[Float[np.ndarray, "n"], Int[np.ndarray, "n"]] | None:
    """Evidence at each azimuth, 0 to 1, and which wall is seen there."""
    azimuth = (np.arange(2 * SETTINGS.columns) + 0.5) * np.pi / SETTINGS.columns
    owner = _owners(walls, azimuth)
    if owner is None:
        return None
    axis = np.array([w.axis for w in walls])[owner]
    reach = np.exp([w.log_distance for w in walls])[owner]
    if (np.cos(azimuth - axis * QUARTER) <= 0.01).any():
        return None
    ceiling = edges.border(azimuth, axis, reach / np.exp(log_height))
    floor = edges.border(azimuth, axis, -reach)
    return 0.5 * (ceiling + floor), owner


def _refine_walls(edges: _Edges, walls: tuple[_Wall, ...], log_height: float) -> tuple[tuple[_Wall, ...], float]:
    """Distances and the ceiling's height, one after the other by ever smaller steps, where the edges are strongest."""

    def score(tried: tuple[_Wall, ...], height: float) -> float:
        seen = _border_evidence(edges, tried, height)
        return -1.0 if seen is None else float(seen[0].mean())

    best = score(walls, log_height)
    for step in SETTINGS.refining:
        for _ in range(SETTINGS.rounds):
            before = best
            for move, index in product((step, -step), range(-2, len(walls))):
                # All together keep the ceiling's border, and move the floor's; the ceiling alone moves its border.
                moved = tuple(
                    replace(w, log_distance=w.log_distance + move) if index in (-2, number) else w
                    for number, w in enumerate(walls)
                )
                height = log_height + (move if index < 0 else 0.0)
                now = score(moved, height)
                if now > best:
                    best, walls, log_height = now, moved, height
            if best == before:
                break
    return walls, log_height


def _outline_room(edges: _Edges, walls: tuple[_Wall, ...], log_height: float) -> SphereRoom:
    """The room's corners; where a wall ends before a farther one, a hidden wall leads back from its end."""
    seen = _border_evidence(edges, walls, log_height)
    starts = _starts(walls)
    support = np.zeros(len(walls)) if seen is None else np.bincount(seen[1], seen[0], len(walls))
    if seen is not None:
        support /= np.maximum(np.bincount(seen[1], minlength=len(walls)), 1)
    corners, sure = [], []
    for index, (wall, before) in enumerate(zip(walls, (walls[-1], *walls[:-1]), strict=True)):
        u = _axis_direction(wall.axis)
        if not wall.jumps:
            corners.append(np.exp(wall.log_distance) * u + np.exp(before.log_distance) * _axis_direction(before.axis))
            sure.append(support[index])
            continue
        ray = np.array([np.cos(starts[index]), np.sin(starts[index])])
        near, far = sorted((before.log_distance, wall.log_distance))
        end = ray * np.exp(near) / float(ray @ u)
        behind = end + u * (np.exp(far) - float(end @ u))
        corners += [end, behind] if before.log_distance < wall.log_distance else [behind, end]
        sure += [0.0, support[index]]
    return SphereRoom(np.array(corners), float(np.exp(log_height)), np.array(sure))
