"""What holds measured objects before their shapes and the walls are known: by the terms that decide it once they are,
too (`arrangement.support_terms`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from diorama_core.arrangement.support_hypotheses import (
    FARTHEST_WIDTHS,
    MEASURED,
    OBJECT,
    SupportHypothesis,
    ends_within,
    seen_below,
)
from diorama_core.arrangement.support_terms import fitted_weights
from diorama_core.arrangement.supports import chosen_supports
from diorama_core.artefacts import DetectedObject
from diorama_core.library.taxonomy import WITH_BOARDS, Category
from diorama_core.perception.measured.boxes import TurnedExtent
from diorama_core.perception.measured.cloud import SETTINGS, MeasuredSettings
from diorama_core.scene.frames import UP_WORLD
from diorama_core.scene.types import Camera, Support, yaw_rotation


def supports_of_boxes(
    objects: tuple[DetectedObject, ...],
    extents: Mapping[str, TurnedExtent],
    categories: Mapping[str, Category],
    camera: Camera,
    settings: MeasuredSettings = SETTINGS,
) -> tuple[Support, ...]:
    """One edge for each object, to the floor, a wall, the ceiling or another object, such that all together are
    likeliest; never a cycle.

    Args:
        objects: with masks and boxes in the photo.
        extents: measured boxes by object id, in the world (m).
        categories: by object id.
        camera: in the world; tells how sure positions are.
        settings: from which height on a thing may hang on the ceiling.
    """
    below = seen_below({o.id: o.mask for o in objects})
    pictured = {o.id: o.box for o in objects}

    def hypotheses(key: str) -> Iterator[SupportHypothesis]:
        extent, kind = extents[key], categories[key]
        bottom, top = float(extent.low[2]), float(extent.high[2])
        tolerance = MEASURED.tolerance_m(camera, extent.centre_world, UP_WORLD)
        yield SupportHypothesis(Support(key, "floor"), "floor", kind, believed=True, gap=abs(bottom) / tolerance)
        yield SupportHypothesis(Support(key, "wall", "mounted on"), "wall", kind, believed=True)
        short = max(settings.ceiling_m - top, 0.0) / tolerance
        yield SupportHypothesis(Support(key, "ceiling", "mounted on"), "ceiling", kind, believed=True, gap=short)
        for other, carrier in extents.items():
            beside = _distance_beside_m(extent, carrier)
            if other == key or beside >= FARTHEST_WIDTHS * float(extent.size[:2].max()):
                continue
            gap = min(abs(bottom - h) for h in resting_heights(carrier, categories[other], bottom))
            yield SupportHypothesis(
                Support(key, other),
                OBJECT,
                kind,
                categories[other],
                believed=True,
                gap=float(np.hypot(gap, beside)) / tolerance,
                below=below.get(key, {}).get(other, 0.0),
                foot_in_box=ends_within(pictured[key], pictured[other]),
            )

    choices = chosen_supports({key: tuple(hypotheses(key)) for key in extents}, fitted_weights())
    return tuple(choices[key].edge for key in extents)


def resting_heights(extent: TurnedExtent, category: Category, bottom_m: float) -> list[float]:
    """Heights of an object's support surfaces: its top, its seat, and its boards, which may be anywhere.

    Args:
        extent: of the object.
        category: of the object.
        bottom_m: of what may rest on it.
    """
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
