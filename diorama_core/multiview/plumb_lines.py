"""The lens of one photo by its bent lines: walls, frames and furniture have straight edges, so a lens that bends many
of them alike is known without a calibration (the plumb-line method, Brown, Close-range camera calibration, 1971).

Long smooth edges are found by the direction of the picture's gradient, and the one radial coefficient under which most
of them are straight is taken. Round things are bent under every coefficient, so that a truncated cost leaves them out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.multiview.lens import Lens, distort_box, straight_points, undistort
from diorama_core.scene.types import Intrinsics


@dataclass(frozen=True)
class PlumbLineSettings:
    """Limits of what counts as a bent line, and how many of them speak for a lens."""

    side_px: int = 1200
    """Edges are found in a picture no larger than this."""
    min_length: float = 0.16
    """Length of an edge, in diagonals."""
    max_sagitta: float = 0.06
    """Share of an edge's length: what is bent more is round."""
    smooth_px: float = 0.8
    """Deviation of an edge from a parabola."""
    straight_px: float = 0.5
    """Deviation of an edge from a line up to which it is straight; beyond, all edges cost the same."""
    k1: tuple[float, float, int] = (-0.4, 0.4, 161)
    """Coefficients that are tried, for half a diagonal as focal length."""
    told_px: float = 1.5
    """So much an edge must be bent by the coefficient to speak for it or against it."""
    min_lines: int = 5
    min_straight: float = 0.75
    """Share of these edges that the coefficient makes straight..."""
    max_straight: float = 0.25
    """...and that are straight in the photo as it is."""


SETTINGS = PlumbLineSettings()
_BINS, _HALF_BIN_RAD = 8, np.pi / 8
"""Directions by which edges are told apart, overlapping, so that a bent one is whole in one of them."""
_SAMPLES = 17
"""Points of each edge that are straightened."""


def undistort_by_lines(inputs: Inputs, k1: float | None = None) -> tuple[Inputs, tuple[str, ...]]:
    """One photo with everything that lies on it, straightened where its lines say that the lens bends them; and the
    note that it was.

    Args:
        inputs: as given.
        k1: what the lines said before (`Photo.straightened`), 0 to leave the photo as it is; None to ask them.
    """
    k, lens = fit_lens(inputs.photo.rgb) if k1 is None else _lens(inputs.photo.width, inputs.photo.height, k1)
    straight = undistort(inputs, k, lens)
    if straight is inputs:
        return inputs, ()
    camera = inputs.intrinsics
    focal = camera.fx if camera is not None else inputs.photo.exif_focal_px
    distortion = "" if focal is None else f" (k1 {lens.k[0] * (focal / k.fx) ** 2:.3f})"
    marked = replace(straight, photo=replace(straight.photo, straightened=lens.k[0]))
    return marked, (f"the lens bends straight lines{distortion}; the photo was straightened by them",)


def box_before_straightening(box: LabelledBox, photo: Photo) -> LabelledBox:
    """A box of a straightened photo as it is in the photo's file."""
    return distort_box(box, *_lens(photo.width, photo.height, photo.straightened or 0.0))


def fit_lens(rgb: UInt8[np.ndarray, "h w 3"]) -> tuple[Intrinsics, Lens]:
    """The lens by which a photo's lines are bent, and the camera that its coefficient is for.

    The lens bends nothing where too few lines say that there is any distortion.
    """
    height, width = rgb.shape[:2]
    factor = min(1.0, SETTINGS.side_px / max(height, width))
    grey = cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)
    small = cv2.resize(grey, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA) if factor < 1 else grey
    lines = np.array(list(_edges(np.asarray(small)))).reshape(-1, _SAMPLES, 2)
    return _lens(width, height, _coefficient(lines, _camera(small.shape[1], small.shape[0])))


def _lens(width: int, height: int, k1: float) -> tuple[Intrinsics, Lens]:
    return _camera(width, height), Lens((k1,) if k1 else ())


def _camera(width: int, height: int) -> Intrinsics:
    """A camera whose unit is half the diagonal; a radial coefficient for another focal length follows from its."""
    half = float(np.hypot(width, height)) / 2
    return Intrinsics(width, height, half, half, width / 2, height / 2)


def _edges(grey: UInt8[np.ndarray, "h w"]) -> Iterator[Float[np.ndarray, "samples 2"]]:
    """Points along long smooth edges, in pixels."""
    smooth = cv2.GaussianBlur(grey, (0, 0), 1.0)
    dx, dy = cv2.Sobel(smooth, cv2.CV_16S, 1, 0), cv2.Sobel(smooth, cv2.CV_16S, 0, 1)
    strong = float(np.percentile(np.hypot(dx, dy), 90))
    edges = cv2.Canny(dx, dy, 0.4 * strong, strong, L2gradient=True) > 0
    across = np.arctan2(dy, dx)
    least = SETTINGS.min_length * float(np.hypot(*grey.shape))
    for number in range(_BINS):
        off = (across - number * np.pi / _BINS + np.pi / 2) % np.pi - np.pi / 2
        along = (edges & (np.abs(off) < _HALF_BIN_RAD)).astype(np.uint8)
        _, labels, stats, _ = cv2.connectedComponentsWithStats(along, connectivity=8)
        spans = np.hypot(stats[1:, cv2.CC_STAT_WIDTH], stats[1:, cv2.CC_STAT_HEIGHT])
        for label in 1 + np.flatnonzero(spans >= least):
            x, y, w, h = stats[label, :4]
            rows, columns = np.nonzero(labels[y : y + h, x : x + w] == label)
            edge = _parabola(np.column_stack([columns + x + 0.5, rows + y + 0.5]), least)
            if edge is not None:
                yield edge


def _parabola(points: Float[np.ndarray, "n 2"], least_px: float) -> Float[np.ndarray, "samples 2"] | None:
    """Points of an edge as a parabola smooths them; None where it is none, or is round."""
    middle = points.mean(axis=0)
    axes = np.linalg.svd(points - middle, full_matrices=False)[2]
    along, across = ((points - middle) @ axes.T).T
    fit = np.polynomial.Polynomial.fit(along, across, 2)
    length = float(np.ptp(along))
    if length < least_px or np.percentile(np.abs(fit(along) - across), 90) > SETTINGS.smooth_px:
        return None
    t = np.linspace(along.min(), along.max(), _SAMPLES)
    if np.ptp(fit(t) - np.linspace(fit(t[0]), fit(t[-1]), _SAMPLES)) > SETTINGS.max_sagitta * length:
        return None
    return np.asarray(middle + np.column_stack([t, fit(t)]) @ axes)


def _coefficient(lines: Float[np.ndarray, "lines samples 2"], camera: Intrinsics) -> float:
    """The radial coefficient that makes most edges straight; 0 where it is not sure that there is one."""
    if len(lines) < SETTINGS.min_lines:
        return 0.0
    bent = np.count_nonzero(_deviation(lines) >= SETTINGS.straight_px)
    if bent < (1.0 - SETTINGS.max_straight) * SETTINGS.min_lines:
        return 0.0
    weights = np.linalg.norm(lines[:, -1] - lines[:, 0], axis=1)

    def straight(k1: float) -> Float[np.ndarray, "lines samples 2"]:
        return straight_points(lines.reshape(-1, 2), camera, Lens((k1,))).reshape(lines.shape)

    def cost(k1: float) -> float:
        return float((weights * np.minimum(_deviation(straight(k1)) / SETTINGS.straight_px, 1.0) ** 2).sum())

    def best_of(tried: Float[np.ndarray, " n"]) -> float:
        return float(min(tried, key=lambda k1: (cost(k1), abs(k1))))

    tried = np.linspace(*SETTINGS.k1)
    step = float(tried[1] - tried[0])
    best = best_of(best_of(tried) + np.linspace(-step, step, 21))
    then = straight(best)
    tells = np.abs(_sagitta(lines) - _sagitta(then)) > SETTINGS.told_px
    if np.count_nonzero(tells) < SETTINGS.min_lines:
        return 0.0
    was, made = (float((_deviation(of)[tells] < SETTINGS.straight_px).mean()) for of in (lines, then))
    return best if made >= SETTINGS.min_straight and was <= SETTINGS.max_straight else 0.0


def _deviation(lines: Float[np.ndarray, "lines samples 2"]) -> Float[np.ndarray, " lines"]:
    """How far the points of each edge are off a line, root mean square."""
    local = lines - lines.mean(axis=1, keepdims=True)
    return np.asarray(np.linalg.svd(local, compute_uv=False)[:, 1] / np.sqrt(lines.shape[1]))


def _sagitta(lines: Float[np.ndarray, "lines samples 2"]) -> Float[np.ndarray, " lines"]:
    """How far the middle of each edge is off its chord, with its sign."""
    chord, middle = lines[:, -1] - lines[:, 0], lines[:, lines.shape[1] // 2] - lines[:, 0]
    return (chord[:, 0] * middle[:, 1] - chord[:, 1] * middle[:, 0]) / np.maximum(np.linalg.norm(chord, axis=1), 1e-9)
