"""Things of one shape in one picture have one size where their evidence agrees: four dining chairs are a set."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.scene.types import Pose, Scene, SceneObject

_SURE_LOG = 0.1
"""How far the size of a thing that is seen well may be from its set's and still be a measuring error."""
_UNSURE_LOG = 0.35
"""How much farther that of one that is hardly seen."""
_LEAST_VOICE = 0.05


def sized_by_sets(scene: Scene) -> Scene:
    """The scene with one scale for all things of a kind and shape whose sizes agree; what does not agree is left.

    What stands keeps its base, what is mounted its middle; locked things stay as they are, and say nothing.
    """
    sets: dict[tuple[str, str], list[SceneObject]] = {}
    for item in scene.objects:
        if not item.locked:
            sets.setdefault((item.category, item.shape_id), []).append(item)
    sized: dict[str, SceneObject] = {}
    for members in sets.values():
        scales = np.log([m.pose.scale for m in members])
        agree, common = _agreed(scales, np.array([m.confidence for m in members]))
        for item, of_set in zip(members, agree, strict=True):
            if of_set:
                sized[item.id] = _scaled(scene, item, np.exp(common))
    return replace(scene, objects=tuple(sized.get(o.id, o) for o in scene.objects)) if sized else scene


def _agreed(
    log_scales: Float[np.ndarray, "n 3"], confidence: Float[np.ndarray, " n"]
) -> tuple[Bool[np.ndarray, " n"], Float[np.ndarray, "3"]]:
    """Which members share a size, and its logarithm: the mean of those near the median, the surest counting most."""
    voices = np.clip(confidence, 0.0, 1.0) + _LEAST_VOICE
    middle = np.array([_weighted_median(column, voices) for column in log_scales.T])
    tolerance = _SURE_LOG + _UNSURE_LOG * (1.0 - np.clip(confidence, 0.0, 1.0))
    near = (np.abs(log_scales - middle) <= tolerance[:, None]).all(axis=1)
    if near.sum() < 2:
        return np.zeros(len(near), dtype=bool), middle
    return near, np.average(log_scales[near], axis=0, weights=voices[near])


def _weighted_median(values: Float[np.ndarray, " n"], weights: Float[np.ndarray, " n"]) -> float:
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(weights[order]) / weights.sum()
    return float(values[order][np.searchsorted(reached, 0.5)])


def _scaled(scene: Scene, item: SceneObject, scale: Float[np.ndarray, "3"]) -> SceneObject:
    edge = scene.support_of(item.id)
    position = item.pose.position
    if edge is None or edge.relation == "placed on":
        rise = 0.5 * item.shape_size_m[2] * (scale[2] - item.pose.scale[2])
        position = position + rise * item.pose.R_world_object[:, 2]
    return replace(item, pose=Pose(item.pose.R_world_object, position, scale))
