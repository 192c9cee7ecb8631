"""What gravity does to an exported scene: two simulated seconds in MuJoCo."""

from __future__ import annotations

import json
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from diorama_core.errors import UnavailableError
from diorama_core.export.colliders import physical_scene
from diorama_core.export.files import companion_folder
from diorama_core.export.gathering import ExportScene
from diorama_core.export.mjcf import mjcf_text
from diorama_core.export.physics import GRAVITY
from diorama_core.export.urdf import POSES

MAX_DRIFT_M = 0.01
MAX_TURN_RAD = float(np.radians(2.0))
FALLEN_M, TIPPED_DEG = 0.1, 30.0
"""What is lower by more has fallen off what it stood on; what tips farther does not come back."""


@dataclass(frozen=True)
class Drift:
    """How one object moved."""

    object_id: str
    moved_m: float
    turned_rad: float
    free: bool
    """Whether it could move at all."""
    fallen_m: float = 0.0
    """How much lower it is."""
    tilted_deg: float = 0.0
    """How far its upright axis tipped."""

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
    def falls(self) -> tuple[Drift, ...]:
        """The objects that fell off or over, in the order of the scene."""
        return tuple(d for d in self.drifts if d.fallen_m > FALLEN_M or d.tilted_deg > TIPPED_DEG)

    @property
    def unstable(self) -> tuple[Drift, ...]:
        """The objects that did not stay, the farthest first."""
        return tuple(sorted((d for d in self.drifts if not d.stable), key=lambda d: -d.moved_m))


@dataclass(frozen=True)
class Shake:
    """A floor that goes to and fro along x."""

    acceleration_g: float
    """Amplitude, in units of gravity."""
    frequency_hz: float
    seconds: float

    def __str__(self) -> str:
        return f"{self.acceleration_g:g} g at {self.frequency_hz:g} Hz for {self.seconds:g} s"


EARTHQUAKE = Shake(0.3, 2.0, 3.0)
"""Strong: 0.3 g is what many building codes count with; at 2 Hz the floor goes 1.9 cm to either side."""


def stability(
    gathered: ExportScene, *, urdf: Path | None = None, seconds: float = 2.0, shake: Shake | None = None
) -> StabilityReport:
    """Simulate the exported bodies: as MuJoCo's own model, or as files of URDF say them, with MuJoCo's own settings.

    Args:
        gathered: What was exported.
        urdf: The files that were written of it: the room's, or the `.zip`.
        seconds: Of simulated time; a shake has its own, and they follow, so that what tips has fallen.
        shake: How the floor moves; seen from the floor, everything is accelerated the other way.

    Raises:
        UnavailableError: when MuJoCo is not installed.
    """
    try:
        import mujoco
    except ImportError as missing:
        raise UnavailableError("simulating needs MuJoCo: pip install 'diorama[sim]'") from missing
    physical = physical_scene(gathered)
    model = mujoco.MjModel.from_xml_string(mjcf_text(gathered, physical)) if urdf is None else urdf_model(urdf)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    numbers = {model.body(k).name.rpartition("/")[2]: k for k in range(model.nbody)}
    numbers = {b.node.id: numbers[b.node.slug] for b in physical.bodies}
    before = {i: (data.xpos[k].copy(), data.xmat[k].reshape(3, 3).copy()) for i, k in numbers.items()}
    seconds += 0.0 if shake is None else shake.seconds
    for _ in range(round(seconds / model.opt.timestep)):
        if shake is not None:
            swing = np.sin(2 * np.pi * shake.frequency_hz * data.time) if data.time < shake.seconds else 0.0
            model.opt.gravity[0] = -GRAVITY * shake.acceleration_g * swing
        mujoco.mj_step(model, data)
    drifts = []
    for body in physical.bodies:
        (position, R), number = before[body.node.id], numbers[body.node.id]
        cosine = (np.trace(data.xmat[number].reshape(3, 3) @ R.T) - 1.0) / 2.0
        moved = float(np.linalg.norm(data.xpos[number] - position))
        turned = float(np.arccos(np.clip(cosine, -1.0, 1.0)))
        fallen = float(position[2] - data.xpos[number][2])
        tilted = float(np.degrees(np.arccos(np.clip(data.xmat[number].reshape(3, 3)[:, 2] @ R[:, 2], -1.0, 1.0))))
        drifts.append(Drift(body.node.id, moved, turned, body.free, fallen, tilted))
    return StabilityReport(tuple(drifts), physical.notes, seconds)


def urdf_model(path: Path) -> Any:
    """MuJoCo's model of a room in URDF with its objects at their poses (`mujoco.MjModel`).

    Args:
        path: The room's file, or the `.zip`.
    """
    import mujoco

    with tempfile.TemporaryDirectory() as unpacked:
        if path.suffix == ".zip":
            with zipfile.ZipFile(path) as archive:
                archive.extractall(unpacked)
            path = Path(unpacked) / f"{path.stem}.urdf"
        folder = path.with_name(companion_folder(path, "urdf"))
        room = mujoco.MjSpec.from_file(str(path))
        for pose in json.loads((folder / POSES).read_text(encoding="utf-8"))["objects"]:
            thing = mujoco.MjSpec.from_file(str(folder / pose["file"]))
            frame = room.worldbody.add_frame(pos=pose["position_m"], quat=pose["quaternion_wxyz"])
            frame.attach_body(thing.worldbody.first_body(), f"{pose['name']}/", "").add_freejoint()
        return room.compile()
