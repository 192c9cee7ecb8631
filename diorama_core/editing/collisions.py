"""Which objects run into each other: exact triangle meshes (python-fcl), with room for touching."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import fcl
import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.io.cache import LruCache
from diorama_core.library import taxonomy
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Pose, Scene, SceneObject

TOUCHING_M = 0.006
"""Objects shrunk by this much still overlap where they collide, not where they merely touch."""
CACHE_SIZE = 400
WALKED_ON_M = 0.035
"""Flatter objects (rugs, mats) may lie under other objects."""

Pair = tuple[str, str]


class Collisions:
    """Bounding volume hierarchies of shapes, cached by shape and size. Used from one thread."""

    def __init__(self, library: ShapeLibrary) -> None:
        self._library = library
        self._trees: LruCache[tuple[str, tuple[float, ...]], fcl.BVHModel] = LruCache(CACHE_SIZE)

    def pairs(self, scene: Scene, ids: Iterable[str], poses: Mapping[str, Pose] | None = None) -> frozenset[Pair]:
        """Pairs (a chosen object, any other) that collide.

        Args:
            scene: everything.
            ids: whose collisions are asked for.
            poses: current poses of objects that differ from the scene.
        """
        chosen = set(ids)
        items = [o for o in scene.objects if not o.hidden and not _soft(o)]
        here = {o.id: (poses or {}).get(o.id, o.pose) for o in items}
        if not items:
            return frozenset()
        low, high = _boxes(items, here)
        pairs: set[Pair] = set()
        for k in [k for k, o in enumerate(items) if o.id in chosen]:
            near = ((low <= high[k] - TOUCHING_M) & (high >= low[k] + TOUCHING_M)).all(axis=1)
            for j in np.flatnonzero(near):
                a, b = items[k], items[int(j)]
                if a.id == b.id or (b.id in chosen and int(j) < k) or _belongs(scene, a.id, b.id):
                    continue
                if self._hit(a, here[a.id], b, here[b.id]):
                    pairs.add((a.id, b.id))
        return frozenset(pairs)

    def _hit(self, a: SceneObject, a_pose: Pose, b: SceneObject, b_pose: Pose) -> bool:
        first = fcl.CollisionObject(self._tree(a), _transform(a_pose))
        second = fcl.CollisionObject(self._tree(b), _transform(b_pose))
        return bool(fcl.collide(first, second, fcl.CollisionRequest(), fcl.CollisionResult()))

    def _tree(self, item: SceneObject) -> fcl.BVHModel:
        shrunk = 1.0 - np.minimum(TOUCHING_M / np.maximum(item.size_m, 1e-6), 0.5)
        scale = np.asarray(item.pose.scale) * shrunk
        key = (item.shape_id, tuple(np.round(scale, 4)))
        return self._trees.get(key, lambda: _bounding_tree(self._library.mesh(item.shape_id), scale))


def _bounding_tree(mesh: trimesh.Trimesh, scale: Float[np.ndarray, "3"]) -> fcl.BVHModel:
    tree = fcl.BVHModel()
    vertices = np.asarray(mesh.vertices, dtype=np.float64) * scale
    tree.beginModel(len(mesh.faces), len(vertices))
    tree.addSubModel(vertices, np.asarray(mesh.faces, dtype=np.int64))
    tree.endModel()
    return tree


def _boxes(items: list[SceneObject], here: Mapping[str, Pose]) -> tuple[np.ndarray, np.ndarray]:
    half = np.array(
        [np.abs(here[o.id].R_world_object) @ (np.asarray(o.shape_size_m) * here[o.id].scale) / 2 for o in items]
    )
    centre = np.array([here[o.id].position for o in items])
    return centre - half, centre + half


def _transform(pose: Pose) -> fcl.Transform:
    return fcl.Transform(np.array(pose.R_world_object), np.array(pose.position))


def _soft(item: SceneObject) -> bool:
    """Whether running into it is no harm: what gives way, and what is walked on."""
    return taxonomy.resolve(item.category).category.soft or float(item.size_m[2]) < WALKED_ON_M


def _belongs(scene: Scene, a: str, b: str) -> bool:
    """What lies on or in its supporter touches it by right (a book pressed into a soft seat, a plant in its pot)."""
    return b in scene.children_of(a) or a in scene.children_of(b)
