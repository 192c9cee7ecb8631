"""Which of the usual units a depth map has, by what the picture says of its scale."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diorama_core.errors import InputError
from diorama_core.perception.inputs.depth.kinds import DepthKind
from diorama_core.perception.inputs.depth.scale import ScaleEvidence

USUAL_UNITS = {
    1.0: "metres", 1000.0: "millimetres", 5000.0: "1/5000 m, as in TUM RGB-D", 4000.0: "1/4000 m",
    256.0: "1/256 m", 100.0: "centimetres", 10000.0: "1/10000 m", 8000.0: "1/8000 m", 500.0: "1/500 m",
    2000.0: "1/2000 m", 10.0: "decimetres", 39.37: "inches", 3.2808: "feet", 6553.5: "1/6553.5 m",
    16777.215: "CARLA's 24 bits", 25.5: "1/25.5 m", 1000000.0: "micrometres",
    512.0: "1/512 m", 128.0: "1/128 m", 200.0: "1/200 m",
    50.0: "1/50 m",
}  # fmt: skip
"""Units per metre of sensors and data sets."""
CONTRADICTED_BY = float(np.log(1.8))
"""Factor beyond which the picture contradicts a unit: rooms of unusual things measure up to 1.5."""
CERTAIN_NATS = 1.2
"""By which one unit must be likelier than all others to be used; otherwise it is asked for."""
TOLERANCE = 0.11
"""Deviation of the evidence's logarithm from the true one, beside its own sigma's half: measured on known rooms."""
MIN_THINGS = 3
USUAL_HEIGHTS_M = (0.9, 2.5)
"""Usual heights of cameras over floors (m): of 26 photos with predicted depth one was higher, none lower."""


@dataclass(frozen=True)
class DepthAnswer:
    """What a person may say of a depth map: its unit, or what its numbers are."""

    words: str
    per_metre: float | None = None
    """Units per metre; None where the file and the picture say."""
    kind: DepthKind = "auto"


class AmbiguousDepthError(InputError):
    """What a depth map holds cannot be told; `choices` are the likely answers."""

    def __init__(self, message: str, choices: tuple[DepthAnswer, ...] = ()) -> None:
        super().__init__(message)
        self.choices = choices


@dataclass(frozen=True)
class DepthUnit:
    """Units per metre, and what to tell."""

    per_metre: float
    note: str = ""
    question: str = ""
    """Why the unit cannot be told, and what to give; empty where it can."""
    choices: tuple[tuple[float, str], ...] = ()
    """Likely units per metre and their words, where it cannot be told."""


def unit_of(evidence: ScaleEvidence | None, stated: float) -> DepthUnit:
    """The unit of a map.

    Args:
        evidence: how many metres a unit is, by the picture; None where it says nothing.
        stated: units per metre that the container has.
    """
    if evidence is None or (evidence.things < MIN_THINGS and not evidence.heights_agree):
        return DepthUnit(stated, _doubtful_height(evidence, stated))
    seen = -evidence.log_scale
    off = abs(seen - np.log(stated))
    if off < CONTRADICTED_BY or off < 3.0 * evidence.sigma:
        return DepthUnit(stated)
    sigma = float(np.hypot(TOLERANCE, evidence.sigma / 2))
    nats = {u: -0.5 * ((seen - np.log(u)) / sigma) ** 2 for u in USUAL_UNITS}
    likely = sorted(nats, key=lambda u: -nats[u])[:2]
    wrong = _words(stated, float(np.exp(seen)) / stated, evidence)
    if nats[likely[0]] < -4.5 and evidence.things < MIN_THINGS:  # a hall, or depth that a network guessed
        return DepthUnit(stated, f"{wrong}; if that is wrong, give its unit by --depth-scale")
    if nats[likely[0]] < -4.5:
        return DepthUnit(stated, question=f"{wrong}; its unit is unknown: give --depth-scale {np.exp(seen):.3g} or so")
    if nats[likely[0]] - nats[likely[1]] < CERTAIN_NATS:
        best, other = likely
        return DepthUnit(
            stated,
            question=f"{wrong}; give --depth-scale {best:g} ({USUAL_UNITS[best]}) or --depth-scale {other:g}",
            choices=tuple((u, USUAL_UNITS[u]) for u in (best, other, stated) if u in USUAL_UNITS),
        )
    best = likely[0]
    return DepthUnit(best, f"{wrong}; it was read as {USUAL_UNITS[best]} (--depth-scale {best:g})")


def _words(stated: float, factor: float, evidence: ScaleEvidence) -> str:
    unit = USUAL_UNITS.get(stated, f"1/{stated:g} m")
    height, room = evidence.floor_height, evidence.room_height
    camera = "" if height is None else f" and the camera {height / stated:.1f} m above the floor"
    times = f"{factor:.1f} times" if factor > 1 else f"1/{1 / factor:.1f} of"
    if evidence.things < MIN_THINGS and room is not None:
        return f"read in {unit}, the room is {room / stated:.1f} m high{camera}"
    return f"read in {unit}, objects have {times} their usual size{camera}"


def _doubtful_height(evidence: ScaleEvidence | None, stated: float) -> str:
    """A note where only the floor says something, and hardly anybody holds a camera so high or low."""
    if evidence is None or evidence.floor_height is None:
        return ""
    height = evidence.floor_height / stated
    if USUAL_HEIGHTS_M[0] <= height <= USUAL_HEIGHTS_M[1]:
        return ""
    return (
        f"by this depth the camera is {height:.1f} m above the floor; if that is wrong, give its unit by --depth-scale"
    )
