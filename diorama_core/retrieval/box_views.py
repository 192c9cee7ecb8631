"""How likely a box in a picture is for a thing of each kind: every kind set at many distances before the camera, or on
a thing whose size tells how far away both are.

Where its foot or its top would be, and how large it would be, are compared with what such things usually have.

By its box alone a dresser may be a pillow that is near; not where it would have to lie on the bed behind it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import CARRIED_KINDS, Category, Mount, SizePrior, category, column
from diorama_core.scene.types import Intrinsics

HEIGHTS_M = np.linspace(0.7, 2.2, 16)
"""Heights of cameras above the floor."""
DISTANCES_M = np.geomspace(0.7, 9.0, 48)


@dataclass(frozen=True)
class BoxViewSettings:
    """Distances and noise of the simulated boxes."""

    foot_sigma_m: float = 0.05
    foot_sigma_share: float = 0.06
    """How far from the floor a foot may seem to be: by itself, and for every metre of distance."""
    on_objects_m: float = 0.75
    on_objects_sigma_m: float = 0.3
    on_walls_m: float = 1.45
    on_walls_sigma_m: float = 0.35
    """Middle heights of what hangs on walls."""
    ceiling_m: float = 2.55
    ceiling_sigma_m: float = 0.3
    view_sigma: float = 0.3
    """Deviation of the logarithms of sizes read off a box: turns, perspective, ornaments."""
    hidden_share: float = 0.15
    hidden_range: float = 2.0
    """Range of a logarithm over which any smaller size is as likely, of things much of which is hidden."""
    also_carried: float = 0.5
    """How often boxes, baskets and plants lie on other things, which else stand on the floor."""
    border_px: float = 3.0
    certain: float = 0.02
    """Likelihood that is spread evenly over all kinds: boxes are drawn by people."""
    anywhere: float = 0.1
    """How likely a carrier's distance is not what its kind's usual size says."""
    reach_m: float = 0.15
    reach_share: float = 0.05
    """How far before and behind a carrier a thing on it may seem to be: by itself, and for every metre of distance."""
    level_sigma: float = 0.15
    """Deviation of the height of a top or seat, as a share of it."""


SETTINGS = BoxViewSettings()


@dataclass(frozen=True, eq=False)
class BoxView:
    """One box as directions from the camera."""

    tan_bottom: float
    """Height that is gained for every metre of distance, at the box's lower edge."""
    tan_top: float
    width: float
    """Metres that it spans at one metre."""
    cut_bottom: bool
    cut_top: bool
    cut_side: bool
    carried: float
    """How likely such a box is for what lies on another thing, by the boxes below it."""


def box_view(
    box: tuple[float, float, float, float], carried: float, k: Intrinsics, R_world_camera: Float[np.ndarray, "3 3"]
) -> BoxView:
    """A box (x1, y1, x2, y2, pixels) as a camera sees it that is held so.

    Args:
        box: x1, y1, x2, y2 in pixels.
        carried: how likely it is for what lies on another thing.
        k: of the camera.
        R_world_camera: of the camera.
    """
    x1, y1, x2, y2 = box
    middle_x, middle_y = (x1 + x2) / 2, (y1 + y2) / 2
    pixels = np.array([[middle_x, y2], [middle_x, y1], [x1, middle_y], [x2, middle_y]])
    rays = np.column_stack([(pixels[:, 0] - k.cx) / k.fx, (pixels[:, 1] - k.cy) / k.fy, np.ones(4)])
    rays = rays @ R_world_camera.T
    rays = rays / np.maximum(np.linalg.norm(rays[:, :2], axis=1, keepdims=True), 1e-6)
    return BoxView(
        tan_bottom=float(rays[0, 2]),
        tan_top=float(rays[1, 2]),
        width=float(np.linalg.norm(rays[2, :2] - rays[3, :2])),
        cut_bottom=y2 > k.height - SETTINGS.border_px,
        cut_top=y1 < SETTINGS.border_px,
        cut_side=x1 < SETTINGS.border_px or x2 > k.width - SETTINGS.border_px,
        carried=carried,
    )


def box_likelihood(view: BoxView, kind: str) -> Float[np.ndarray, "h"]:
    """How likely such a box is for a kind, for every camera height: over all distances and the kind's modes."""
    entry = category(kind)
    likely = _standing(view, entry.priors, entry.mount)
    if entry.mount == "surface":
        likely = likely * view.carried
    elif entry.mount == "floor" and kind in CARRIED_KINDS:
        lying = _standing(view, entry.priors, "surface")
        likely = (1.0 - SETTINGS.also_carried) * likely + SETTINGS.also_carried * view.carried * lying
    return likely + SETTINGS.certain


def _standing(view: BoxView, priors: tuple[SizePrior, ...], mount: Mount) -> Float[np.ndarray, "h"]:
    return np.mean(
        [(place_density(view, p, mount) * size_density(view, p, mount)).mean(axis=1) for p in priors],
        axis=0,
    )


def size_density(view: BoxView, prior: SizePrior, mount: Mount) -> Float[np.ndarray, "d"]:
    """How usual the size would be that a thing in the box has, for every distance; a density over two logarithms."""
    beyond = _depth_seen(view, prior)
    tall_m = np.maximum(DISTANCES_M * (view.tan_top - view.tan_bottom) + beyond * view.tan_top, 0.01)
    wide_m = np.maximum(DISTANCES_M * view.width, 0.01)
    across = 0.5 * (prior.width_m + prior.depth_m) if mount != "wall" else prior.width_m
    tall = _log_normal(tall_m, prior.height_m, prior.sigma_height, view.cut_bottom or view.cut_top)
    return tall * _log_normal(wide_m, across, prior.sigma_width, view.cut_side)


def place_density(view: BoxView, prior: SizePrior, mount: Mount) -> Float[np.ndarray, "h d"]:
    """How usual it is for a thing that is so mounted to be where it would be; densities over height in metres."""
    bottom = HEIGHTS_M[:, None] + DISTANCES_M * view.tan_bottom
    top = HEIGHTS_M[:, None] + (DISTANCES_M + _depth_seen(view, prior)) * view.tan_top
    sigma = foot_sigma_m()
    if mount == "floor":
        return normal(np.minimum(bottom, 0.0) if view.cut_bottom else bottom, sigma)
    if mount == "ceiling":
        return normal(
            np.maximum(top - SETTINGS.ceiling_m, 0.0) if view.cut_top else top - SETTINGS.ceiling_m,
            SETTINGS.ceiling_sigma_m + sigma,
        )
    if mount == "wall":
        return normal((bottom + top) / 2 - SETTINGS.on_walls_m, SETTINGS.on_walls_sigma_m + sigma) * (bottom > 0.0)
    return normal(bottom - SETTINGS.on_objects_m, SETTINGS.on_objects_sigma_m + sigma)


def foot_sigma_m() -> Float[np.ndarray, "d"]:
    """How far from what it stands on a foot may seem to be, for every distance."""
    return SETTINGS.foot_sigma_m + SETTINGS.foot_sigma_share * DISTANCES_M


def _depth_seen(view: BoxView, prior: SizePrior) -> float:
    """From above one sees a thing's far edge."""
    return prior.depth_m if view.tan_top < 0 else 0.0


def normal(off: Float[np.ndarray, "h d"], sigma: Float[np.ndarray, "d"] | float) -> Float[np.ndarray, "h d"]:
    """A normal density, but for a constant factor."""
    return np.asarray(np.exp(-0.5 * (off / sigma) ** 2) / sigma)


def _log_normal(size_m: Float[np.ndarray, "d"], usual_m: float, sigma: float, cut: bool) -> Float[np.ndarray, "d"]:
    """Density of the logarithm of a size; smaller ones are as likely where a thing is cut or hidden."""
    off = np.log(size_m / usual_m)
    spread = float(np.hypot(sigma, SETTINGS.view_sigma))
    whole = np.exp(-0.5 * (off / spread) ** 2) / spread
    part = ((off < 0) & (off > -SETTINGS.hidden_range)) * np.sqrt(2 * np.pi) / SETTINGS.hidden_range
    share = 0.7 if cut else SETTINGS.hidden_share
    return np.asarray((1 - share) * whole + share * part)


_BOARDS = frozenset(kind for kind, like in column("carries_as").items() if like == "bookshelf")
"""Things lie at any height of them."""
_RAISED_M, _RAISED_SIGMA_M = {"surface": 0.75, "wall": 1.45, "ceiling": 2.3}, 0.35
"""Heights of carriers that do not stand on the floor."""


def lying_likelihoods(
    view: BoxView,
    kinds: Sequence[str],
    carrier: BoxView,
    carrier_kinds: Sequence[str],
    height: Float[np.ndarray, "h"],
) -> Float[np.ndarray, "k c"]:
    """How likely a box is for every kind lying on every kind of carrier.

    Args:
        view: the box of what lies there.
        kinds: that it may be of.
        carrier: the box of what it lies on.
        carrier_kinds: that this may be of.
        height: how likely every camera height of `box_views.HEIGHTS_M` is, adding up to 1.
    """
    entries = [category(kind) for kind in kinds]
    sizes = np.stack([np.mean([size_density(view, p, e.mount) for p in e.priors], axis=0) for e in entries])
    distances = []
    for entry in map(category, carrier_kinds):
        of_modes = [_lying_likelihood(view, carrier, entry, prior) for prior in entry.priors]
        distances.append(height @ np.mean(of_modes, axis=0))
    return np.asarray(sizes @ np.stack(distances, axis=1) + SETTINGS.certain)


def _lying_likelihood(view: BoxView, carrier: BoxView, entry: Category, prior: SizePrior) -> Float[np.ndarray, "h d"]:
    """How likely what lies on a carrier of one kind is at every distance, times how well its foot is level with it."""
    likely = place_density(carrier, prior, entry.mount) * size_density(carrier, prior, entry.mount)
    likely = likely / np.maximum(likely.sum(axis=1, keepdims=True), 1e-12)
    likely = (1.0 - SETTINGS.anywhere) * likely + SETTINGS.anywhere / len(DISTANCES_M)
    reach = SETTINGS.reach_m + SETTINGS.reach_share * DISTANCES_M[:, None]
    beyond = DISTANCES_M - DISTANCES_M[:, None]
    on_it = (beyond > -reach) & (beyond < prior.depth_m + reach)
    level, spread = _level_m(entry, prior)
    foot = DISTANCES_M * view.tan_bottom - level + HEIGHTS_M[:, None]
    if view.cut_bottom:
        foot = np.minimum(foot, 0.0)
    return likely @ (on_it / on_it.sum(axis=1, keepdims=True)) * normal(foot, np.hypot(spread, foot_sigma_m()))


def _level_m(entry: Category, prior: SizePrior) -> tuple[float, float]:
    """Height of what things lie on, and its standard deviation, metres."""
    if entry.name in _BOARDS and entry.mount == "floor":
        return prior.height_m / 2, prior.height_m / 2
    if entry.mount != "floor":
        return _RAISED_M[entry.mount] + (prior.height_m if entry.mount == "surface" else 0.0), _RAISED_SIGMA_M
    level = entry.seat_height_m or prior.height_m
    return level, SETTINGS.level_sigma * level
