"""The curves and the report of one optimisation, as the panels show them."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from diorama_core.artefacts import LayoutReport
from diorama_core.scene.types import Scene

Costs = Sequence[tuple[str, float]]
Samples = list[tuple[float, tuple[tuple[str, float], ...]]]
"""Seconds since the start, and every cost then; only ever appended to."""


@dataclass
class LayoutRun:
    """One run, while it lasts and after. Used from the UI thread, except for `going`."""

    recipe: str
    started_at: float
    start: Scene
    only: tuple[str, ...] = ()
    """Ids that were free to move; everything unlocked that no person placed when empty."""
    left: int = 0
    """How many objects stayed because a person placed them."""
    times_s: list[float] = field(default_factory=list)
    costs: dict[str, list[float]] = field(default_factory=dict)
    report: LayoutReport | None = None
    final: Scene | None = None
    """What was committed."""
    worse: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Problems that objects have after the run and did not have before it, by id."""
    showing_before: bool = False
    drawn_at: float = 0.0
    """When its curves were drawn last while it ran, on the monotonic clock."""
    going: threading.Event = field(default_factory=threading.Event)
    """Clear while the run pauses."""

    def __post_init__(self) -> None:
        self.going.set()

    @property
    def is_paused(self) -> bool:
        """Whether the run is paused."""
        return not self.going.is_set()

    def read(self, samples: Samples) -> None:
        """Take up what the optimiser has written since. A cost that begins later or ends earlier keeps its level."""
        for at_s, costs in samples[len(self.times_s) :]:
            self.times_s.append(at_s)
            for name, value in costs:
                self.costs.setdefault(name, [float(value)] * (len(self.times_s) - 1)).append(float(value))
            for values in self.costs.values():
                values.extend([values[-1]] * (len(self.times_s) - len(values)))
