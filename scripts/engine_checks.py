"""One engine loads an exported room and lets two seconds of gravity run. Runs in an environment that has the engine.

    python scripts/engine_checks.py ENGINE FOLDER

FOLDER holds `room.urdf`, `room.sdf`, `room.xml` and `room.usdc` with what they refer to. Prints one line of JSON: the
engine's version, the limits of its joints (null without), how many colliders it has, and how far each object moved
(metres) and turned (degrees).
"""

from __future__ import annotations

import itertools
import json
import sys
import xml.etree.ElementTree as ET
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

SECONDS = 2.0
Poses = dict[str, tuple[np.ndarray, np.ndarray]]
"""Position and quaternion (any order that stays) of each object."""
Limits = list[tuple[float, float] | None]
Checked = tuple[Poses, Poses, Limits, int]
"""Poses before and after, limits of the joints, number of colliders."""


def mujoco(folder: Path) -> Checked:
    """MJCF."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(folder / "room.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    free = [model.body(j.bodyid[0]).name for j in map(model.joint, range(model.njnt)) if j.type[0] == 0]

    def poses() -> Poses:
        return {name: (data.body(name).xpos.copy(), data.body(name).xquat.copy()) for name in free}

    before = poses()
    while data.time < SECONDS:
        mujoco.mj_step(model, data)
    joints = [model.joint(k) for k in range(model.njnt)]
    limits = [limited(*j.range) if model.jnt_limited[j.id] else None for j in joints if j.type[0] > 1]
    return before, poses(), limits, int((model.geom_group == 3).sum())


def pybullet(folder: Path) -> Checked:
    """URDF: the room, and the objects at their poses."""
    import pybullet as p

    p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81)
    bodies = {"": p.loadURDF(str(folder / "room.urdf"), useFixedBase=True)}
    for thing in things(folder):
        w, x, y, z = thing["quaternion_wxyz"]
        file = str(folder / "room_urdf" / thing["file"])
        # Bullet's pose is that of the centre of mass, its loader's that of the link.
        bodies[thing["name"]] = p.loadURDF(file, thing["position_m"], [x, y, z, w])
    joints = [
        (b, k) for b in bodies.values() for k in range(p.getNumJoints(b)) if p.getJointInfo(b, k)[2] != p.JOINT_FIXED
    ]
    for body, joint in joints:
        p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0.5)

    def poses() -> Poses:
        found = {n: p.getBasePositionAndOrientation(b) for n, b in bodies.items() if n}
        return {name: (np.array(place), np.array(turn)) for name, (place, turn) in found.items()}

    before = poses()
    for _ in range(int(240 * SECONDS)):
        p.stepSimulation()
    limits = [limited(*p.getJointInfo(b, k)[8:10]) for b, k in joints]
    links = [(b, k) for b in bodies.values() for k in range(-1, p.getNumJoints(b))]
    return before, poses(), limits, sum(len(p.getCollisionShapeData(b, k)) for b, k in links)


def sapien(folder: Path) -> Checked:
    """URDF: the room, and the objects at their poses."""
    import sapien

    scene = sapien.Scene([sapien.physx.PhysxCpuSystem()])
    scene.set_timestep(1 / 240)
    loader = scene.create_urdf_loader()
    loader.fix_root_link = True
    everything = [made for some in loader.load_multiple(without_visuals(folder / "room.urdf"))[:2] for made in some]
    for component in (c for made in everything for c in getattr(made, "components", ())):
        if isinstance(component, sapien.physx.PhysxRigidDynamicComponent):
            component.kinematic = True  # a room without joints is an actor, which the loader leaves free to fall
    loader.fix_root_link = False
    bodies = {}
    for thing in things(folder):
        articulations, actors = loader.load_multiple(without_visuals(folder / "room_urdf" / thing["file"]))[:2]
        made = [*articulations, *actors][0]
        made.set_pose(sapien.Pose(thing["position_m"], thing["quaternion_wxyz"]))
        bodies[thing["name"]] = made
        everything.append(made)

    def poses() -> Poses:
        return {name: (body.get_pose().p.copy(), body.get_pose().q.copy()) for name, body in bodies.items()}

    before = poses()
    for _ in range(int(240 * SECONDS)):
        scene.step()
    limits = [limit for made in everything for limit in sapien_limits(made)]
    return before, poses(), limits, sum(sapien_colliders(made) for made in everything)


def without_visuals(path: Path) -> str:
    """The file without what is seen, for which the engine needs a graphics card."""
    tree = ET.parse(path)
    for link in tree.iter("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
    bare = path.with_stem(f"{path.stem}_bare")
    tree.write(bare)
    return str(bare)


def sapien_limits(made: Any) -> Limits:
    joints = made.get_active_joints() if hasattr(made, "get_active_joints") else []
    return [limited(*map(float, j.get_limits()[0])) for j in joints]


def sapien_colliders(made: Any) -> int:
    from sapien import physx

    bodies = made.links if hasattr(made, "links") else made.components
    return sum(len(b.collision_shapes) for b in bodies if isinstance(b, physx.PhysxRigidBaseComponent))


def drake(folder: Path) -> Checked:
    """SDF."""
    from pydrake.all import AddMultibodyPlantSceneGraph, DiagramBuilder, Parser, Role, Simulator

    builder = DiagramBuilder()
    plant, geometries = AddMultibodyPlantSceneGraph(builder, time_step=0.002)
    Parser(plant).AddModels(str(folder / "room.sdf"))
    plant.Finalize()
    simulator = Simulator(builder.Build())
    context = plant.GetMyContextFromRoot(simulator.get_context())
    free = [plant.get_body(index) for index in plant.GetFloatingBaseBodies()]

    def poses() -> Poses:
        found = {body.name(): plant.EvalBodyPoseInWorld(context, body) for body in free}
        return {n: (X.translation().copy(), X.rotation().ToQuaternion().wxyz()) for n, X in found.items()}

    before = poses()
    simulator.AdvanceTo(SECONDS)
    joints = [plant.get_joint(k) for k in plant.GetJointIndices()]
    limits = [
        limited(float(j.position_lower_limits()[0]), float(j.position_upper_limits()[0]))
        for j in joints
        if j.num_velocities() == 1
    ]
    return before, poses(), limits, geometries.model_inspector().NumGeometriesWithRole(Role.kProximity)


def newton(folder: Path) -> Checked:
    """USD, with the engine's MuJoCo solver on the CPU."""
    import newton
    import warp

    warp.config.quiet = True
    builder = newton.ModelBuilder(up_axis=newton.Axis.Z)
    newton.solvers.SolverMuJoCo.register_custom_attributes(builder)  # the stage's own settings of the solver
    builder.add_usd(str(folder / "room.usdc"))
    model = builder.finalize(device="cpu")
    solver = newton.solvers.SolverMuJoCo(model, njmax=4000, nconmax=4000, use_mujoco_cpu=True)
    here, there, control = model.state(), model.state(), model.control()
    newton.eval_fk(model, model.joint_q, model.joint_qd, here)
    names = [path.rpartition("/")[2] for path in model.body_label]

    def poses(state: Any) -> Poses:
        return {
            n: (row[:3], row[3:]) for n, row in zip(names, state.body_q.numpy().copy(), strict=True) if "__" not in n
        }

    before = poses(here)
    for _ in range(int(500 * SECONDS)):
        here.clear_forces()
        solver.step(here, there, control, None, 0.002)
        here, there = there, here
    starts = model.joint_qd_start.numpy()
    low, high = model.joint_limit_lower.numpy(), model.joint_limit_upper.numpy()
    limits = [limited(float(low[a]), float(high[a])) for a, b in itertools.pairwise(starts) if b - a == 1]
    solid = int(newton.ShapeFlags.COLLIDE_SHAPES)
    return before, poses(here), limits, int(((model.shape_flags.numpy() & solid) != 0).sum())


def limited(low: float, high: float) -> tuple[float, float] | None:
    """The limits; None where there are none, whichever way the engine says so."""
    return (low, high) if low < high and max(abs(low), abs(high)) < 1e3 else None


def things(folder: Path) -> list[dict[str, Any]]:
    """The objects that may move, and their poses."""
    found: list[dict[str, Any]] = json.loads((folder / "room_urdf" / "poses.json").read_text())["objects"]
    return found


def turned_deg(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.degrees(2 * np.arccos(np.clip(abs(a @ b), 0.0, 1.0))))


ENGINES = {"mujoco": mujoco, "pybullet": pybullet, "sapien": sapien, "drake": drake, "newton": newton}

if __name__ == "__main__":
    engine, where = sys.argv[1], Path(sys.argv[2])
    before, after, limits, colliders = ENGINES[engine](where)
    moved = {n: [float(np.linalg.norm(after[n][0] - p)), turned_deg(after[n][1], q)] for n, (p, q) in before.items()}
    print(json.dumps({"version": version(engine), "limits": limits, "colliders": colliders, "moved": moved}))
