"""Exact collision between posed meshes, triangle against triangle, with boxes to skip what is far apart."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import fcl
import numpy as np
from jaxtyping import Float

from diorama_core.geometry.ray_scene import RayScene
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.scene.types import Pose, box_corners
from diorama_core.scene.values import Vector3

LIFT_M = 1e-3
"""Resting objects are tested this much above their place, so that contact is not collision."""
ROUNDED_M = 1e-4
"""Shapes reach no farther beyond the sizes that their records state."""


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
class PlacedBodies:
    """What has been placed so far, ready to be collided with."""

    library: ShapeLibrary = field(repr=False)
    _placed: dict[str, _Posed] = field(default_factory=dict, repr=False)

    def add(self, object_id: str, item: Item, pose: Pose) -> None:
        """Place a body for good.

        Args:
            object_id: of the object.
            item: its shape.
            pose: where it is.
        """
        self._placed[object_id] = self._pose(item, pose, np.zeros(3))

    def remove(self, object_id: str) -> None:
        """Take a body away again."""
        del self._placed[object_id]

    def hit_by(
        self, item: Item, pose: Pose, *, ignore: Collection[str] = (), lift: Vector3 = (0.0, 0.0, LIFT_M)
    ) -> str | None:
        """Id of a placed body whose surface the posed item would cut, or None.

        Args:
            item: its shape.
            pose: where it would be.
            ignore: ids that do not count.
            lift: shift before it is tried, metres.
        """
        body = self._pose(item, pose, np.asarray(lift, dtype=np.float64))
        request, result = fcl.CollisionRequest(), fcl.CollisionResult()
        for name, other in self._placed.items():
            if name in ignore or (body.low > other.high).any() or (other.low > body.high).any():
                continue
            if fcl.collide(body.triangles, other.triangles, request, result):
                return name
        return None

    def _pose(self, item: Item, pose: Pose, lift: np.ndarray) -> _Posed:
        return _Posed(self.library, item, pose.R_world_object, pose.position + lift)


@dataclass(frozen=True, eq=False)
class _Posed:
    """An item at a place. Its triangles are asked for only where its box meets another's: most of what is tried stands
    alone, and to build a shape takes as long as hundreds of boxes.
    """

    library: ShapeLibrary
    item: Item
    R_world_item: Float[np.ndarray, "3 3"]
    at: Float[np.ndarray, "3"]

    @cached_property
    def _corners(self) -> Float[np.ndarray, "8 3"]:
        return box_corners(self.item.size_m + 2.0 * ROUNDED_M) @ self.R_world_item.T + self.at

    @cached_property
    def low(self) -> Float[np.ndarray, "3"]:
        """Lowest corner of its box in the world."""
        return np.asarray(self._corners.min(axis=0))

    @cached_property
    def high(self) -> Float[np.ndarray, "3"]:
        """Highest corner of its box in the world."""
        return np.asarray(self._corners.max(axis=0))

    @cached_property
    def triangles(self) -> fcl.CollisionObject:
        """What collides."""
        model = _model(_Mesh(self.library, self.item.shape.id), self.item.scale)
        return fcl.CollisionObject(model, fcl.Transform(self.R_world_item, self.at))


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
def _model(mesh: _Mesh, scale: tuple[float, float, float]) -> fcl.BVHModel:
    vertices, faces = mesh.arrays()
    vertices = vertices * scale
    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(faces))
    model.addSubModel(vertices, faces)
    model.endModel()
    return model


@lru_cache(maxsize=512)
def _caster(mesh: _Mesh) -> RayScene:
    return RayScene(*mesh.arrays())


def heights_below(
    library: ShapeLibrary, shape_id: str, points: Float[np.ndarray, "n 3"], reach_m: float
) -> Float[np.ndarray, "n"]:
    """z of the first surface under points, canonical frame; -inf where none is within reach.

    Args:
        library: where shapes come from.
        shape_id: of the library.
        points: canonical frame, metres.
        reach_m: downward.
    """
    down = np.concatenate([points, np.tile([0.0, 0.0, -1.0], (len(points), 1))], axis=1).astype(np.float32)
    t = _caster(_Mesh(library, shape_id)).first_hits(down).distance
    return np.where(t <= reach_m, points[:, 2] - t, -np.inf)
