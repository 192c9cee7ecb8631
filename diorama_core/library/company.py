"""What company kinds keep: what lies on what, and in which rooms things are, as rough counts in homes and offices."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from diorama_core.library.taxonomy import UNKNOWN, category, column, having, lies_on_furniture

CARRIES_AS: Mapping[str, str] = column("carries_as")
"""By carrier, the kind whose loads lie on it. Kinds that are not named lie there now and then if they lie at all."""

CARRIED_KINDS: frozenset[str] = frozenset(column("lies_on"))
"""All that lies on other things now and then, whatever else it stands on."""

STACKED_ON = having("stacked_on")
"""Small things that lie on others and on which others are put."""

WITH_BOARDS = having("has_boards")
"""Furniture in which things are found as well as on it: on boards below its top."""

SELDOM_CARRIED, HARDLY_CARRIED = 0.3, 0.08
"""Ratios for kinds that lie on things and are not named, and for those that stand on floors or hang."""


def often_carried(kind: str, carrier: str) -> float:
    """How many times more often a kind lies on a carrier than it is met at all; 1 where nothing is known of either."""
    if carrier not in CARRIES_AS or kind == UNKNOWN.name:
        return 1.0
    seldom = SELDOM_CARRIED if lies_on_furniture(kind) else HARDLY_CARRIED
    return (category(kind).lies_on or {}).get(CARRIES_AS[carrier], seldom)


ROOMS: Mapping[str, frozenset[str]] = {
    room: frozenset(kind for kind, rooms in column("rooms").items() if room in rooms)
    for room in sorted({room for rooms in column("rooms").values() for room in rooms})
}
"""Kinds that are met more often in a room of a type than elsewhere."""


@cache
def usual_carriers(kind: str) -> tuple[str, ...]:
    """What things of a kind are put on, the likeliest first: where they lie more often than they are met at all."""
    weights = {carrier: often_carried(kind, carrier) for carrier in CARRIES_AS if kind != UNKNOWN.name}
    likely = sorted(
        weights, key=lambda carrier: (-weights[carrier], CARRIES_AS[carrier] != carrier, category(carrier).kin)
    )
    return tuple(carrier for carrier in likely if weights[carrier] > 1.0)


def carrier_in(kind: str, room: str) -> str | None:
    """What a thing of a kind is most likely put on in a room of a type; None for what is not put on furniture."""
    at_home, usual = ROOMS.get(room, frozenset()), column("frequency")
    carriers = [carrier for carrier in usual_carriers(kind) if not category(carrier).kin]
    return max(
        carriers,
        key=lambda carrier: (often_carried(kind, carrier) * (1 + (carrier in at_home)), usual.get(carrier, 0.0)),
        default=None,
    )
