"""A rectified level view of the photo: columns are headings, rows are slopes of the line of sight.

In such a view every upright line is a column, and a wall at a distance d shows between the slopes of its foot and of
its top there. Evidence for floor, wall and ceiling is accumulated along the columns once; a wall is then scored in a
heading by two lookups (Flint et al. 2010, "A dynamic programming approach to reconstructing building interiors").
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Int, UInt8
from scipy.ndimage import gaussian_filter
from scipy.spatial import ConvexHull, QhullError

from diorama_core.architecture.from_depth import view_headings
from diorama_core.architecture.single_view.room_cues import EDGE_THRESHOLD, RoomCues
from diorama_core.architecture.texture.colours import object_pixels
from diorama_core.artefacts import DetectedObject
from diorama_core.scene.types import Camera

LAB_BINS = np.array([16.0, 5.0, 5.0])
"""Widths of the histograms' cells, levels of 255."""


@dataclass(frozen=True)
class LevelViewSettings:
    """Resolution and range of the level view."""

    headings: int = 144
    slopes: int = 160
    steepest: float = 6.0
    colour_side_px: int = 400
    horizon_m: float = 8.0
    """Floor farther away than this cannot be distinguished from the walls behind it."""
    overhead_slope: float = 0.18
    """Ceilings are not visible below this slope above the horizon."""
    unseen_colour: float = 3e-4
    clearest_ratio: float = 3.0
    """Log-likelihood ratios are clipped to this."""
    enough_seeds: int = 120


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
    floor_ratio: Float[np.ndarray, "m k"]
    """-1 to 1: whether the colour is the floor's or the walls'; 0 where that is unknown or an object hides it."""
    lines: Float[np.ndarray, "m k 3"]
    """Share of all line evidence that runs along each room axis in a cell."""
    upright: Float[np.ndarray, "m1 k"]
    """Upright edges along the borders of headings: response over the threshold times length in picture diagonals."""

    @property
    def middles_rad(self) -> Float[np.ndarray, "m"]:
        """Headings of the columns' middles."""
        return 0.5 * (self.edges_rad[1:] + self.edges_rad[:-1])

    def row_of(self, slope: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
        """Where slopes lie among the rows' borders, as a fraction."""
        return np.interp(slope, self.slopes, np.arange(len(self.slopes)))


def level_view(rgb: UInt8[np.ndarray, "h w 3"], cues: RoomCues, objects: tuple[DetectedObject, ...]) -> LevelView:
    """The precomputed evidence for scoring walls by headings."""
    camera = cues.camera
    low, high = view_headings(camera)
    edges = np.linspace(low, high, SETTINGS.headings + 1)
    slopes = _slopes(camera)
    middles, rows = 0.5 * (edges[1:] + edges[:-1]), 0.5 * (slopes[1:] + slopes[:-1])
    pixels, inside = project_directions(camera, _directions(middles, rows))
    hidden = object_pixels((rgb.shape[0], rgb.shape[1]), objects)
    columns, lines = (np.where(inside, pixels[..., i], 0).astype(int) for i in (0, 1))
    free = inside & ~hidden[lines, columns]
    share = _cell_shares(camera, edges, slopes) * inside
    return LevelView(
        camera=camera,
        edges_rad=edges,
        slopes=slopes,
        share=share / max(float(share.sum()), 1e-9),
        floor_ratio=_floor_ratio(_small_lab(rgb), pixels / np.array(rgb.shape[1::-1]), free, middles, rows, cues),
        lines=_line_shares(cues, edges, slopes),
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


def _small_lab(rgb: UInt8[np.ndarray, "h w 3"]) -> UInt8[np.ndarray, "hs ws 3"]:
    scale = min(1.0, SETTINGS.colour_side_px / max(rgb.shape[:2]))
    small = cv2.resize(rgb, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return np.asarray(cv2.cvtColor(cv2.medianBlur(small, 3), cv2.COLOR_RGB2LAB))


def _floor_ratio(
    lab: UInt8[np.ndarray, "hs ws 3"],
    place: Float[np.ndarray, "m k 2"],
    free: Bool[np.ndarray, "m k"],
    headings: Float[np.ndarray, "m"],
    slopes: Float[np.ndarray, "k"],
    cues: RoomCues,
) -> Float[np.ndarray, "m k"]:
    """Log-likelihood ratio of floor colours (between objects on the floor) and wall colours (at eye height)."""
    shape = np.array(lab.shape[1::-1])
    columns, rows = np.moveaxis(np.where(free[..., None], place, 0) * shape, -1, 0).astype(int)
    cells = (lab[rows.clip(0, lab.shape[0] - 1), columns.clip(0, lab.shape[1] - 1)] / LAB_BINS).astype(int)
    floor = free & _hits_sure_floor(headings, slopes, cues)
    eye = float(cues.camera.position[2])
    wall = free & ((slopes > -eye / SETTINGS.horizon_m) & (slopes < SETTINGS.overhead_slope))[None]
    if min(floor.sum(), wall.sum()) < SETTINGS.enough_seeds:
        return np.zeros(free.shape)
    ratio = np.log(_frequency(cells, floor) + SETTINGS.unseen_colour) - np.log(
        _frequency(cells, wall) + SETTINGS.unseen_colour
    )
    return np.where(free, np.clip(ratio / SETTINGS.clearest_ratio, -1.0, 1.0), 0.0)


def _frequency(cells: Int[np.ndarray, "m k 3"], chosen: Bool[np.ndarray, "m k"]) -> Float[np.ndarray, "m k"]:
    """How usual each cell's colour is among the chosen ones, blurred over like colours."""
    bins = np.ceil(256.0 / LAB_BINS).astype(int)
    counts = np.zeros(bins)
    np.add.at(counts, tuple(cells[chosen].T), 1.0)
    smooth: Float[np.ndarray, "a b c"] = gaussian_filter(counts / max(int(chosen.sum()), 1), sigma=(0.9, 0.7, 0.7))
    return np.asarray(smooth[tuple(np.moveaxis(cells, -1, 0))])


def _hits_sure_floor(
    headings: Float[np.ndarray, "m"], slopes: Float[np.ndarray, "k"], cues: RoomCues
) -> Bool[np.ndarray, "m k"]:
    """Lines of sight that would meet the floor between the camera and the objects that stand in the room."""
    eye = cues.camera.position
    reach = np.where(slopes < -1e-3, eye[2] / np.maximum(-slopes, 1e-3), np.inf)
    on_floor = np.broadcast_to(np.isfinite(reach)[None], (len(headings), len(slopes)))
    spots = [eye[:2]]
    for low, high in zip(cues.object_low, cues.object_high, strict=True):
        spots += [np.array([x, y]) for x in (low[0], high[0]) for y in (low[1], high[1])]
    try:
        bounds = ConvexHull(np.array(spots)).equations
    except (QhullError, ValueError):
        return on_floor & False
    across = np.stack([np.sin(headings), np.cos(headings)], axis=-1)
    points = eye[:2] + np.where(np.isfinite(reach), reach, 0.0)[None, :, None] * across[:, None]
    return np.asarray(on_floor & (points @ bounds[:, :2].T + bounds[:, 2] <= 0).all(axis=-1))


def _line_shares(
    cues: RoomCues, edges: Float[np.ndarray, "m1"], slopes: Float[np.ndarray, "k1"]
) -> Float[np.ndarray, "m k 3"]:
    """Line evidence by heading, slope and axis."""
    d = cues.directions
    shares = np.zeros((len(edges) - 1, len(slopes) - 1, 3))
    if len(d) == 0:
        return shares
    column = np.searchsorted(edges, np.arctan2(d[:, 0], d[:, 1])) - 1
    row = np.searchsorted(slopes, d[:, 2] / np.maximum(np.linalg.norm(d[:, :2], axis=1), 1e-6)) - 1
    ok = (column >= 0) & (column < shares.shape[0]) & (row >= 0) & (row < shares.shape[1])
    np.add.at(shares, (column[ok], row[ok], cues.ray_axes[ok]), cues.ray_weights[ok])
    return shares


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
