"""A scene to play with: gravity and pushes in MuJoCo, step by step, with the poses that objects have then."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.errors import UnavailableError
from diorama_core.export.colliders import physical_scene
from diorama_core.export.gathering import ExportScene
from diorama_core.export.mjcf import mjcf_text
from diorama_core.geometry.rotations import quaternion_wxyz, rotation_from_quaternion
from diorama_core.scene.types import Pose

PUSH_M_S = 1.5
"""Speed that a push gives an object, whatever its mass."""
REST_M_S = 0.01
"""Speeds below this are rest."""


class Playground:
    """The exported bodies of a scene while time goes on."""

    def __init__(self, gathered: ExportScene) -> None:
        """Make MuJoCo's model of a scene; nothing moves yet.

        Raises:
            UnavailableError: MuJoCo is not installed.
        """
        try:
            import mujoco
        except ImportError as missing:
            raise UnavailableError("playing needs MuJoCo: pip install 'diorama[sim]'") from missing
        physical = physical_scene(gathered)
        self._mujoco: Any = mujoco
        self._model = mujoco.MjModel.from_xml_string(mjcf_text(gathered, physical))
        self._data = mujoco.MjData(self._model)
        mujoco.mj_forward(self._model, self._data)
        numbers = {self._model.body(k).name: k for k in range(self._model.nbody)}
        self._numbers = {b.node.id: numbers[b.node.slug] for b in physical.bodies if b.free}
        self._first = {i: self._rigid(k) for i, k in self._numbers.items()}
        self._items = {o.id: o for o in gathered.scene.objects}

    @property
    def movable(self) -> frozenset[str]:
        """Ids of the objects that can move."""
        return frozenset(self._numbers)

    @property
    def seconds(self) -> float:
        """Simulated so far."""
        return float(self._data.time)

    @property
    def is_at_rest(self) -> bool:
        """True if nothing moves."""
        return bool(np.abs(self._data.qvel).max(initial=0.0) < REST_M_S)

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
        return {i: self._pose(i, self._rigid(k)) for i, k in self._numbers.items()}

    def _pose(self, object_id: str, now: Float[np.ndarray, "4 4"]) -> Pose:
        pose, moved = self._items[object_id].pose, now @ np.linalg.inv(self._first[object_id])
        position = moved[:3, :3] @ pose.position + moved[:3, 3]
        R = rotation_from_quaternion(quaternion_wxyz(moved[:3, :3] @ pose.R_world_object))  # exactly orthonormal
        return replace(pose, R_world_object=R, position=position)

    def _rigid(self, number: int) -> Float[np.ndarray, "4 4"]:
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = self._data.xmat[number].reshape(3, 3), self._data.xpos[number]
        return T
