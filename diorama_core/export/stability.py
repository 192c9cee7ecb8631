"""What gravity does to an exported scene, in MuJoCo: two simulated seconds, or as long as somebody plays with it."""

from __future__ import annotations

import json
import tempfile
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.errors import UnavailableError
from diorama_core.export.bodies import PhysicalScene
from diorama_core.export.colliders import physical_scene
from diorama_core.export.files import companion_folder
from diorama_core.export.gathering import ExportScene
from diorama_core.export.mjcf import mjcf_text
from diorama_core.export.physics import GRAVITY
from diorama_core.export.urdf import POSES
from diorama_core.geometry.rotations import quaternion_wxyz, rotation_from_quaternion
from diorama_core.scene.types import Pose

MAX_DRIFT_M = 0.01
MAX_TURN_RAD = float(np.radians(2.0))
FALLEN_M, TIPPED_DEG = 0.1, 30.0
"""What is lower by more has fallen off what it stood on; what tips farther does not come back."""
PUSH_M_S = 1.5
"""Speed that a push gives an object, whatever its mass."""


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
    mujoco, physical = _mujoco("simulating"), physical_scene(gathered)
    model = mujoco.MjModel.from_xml_string(mjcf_text(gathered, physical)) if urdf is None else urdf_model(urdf)
    data, numbers = _start(mujoco, model, physical)
    first = {i: _rigid(data, k) for i, k in numbers.items()}
    seconds += 0.0 if shake is None else shake.seconds
    for _ in range(round(seconds / model.opt.timestep)):
        if shake is not None:
            swing = np.sin(2 * np.pi * shake.frequency_hz * data.time) if data.time < shake.seconds else 0.0
            model.opt.gravity[0] = -GRAVITY * shake.acceleration_g * swing
        mujoco.mj_step(model, data)
    drifts = []
    for body in physical.bodies:
        before, after = first[body.node.id], _rigid(data, numbers[body.node.id])
        moved = float(np.linalg.norm(after[:3, 3] - before[:3, 3]))
        turned = _angle_rad((np.trace(after[:3, :3] @ before[:3, :3].T) - 1.0) / 2.0)
        tilted = float(np.degrees(_angle_rad(after[:3, 2] @ before[:3, 2])))
        drifts.append(Drift(body.node.id, moved, turned, body.free, float(before[2, 3] - after[2, 3]), tilted))
    return StabilityReport(tuple(drifts), physical.notes, seconds)


def _mujoco(doing: str) -> Any:
    """MuJoCo's module, which `doing` something needs."""
    try:
        import mujoco
    except ImportError as missing:
        raise UnavailableError(f"{doing} needs MuJoCo: pip install 'diorama[sim]'") from missing
    return mujoco


def _start(mujoco: Any, model: Any, physical: PhysicalScene) -> tuple[Any, dict[str, int]]:
    """The state of a model in which nothing moves yet, and the number of each object's body by its id."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    numbers = {model.body(k).name.rpartition("/")[2]: k for k in range(model.nbody)}
    return data, {b.node.id: numbers[b.node.slug] for b in physical.bodies}


def _rigid(data: Any, number: int) -> Float[np.ndarray, "4 4"]:
    """Where a body is in the world now."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = data.xmat[number].reshape(3, 3), data.xpos[number]
    return T


def _angle_rad(cosine: float) -> float:
    return float(np.arccos(np.clip(cosine, -1.0, 1.0)))


def urdf_model(path: Path) -> Any:
    """MuJoCo's model (`mujoco.MjModel`) of a room's URDF, or `.zip`, with its objects at their poses."""
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


class Playground:
    """A scene to play with: gravity and pushes, step by step, with the poses that objects have then."""

    def __init__(self, gathered: ExportScene) -> None:
        """Make MuJoCo's model of a scene; nothing moves yet.

        Raises:
            UnavailableError: MuJoCo is not installed.
        """
        self._mujoco, physical = _mujoco("playing"), physical_scene(gathered)
        self._model = self._mujoco.MjModel.from_xml_string(mjcf_text(gathered, physical))
        self._data, numbers = _start(self._mujoco, self._model, physical)
        self._numbers = {b.node.id: numbers[b.node.id] for b in physical.bodies if b.free}
        self._first = {i: _rigid(self._data, k) for i, k in self._numbers.items()}
        self._items = {o.id: o for o in gathered.scene.objects}

    @property
    def movable(self) -> frozenset[str]:
        """Ids of the objects that can move."""
        return frozenset(self._numbers)

    @property
    def seconds(self) -> float:
        """Simulated so far."""
        return float(self._data.time)

    def step(self, seconds: float) -> None:
        """Let time go on."""
        for _ in range(round(seconds / self._model.opt.timestep)):
            self._mujoco.mj_step(self._model, self._data)

    def push(self, object_id: str, direction: Float[np.ndarray, "3"]) -> bool:
        """Push an object along a direction of the world; False where it is fixed."""
        number = self._numbers.get(object_id)
        if number is None:
            return False
        first = int(self._model.jnt_dofadr[self._model.body_jntadr[number]])
        self._data.qvel[first : first + 3] += PUSH_M_S * direction / max(float(np.linalg.norm(direction)), 1e-9)
        return True

    def poses(self) -> Mapping[str, Pose]:
        """Poses of the objects that can move."""
        return {i: self._pose(i, _rigid(self._data, k)) for i, k in self._numbers.items()}

    def _pose(self, object_id: str, now: Float[np.ndarray, "4 4"]) -> Pose:
        pose, moved = self._items[object_id].pose, now @ np.linalg.inv(self._first[object_id])
        position = moved[:3, :3] @ pose.position + moved[:3, 3]
        R = rotation_from_quaternion(quaternion_wxyz(moved[:3, :3] @ pose.R_world_object))  # exactly orthonormal
        return replace(pose, R_world_object=R, position=position)
