"""A language model's graph applied to the geometry of the objects: supports, and fronts turned as it says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from diorama_core.artefacts import Cuboid, ObjectGeometry, SceneGraph
from diorama_core.scene.types import yaw_rotation

_TURNS: Mapping[str, float] = {
    "toward camera": np.pi,
    "away from camera": 0.0,
    "left": np.pi / 2,
    "right": -np.pi / 2,
}
"""Heading of a front relative to the line of sight, counter-clockwise seen from above."""


MAX_SETTLING_M = 0.35
"""A cuboid's underside moves no farther than this to its supporter; the layout optimiser does the rest."""
MIN_HEIGHT_M = 0.02


def with_graph(geometry: ObjectGeometry, graph: SceneGraph | None) -> ObjectGeometry:
    """The geometry with the graph's supports, and fronts turned as the graph says; unchanged without a graph."""
    if graph is None:
        return geometry
    facing = dict(graph.facing)
    turned = (_turn_front(c, facing.get(c.object_id), geometry) for c in geometry.cuboids)
    before, now = ({s.child: s.parent for s in edges} for edges in (geometry.supports, graph.supports))
    tops = {c.object_id: float(c.corners_world[:, 2].max()) for c in geometry.cuboids}
    cuboids = tuple(
        c
        if before.get(c.object_id) == now.get(c.object_id)
        else _extend_to_supporter(c, now.get(c.object_id, ""), tops)
        for c in turned
    )
    return replace(geometry, supports=graph.supports, cuboids=cuboids)


def _extend_to_supporter(cuboid: Cuboid, parent: str, tops_m: Mapping[str, float]) -> Cuboid:
    """The cuboid reaching down to a new supporter, its top where it was: the floor, or a top that is near."""
    low, high = (float(v) for v in (cuboid.corners_world[:, 2].min(), cuboid.corners_world[:, 2].max()))
    bottom = 0.0 if parent == "floor" else tops_m.get(parent, low)
    if abs(bottom - low) > MAX_SETTLING_M or high - bottom < MIN_HEIGHT_M:
        return cuboid
    size = cuboid.size_m.copy()
    size[2] = high - bottom
    centre = cuboid.centre.copy()
    centre[2] = (high + bottom) / 2
    return replace(cuboid, centre=centre, size_m=size)


def _turn_front(cuboid: Cuboid, direction: str | None, geometry: ObjectGeometry) -> Cuboid:
    """The cuboid with its front on the side that looks the named way; untouched where its front is known."""
    if direction is None or direction not in _TURNS or cuboid.front_known:
        return cuboid
    sight = cuboid.centre[:2] - geometry.camera.position[:2]
    heading = float(np.arctan2(sight[1], sight[0])) + _TURNS[direction]
    wanted = np.array([np.cos(heading), np.sin(heading)])
    quarter = max(range(4), key=lambda k: float((cuboid.R_world_object @ yaw_rotation(k * np.pi / 2))[:2, 0] @ wanted))
    size = cuboid.size_m if quarter % 2 == 0 else cuboid.size_m[[1, 0, 2]]
    R = cuboid.R_world_object @ yaw_rotation(quarter * np.pi / 2)
    return replace(cuboid, R_world_object=R, size_m=size, front_known=True)
