"""Exact collision between posed meshes, triangle against triangle, with boxes to skip what is far apart."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import fcl
import numpy as np
from jaxtyping import Float

from diorama_core.geometry.open3d_import import o3d
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.scene.types import Pose
from diorama_core.scene.values import Vector3

LIFT_M = 1e-3
"""Resting objects are tested this much above their place, so that contact is not collision."""


@dataclass(frozen=True)
class Item:
    """A shape at a chosen size, not yet placed."""

    shape: Shape
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0)

    @property
    def size_m(self) -> Float[np.ndarray, "3"]:
        """Extents along its own axes."""
        return np.asarray(self.shape.size_m) * self.scale

    @property
    def category(self) -> str:
        """Canonical category."""
        return self.shape.category


@dataclass
class Bodies:
    """What has been placed so far, ready to be collided with."""

    library: ShapeLibrary = field(repr=False)
    _placed: dict[str, tuple[fcl.CollisionObject, np.ndarray]] = field(default_factory=dict, repr=False)

    def add(self, object_id: str, item: Item, pose: Pose) -> None:
        """Place a body for good."""
        self._placed[object_id] = self._posed(item, pose, np.zeros(3))

    def remove(self, object_id: str) -> None:
        """Take a body away again."""
        del self._placed[object_id]

    def hit_by(
        self, item: Item, pose: Pose, *, ignore: Collection[str] = (), lift: Vector3 = (0.0, 0.0, LIFT_M)
    ) -> str | None:
        """Id of a placed body whose surface the posed item would cut, or None."""
        body, bounds = self._posed(item, pose, np.asarray(lift, dtype=np.float64))
        request, result = fcl.CollisionRequest(), fcl.CollisionResult()
        for name, (other, box) in self._placed.items():
            if name in ignore or (bounds[0] > box[1]).any() or (box[0] > bounds[1]).any():
                continue
            if fcl.collide(body, other, request, result):
                return name
        return None

    def _posed(self, item: Item, pose: Pose, lift: np.ndarray) -> tuple[fcl.CollisionObject, np.ndarray]:
        model, corners = _model(_Mesh(self.library, item.shape.id), item.scale)
        at = pose.position + lift
        world = corners @ pose.R_world_object.T + at
        return fcl.CollisionObject(model, fcl.Transform(pose.R_world_object, at)), np.stack(
            [world.min(axis=0), world.max(axis=0)]
        )


@dataclass(frozen=True)
class _Mesh:
    """Names a mesh of a library; equal for the same library object."""

    library: ShapeLibrary = field(repr=False)
    shape_id: str = ""

    def __hash__(self) -> int:
        return hash((id(self.library), self.shape_id))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Mesh) and self.library is other.library and self.shape_id == other.shape_id

    def arrays(self) -> tuple[Float[np.ndarray, "n 3"], np.ndarray]:
        """Vertices and faces."""
        mesh = self.library.mesh(self.shape_id)
        return np.asarray(mesh.vertices), np.asarray(mesh.faces)


@lru_cache(maxsize=512)
def _model(mesh: _Mesh, scale: tuple[float, float, float]) -> tuple[fcl.BVHModel, Float[np.ndarray, "8 3"]]:
    vertices, faces = mesh.arrays()
    vertices = vertices * scale
    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(faces))
    model.addSubModel(vertices, faces)
    model.endModel()
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    corners = np.array([[(low, high)[(k >> axis) & 1][axis] for axis in range(3)] for k in range(8)])
    return model, corners


@lru_cache(maxsize=512)
def _caster(mesh: _Mesh) -> Any:
    vertices, faces = mesh.arrays()
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        o3d.core.Tensor.from_numpy(vertices.astype(np.float32)),
        o3d.core.Tensor.from_numpy(faces.astype(np.uint32)),
    )
    return scene


def heights_below(
    library: ShapeLibrary, shape_id: str, points: Float[np.ndarray, "n 3"], reach_m: float
) -> Float[np.ndarray, "n"]:
    """z of the first surface under points, canonical frame; -inf where none is within reach."""
    down = np.concatenate([points, np.tile([0.0, 0.0, -1.0], (len(points), 1))], axis=1).astype(np.float32)
    t = _caster(_Mesh(library, shape_id)).cast_rays(o3d.core.Tensor.from_numpy(down))["t_hit"].numpy()
    return np.where(t <= reach_m, points[:, 2] - t, -np.inf)
