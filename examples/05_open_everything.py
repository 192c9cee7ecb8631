"""Open and close every drawer and door of a room in MuJoCo with a hand that holds its handle and pulls by 40 N at most.

python examples/05_open_everything.py my-room
"""

from __future__ import annotations

import json
import sys
import tempfile
import zipfile
from pathlib import Path

import mujoco
import numpy as np

import diorama_core as diorama

SECONDS, HELD_S, MAX_FORCE_N = 4.0, 0.5, 40.0


def main(project: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        diorama.export(diorama.load(project), f"{folder}/pack.zip", format="robot")
        zipfile.ZipFile(f"{folder}/pack.zip").extractall(folder)
        objects = json.loads((Path(folder) / "objects.json").read_text())["objects"]
        joints = [j for o in objects for j in o["joints"] if j["kind"] != "swivel" and not j["open"]]
        model = with_hands(mujoco.MjSpec.from_file(f"{folder}/room.xml"), joints)
    shares = [opened(model, joint) for joint in joints]
    for joint, (most, last) in zip(joints, shares, strict=True):
        print(f"{joint['name']}: opened to {most:.0%}, closed to {last:.0%}")
    print(f"{sum(most > 0.9 and last < 0.1 for most, last in shares)} of {len(joints)} open and close")


def with_hands(room: mujoco.MjSpec, joints: list[dict]) -> mujoco.MjModel:
    """The room with a hand at every handle, on three slides of limited force, that holds its part at one point."""
    for joint in joints:
        hand = room.worldbody.add_body(name=f"{joint['name']} hand", pos=joint["handle_m"], gravcomp=1)
        hand.add_geom(size=[0.02, 0, 0], mass=0.3, contype=0, conaffinity=0)
        for name, axis in zip("xyz", np.eye(3), strict=True):
            hand.add_joint(name=f"{joint['name']} {name}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
            motor = room.add_actuator(name=f"{joint['name']} {name}", target=f"{joint['name']} {name}")
            motor.set_to_position(kp=1000, kv=60)
            motor.trntype, motor.forcelimited = mujoco.mjtTrn.mjTRN_JOINT, True
            motor.forcerange = [-MAX_FORCE_N, MAX_FORCE_N]
        held = room.add_equality(type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_BODY)
        held.name1, held.name2 = f"{joint['name']} hand", joint["name"]
        held.data[:3] = 0
    return room.compile()


def opened(model: mujoco.MjModel, joint: dict) -> tuple[float, float]:
    """How far a part came out and how far it was left open, as shares of its travel."""
    data = mujoco.MjData(model)
    travel = joint["upper"] if joint["upper"] > -joint["lower"] else joint["lower"]
    most = 0.0
    while data.time < 2 * (SECONDS + HELD_S):
        share = min(data.time / SECONDS, 1.0, max(2 * SECONDS + HELD_S - data.time, 0.0) / SECONDS)
        for name, target in zip("xyz", moved(joint, share * travel) - joint["handle_m"], strict=True):
            data.actuator(f"{joint['name']} {name}").ctrl = target
        mujoco.mj_step(model, data)
        most = max(most, float(data.joint(joint["name"]).qpos[0] / travel))
    return most, abs(float(data.joint(joint["name"]).qpos[0] / travel))


def moved(joint: dict, by: float) -> np.ndarray:
    """Where a handle is when its part has moved by so much."""
    handle, origin, axis = (np.array(joint[key]) for key in ("handle_m", "origin_m", "axis"))
    if joint["kind"] == "slide":
        return handle + by * axis
    lever = handle - origin
    along = axis * (axis @ lever)
    return origin + along + np.cos(by) * (lever - along) + np.sin(by) * np.cross(axis, lever)


if __name__ == "__main__":
    main(sys.argv[1])
