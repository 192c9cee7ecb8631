"""A piece of the photo that shows a material evenly, head-on in the shape's texture coordinates, made to repeat."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.appearance.surface_view import SurfaceView
from diorama_core.architecture.texture.quilting import broad_shading, detail_continued


@dataclass(frozen=True)
class TextureExampleSettings:
    """Which piece of the photo is a texture example."""

    min_radius_px: int = 12
    max_radius_px: int = 90
    """Half the side of the piece in pixels of the photo."""
    candidates: int = 16
    radii: tuple[float, float] = (1.0, 0.6)
    """Shares of the largest piece around a place that are tried."""
    max_bend: float = 0.12
    """Texture coordinates in the piece deviate from a flat one's by at most this share of its size."""
    max_stretch: float = 4.0
    """Ratio of the longest to the shortest pixel on the surface: beyond, the surface is seen too edge-on."""
    own_share: float = 0.85
    """Share of the piece that is of the slot's main colour."""
    min_contrast: float = 3.0
    """Deviation of the detail, in levels of 255, from which on it is a pattern and not the sensor's noise."""
    min_side_px: int = 20
    fine_share: float = 0.1
    """Detail finer than this share of the piece repeats often enough to be a pattern."""
    min_fine: float = 0.6
    """Share of the variance that it has to make up."""
    cells: int = 4
    min_even: float = 0.45
    """Deviation of the least patterned sixteenth of the piece over that of the most patterned one."""
    max_offset: float = 1.0
    """Difference of a sixteenth's mean colour from the whole's, in deviations of the detail: beyond, it shows a
    mark."""
    seam_share: float = 0.4
    min_seam_px: int = 24
    strongest: float = 110.0
    shading_share: float = 0.35


SETTINGS = TextureExampleSettings()


@dataclass(frozen=True, eq=False)
class Example:
    """A square piece of material."""

    colours: Float32[np.ndarray, "n n 3"]
    """0 to 255, sRGB, without broad shading; first row on top."""
    texel_m: float
    """Metres of the shape at scale 1."""


def best_example(
    view: SurfaceView, mine: Bool[np.ndarray, "gh gw"], near: Bool[np.ndarray, "gh gw"], rgb: UInt8[np.ndarray, "h w 3"]
) -> Example | None:
    """The largest even piece of a slot that shows a pattern; None where there is none.

    Args:
        view: The shape in its pose.
        mine: Where the slot is seen, on the view's grid.
        near: Where it has its main colour.
        rgb: The photo.
    """
    inside = cv2.distanceTransform(np.pad(mine, 1).astype(np.uint8), cv2.DIST_L2, 3)[1:-1, 1:-1]
    best, score = None, 0.0
    for row, column in _centres(inside):
        radius = min(float(inside[row, column]) * 0.7, SETTINGS.max_radius_px / view.step)
        for share in SETTINGS.radii:
            piece = _piece(view, near, rgb, row, column, int(share * radius))
            size = 0.0 if piece is None else len(piece.colours) * pattern_strength(piece.colours)
            best, score = (piece, size) if size > score else (best, score)
    return best


def _centres(inside: Float32[np.ndarray, "h w"]) -> list[tuple[int, int]]:
    """Places far inside, the farthest first, none within another's piece."""
    left, centres = inside.copy(), []
    for _ in range(SETTINGS.candidates):
        row, column = np.unravel_index(int(np.argmax(left)), left.shape)
        radius = float(left[row, column])
        if radius < 6:
            break
        centres.append((int(row), int(column)))
        cv2.circle(left, (int(column), int(row)), max(2, int(0.6 * radius)), 0.0, -1)
    return centres


def _piece(
    view: SurfaceView,
    near: Bool[np.ndarray, "gh gw"],
    rgb: UInt8[np.ndarray, "h w 3"],
    row: int,
    column: int,
    radius: int,
) -> Example | None:
    """The piece around one place, if it is flat, not too edge-on, of the material, even and patterned."""
    if radius * view.step < SETTINGS.min_radius_px:
        return None
    window = (slice(row - radius, row + radius + 1), slice(column - radius, column + radius + 1))
    if near[window].mean() < SETTINGS.own_share:
        return None
    y, x = np.mgrid[-radius : radius + 1, -radius : radius + 1].astype(np.float64)
    design = np.stack([x.ravel(), y.ravel(), np.ones(x.size)], axis=1)
    uv = view.uv_m[window].reshape(-1, 2).astype(np.float64)
    fit = np.linalg.lstsq(design, uv, rcond=None)[0]
    J = fit[:2].T / view.step
    stretch = np.linalg.svd(J, compute_uv=False)
    size_m = 2 * radius * view.step * stretch[0]
    bend = np.abs(design @ fit - uv).max()
    if stretch[1] < 1e-9 or stretch[0] > SETTINGS.max_stretch * stretch[1] or bend > SETTINGS.max_bend * size_m:
        return None
    place = np.array([view.left + column * view.step, view.top + row * view.step], dtype=np.float64)
    example = _head_on(rgb, place, J, radius * view.step)
    return example if pattern_strength(example.colours) > 0 else None


def _head_on(
    rgb: UInt8[np.ndarray, "h w 3"], place: Float[np.ndarray, "2"], J: Float[np.ndarray, "2 2"], radius_px: int
) -> Example:
    """The photo around a place, along the axes of the texture (v upward), one texel about one pixel."""
    texel_m = float(np.sqrt(abs(np.linalg.det(J))))
    to_pixels = np.linalg.inv(J) * texel_m @ np.diag([1.0, -1.0])
    # The largest square of the texture whose corners stay within the piece.
    half = int(radius_px / np.abs(to_pixels @ np.array([[1, 1], [1, -1]])).max())
    half = max(half, 4)
    offset = place - to_pixels @ np.array([half, half])
    M = np.concatenate([to_pixels, offset[:, None]], axis=1)
    size = (2 * half + 1, 2 * half + 1)
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    colours = cv2.warpAffine(rgb, M, size, flags=flags, borderMode=cv2.BORDER_REFLECT).astype(np.float32)
    whole = np.ones(colours.shape[:2], dtype=bool)
    broad = broad_shading(colours, whole, SETTINGS.shading_share * size[0])
    flat = colours / np.maximum(broad, 1.0) * colours.reshape(-1, 3).mean(axis=0)
    return Example(flat.clip(0, 255).astype(np.float32), texel_m)


def pattern_strength(colours: Float32[np.ndarray, "n n 3"]) -> float:
    """How far a piece shows a pattern that repeats all over it, 0 to 1; 0 for plain ones and for seams, folds, marks.

    A pattern has detail finer than the piece, about as much of it in every part of the piece, and no part whose mean
    stands out.
    """
    size = len(colours)
    grey = cv2.GaussianBlur(cv2.cvtColor(colours, cv2.COLOR_RGB2GRAY), (0, 0), 0.7)
    fine = grey - cv2.GaussianBlur(grey, (0, 0), SETTINGS.fine_share * size)
    if size < SETTINGS.min_side_px or float(fine.std()) < SETTINGS.min_contrast:
        return 0.0
    share = float(fine.var()) / max(float(grey.var()), 1e-6)
    cells = [
        c
        for strip in np.array_split(fine, SETTINGS.cells, axis=0)
        for c in np.array_split(strip, SETTINGS.cells, axis=1)
    ]
    spreads = np.array([c.std() for c in cells])
    even = float(spreads.min() / max(spreads.max(), 1e-6))
    means = cv2.resize(colours, (SETTINGS.cells, SETTINGS.cells), interpolation=cv2.INTER_AREA).reshape(-1, 3)
    offset = float(np.abs(means - means.mean(axis=0)).max() / fine.std())
    if share < SETTINGS.min_fine or even < SETTINGS.min_even or offset > SETTINGS.max_offset:
        return 0.0
    return even * share


def tileable(example: Example) -> UInt8[np.ndarray, "m m 3"]:
    """The piece made to repeat: its halves swapped, so that its inside meets across the border, the gap quilted."""
    size = len(example.colours)
    gap = max(SETTINGS.min_seam_px, round(SETTINGS.seam_share * size))
    side, first = size + gap, size // 2
    canvas = np.zeros((side, side, 3), np.float32)
    known = np.zeros((side, side), dtype=bool)
    canvas[:size, :size], known[:size, :size] = example.colours, True
    canvas, known = np.roll(canvas, (-first, -first), axis=(0, 1)), np.roll(known, (-first, -first), axis=(0, 1))
    mean = example.colours.reshape(-1, 3).mean(axis=0)
    detail = detail_continued((canvas - mean) * known[..., None], known, SETTINGS.strongest)
    if detail is None:
        detail = _tile_mirror_images(example.colours) - mean
    return (mean + detail).clip(0, 255).astype(np.uint8)


def _tile_mirror_images(colours: Float32[np.ndarray, "n n 3"]) -> Float32[np.ndarray, "m m 3"]:
    """A piece too small to be quilted, beside its mirror images."""
    row = np.concatenate([colours, colours[:, ::-1]], axis=1)
    return np.concatenate([row, row[::-1]], axis=0)
