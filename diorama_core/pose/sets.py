"""Objects of a set in one picture agree: four dining chairs are four of the same shape and equally large."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import SETS, UNKNOWN
from diorama_core.pose.settings import SETTINGS, PoseSearchSettings


def mix_ranks(
    categories: Sequence[str],
    ranks: Sequence[Mapping[str, float]],
    trust: Sequence[float],
    max_loss: Sequence[float],
    settings: PoseSearchSettings = SETTINGS.search,
) -> list[dict[str, float]]:
    """Each object's log ranks of shapes, mixed with those of objects of its category.

    Args:
        categories: Category of every object; unnamed objects stand alone.
        ranks: For every object its shapes' log ranks, higher is better.
        trust: How well every object is seen: how much it has to say for its group.
        max_loss: By how much the shape agreed on may be ranked below an object's own best before the object goes its
            own way; where this is finite, only objects that come in sets agree at all.

    Returns:
        For every object the same shapes with ranks relative to its best.
    """
    relative = [
        {key: value - max(object_ranks.values()) for key, value in object_ranks.items()} for object_ranks in ranks
    ]
    groups = _groups(categories, relative, settings)
    agreed = []
    for group, object_ranks, name, most in zip(groups, relative, categories, max_loss, strict=True):
        alike = [i for i, other in enumerate(groups) if other == group]
        weight = sum(trust[i] + 1e-3 for i in alike)
        mean = {
            key: sum((trust[i] + 1e-3) * relative[i].get(key, settings.absent) for i in alike) / weight
            for key in object_ranks
        }
        mixed = {
            key: settings.own_share * object_ranks[key] + (1 - settings.own_share) * mean[key] for key in object_ranks
        }
        if name in SETS:
            mixed = _with_the_set(mixed, mean, settings)
        in_sets = most == float("inf") or name in SETS
        agreed.append(
            mixed if in_sets and object_ranks[max(mixed, key=lambda key: mixed[key])] >= -most else dict(object_ranks)
        )
    return agreed


def _with_the_set(
    mixed: Mapping[str, float], mean: Mapping[str, float], settings: PoseSearchSettings
) -> dict[str, float]:
    """The ranks with the set's favourite first, where it is nearly that already; the two change places."""
    best_alone, favourite = (max(sorted(ranks), key=ranks.__getitem__) for ranks in (mixed, mean))
    if mixed[best_alone] - mixed[favourite] >= settings.tie:
        return dict(mixed)
    return {**mixed, favourite: mixed[best_alone], best_alone: mixed[favourite]}


def _groups(categories: Sequence[str], ranks: Sequence[Mapping[str, float]], settings: PoseSearchSettings) -> list[int]:
    """A group number per object: those of one category with mostly the same shapes to choose from."""
    leaders: list[int] = []
    groups = []
    for i, name in enumerate(categories):
        members = [
            g
            for g, j in enumerate(leaders)
            if name == categories[j] and _overlap(ranks[i], ranks[j]) >= settings.overlap
        ]
        alone = name == UNKNOWN.name or not members
        groups.append(len(leaders) if alone else members[0])
        if alone:
            leaders.append(i)
    return groups


def _overlap(a: Mapping[str, float], b: Mapping[str, float]) -> float:
    return len(a.keys() & b.keys()) / len(a.keys() | b.keys())


def equalise_scales(
    categories: Sequence[str],
    shape_ids: Sequence[str],
    scales: Float[np.ndarray, "n 3"],
    trust: Sequence[float],
    settings: PoseSearchSettings = SETTINGS.search,
) -> Float[np.ndarray, "n 3"]:
    """The scale that each object would have were its set of one size; its own where it stands alone.

    Args:
        categories: of every object; only those that come in sets share.
        shape_ids: the shape chosen for every object.
        scales: its scale along the shape's axes.
        trust: how well every object is seen.
    """
    logs, shared = np.log(scales), scales.copy()
    for name in sorted({s for s, c in zip(shape_ids, categories, strict=True) if c in SETS}):
        alike = np.array([i for i, s in enumerate(shape_ids) if s == name and categories[i] in SETS])
        if len(alike) < 2:
            continue
        common = _weighted_median(logs[alike], np.array([trust[i] + 1e-3 for i in alike]))
        near = alike[np.abs(logs[alike] - common).max(axis=1) <= settings.max_log_difference]
        shared[near] = np.exp(common)
    return shared


def _weighted_median(values: Float[np.ndarray, "m k"], weight: Float[np.ndarray, "m"]) -> Float[np.ndarray, "k"]:
    """Per column the value up to which half of the weight lies."""
    order = np.argsort(values, axis=0, kind="stable")
    below = np.cumsum(weight[order], axis=0)
    at = (below >= 0.5 * weight.sum()).argmax(axis=0)
    return np.take_along_axis(values, order, axis=0)[at, np.arange(values.shape[1])]
