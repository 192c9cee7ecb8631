"""A rectified level view of the photo: columns are headings, rows are slopes of the line of sight.

In such a view every upright line is a column, and a wall at a distance d shows between the slopes of its foot and of
its top there. Evidence for floor, wall and ceiling is accumulated along the columns once; a wall is then scored in a
heading by two lookups (Flint et al. 2010, "A dynamic programming approach to reconstructing building interiors").
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float
from scipy.special import logit

from diorama_core.architecture.from_depth import view_headings
from diorama_core.architecture.single_view.room_cues import EDGE_THRESHOLD, RoomCues
from diorama_core.models.room_surfaces import RoomSurfaces
from diorama_core.scene.types import Camera


@dataclass(frozen=True)
class LevelViewSettings:
    """Resolution and range of the level view."""

    headings: int = 144
    slopes: int = 160
    steepest: float = 6.0
    clearest_odds: float = 4.0
    """Logarithms of odds are clipped to this."""


SETTINGS = LevelViewSettings()


@dataclass(frozen=True, eq=False)
class LevelView:
    """Image evidence by heading and slope; slopes grow upward."""

    camera: Camera
    edges_rad: Float[np.ndarray, "m1"]
    slopes: Float[np.ndarray, "k1"]
    """Borders of the rows."""
    share: Float[np.ndarray, "m k"]
    """Share of the picture that each cell covers; 0 outside it."""
    floor_odds: Float[np.ndarray, "m k"]
    ceiling_odds: Float[np.ndarray, "m k"]
    """-1 to 1: whether the room shows floor, or ceiling, there; 0 where that is unknown or an object hides it."""
    slant: Float[np.ndarray, "m"]
    """Slant of the wall (`models.room_surfaces`) in each heading,"""
    walls_seen: Float[np.ndarray, "m"]
    """and the share of the picture that shows it."""
    upright: Float[np.ndarray, "m1 k"]
    """Upright edges along the borders of headings: response over the threshold times length in picture diagonals."""

    @property
    def middles_rad(self) -> Float[np.ndarray, "m"]:
        """Headings of the columns' middles."""
        return 0.5 * (self.edges_rad[1:] + self.edges_rad[:-1])

    def row_of(self, slope: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
        """Where slopes lie among the rows' borders, as a fraction."""
        return np.interp(slope, self.slopes, np.arange(len(self.slopes)))


def level_view(cues: RoomCues, surfaces: RoomSurfaces | None, hidden: Bool[np.ndarray, "h w"]) -> LevelView:
    """The precomputed evidence for scoring walls by headings.

    Args:
        cues: lines and objects.
        surfaces: of the room in the whole picture; None where nothing tells them.
        hidden: pixels of objects: what is behind them is a guess.
    """
    camera = cues.camera
    low, high = view_headings(camera)
    edges = np.linspace(low, high, SETTINGS.headings + 1)
    slopes = _slopes(camera)
    middles, rows = 0.5 * (edges[1:] + edges[:-1]), 0.5 * (slopes[1:] + slopes[:-1])
    pixels, inside = project_directions(camera, _directions(middles, rows))
    share = _cell_shares(camera, edges, slopes) * inside
    share /= max(float(share.sum()), 1e-9)
    shares, slant = _sample_surfaces(surfaces, camera, pixels, inside)
    columns, lines = np.moveaxis(np.where(inside[..., None], pixels, 0.0).astype(int), -1, 0)
    free = inside & ~hidden[lines, columns]
    walls = shares[1] * share * free
    return LevelView(
        camera=camera,
        edges_rad=edges,
        slopes=slopes,
        share=share,
        floor_odds=_odds(shares[0]) * free,
        ceiling_odds=_odds(shares[2]) * free,
        slant=(slant * walls).sum(axis=1) / np.maximum(walls.sum(axis=1), 1e-9),
        walls_seen=walls.sum(axis=1),
        upright=_upright(cues, edges, slopes),
    )


def project_directions(
    camera: Camera, directions: Float[np.ndarray, "*n 3"]
) -> tuple[Float[np.ndarray, "*n 2"], Bool[np.ndarray, "*n"]]:
    """Pixels of world directions, and whether they are in the picture."""
    local = directions @ camera.T_world_camera[:3, :3]
    k = camera.intrinsics
    z = np.where(local[..., 2] > 1e-3, local[..., 2], np.inf)
    u, v = k.fx * local[..., 0] / z + k.cx, k.fy * local[..., 1] / z + k.cy
    inside = (local[..., 2] > 1e-3) & (u > 0) & (v > 0) & (u < k.width) & (v < k.height)
    return np.stack([u, v], axis=-1), np.asarray(inside)


def _slopes(camera: Camera) -> Float[np.ndarray, "k1"]:
    k = camera.intrinsics
    rim = np.concatenate(
        [
            np.stack([np.linspace(0, k.width, 9), np.full(9, float(row))], axis=-1) for row in (0, k.height)
        ]
    )  # fmt: skip
    rays = camera.rays(rim)
    slopes = rays[:, 2] / np.maximum(np.linalg.norm(rays[:, :2], axis=1), 1e-6)
    low, high = np.arctan(np.clip([slopes.min(), slopes.max()], -SETTINGS.steepest, SETTINGS.steepest))
    return np.asarray(np.tan(np.linspace(min(low, -0.2), max(high, 0.2), SETTINGS.slopes + 1)))


def _directions(headings: Float[np.ndarray, "m"], slopes: Float[np.ndarray, "k"]) -> Float[np.ndarray, "m k 3"]:
    across = np.stack([np.sin(headings), np.cos(headings)], axis=-1)
    level = np.broadcast_to(across[:, None], (len(headings), len(slopes), 2))
    return np.concatenate([level, np.broadcast_to(slopes[None, :, None], (len(headings), len(slopes), 1))], axis=-1)


def _cell_shares(
    camera: Camera, edges: Float[np.ndarray, "m1"], slopes: Float[np.ndarray, "k1"]
) -> Float[np.ndarray, "m k"]:
    """Area of the cells in the picture, square pixels."""
    corners = project_directions(camera, _directions(edges, slopes))[0]
    across = corners[1:, :-1] - corners[:-1, :-1]
    up = corners[:-1, 1:] - corners[:-1, :-1]
    return np.asarray(np.abs(across[..., 0] * up[..., 1] - across[..., 1] * up[..., 0]))


def _sample_surfaces(
    surfaces: RoomSurfaces | None, camera: Camera, pixels: Float[np.ndarray, "m k 2"], inside: Bool[np.ndarray, "m k"]
) -> tuple[Float[np.ndarray, "3 m k"], Float[np.ndarray, "m k"]]:
    """Probabilities of the surfaces and the slant at pixels; even odds and no wall where they are not known."""
    unknown = np.broadcast_to(np.array([0.5, 0.0, 0.5])[:, None, None], (3, *inside.shape))
    if surfaces is None:
        return unknown, np.zeros(inside.shape)
    k, cells = camera.intrinsics, np.array(surfaces.slant.shape[::-1])
    at = np.where(inside[..., None], pixels / (k.width, k.height) * cells - 0.5, 0.0).astype(np.float32)
    maps = (*surfaces.shares, surfaces.slant)
    *shares, slant = (cv2.remap(m, at, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE) for m in maps)
    return np.where(inside, np.stack(shares), unknown), slant


def _odds(share: Float[np.ndarray, "m k"]) -> Float[np.ndarray, "m k"]:
    """Logarithms of odds over the clearest, -1 to 1."""
    return np.clip(logit(np.clip(share, 1e-6, 1 - 1e-6)) / SETTINGS.clearest_odds, -1.0, 1.0)


def _upright(
    cues: RoomCues, edges: Float[np.ndarray, "m1"], slopes: Float[np.ndarray, "k1"]
) -> Float[np.ndarray, "m1 k"]:
    corners, _ = project_directions(cues.camera, _directions(edges, slopes))
    lengths = np.linalg.norm(corners[:, 1:] - corners[:, :-1], axis=-1)
    pixels, inside = project_directions(cues.camera, _directions(edges, 0.5 * (slopes[1:] + slopes[:-1])))
    k = cues.camera.intrinsics
    responses = response(cues.edge_maps[2], pixels, inside, cues.map_scale) - EDGE_THRESHOLD
    return np.asarray(np.where(inside, responses * lengths / np.hypot(k.width, k.height), 0.0))


def response(
    edge_map: Float[np.ndarray, "hm wm"],
    pixels: Float[np.ndarray, "*n 2"],
    inside: Bool[np.ndarray, "*n"],
    scale: float,
) -> Float[np.ndarray, "*n"]:
    """An edge map's values at pixels of the photo; the neutral one outside.

    Args:
        edge_map: responses of a map that is `scale` times as large as the photo.
        pixels: columns and rows in the photo.
        inside: whether each pixel lies within the photo.
        scale: pixels of the map a pixel of the photo.
    """
    columns, rows = np.moveaxis(np.where(inside[..., None], pixels * scale, 0.0).astype(int), -1, 0)
    height, width = edge_map.shape
    return np.where(inside, edge_map[rows.clip(0, height - 1), columns.clip(0, width - 1)], EDGE_THRESHOLD)
