"""Objects of a kind in one picture agree on their shape: four dining chairs are four of the same."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from diorama_core.library.taxonomy import UNKNOWN, having

_OWN_SHARE = 0.35
_ABSENT = -0.7
_OVERLAP = 0.5
_TIE = 0.15
"""Two shapes whose log ranks differ by less are as good for one thing of a set: then it takes what the set likes."""
MAX_LOSS_WITH_DEPTH = 1.0
"""Maximum cost of agreement where depth was measured, since depth shows when objects differ."""
MAX_LOSS_OF_SURE_OUTLINES = 1.0
"""And of things that come in no sets where their masks are sure: these show it, too."""
MAX_LOSS_WHERE_COLOURS_TELL = 0.5
"""And of things that are told from what is seen through and past them."""
SETS = having("in_sets")
"""What comes in sets; books and pictures of one room are different ones."""


def agreed_ranks(
    categories: Sequence[str],
    ranks: Sequence[Mapping[str, float]],
    trust: Sequence[float],
    max_loss: Sequence[float],
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
    relative = [{key: value - max(own.values()) for key, value in own.items()} for own in ranks]
    groups = _groups(categories, relative)
    agreed = []
    for group, own, name, most in zip(groups, relative, categories, max_loss, strict=True):
        alike = [i for i, other in enumerate(groups) if other == group]
        weight = sum(trust[i] + 1e-3 for i in alike)
        mean = {key: sum((trust[i] + 1e-3) * relative[i].get(key, _ABSENT) for i in alike) / weight for key in own}
        mixed = {key: _OWN_SHARE * own[key] + (1 - _OWN_SHARE) * mean[key] for key in own}
        if name in SETS:
            mixed = _with_the_set(mixed, mean)
        in_sets = most == float("inf") or name in SETS
        agreed.append(mixed if in_sets and own[max(mixed, key=lambda key: mixed[key])] >= -most else dict(own))
    return agreed


def _with_the_set(mixed: Mapping[str, float], mean: Mapping[str, float]) -> dict[str, float]:
    """The ranks with the set's favourite first, where it is nearly that already; the two change places."""
    own, favourite = (max(sorted(ranks), key=ranks.__getitem__) for ranks in (mixed, mean))
    if mixed[own] - mixed[favourite] >= _TIE:
        return dict(mixed)
    return {**mixed, favourite: mixed[own], own: mixed[favourite]}


def _groups(categories: Sequence[str], ranks: Sequence[Mapping[str, float]]) -> list[int]:
    """A group number per object: those of one category with mostly the same shapes to choose from."""
    leaders: list[int] = []
    groups = []
    for i, name in enumerate(categories):
        found = [g for g, j in enumerate(leaders) if name == categories[j] and _overlap(ranks[i], ranks[j]) >= _OVERLAP]
        alone = name == UNKNOWN.name or not found
        groups.append(len(leaders) if alone else found[0])
        if alone:
            leaders.append(i)
    return groups


def _overlap(a: Mapping[str, float], b: Mapping[str, float]) -> float:
    return len(a.keys() & b.keys()) / len(a.keys() | b.keys())
