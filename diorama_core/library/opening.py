"""Doors, drawers and lids that stand open: built-in shapes whose moving parts are moved along their joints."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from diorama_core.library.furniture.articulation import articulation, joint_of
from diorama_core.library.furniture.joints import Joint
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.library.stretch import EVEN, Scale

BUILT_IN = "built in"
STEPS = 20
"""Shapes are made for so many degrees of openness: each is meshes of its own."""


def can_open(library: ShapeLibrary, shape_id: str) -> bool:
    """Whether a shape has doors, drawers or lids; those that are not built in do not tell."""
    if record_of(library, shape_id).source != BUILT_IN:
        return False
    pieces = articulation(shape_id)
    return pieces is not None and any(j.kind != "swivel" for j in pieces.joints)


def opened_parts(library: ShapeLibrary, shape_id: str, open_share: float, scale: Scale = EVEN) -> trimesh.Scene:
    """The parts of a shape as it stands open; the library's own where nothing of it opens.

    Args:
        library: where it is.
        shape_id: which shape.
        open_share: 0 closed to 1 as far as it goes.
        scale: by which it will be scaled, relative to an even scale: what turns keeps its form.

    Raises:
        LibraryError: when the shape is unknown.
    """
    step = round(open_share * STEPS)
    if step == 0 or not can_open(library, shape_id):
        return library.parts(shape_id)
    return _opened(shape_id, step, scale)


class OpenedShapes:
    """Lets an open shape be read like the parts of a library's shape."""

    def __init__(self, library: ShapeLibrary, open_share: float, scale: Scale = EVEN) -> None:
        """Arguments as for `opened_parts`."""
        self._library, self._open_share, self._scale = library, open_share, scale

    def parts(self, shape_id: str) -> trimesh.Scene:
        """Geometry with materials, in the canonical frame. Shared: do not change it."""
        return opened_parts(self._library, shape_id, self._open_share, self._scale)


@lru_cache(maxsize=64)
def _opened(shape_id: str, step: int, scale: Scale) -> trimesh.Scene:
    pieces = articulation(shape_id)
    assert pieces is not None
    scene = trimesh.Scene()
    for name, mesh in pieces.scene.geometry.items():
        number = joint_of(str(name))
        shown = mesh.copy()
        if number is not None:
            shown.vertices = _moved(np.asarray(mesh.vertices), pieces.joints[number], step / STEPS, np.array(scale))
        scene.add_geometry(shown, node_name=str(name), geom_name=str(name))
    return scene


def travel_at(joint: Joint, open_share: float) -> float:
    """How far along its joint a part stands, radians or metres, when its shape is open by a share; 0 for swivels."""
    if joint.kind == "swivel":
        return 0.0
    return joint.lower + round(open_share * STEPS) / STEPS * (joint.upper - joint.lower)


def _moved(
    vertices: Float[np.ndarray, "n 3"], joint: Joint, share: float, scale: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "n 3"]:
    """Vertices moved a share of the way along a joint, rigidly in the scaled shape."""
    travel = travel_at(joint, share)
    axis, origin = np.asarray(joint.axis), np.asarray(joint.origin)
    if joint.kind == "slide":
        return vertices + travel * axis
    if joint.kind == "swivel":
        return vertices
    scaled_axis = axis * scale
    R = Rotation.from_rotvec(travel * scaled_axis / np.linalg.norm(scaled_axis)).as_matrix()
    return (((vertices - origin) * scale) @ R.T) / scale + origin
