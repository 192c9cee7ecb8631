"""What is known of a model beforehand, and the names of axes and units."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Int

from diorama_core.errors import InputError
from diorama_core.io.bounded import shorten
from diorama_core.library import taxonomy

AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
UNITS = {1.0: "metres", 0.01: "centimetres", 0.001: "millimetres", 0.0254: "inches", 0.3048: "feet"}


@dataclass(frozen=True)
class Given:
    """What is known of a model beforehand, from flags, a table or a data set; None is guessed."""

    up: str | None = None
    """Axis of the file that points up, such as `+y`."""
    front: str | None = None
    unit_m: float | None = None
    """Metres in one unit of the file."""
    category: str | None = None
    caption: str = ""
    synonyms: tuple[str, ...] = ()
    source: str = ""
    licence: str = ""
    reason: str = "given"
    """Who says so, for the record."""

    def __post_init__(self) -> None:
        for name in ("up", "front"):
            value = getattr(self, name)
            if value is not None and value not in AXES:
                raise InputError(f"{name} axis {value!r}: choose one of {', '.join(AXES)}")
        if self.up is not None and self.front is not None and self.up[1] == self.front[1]:
            raise InputError(f"up {self.up} and front {self.front} lie along one axis; they must be at right angles")
        if self.unit_m is not None and not 1e-9 < self.unit_m < 1e9:
            raise InputError(f"unit {self.unit_m}: give the metres in one unit of the file, such as 0.01")
        if self.category is not None and not taxonomy.resolve(self.category).exact:
            name = shorten(self.category, 60)
            raise InputError(f"category {name!r} is not known; {taxonomy.resolve(name).note}")

    def override(self, other: Given) -> Given:
        """The other, overridden by what this states."""
        stated = {k: v for k, v in vars(self).items() if v not in (None, "", ()) and k != "reason"}
        speakers = [g.reason for g in (self, other) if (g.up or g.front or g.unit_m or g.category) is not None]
        return replace(other, **stated, reason=" and ".join(dict.fromkeys(speakers)) or self.reason)


def axis_vector(axis: str) -> Int[np.ndarray, "3"]:
    """`-y` as a vector."""
    vector = np.zeros(3, dtype=int)
    vector["xyz".index(axis[1])] = 1 if axis[0] == "+" else -1
    return vector


def axis_name(vector: Int[np.ndarray, "3"]) -> str:
    """A unit vector along an axis as `-y`."""
    axis = int(np.abs(vector).argmax())
    return ("+" if vector[axis] > 0 else "-") + "xyz"[axis]
