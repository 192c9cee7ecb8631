"""A gymnasium environment of a room: a disc drives to where it reaches one of the room's surfaces.

python examples/06_gymnasium.py my-room
"""

from __future__ import annotations

import json
import sys
import tempfile
import zipfile
from pathlib import Path

import gymnasium
import mujoco
import numpy as np

import diorama_core as diorama


class Room(gymnasium.Env):
    """State: x and y of the disc and of its goal, metres. Action: velocity, metres a second. Reward: way gained."""

    def __init__(self, pack: Path) -> None:
        spec = mujoco.MjSpec.from_file(str(pack / "room.xml"))
        disc = spec.worldbody.add_body(name="disc", pos=[0, 0, 0.35])
        disc.add_geom(type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[0.25, 0.3, 0], mass=30)
        for name, axis in (("x", [1, 0, 0]), ("y", [0, 1, 0])):
            disc.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
            spec.add_actuator(target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT).set_to_velocity(kv=500)
        self.model = spec.compile()
        regions = json.loads((pack / "regions.json").read_text())["regions"]
        self.stands = [[r["stand"]["x"], r["stand"]["y"]] for r in regions if r["stand"]]
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (4,), np.float64)
        self.action_space = gymnasium.spaces.Box(-0.5, 0.5, (2,), np.float64)

    def reset(self, *, seed: int | None = None, options: dict | None = None) -> tuple[np.ndarray, dict]:
        super().reset(seed=seed)
        self.data = mujoco.MjData(self.model)
        start, self.goal = self.np_random.choice(self.stands, 2, replace=False)
        self.data.joint("x").qpos, self.data.joint("y").qpos = start
        mujoco.mj_forward(self.model, self.data)
        return self.state(), {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict]:
        before, self.data.ctrl[-2:] = self.left(), action
        mujoco.mj_step(self.model, self.data, nstep=50)
        return self.state(), before - self.left(), self.left() < 0.05, self.data.time > 60, {}

    def state(self) -> np.ndarray:
        return np.array([*self.data.body("disc").xpos[:2], *self.goal])

    def left(self) -> float:
        return float(np.linalg.norm(self.data.body("disc").xpos[:2] - self.goal))


def main(project: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        diorama.export(diorama.load(project), f"{folder}/pack.zip", format="robot")
        zipfile.ZipFile(f"{folder}/pack.zip").extractall(folder)
        room = Room(Path(folder))
    state, _ = room.reset(seed=0)
    done = late = False
    while not done and not late:  # straight ahead; a policy would drive around what stands there
        state, _, done, late, _ = room.step(np.clip(state[2:] - state[:2], -0.5, 0.5))
    print(f"{'at the goal' if done else f'{room.left():.2f} m left'} after {room.data.time:.1f} s")


if __name__ == "__main__":
    main(sys.argv[1])
