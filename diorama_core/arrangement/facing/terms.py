"""What speaks for headings, whatever the picture shows: each term is one small function with a fitted weight.
`weights.json` beside this module says how the weights were fitted and what leaving each out costs.

A term gives every heading of an object (or every pair of headings of two objects) an agreement of at most 1; its
weight, fitted by `python -m diorama_core.training facings`, makes nats of it.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.facing.evidence import HEADINGS, FacingRoom, unit
from diorama_core.library.taxonomy import broad, having, with_kin

PATH = Path(__file__).with_name("weights.json")


@dataclass(frozen=True)
class FacingWeights:
    """Nats of every term's agreement (`terms.TERMS`); of the picture, a factor of its log-likelihood."""

    picture: float
    shown_seats: float
    shown_sofas: float
    shown_storage: float
    shown_screens: float
    shown_others: float
    at_table: float
    at_user: float
    back_at_wall: float
    back_at_wall_others: float
    out_of_wall: float
    as_told: float
    leaning: float
    at_middle: float
    as_carrier: float
    side_by_side: float
    as_bed: float

    def weight_of(self, term: str) -> float:
        """The weight of a term."""
        return float(getattr(self, term))


@cache
def facing_weights() -> FacingWeights:
    """The fitted weights."""
    return FacingWeights(**json.loads(PATH.read_text(encoding="utf-8"))["weights"])


Agreement = Float[np.ndarray, "24"]
PairAgreement = Float[np.ndarray, "24 24"]

SEATS = having("drawn_up")
LOUNGE = with_kin("sofa", "armchair")
LOW_TABLES = with_kin("coffee table")
TABLES = having("legroom") - LOW_TABLES | with_kin("piano")
SCREENS = having("screen") | with_kin("laptop")
INPUTS = frozenset({"keyboard", "mouse"})
STORAGE = having("stores")
BEDS = with_kin("bed")
SHOWN = frozenset({"towel", "trash can"})
"""What is folded, or has a lid, shows its front."""
NO_FRONT = having("no_front") - with_kin("pillow") - SHOWN
"""Set down any way round."""
AT_TABLE_M, AT_LOW_TABLE_M = 0.9, 1.6
"""Gaps within which a seat is drawn up to a table, as people pull chairs out and legs need room."""
COMPANY_M = 4.0
"""Within which a television has its viewers: across a living room."""
BESIDE_M = 0.5
"""Gaps within which things stand side by side."""
WALL_REACH_M, WALL_BESIDE_M, WALL_FADES_M = 0.7, 3.0, 0.4
"""Within which a wall is behind an object, to either side of it, and the gap at which it says a third as much."""
MIN_WALL_SAMPLES = 10


@dataclass(frozen=True)
class Term:
    """One reason to face somewhere; agreements of single objects, of pairs, or both."""

    name: str
    """Its field of `FacingWeights`."""
    sentence: str
    one: Callable[[FacingRoom, int], Agreement | None] | None = None
    pair: Callable[[FacingRoom, int, int], PairAgreement | None] | None = None


def heading_cosine(room: FacingRoom, i: int, direction: Float[np.ndarray, "2"]) -> Agreement:
    """Cosine between each heading and a direction."""
    return np.asarray(room.objects[i].directions @ direction)


def camera_agreement(kinds: frozenset[str] | None) -> Callable[[FacingRoom, int], Agreement | None]:
    """Photos show fronts of some kinds: away from the camera is unlikely, sideways hardly less so than toward it."""

    def one(room: FacingRoom, i: int) -> Agreement | None:
        kind = room.objects[i].kind
        if kind not in kinds if kinds is not None else kind in SEATS | STORAGE | SCREENS | LOUNGE | NO_FRONT:
            return None
        cosine = heading_cosine(room, i, room.camera_direction(i))
        return 0.25 * cosine + 0.75 * np.minimum(cosine, 0.0)

    return one


def at_table(room: FacingRoom, i: int) -> Agreement | None:
    """A seat faces the table or desk that it is drawn up to, square to the side where it stands."""
    if room.objects[i].kind not in SEATS | LOUNGE:
        return None
    table = room.nearest(i, TABLES if room.objects[i].kind in SEATS else LOW_TABLES, _table_reach_m(room, i))
    return None if table is None else heading_cosine(room, i, square_to(room, i, table))


def _table_reach_m(room: FacingRoom, i: int) -> float:
    return AT_TABLE_M if room.objects[i].kind in SEATS else AT_LOW_TABLE_M


def square_to(room: FacingRoom, i: int, table: int) -> Float[np.ndarray, "2"]:
    """From an object to a table, across the side of the table beside which it stands; aslant at a corner."""
    other = room.objects[table]
    offset = other.centre[:2] - room.objects[i].centre[:2]
    local = other.axes[:2] @ offset
    beyond = np.sign(local) * np.maximum(np.abs(local) - 0.5 * other.size_m[:2], 0.0)
    if not beyond.any():
        share = np.abs(local) / np.maximum(other.size_m[:2], 1e-6)
        beyond = np.where(share == share.max(), local, 0.0)
    return unit(beyond @ other.axes[:2])


def at_user(room: FacingRoom, i: int) -> Agreement | None:
    """A screen faces the keyboard before it, or the nearest seat."""
    item = room.objects[i]
    if item.kind not in SCREENS or item.carrier is None:
        return None
    keyboards = room.loads(item.carrier, INPUTS) or room.loads(i, INPUTS)
    user = min(keyboards, key=lambda j: float(np.linalg.norm(room.objects[j].centre - item.centre)), default=None)
    if user is None:
        seats = LOUNGE | BEDS if item.kind == "television" else SEATS
        user = room.nearest(i, seats, COMPANY_M if item.kind == "television" else AT_LOW_TABLE_M)
    return None if user is None else heading_cosine(room, i, unit(room.objects[user].centre[:2] - item.centre[:2]))


def back_at_wall(kinds: frozenset[str] | None) -> Callable[[FacingRoom, int], Agreement | None]:
    """The back is at a wall that is seen, less so the farther it is from there."""

    def one(room: FacingRoom, i: int) -> Agreement | None:
        item = room.objects[i]
        if item.kind in NO_FRONT | SCREENS | SEATS or (item.kind in STORAGE | BEDS) != (kinds is not None):
            return None
        agreement = sum(
            (_wall_behind(room, i, axis) * (item.directions @ axis) for axis in item.axes), np.zeros(HEADINGS)
        )
        return agreement / max(1.0, float(np.abs(agreement).max()))

    return one


def _wall_behind(room: FacingRoom, i: int, direction: Float[np.ndarray, "2"]) -> float:
    """How near a wall is behind an object that faces in a direction, 0 to 1."""
    item = room.objects[i]
    offset = room.walls.points_xy - (item.centre[:2] - direction * item.reach_m(direction))
    gap = -(offset @ direction)
    side = np.abs(offset @ np.array([-direction[1], direction[0]]))
    near = (room.walls.normals_xy @ direction > 0.9) & (gap > -0.3) & (gap < WALL_REACH_M) & (side < WALL_BESIDE_M)
    return float(np.exp(-np.abs(np.median(gap[near])) / WALL_FADES_M)) if near.sum() >= MIN_WALL_SAMPLES else 0.0


def out_of_wall(room: FacingRoom, i: int) -> Agreement | None:
    """What hangs on a wall looks out of it."""
    direction = room.objects[i].out_of_wall
    return None if direction is None else heading_cosine(room, i, direction)


def as_measured(room: FacingRoom, i: int) -> Agreement | None:
    """What was told of its front holds."""
    return heading_cosine(room, i, room.objects[i].axes[0]) if room.objects[i].front_known else None


def leaning(room: FacingRoom, i: int) -> Agreement | None:
    """Pillows lean on the head of a bed, or on the back of a seat: across its length, to the camera's side."""
    item = room.objects[i]
    if item.kind != "pillow" or item.carrier is None:
        return None
    carrier = room.objects[item.carrier]
    on_bed = carrier.kind in BEDS
    long = int(np.argmax(carrier.size_m[:2]))
    axis = carrier.axes[long if on_bed else 1 - long]
    inward = carrier.centre[:2] - item.centre[:2] if on_bed else room.camera_direction(i)
    return heading_cosine(room, i, axis if axis @ inward >= 0 else -axis)


def at_middle(room: FacingRoom, i: int) -> Agreement | None:
    """Furniture faces the middle of what is in the room; seats face what they serve."""
    item = room.objects[i]
    if len(room.objects) < 3 or item.carrier is not None or item.kind in NO_FRONT | SEATS | LOUNGE:
        return None
    middle = np.mean([o.centre[:2] for o in room.objects], axis=0) - item.centre[:2]
    return heading_cosine(room, i, unit(middle)) if np.linalg.norm(middle) > 0.3 else None


def as_carrier(room: FacingRoom, i: int, j: int) -> PairAgreement | None:
    """What stands on furniture with a front faces as that does; books show their spines."""
    child, parent = room.objects[i], room.objects[j]
    if child.carrier != j or child.kind in NO_FRONT | {"pillow"} or parent.kind in NO_FRONT:
        return None
    return np.asarray(child.directions @ parent.directions.T)


def side_by_side(room: FacingRoom, i: int, j: int) -> PairAgreement | None:
    """Things of a kind side by side face alike: chairs in a row, monitors on a desk, cabinets along a wall."""
    a, b = room.objects[i], room.objects[j]
    alike = broad(a.kind) == broad(b.kind) or (a.kind in STORAGE and b.kind in STORAGE)
    if not alike or a.kind in NO_FRONT or i > j or room.gap_m(i, j) > BESIDE_M or a.carrier != b.carrier:
        return None
    offset = unit(b.centre[:2] - a.centre[:2])
    beside = np.sqrt(np.outer(1 - (a.directions @ offset) ** 2, 1 - (b.directions @ offset) ** 2))
    return np.asarray(beside * (a.directions @ b.directions.T))


def as_bed(room: FacingRoom, i: int, j: int) -> PairAgreement | None:
    """A night stand faces as the bed beside it."""
    a, b = room.objects[i], room.objects[j]
    if a.kind != "night stand" or b.kind not in BEDS or room.gap_m(i, j) > BESIDE_M:
        return None
    return np.asarray(a.directions @ b.directions.T)


TERMS: tuple[Term, ...] = (
    Term("shown_seats", "photos show fronts of seats", camera_agreement(SEATS)),
    Term("shown_sofas", "photos show fronts of sofas and armchairs", camera_agreement(LOUNGE)),
    Term("shown_storage", "photos show fronts of cupboards", camera_agreement(STORAGE)),
    Term("shown_screens", "screens face who looks at them", camera_agreement(SCREENS)),
    Term("shown_others", "photos show fronts", camera_agreement(None)),
    Term("at_table", "seats face the table that they are drawn up to", at_table),
    Term("at_user", "screens face the keyboard or seat that uses them", at_user),
    Term("back_at_wall", "cupboards and beds turn their backs to a wall", back_at_wall(STORAGE | BEDS)),
    Term("back_at_wall_others", "backs are at walls", back_at_wall(None)),
    Term("out_of_wall", "what hangs on a wall looks out of it", out_of_wall),
    Term("as_told", "the front was given", as_measured),
    Term("leaning", "pillows lean on the back of what they lie on", leaning),
    Term("at_middle", "furniture faces the middle of the room", at_middle),
    Term("as_carrier", "what stands on furniture faces as that does", pair=as_carrier),
    Term("side_by_side", "objects of a kind side by side face the same way", pair=side_by_side),
    Term("as_bed", "a night stand faces as its bed", pair=as_bed),
)


def pairs_of(room: FacingRoom, term: Term) -> Iterator[tuple[int, int, PairAgreement]]:
    """All pairs of objects about which a term says something, with their agreements."""
    if term.pair is None:
        return
    count = len(room.objects)
    for i in range(count):
        for j in range(count):
            agreement = term.pair(room, i, j) if i != j else None
            if agreement is not None:
                yield i, j, agreement
