"""What the layout's approximations leave: overlap of the meshes themselves, and drift under gravity."""

from __future__ import annotations

import itertools
from functools import cache, partial

import manifold3d
import numpy as np
import trimesh

from diorama_core.arrangement.surfaces import is_wall_like
from diorama_core.errors import UnavailableError
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.geometry.sat import place_bodies
from diorama_core.io.cache import LruCache
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Scene

_CLOSED: LruCache[str, manifold3d.Manifold | None] = LruCache(1024)
"""The closed solid of each shape, by its content."""


def mesh_overlap_m3(scene: Scene, library: ShapeLibrary, *, skip_supporters: bool = True) -> float:
    """Volume in cubic metres shared by the objects' meshes, summed over pairs.

    Meshes that are not closed are replaced by the hulls of their convex parts. Pairs of an object and what holds it up,
    which touch on purpose, may be left out.
    """
    problem = build_problem(scene, library)
    corners = [scene.object(name).corners_world for name in problem.ids]
    bounds = [(c.min(axis=0), c.max(axis=0)) for c in corners]
    solid = cache(partial(_solid, scene, library, problem))
    total = 0.0
    for i, j in itertools.combinations(range(problem.count), 2):
        if skip_supporters and problem.kin[i, j]:
            continue
        if (bounds[i][0] < bounds[j][1]).all() and (bounds[j][0] < bounds[i][1]).all():
            total += max(float((solid(i) ^ solid(j)).volume()), 0.0)
    return total


def _solid(scene: Scene, library: ShapeLibrary, problem: Problem, index: int) -> manifold3d.Manifold:
    item = scene.object(problem.ids[index])
    solid = _CLOSED.get(
        library.shape(item.shape_id).content_hash, lambda: _unite_closed_bodies(library.mesh(item.shape_id))
    )
    if solid is None:
        hulls = [_manifold(trimesh.convex.convex_hull(q.vertices)) for q in problem.parts[index]]
        solid = manifold3d.Manifold.batch_boolean(hulls, manifold3d.OpType.Add)
    return solid.transform(item.pose.matrix[:3])


def _unite_closed_bodies(mesh: trimesh.Trimesh) -> manifold3d.Manifold | None:
    """The union of a mesh's closed bodies; None where it has none, or they make no solid."""
    closed = [_manifold(b) for b in mesh.split(only_watertight=False) if b.is_watertight and b.volume > 0]
    solid = manifold3d.Manifold.batch_boolean(closed, manifold3d.OpType.Add) if closed else None
    return None if solid is None or solid.status() != manifold3d.Error.NoError or solid.is_empty() else solid


def _manifold(mesh: trimesh.Trimesh) -> manifold3d.Manifold:
    merged = mesh.copy()
    merged.merge_vertices(merge_tex=True, merge_norm=True)
    return manifold3d.Manifold(
        manifold3d.Mesh(np.asarray(merged.vertices, np.float32), np.asarray(merged.faces, np.uint32))
    )


def drift(
    scene: Scene, library: ShapeLibrary, *, seconds: float = 2.0, step_s: float = 0.004
) -> dict[str, tuple[float, float]]:
    """How far each object moves (metres) and turns (radians) when gravity is switched on, by id.

    Convex parts are the collision bodies; room planes are static; objects hung on walls or ceilings are fixed, as are
    locked ones.

    Args:
        scene: as it is.
        library: where shapes come from.
        seconds: simulated.
        step_s: of the simulation.

    Raises:
        UnavailableError: when MuJoCo is not installed.
    """
    try:
        import mujoco
    except ImportError as missing:
        raise UnavailableError("the drift test needs MuJoCo; install it with: pip install 'diorama[sim]'") from missing
    problem = build_problem(scene, library)
    model = mujoco.MjModel.from_xml_string(_model_xml(scene, problem, step_s))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    start = {name: (data.body(name).xpos.copy(), data.body(name).xmat.reshape(3, 3).copy()) for name in problem.ids}
    for _ in range(round(seconds / step_s)):
        mujoco.mj_step(model, data)
    moved = {}
    for name, (p, R) in start.items():
        body = data.body(name)
        cosine = (np.trace(body.xmat.reshape(3, 3) @ R.T) - 1.0) / 2.0
        moved[name] = (float(np.linalg.norm(body.xpos - p)), float(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return moved


def stable_share(moved: dict[str, tuple[float, float]], *, max_m: float = 0.01, max_rad: float = 0.0349) -> float:
    """Share of objects that moved under 1 cm and turned under 2 degrees."""
    return float(np.mean([d <= max_m and a <= max_rad for d, a in moved.values()])) if moved else 1.0


def _model_xml(scene: Scene, problem: Problem, step_s: float) -> str:
    """A MuJoCo model of the scene: one free body per object, its convex parts as meshes, planes of the room static."""
    scale = np.array([scene.object(name).pose.scale for name in problem.ids]).reshape(-1, 3)
    assets, bodies = [], []
    here = place_bodies(problem.packed, np.tile(np.eye(3), (problem.count, 1, 1)), np.zeros((problem.count, 3)), scale)
    for k, name in enumerate(problem.ids):
        pose = scene.object(name).pose
        geoms = []
        for number in np.flatnonzero(here.owner == k):
            points = " ".join(f"{x:.7g}" for x in here.vertices[number].ravel())
            assets.append(f'<mesh name="m{number}" vertex="{points}" inertia="convex"/>')
            geoms.append(f'<geom type="mesh" mesh="m{number}" density="200"/>')
        hung = is_wall_like(problem.surface[k]) or problem.surface[k] is None or problem.contact[k][2] > 0.5
        joint = "" if hung or not problem.free[k] else "<freejoint/>"
        at, turn = _numbers(pose.position), _numbers(quaternion_wxyz(pose.R_world_object))
        bodies.append(f'<body name="{name}" pos="{at}" quat="{turn}">{joint}{"".join(geoms)}</body>')
    room = [
        f'<geom type="plane" size="50 50 1" pos="{_numbers(p.centre)}" zaxis="{_numbers(p.normal)}"/>'
        for p in scene.architecture.by_role("floor")
    ]
    return (
        f'<mujoco><option timestep="{step_s}" integrator="implicitfast" cone="elliptic"/>'
        '<default><geom friction="1 0.02 0.001" solref="0.01 1" margin="0.0005"/></default>'
        f"<asset>{''.join(assets)}</asset><worldbody>{''.join(room)}{''.join(bodies)}</worldbody>"
        f"<contact>{_rugs_give_way(problem)}</contact></mujoco>"
    )


def _rugs_give_way(problem: Problem) -> str:
    """Rugs do not lift what stands on the floor over their edge; what the graph puts on a rug rests on it."""
    return "".join(
        f'<exclude body1="{problem.ids[i]}" body2="{problem.ids[j]}"/>'
        for i, j in itertools.combinations(range(problem.count), 2)
        if problem.yielding[i, j] and i not in problem.chain(j) and j not in problem.chain(i)
    )


def _numbers(values: np.ndarray) -> str:
    return " ".join(f"{float(x):.9g}" for x in values)
