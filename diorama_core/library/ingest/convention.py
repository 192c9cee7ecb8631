"""What formats promise about their frame and unit, or what their files usually do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Convention:
    """Probabilities of axes, and of metres in a unit."""

    name: str
    up: Mapping[str, float]
    front: Mapping[str, float] = field(default_factory=dict)
    unit: Mapping[float, float] = field(default_factory=dict)
    promises: bool = False
    """Whether the specification says metres and +Y up, so that nothing else is ever guessed while it can be true."""
    kept: bool = False
    """Whether other files of the folder keep the promise, so that this one does."""


GLTF = Convention("glTF", {"+y": 0.99}, {"+z": 0.7}, {1.0: 0.85, 0.01: 0.04, 0.001: 0.03}, promises=True)
"""The specification: +Y up, +Z front, metres. Fronts are mostly kept."""
OBJ = Convention("OBJ", {"+y": 0.65, "+z": 0.3}, {}, {1.0: 0.4, 0.01: 0.3, 0.001: 0.15, 0.0254: 0.1})
PLY = Convention("PLY", {"+z": 0.5, "+y": 0.4}, {}, {1.0: 0.6, 0.001: 0.2, 0.01: 0.1})
STL = Convention("STL", {"+z": 0.75, "+y": 0.2}, {}, {0.001: 0.7, 1.0: 0.15, 0.01: 0.05, 0.0254: 0.08})
THREE_DS = Convention("3DS", {"+z": 0.85, "+y": 0.1}, {"-y": 0.6}, {1.0: 0.3, 0.01: 0.25, 0.0254: 0.25, 0.001: 0.15})
UNKNOWN = Convention("no", {}, {}, {1.0: 0.4, 0.01: 0.2, 0.001: 0.2, 0.0254: 0.1})
"""Nothing is promised; for tests of what geometry alone tells."""
