"""What holds measured objects before their shapes and the walls are known: by the terms that decide it once they are,
too (`arrangement.support_terms`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.arrangement.support_hypotheses import (
    FARTHEST_WIDTHS,
    OBJECT,
    RIM_SHARE,
    SupportHypothesis,
    ends_within,
    visible_shares_below,
)
from diorama_core.arrangement.support_terms import support_weights
from diorama_core.arrangement.supports import choose_supports
from diorama_core.artefacts import DetectedObject
from diorama_core.library.taxonomy import WITH_BOARDS, Category
from diorama_core.perception.measured.boxes import TurnedExtent
from diorama_core.perception.measured.cloud import SETTINGS, MeasuredSettings
from diorama_core.scene.types import Support, yaw_rotation


def supports_of_boxes(
    objects: tuple[DetectedObject, ...],
    extents: Mapping[str, TurnedExtent],
    categories: Mapping[str, Category],
    depth_m: Float[np.ndarray, "h w"],
    settings: MeasuredSettings = SETTINGS,
) -> tuple[Support, ...]:
    """One edge for each object, to the floor, a wall, the ceiling or another object, such that all together are
    likeliest; never a cycle.

    Args:
        objects: with masks and boxes in the photo.
        extents: measured boxes by object id, in the world (m).
        categories: by object id.
        depth_m: z in camera in metres; 0 where missing.
        settings: usual errors of heights, and what a gap says against a supporter.
    """
    below = visible_shares_below({o.id: o.mask for o in objects})
    hidden = {o.id: rim_occlusion(o.mask, depth_m, settings) for o in objects}
    pictured = {o.id: o.box for o in objects}
    weights = support_weights()
    weights = replace(weights, terms={**weights.terms, "gap": settings.gap_nats})

    def hypotheses(key: str) -> Iterator[SupportHypothesis]:
        extent, kind = extents[key], categories[key]
        bottom = float(extent.low[2])
        above = abs(bottom) * (1.0 - hidden[key]) / settings.gap_m
        yield SupportHypothesis(Support(key, "floor"), "floor", kind, believed=True, gap=above)
        if kind.mount != "surface":  # what people put on furniture is on some that nobody marked, rather than on a wall
            yield SupportHypothesis(Support(key, "wall", "mounted on"), "wall", kind, believed=True)
        if kind.mount == "ceiling":
            yield SupportHypothesis(Support(key, "ceiling", "mounted on"), "ceiling", kind, believed=True)
        for other, carrier in extents.items():
            beside = _distance_beside_m(extent, carrier)
            gap = min(abs(bottom - h) for h in resting_heights(carrier, categories[other], bottom))
            if other == key or beside >= FARTHEST_WIDTHS * float(extent.size[:2].max()):
                continue
            yield SupportHypothesis(
                Support(key, other),
                OBJECT,
                kind,
                categories[other],
                believed=True,
                gap=float(np.hypot(gap, beside)) / settings.gap_m,
                below=below.get(key, {}).get(other, 0.0),
                foot_in_box=ends_within(pictured[key], pictured[other]),
            )

    choices = choose_supports({key: tuple(hypotheses(key)) for key in extents}, weights)
    return tuple(choices[key].edge for key in extents)


def rim_occlusion(
    mask: Bool[np.ndarray, "h w"], depth_m: Float[np.ndarray, "h w"], settings: MeasuredSettings = SETTINGS
) -> float:
    """Share of an object's lower rim that something nearer, or the picture's border, hides.

    Args:
        mask: of the object.
        depth_m: z in camera in metres; 0 where missing.
        settings: how much nearer it must be.
    """
    columns = np.flatnonzero(mask.any(axis=0))
    if not len(columns):
        return 1.0
    height = len(mask)
    lowest = height - 1 - mask[::-1, columns].argmax(axis=0)
    ends = lowest >= np.median(lowest) - 0.25 * max(np.ptp(lowest), 1)  # the underside of a table top is no end
    columns, lowest = columns[ends], lowest[ends]
    under = lowest + max(2, round(RIM_SHARE * height))
    inside = under < height
    above, below = depth_m[np.maximum(lowest - 1, 0), columns], depth_m[np.minimum(under, height - 1), columns]
    nearer = (above > 0) & (below > 0) & (below < above - settings.nearer_m - 0.02 * above)
    return float((nearer | ~inside).mean())


def resting_heights(extent: TurnedExtent, category: Category, bottom_m: float) -> list[float]:
    """Heights of an object's support surfaces: its top, its seat, and its boards, which may be anywhere."""
    heights = [float(extent.high[2])]
    if category.seat_height_m is not None and category.seat_height_m < extent.high[2]:
        heights.append(category.seat_height_m)
    if category.name in WITH_BOARDS and extent.low[2] < bottom_m < extent.high[2]:
        heights.append(bottom_m)
    return heights


def _distance_beside_m(child: TurnedExtent, parent: TurnedExtent) -> float:
    """How far the child's middle is beside the parent's footprint (m)."""
    middle = (child.centre_world @ yaw_rotation(parent.yaw_rad))[:2]
    outside = np.maximum(np.maximum(parent.low[:2] - middle, middle - parent.high[:2]), 0.0)
    return float(np.hypot(*outside))
