"""What the picture says about every object: its box, how sure each edge is, and what hides it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.artefacts import DetectedObject
from diorama_core.geometry.casting import camera_rays
from diorama_core.geometry.projection import NEAR_M
from diorama_core.library.taxonomy import Category, category
from diorama_core.models.seen_depth import SeenDepth
from diorama_core.perception.metrology.priors import SizeMode, size_modes
from diorama_core.perception.metrology.problem import UNTOLD, View
from diorama_core.perception.metrology.settings import SETTINGS, BoxObservationSettings, MetrologySettings
from diorama_core.perception.metrology.silhouette import CORNER_EDGES, mask_reach
from diorama_core.scene.types import Camera

_OUTWARD = np.array([-1.0, -1.0, 1.0, 1.0])
HIDDEN_ODDS = np.array([0.06, 0.03, 0.06, 0.12])
"""That an object goes on unseen beyond an edge of its box where nothing speaks for it; see `hidden_odds`."""


@dataclass(frozen=True, eq=False)
class SeenDepths:
    """Depths at which a network sees the objects. Its errors of scale are common to the whole picture, so they are in
    heights of the camera above the floor that it sees."""

    log_height: float
    """Logarithm of that height (m)."""
    height_sigma: float
    """Deviation of this logarithm."""
    log_depth: Float[np.ndarray, "n"]
    """Logarithms of the objects' depths over that height."""
    log_sigma: Float[np.ndarray, "n"]
    """Deviations of these."""


@dataclass(frozen=True, eq=False)
class BoxObservations:
    """All objects of a picture, as arrays over objects."""

    categories: tuple[Category, ...]
    box_px: Float[np.ndarray, "n 4"]
    edge_sigma_px: Float[np.ndarray, "n 4"]
    covered_by: Bool[np.ndarray, "n n 4"]
    """Whether edge e of object i is covered by object j's box, j being in front."""
    in_front: Bool[np.ndarray, "n n"]
    """Whether object j is in front of object i, if both stand on the floor."""
    truncated: Bool[np.ndarray, "n 4"]
    """Whether an edge lies on the picture's border."""
    mask_reach: Float[np.ndarray, "n 4"]
    """How far masks reach into their boxes' corners (`silhouette.mask_reach`)."""
    corner_weight: Float[np.ndarray, "n 4"]
    """Trust in that, 0 where a corner is hidden or cut."""
    mask_exact: Bool[np.ndarray, "n"]
    """Whether the mask is the user's own."""
    before: Float[np.ndarray, "n n"]
    """How much of both sides of object i's lower end is object j, 0 to 1: then i is on j or in front of it."""
    beside: Float[np.ndarray, "n n 4"]
    """Share of the outer side of edge e of object i that is object j's mask."""
    ends_seen: Float[np.ndarray, "n"]
    """Share of the mask's columns that end within the picture and on nothing that is marked: there its foot is seen."""
    meanings: tuple[tuple[tuple[str, float], ...], ...]
    """`DetectedObject.meanings` of every object."""
    settings: MetrologySettings
    depths: SeenDepths | None = None
    """What a depth network sees; None without one."""

    def __len__(self) -> int:
        return len(self.categories)

    def size_modes(self, index: int) -> tuple[SizeMode, ...]:
        """The sizes that an object may have, of its category and of what else its word may mean."""
        return size_modes(self.categories[index].name, self.meanings[index], self.settings.placement)

    def log_depth(self, index: int, camera_height_m: float) -> tuple[float, float]:
        """Logarithm of the depth (m) at which an object is seen, for a height of the camera, and its deviation."""
        if self.depths is None:
            return 0.0, UNTOLD
        return float(self.depths.log_depth[index] + np.log(camera_height_m)), float(self.depths.log_sigma[index])

    def is_hidden(self, index: int, parent: int | None = None) -> Bool[np.ndarray, "4"]:
        """Edges of an object that others hide."""
        return self.hidden_px(index, parent) > 0

    def hidden_px(self, index: int, parent: int | None = None) -> Float[np.ndarray, "4"]:
        """How far beyond each edge of an object others hide what is there.

        What rests on a parent is not hidden by it, nor by things on the floor that are not in front of the parent.
        """
        return self._beyond_edges(index, parent)[0]

    def hidden_odds(self, index: int, parent: int | None = None) -> Float[np.ndarray, "4"]:
        """Odds that an object goes on unseen beyond each edge, by what is drawn and outlined there.

        Of the lower edge the whole lower contour tells: seen at an angle, a thing has its lowest point at one end.
        """
        return self._beyond_edges(index, parent)[1]

    def _beyond_edges(self, index: int, parent: int | None) -> tuple[Float[np.ndarray, "4"], Float[np.ndarray, "4"]]:
        """`hidden_px` and `hidden_odds`, found once: thousands of assumptions about the same objects ask for them."""
        if (index, parent) not in self._beyond_cache:
            others = [j for j in range(len(self)) if j != index and (parent is None or self._may_hide(j, parent))]
            beyond = (self.box_px[others] - self.box_px[index]) * _OUTWARD
            far = np.where(self.covered_by[index][others], beyond, 0.0).max(axis=0, initial=0.0)
            outlined = np.minimum(self.beside[index][others].sum(axis=0), 1.0) if others else np.zeros(4)
            unseen = np.array([1.0, 1.0, 1.0, 1.0 - self.ends_seen[index]])
            raised = np.where(far > 0, self.settings.observed.odds_boxed, 1.0)
            odds = HIDDEN_ODDS * (raised * self.settings.observed.odds_outlined**outlined) ** unseen
            far.setflags(write=False)
            odds.setflags(write=False)
            self._beyond_cache[index, parent] = far, odds
        return self._beyond_cache[index, parent]

    @cached_property
    def _beyond_cache(self) -> dict[tuple[int, int | None], tuple[np.ndarray, np.ndarray]]:
        return {}

    def _may_hide(self, other: int, parent: int) -> bool:
        on_floor = self.categories[other].mount == "floor"
        return other != parent and (not on_floor or bool(self.in_front[parent, other]))


def gather(
    objects: tuple[DetectedObject, ...], width: int, height: int, settings: MetrologySettings = SETTINGS
) -> BoxObservations:
    """The evidence of the objects of a picture of `width` x `height` pixels.

    Args:
        objects: with boxes in pixels and masks of shape (h, w).
        width, height: of the picture, pixels.
        settings: of metrology.
    """
    observed, size = settings.observed, np.array([width, height])
    drawn = np.array([o.box for o in objects], dtype=float).reshape(-1, 4)
    low = np.clip(drawn[:, :2], 0.0, size - observed.min_box_px)
    boxes = np.concatenate([low, np.clip(drawn[:, 2:], low + observed.min_box_px, size)], axis=1)
    extent = np.tile(boxes[:, 2:] - boxes[:, :2], 2)
    sigma = observed.share_sigma * extent + observed.pixel_sigma * max(width, height) / 640
    border = np.array([0.0, 0.0, width, height])
    truncated = np.abs(boxes - border) <= observed.border_share * max(width, height)
    # A box that ends clearly lower is in front, on the same floor.
    in_front = boxes[None, :, 3] > boxes[:, None, 3] + observed.clearly_lower * height
    covered = _find_covered_edges(boxes, in_front, observed)
    unseen = truncated | covered.any(axis=1).reshape(-1, 4)
    exact = np.array([o.mask_confidence >= 1 for o in objects], dtype=bool)
    trust = np.array([o.mask_confidence**2 for o in objects]).reshape(-1, 1)
    trust = trust * np.where(exact, 1.0, observed.guessed_trust)[:, None]
    weight = np.column_stack([np.where(unseen[:, e].any(axis=1), 0.0, 1.0) for e in CORNER_EDGES]) * trust
    reach = np.array([mask_reach(o, b) for o, b in zip(objects, boxes, strict=True)]).reshape(-1, 4)
    return BoxObservations(
        tuple(category(o.category) for o in objects),
        boxes,
        sigma,
        covered,
        in_front,
        truncated,
        reach,
        weight,
        exact,
        _strip_shares(objects, boxes, observed),
        _edge_shares(objects, boxes, observed),
        _ends_seen(objects, observed),
        tuple(o.meanings for o in objects),
        settings,
    )


def observe_depths(
    seen: SeenDepth,
    objects: Sequence[DetectedObject],
    view: View,
    settings: BoxObservationSettings = SETTINGS.observed,
) -> SeenDepths | None:
    """The depths of objects over the camera's height; None where hardly anything below the camera is unmarked.

    Args:
        seen: depth and deviation of every pixel.
        objects: with masks of shape (h, w).
        view: intrinsics, and rotation from camera to world.
        settings: of what is observed.
    """
    if seen.log_sigma is None:
        raise ValueError("the depth is no rough one")
    log_depth = np.log(np.maximum(seen.depth_m, NEAR_M))
    pose = np.eye(4)
    pose[:3, :3] = view.R_world_camera
    below = -camera_rays(Camera(view.intrinsics, pose))[1][..., 2] * np.exp(log_depth)
    marked = np.logical_or.reduce([o.mask for o in objects]) if objects else np.zeros(log_depth.shape, bool)
    free = below[(below > 0) & ~marked]
    if len(free) < settings.least_free * log_depth.size:
        return None
    log_height = float(np.log(np.quantile(free, settings.floor_share)))
    outlined = [o.mask.any() for o in objects]
    depth = [np.median(log_depth[o.mask]) if known else 0.0 for o, known in zip(objects, outlined, strict=True)]
    sigma = [np.median(seen.log_sigma[o.mask]) if known else UNTOLD for o, known in zip(objects, outlined, strict=True)]
    return SeenDepths(log_height, seen.scale_log_sigma, np.array(depth) - log_height, np.array(sigma, dtype=float))


def _strip_shares(
    objects: tuple[DetectedObject, ...], boxes: Float[np.ndarray, "n 4"], settings: BoxObservationSettings
) -> Float[np.ndarray, "n n"]:
    """For objects i and j the share of j's mask in the strips left and right of i's lower end, the emptier side's."""
    n, before = len(boxes), np.zeros((len(boxes), len(boxes)))
    for i in range(n):
        x1, y1, x2, y2 = boxes[i]
        wide, top = max(settings.strip * (x2 - x1), settings.min_box_px), round(y2 - settings.lower_end * (y2 - y1))
        rows = slice(top, max(round(y2), top + 1))
        sides = [slice(max(round(x1 - wide), 0), round(x1)), slice(round(x2), round(x2 + wide))]
        for j in range(n):
            shares = [float(objects[j].mask[rows, side].mean()) for side in sides if objects[j].mask[rows, side].size]
            before[i, j] = min(shares) if i != j and len(shares) == 2 else 0.0
    return before


def _edge_shares(
    objects: tuple[DetectedObject, ...], boxes: Float[np.ndarray, "n 4"], settings: BoxObservationSettings
) -> Float[np.ndarray, "n n 4"]:
    """For objects i and j and edges of i: the share of points just outside the edge that j's mask has."""
    n, beside = len(boxes), np.zeros((len(boxes), len(boxes), 4))
    if not n:
        return beside
    height, width = objects[0].mask.shape
    steps = (np.arange(settings.along) + 0.5) / settings.along
    away = settings.outside_px * max(height, width) / 640
    for i in range(n):
        x1, y1, x2, y2 = boxes[i]
        x, y = x1 + steps * (x2 - x1), y1 + steps * (y2 - y1)
        sides = (
            (np.full(settings.along, x1 - away), y),
            (x, np.full(settings.along, y1 - away)),
            (np.full(settings.along, x2 + away), y),
            (x, np.full(settings.along, y2 + away)),
        )
        for edge, (u, v) in enumerate(sides):
            columns, rows = u.astype(int).clip(0, width - 1), v.astype(int).clip(0, height - 1)
            for j in range(n):
                if j != i:
                    beside[i, j, edge] = float(objects[j].mask[rows, columns].mean())
    return beside


def _ends_seen(objects: tuple[DetectedObject, ...], settings: BoxObservationSettings) -> Float[np.ndarray, "n"]:
    """For every object the share of its mask's columns below which no other mask and no border is; 0 without a mask."""
    ends = np.zeros(len(objects))
    for i, item in enumerate(objects):
        columns = np.flatnonzero(item.mask.any(axis=0))
        if not len(columns):
            continue
        height, width = item.mask.shape
        away = 1 + round(settings.outside_px * max(height, width) / 640)
        below = height - 1 - np.argmax(item.mask[::-1, columns], axis=0) + away
        within = below < height
        rows = np.minimum(below, height - 1)
        others = [other.mask[rows, columns] for j, other in enumerate(objects) if j != i]
        ends[i] = float((within & ~np.any(others, axis=0)).mean()) if others else float(within.mean())
    return ends


def _find_covered_edges(
    boxes: Float[np.ndarray, "n 4"], in_front: Bool[np.ndarray, "n n"], settings: BoxObservationSettings
) -> Bool[np.ndarray, "n n 4"]:
    """For objects i, j and edges: j's box covers at least half of i's edge and is in front."""
    n = len(boxes)
    low, high = boxes[:, None, :2], boxes[:, None, 2:]
    shared = np.minimum(high, boxes[None, :, 2:]) - np.maximum(low, boxes[None, :, :2])
    share = np.clip(shared, 0, None) / (high - low)
    covered = np.zeros((n, n, 4), dtype=bool)
    for edge in range(4):
        across = edge % 2
        at = boxes[:, None, edge]
        strictly_inside = (boxes[None, :, across] < at) & (at < boxes[None, :, across + 2])
        covered[:, :, edge] = strictly_inside & (share[..., 1 - across] >= settings.covered)
    return covered & (in_front & ~np.eye(n, dtype=bool))[..., None]
