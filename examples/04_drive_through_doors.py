"""Open every door of a room in MuJoCo and drive a disc through it, from 1.5 m inside to 1 m outside.

python examples/04_drive_through_doors.py my-room
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

RADIUS_M, SPEED, SECONDS_TO_OPEN = 0.25, 0.6, 2.0


def main(project: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        diorama.export(diorama.load(project), f"{folder}/pack.zip", format="robot")
        zipfile.ZipFile(f"{folder}/pack.zip").extractall(folder)
        objects = json.loads((Path(folder) / "objects.json").read_text())["objects"]
        doors = [o for o in objects if o["category"] == "door" and o["joints"]]
        model = with_robot(mujoco.MjSpec.from_file(f"{folder}/room.xml"), doors)
    for door in doors:
        seconds, touches = drive(model, door)
        print(f"{door['label']}: {f'through in {seconds:.1f} s' if seconds else 'not through'}, {touches} touches")


def with_robot(room: mujoco.MjSpec, doors: list[dict]) -> mujoco.MjModel:
    """The room with a disc on two slides, and a motor on every door's hinge."""
    robot = room.worldbody.add_body(name="robot", pos=[0, 0, 0.35])
    robot.add_geom(name="robot", type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[RADIUS_M, 0.3, 0], mass=30)
    for name, axis in (("x", [1, 0, 0]), ("y", [0, 1, 0])):
        robot.add_joint(name=f"robot_{name}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
        room.add_actuator(name=f"robot_{name}", target=f"robot_{name}").set_to_velocity(kv=500)
    for joint in (j for door in doors for j in door["joints"]):
        room.add_actuator(name=joint["name"], target=joint["name"]).set_to_position(kp=30, dampratio=1)
    for actuator in room.actuators:
        actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
    return room.compile()


def drive(model: mujoco.MjModel, door: dict) -> tuple[float | None, int]:
    """Seconds until the disc is outside, None where it does not get there, and with how many steps it touched."""
    data = mujoco.MjData(model)
    middle, inward = np.array(door["position_m"])[:2], np.array(door["rotation"])[:2, 0]
    data.joint("robot_x").qpos, data.joint("robot_y").qpos = middle + 1.5 * inward
    for joint in door["joints"]:
        data.actuator(joint["name"]).ctrl = joint["upper"] if joint["upper"] > -joint["lower"] else joint["lower"]
    robot, touches = model.geom("robot").id, 0
    while data.time < SECONDS_TO_OPEN + 3.0 / SPEED:
        velocity = -SPEED * inward if data.time > SECONDS_TO_OPEN else np.zeros(2)
        data.actuator("robot_x").ctrl, data.actuator("robot_y").ctrl = velocity
        mujoco.mj_step(model, data)
        touches += any(robot in contact.geom for contact in data.contact)
        if (data.body("robot").xpos[:2] - middle) @ inward < -1.0:
            return data.time - SECONDS_TO_OPEN, touches
    return None, touches


if __name__ == "__main__":
    main(sys.argv[1])
