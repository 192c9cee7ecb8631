"""Reading a placement: which way the object faces and how sure its cuboid is."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import UNKNOWN, Category
from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.placement import FLOOR, WALL, Placement
from diorama_core.perception.metrology.settings import SETTINGS, HeightScanSettings


def heading_and_size(
    placement: Placement, category: Category, settings: HeightScanSettings = SETTINGS.heights
) -> tuple[float, Float[np.ndarray, "3"]]:
    """Heading of the front and extents (depth, width, height).

    The front faces the camera as far as the axes allow; where width and depth look alike in the category, it may be
    any of the four sides.
    """
    box = placement.cuboid
    yaw, size = float(box.yaw_rad[0]), box.size_m[0]
    if placement.supporter == WALL:
        return yaw, size
    prior = category.priors[0].log_median_xyz
    free = category is UNKNOWN or abs(prior[0] - prior[1]) < settings.square
    turns = (0.0, np.pi / 2, np.pi, -np.pi / 2) if free else (0.0, np.pi)
    to_camera = -box.centre[0, :2]
    facing = [np.cos(yaw + turn) * to_camera[0] + np.sin(yaw + turn) * to_camera[1] for turn in turns]
    best = int(np.argmax(facing))
    if turns[best] in (np.pi / 2, -np.pi / 2):
        size = size[[1, 0, 2]]
    turned = yaw + turns[best]
    return float(np.arctan2(np.sin(turned), np.cos(turned))), size


def foot_seen(
    placement: Placement, observations: BoxObservations, settings: HeightScanSettings = SETTINGS.heights
) -> bool:
    """Whether the lower end of an object is seen, as far as it tells how far away the object is: on the floor."""
    index = placement.index
    hidden = observations.truncated[index][3] or observations.hidden_odds(index)[3] > settings.may_be_hidden
    return placement.supporter != FLOOR or not hidden


def confidence_of(
    placement: Placement,
    observations: BoxObservations,
    height_log_sigma: float,
    settings: HeightScanSettings = SETTINGS.heights,
) -> float:
    """Between 0 and 1: low for implausible sizes, bad fits, hidden or cut boxes, and an unsure camera height.

    Args:
        placement: of one object.
        observations: of all objects.
        height_log_sigma: standard deviation of the logarithm of the camera's height.
        settings: of confidences.
    """
    index = placement.index
    parent = placement.supporter if placement.supporter >= 0 else None
    unseen = int((observations.hidden(index, parent) | observations.truncated[index]).sum())
    fit = np.exp(-placement.cost / settings.cost_scale)
    return float(np.clip(fit * settings.hidden_factor**unseen * np.exp(-height_log_sigma), 0.02, 1.0))
