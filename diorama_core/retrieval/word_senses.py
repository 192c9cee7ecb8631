"""Which kind a loose word means, by where its box is in the picture and how large the thing would be there.

"Lamp" is said of lamps on tables, floors, walls and ceilings, "table" of desks and of coffee tables, and geometry needs
to know which before it can measure anything. Every kind that a word may mean is set at many distances; where its foot
or its top would be, and its size, are compared with what such things usually have. The camera's height is inferred from
all boxes together, on a grid: given the height, boxes are taken to be independent (naive Bayes). What the picture of a
thing looks like joins in where that is known, and then what lies on what and the type of the room (`kinds_together`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import CameraEstimate, DetectedObject
from diorama_core.library.company import CARRIED_KINDS
from diorama_core.library.hyponyms import is_named, meanings
from diorama_core.library.labels import names_a_kind
from diorama_core.library.taxonomy import UNKNOWN, Mount, SizePrior, category
from diorama_core.retrieval.kinds_together import carriers, kinds_together
from diorama_core.retrieval.seen_kinds import as_it_looks
from diorama_core.scene.types import Intrinsics

_HEIGHTS_M = np.linspace(0.7, 2.2, 16)
_USUAL_HEIGHT_M, _HEIGHT_SIGMA_M = 1.45, 0.3
"""Of cameras above the floor."""
_MEASURED_SIGMA_M = 0.15
_DISTANCES_M = np.geomspace(0.7, 9.0, 48)
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
_UNSUPPORTED, _INSIDE = 0.15, 0.5
"""How likely a thing lies on another one where no box is below it, and where one is all around it."""
_ALSO_CARRIED = 0.5
"""How often boxes, baskets and plants lie on other things, which else stand on the floor."""
_BORDER_PX = 3.0
_SWITCH = 1.5
"""How many times likelier it must be that a thing is held otherwise than its word says before geometry takes it so."""
_MAJORITY = 0.5
"""How likely another kind that is held alike must be: a wrong one's narrow size would spoil the whole room's scale."""
_SURE = 0.4
"""How likely a kind must be before geometry takes a thing without a name for it."""
_CERTAIN = 0.02
"""Of the likelihood that is spread evenly over all kinds: boxes are drawn by people."""


@dataclass(frozen=True, eq=False)
class _View:
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


def with_word_senses(objects: tuple[DetectedObject, ...], camera: CameraEstimate) -> tuple[DetectedObject, ...]:
    """The objects, those whose word is used loosely with the category that it most probably means here.

    Where a thing is held decides first, over all kinds that are held there. Among kinds that are held as the word says
    its own category stays unless another one is likelier than all others together: retrieval compares them later.
    A word that is no kind's name ("stand") means the likeliest.
    """
    best = camera.best
    senses = sense_probabilities(objects, best.intrinsics, best.R_world_camera, camera.height_m)
    return tuple(
        replace(item, category=_chosen(item, of_word), meanings=_listed(of_word))
        for item, of_word in zip(objects, senses, strict=True)
    )


def _listed(senses: Mapping[str, float]) -> tuple[tuple[str, float], ...]:
    """Several senses, likeliest first."""
    return tuple(sorted(senses.items(), key=lambda pair: (-pair[1], pair[0]))) if len(senses) > 1 else ()


def sense_probabilities(
    objects: Sequence[DetectedObject],
    intrinsics: Intrinsics,
    R_world_camera: Float[np.ndarray, "3 3"],
    height_m: float | None = None,
) -> list[Mapping[str, float]]:
    """For every object the kinds its word may mean, with probabilities that the boxes leave them.

    Args:
        objects: of one photo; for one without a name its category is the only one.
        intrinsics: of the photo's camera.
        R_world_camera: how it is held; world +Z is up.
        height_m: of the camera above the floor, where that is known.
    """
    below = carriers([item.box for item in objects])
    views = [
        _view(item, _carried(item, objects, on), intrinsics, R_world_camera)
        for item, on in zip(objects, below, strict=True)
    ]
    senses = [
        as_it_looks(meanings(item.label, item.category), item.looks_like, is_named(item.label)) for item in objects
    ]
    likely = [{kind: _likelihood(view, kind) for kind in of_word} for view, of_word in zip(views, senses, strict=True)]
    usual, sigma = (_USUAL_HEIGHT_M, _HEIGHT_SIGMA_M) if height_m is None else (height_m, _MEASURED_SIGMA_M)
    said = [-0.5 * ((_HEIGHTS_M - np.clip(usual, _HEIGHTS_M[0], _HEIGHTS_M[-1])) / sigma) ** 2]
    for of_word, of_view in zip(senses, likely, strict=True):
        said.append(np.log(sum(share * of_view[kind] for kind, share in of_word.items())))
    log_height = np.sort(np.stack(said), axis=0).sum(axis=0)  # the order of the objects must not show in a bit
    height = np.exp(log_height - log_height.max())
    found: list[Mapping[str, float]] = []
    for of_word, of_view in zip(senses, likely, strict=True):
        mixed = sum(share * of_view[kind] for kind, share in of_word.items())  # the others' say on the height
        posterior = {kind: share * float((height * of_view[kind] / mixed).sum()) for kind, share in of_word.items()}
        whole = sum(posterior.values())
        found.append({kind: value / whole for kind, value in posterior.items()})
    return kinds_together(found, below)


def _chosen(item: DetectedObject, senses: Mapping[str, float]) -> str:
    own, named = item.category, is_named(item.label)
    if own == UNKNOWN.name or (named and not names_a_kind(item.label)):
        best = max(senses, key=lambda kind: senses[kind])
        return best if named or senses[best] > _SURE else own
    mounts: dict[Mount, float] = {}
    for kind, share in senses.items():
        mount = category(kind).mount
        mounts[mount] = mounts.get(mount, 0.0) + share
    mount = max(mounts, key=mounts.__getitem__)
    if mounts[mount] <= _SWITCH * mounts.get(category(own).mount, 0.0):
        mount = category(own).mount
    best = max((kind for kind in senses if category(kind).mount == mount), key=lambda kind: senses[kind])
    return best if mount != category(own).mount or senses[best] > _MAJORITY else own


def _carried(item: DetectedObject, objects: Sequence[DetectedObject], inside: int | None) -> float:
    if any(_stands_on(other.box, item.box) for other in objects if other is not item):
        return 1.0
    return _UNSUPPORTED if inside is None else _INSIDE


def _stands_on(below: tuple[float, float, float, float], box: tuple[float, float, float, float]) -> bool:
    """Whether a box's foot is over another one that begins lower than it."""
    x, slack = (box[0] + box[2]) / 2, 0.1 * (box[3] - box[1])
    return below[0] <= x <= below[2] and box[1] < below[1] <= box[3] + slack <= below[3] + slack


def _view(item: DetectedObject, carried: float, k: Intrinsics, R_world_camera: Float[np.ndarray, "3 3"]) -> _View:
    x1, y1, x2, y2 = item.box
    middle_x, middle_y = (x1 + x2) / 2, (y1 + y2) / 2
    pixels = np.array([[middle_x, y2], [middle_x, y1], [x1, middle_y], [x2, middle_y]])
    rays = np.column_stack([(pixels[:, 0] - k.cx) / k.fx, (pixels[:, 1] - k.cy) / k.fy, np.ones(4)])
    rays = rays @ R_world_camera.T
    rays = rays / np.maximum(np.linalg.norm(rays[:, :2], axis=1, keepdims=True), 1e-6)
    return _View(
        tan_bottom=float(rays[0, 2]),
        tan_top=float(rays[1, 2]),
        width=float(np.linalg.norm(rays[2, :2] - rays[3, :2])),
        cut_bottom=y2 > k.height - _BORDER_PX,
        cut_top=y1 < _BORDER_PX,
        cut_side=x1 < _BORDER_PX or x2 > k.width - _BORDER_PX,
        carried=carried,
    )


def _likelihood(view: _View, kind: str) -> Float[np.ndarray, "h"]:
    """How likely such a box is for a kind, for every camera height: over all distances and the kind's modes."""
    entry = category(kind)
    likely = np.mean([_of_size(view, prior, entry.mount) for prior in entry.priors], axis=0)
    if entry.mount == "surface":
        likely = likely * view.carried
    elif entry.mount == "floor" and kind in CARRIED_KINDS:
        lying = np.mean([_of_size(view, prior, "surface") for prior in entry.priors], axis=0)
        likely = (1.0 - _ALSO_CARRIED) * likely + _ALSO_CARRIED * view.carried * lying
    return likely + _CERTAIN


def _of_size(view: _View, prior: SizePrior, mount: str) -> Float[np.ndarray, "h"]:
    camera, distance = _HEIGHTS_M[:, None], _DISTANCES_M[None]
    bottom = camera + distance * view.tan_bottom
    beyond = np.where(view.tan_top < 0, prior.depth_m, 0.0)  # from above one sees a thing's far edge
    top = camera + (distance + beyond) * view.tan_top
    height, width = np.maximum(top - bottom, 0.01), np.maximum(distance * view.width, 0.01)
    across = 0.5 * (prior.width_m + prior.depth_m) if mount != "wall" else prior.width_m
    place = _place(mount, bottom, top, distance, view)
    tall = _log_normal(height, prior.height_m, prior.sigma_height, view.cut_bottom or view.cut_top)
    wide = _log_normal(width, across, prior.sigma_width, view.cut_side)
    return np.asarray((place * tall * wide).mean(axis=1))


def _place(
    mount: str,
    bottom: Float[np.ndarray, "h d"],
    top: Float[np.ndarray, "h d"],
    distance: Float[np.ndarray, "1 d"],
    view: _View,
) -> Float[np.ndarray, "h d"]:
    """How usual it is for a thing that is so mounted to be at such a height; densities over height in metres."""
    sigma = _FOOT_SIGMA_M + _FOOT_SIGMA_SHARE * distance
    if mount == "floor":
        return _normal(np.minimum(bottom, 0.0) if view.cut_bottom else bottom, sigma)
    if mount == "ceiling":
        return _normal(
            np.maximum(top - _CEILING_M, 0.0) if view.cut_top else top - _CEILING_M, _CEILING_SIGMA_M + sigma
        )
    if mount == "wall":
        return _normal((bottom + top) / 2 - _ON_WALLS_M, _ON_WALLS_SIGMA_M + sigma) * (bottom > 0.0)
    return _normal(bottom - _ON_OBJECTS_M, _ON_OBJECTS_SIGMA_M + sigma)


def _normal(off: Float[np.ndarray, "h d"], sigma: Float[np.ndarray, "1 d"] | float) -> Float[np.ndarray, "h d"]:
    return np.asarray(np.exp(-0.5 * (off / sigma) ** 2) / sigma)


def _log_normal(size_m: Float[np.ndarray, "h d"], usual_m: float, sigma: float, cut: bool) -> Float[np.ndarray, "h d"]:
    """Density of the logarithm of a size; smaller ones are as likely where a thing is cut or hidden."""
    off = np.log(size_m / usual_m)
    spread = float(np.hypot(sigma, _VIEW_SIGMA))
    whole = np.exp(-0.5 * (off / spread) ** 2) / spread
    part = ((off < 0) & (off > -_HIDDEN_RANGE)) * np.sqrt(2 * np.pi) / _HIDDEN_RANGE
    share = 0.7 if cut else _HIDDEN_SHARE
    return np.asarray((1 - share) * whole + share * part)
