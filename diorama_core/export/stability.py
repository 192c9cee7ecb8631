"""What gravity does to an exported scene: two simulated seconds in MuJoCo."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diorama_core.errors import UnavailableError
from diorama_core.export.colliders import physical_scene
from diorama_core.export.gathering import ExportScene
from diorama_core.export.mjcf import mjcf_text

MAX_DRIFT_M = 0.01
MAX_TURN_RAD = float(np.radians(2.0))


@dataclass(frozen=True)
class Drift:
    """How one object moved."""

    object_id: str
    moved_m: float
    turned_rad: float
    free: bool
    """Whether it could move at all."""

    @property
    def stable(self) -> bool:
        """Whether it stayed within a centimetre and two degrees."""
        return self.moved_m < MAX_DRIFT_M and self.turned_rad < MAX_TURN_RAD


@dataclass(frozen=True)
class StabilityReport:
    """How every object moved, and what was decided about the bodies."""

    drifts: tuple[Drift, ...]
    notes: tuple[str, ...]
    seconds: float

    @property
    def stable_share(self) -> float:
        """Share of all objects that stayed; 1 without objects."""
        return float(np.mean([d.stable for d in self.drifts])) if self.drifts else 1.0

    @property
    def unstable(self) -> tuple[Drift, ...]:
        """The objects that did not stay, the farthest first."""
        return tuple(sorted((d for d in self.drifts if not d.stable), key=lambda d: -d.moved_m))


def stability(gathered: ExportScene, *, seconds: float = 2.0) -> StabilityReport:
    """Simulate the exported bodies.

    Raises:
        UnavailableError: when MuJoCo is not installed.
    """
    try:
        import mujoco
    except ImportError as missing:
        raise UnavailableError("simulating needs MuJoCo: pip install 'diorama[sim]'") from missing
    physical = physical_scene(gathered)
    model = mujoco.MjModel.from_xml_string(mjcf_text(gathered, physical))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    slugs = [b.node.slug for b in physical.bodies]
    before = [(data.body(s).xpos.copy(), data.body(s).xmat.reshape(3, 3).copy()) for s in slugs]
    for _ in range(round(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
    drifts = []
    for body, (position, R) in zip(physical.bodies, before, strict=True):
        after = data.body(body.node.slug)
        cosine = (np.trace(after.xmat.reshape(3, 3) @ R.T) - 1.0) / 2.0
        moved, turned = float(np.linalg.norm(after.xpos - position)), float(np.arccos(np.clip(cosine, -1.0, 1.0)))
        drifts.append(Drift(body.node.id, moved, turned, body.free))
    return StabilityReport(tuple(drifts), physical.notes, seconds)
