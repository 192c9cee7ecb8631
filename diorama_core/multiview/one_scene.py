"""One scene of several: a photo's own scene in the room of all, its edges and its objects as all photos fit them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.openings import STANDS_OUT_M
from diorama_core.multiview.joint_fit import JointCuboid
from diorama_core.multiview.settings import SETTINGS
from diorama_core.scene.types import Architecture, Camera, Pose, Scene, SceneObject, Support, yaw_rotation

Size = tuple[float, float, float]


def acyclic(edges: Sequence[Support]) -> tuple[Support, ...]:
    """The edges without edges that would close a circle: different photos may disagree about what stands on what."""
    parent: dict[str, str] = {}
    forest = []
    for edge in edges:
        above, seen = edge.parent, {edge.child}
        while above in parent and above not in seen:
            seen.add(above)
            above = parent[above]
        if above not in seen:
            parent[edge.child] = edge.parent
            forest.append(edge)
    return tuple(forest)


def edge_in_room(edge: Support, scene: Scene, room: Architecture) -> Support:
    """An edge whose plane is the first photo's plane of the same role that is nearest."""
    if not scene.has_plane(edge.parent):
        return replace(edge, adheres_to=())
    plane = scene.plane(edge.parent)
    alike = [
        (abs(p.offset - plane.offset) + 10 * (1 - float(p.normal @ plane.normal)), p.id)
        for p in room.by_role(plane.role)
    ]
    return replace(edge, parent=min(alike)[1] if alike else "", adheres_to=())


def move_to_room(scene: Scene, T: Float[np.ndarray, "4 4"]) -> Scene:
    """A scene of a photo's own world, and all candidates' poses, in the room: `p_room = T @ p`, rigid."""
    R, t = T[:3, :3], T[:3, 3]

    def pose_in_room(pose: Pose, shape_size_m: Size) -> Pose:
        return Pose(R @ pose.R_world_object, R @ pose.position + t, pose.scale)

    planes = tuple(replace(p, polygon=p.polygon @ R.T + t) for p in scene.architecture.planes)
    objects = tuple(_with_poses(o, pose_in_room) for o in scene.objects)
    camera = scene.camera and Camera(scene.camera.intrinsics, T @ scene.camera.T_world_camera)
    return replace(scene, camera=camera, objects=objects, architecture=replace(scene.architecture, planes=planes))


def filling(item: SceneObject, joint: JointCuboid) -> SceneObject:
    """The object with every candidate filling the joint cuboid, its front on the side where its photo saw it.

    Extents that boxes hardly tell are those that the shape has in proportion to the others.
    """

    def fit(pose: Pose, shape_size_m: Size) -> Pose:
        turn = round((pose.yaw_rad - joint.yaw_rad) / (np.pi / 2))
        axes = [1, 0, 2] if turn % 2 else [0, 1, 2]
        shape = np.array(shape_size_m)
        size = fuse_proportions(np.maximum(joint.size_m, 1e-3)[axes], np.array(joint.log_size_sigma)[axes], shape)
        R = yaw_rotation(joint.yaw_rad + turn * np.pi / 2)
        base = joint.centre[2] - joint.size_m[2] / 2
        return Pose(R, np.array([*joint.centre[:2], base + size[2] / 2]), size / shape)

    return _with_poses(item, fit)


def set_into_wall(item: SceneObject) -> SceneObject:
    """A door or window with its frame in the wall: no photo tells how thick it is, only what stands out is seen."""

    def thinner(pose: Pose, shape_size_m: Size) -> Pose:
        depth = shape_size_m[0] * float(pose.scale[0])
        if depth <= STANDS_OUT_M:
            return pose
        behind = pose.R_world_object[:, 0] * (depth - STANDS_OUT_M) / 2
        scale = pose.scale * [STANDS_OUT_M / depth, 1.0, 1.0]
        return Pose(pose.R_world_object, pose.position - behind, scale)

    return _with_poses(item, thinner)


def _with_poses(item: SceneObject, change: Callable[[Pose, Size], Pose]) -> SceneObject:
    """The object with another pose, by the pose and the size of its shape, and so every candidate."""
    candidates = tuple(replace(c, pose=change(c.pose, c.shape_size_m)) for c in item.candidates)
    return replace(item, pose=change(item.pose, item.shape_size_m), candidates=candidates)


def fuse_proportions(
    size_m: Float[np.ndarray, "3"], log_sigma: Float[np.ndarray, "3"], shape_size_m: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "3"]:
    """Extents by a measurement and by the proportions of a shape, of unknown scale, each as sure as it is.

    Args:
        size_m: measured.
        log_sigma: deviations of its logarithms.
        shape_size_m: of the shape.
    """
    measured, shape = np.log(size_m), np.log(shape_size_m)
    known = 1.0 / np.maximum(log_sigma, 1e-3) ** 2
    weight = 1.0 / (np.maximum(log_sigma, 1e-3) ** 2 + SETTINGS.proportion_sigma**2)
    scale = float(weight @ (measured - shape) / weight.sum())
    precision = 1.0 / SETTINGS.proportion_sigma**2
    extents: Float[np.ndarray, "3"] = np.exp((known * measured + precision * (shape + scale)) / (known + precision))
    return extents
