"""How likely a box in a picture is for a thing of each kind: every kind set at many distances before the camera.

Where its foot or its top would be, and how large it would be, are compared with what such things usually have.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.library.company import CARRIED_KINDS
from diorama_core.library.taxonomy import Mount, SizePrior, category
from diorama_core.scene.types import Intrinsics

HEIGHTS_M = np.linspace(0.7, 2.2, 16)
"""Of cameras above the floor."""
DISTANCES_M = np.geomspace(0.7, 9.0, 48)
_FOOT_SIGMA_M, _FOOT_SIGMA_SHARE = 0.05, 0.06
"""How far from the floor a foot may seem to be: by itself, and for every metre of distance."""
_ON_OBJECTS_M, _ON_OBJECTS_SIGMA_M = 0.75, 0.3
_ON_WALLS_M, _ON_WALLS_SIGMA_M = 1.45, 0.35
"""Middle heights of what hangs on walls."""
_CEILING_M, _CEILING_SIGMA_M = 2.55, 0.3
_VIEW_SIGMA = 0.3
"""Of the logarithms of sizes read off a box: turns, perspective, ornaments."""
_HIDDEN_SHARE, _HIDDEN_RANGE = 0.15, 2.0
"""Of things much of which is hidden: then any smaller size, over this range of its logarithm, is as likely."""
_ALSO_CARRIED = 0.5
"""How often boxes, baskets and plants lie on other things, which else stand on the floor."""
_BORDER_PX = 3.0
CERTAIN = 0.02
"""Of the likelihood that is spread evenly over all kinds: boxes are drawn by people."""


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
    """A box (x1, y1, x2, y2, pixels) as a camera sees it that is held so."""
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
        cut_bottom=y2 > k.height - _BORDER_PX,
        cut_top=y1 < _BORDER_PX,
        cut_side=x1 < _BORDER_PX or x2 > k.width - _BORDER_PX,
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
        likely = (1.0 - _ALSO_CARRIED) * likely + _ALSO_CARRIED * view.carried * lying
    return likely + CERTAIN


def _standing(view: BoxView, priors: tuple[SizePrior, ...], mount: Mount) -> Float[np.ndarray, "h"]:
    return np.mean(
        [(place_density(view, p, mount) * size_density(view, p, mount)).mean(axis=1) for p in priors], axis=0
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
        return normal(np.maximum(top - _CEILING_M, 0.0) if view.cut_top else top - _CEILING_M, _CEILING_SIGMA_M + sigma)
    if mount == "wall":
        return normal((bottom + top) / 2 - _ON_WALLS_M, _ON_WALLS_SIGMA_M + sigma) * (bottom > 0.0)
    return normal(bottom - _ON_OBJECTS_M, _ON_OBJECTS_SIGMA_M + sigma)


def foot_sigma_m() -> Float[np.ndarray, "d"]:
    """How far from what it stands on a foot may seem to be, for every distance."""
    return _FOOT_SIGMA_M + _FOOT_SIGMA_SHARE * DISTANCES_M


def _depth_seen(view: BoxView, prior: SizePrior) -> float:
    """From above one sees a thing's far edge."""
    return prior.depth_m if view.tan_top < 0 else 0.0


def normal(off: Float[np.ndarray, "h d"], sigma: Float[np.ndarray, "d"] | float) -> Float[np.ndarray, "h d"]:
    """A normal density, but for a constant factor."""
    return np.asarray(np.exp(-0.5 * (off / sigma) ** 2) / sigma)


def _log_normal(size_m: Float[np.ndarray, "d"], usual_m: float, sigma: float, cut: bool) -> Float[np.ndarray, "d"]:
    """Density of the logarithm of a size; smaller ones are as likely where a thing is cut or hidden."""
    off = np.log(size_m / usual_m)
    spread = float(np.hypot(sigma, _VIEW_SIGMA))
    whole = np.exp(-0.5 * (off / spread) ** 2) / spread
    part = ((off < 0) & (off > -_HIDDEN_RANGE)) * np.sqrt(2 * np.pi) / _HIDDEN_RANGE
    share = 0.7 if cut else _HIDDEN_SHARE
    return np.asarray((1 - share) * whole + share * part)
