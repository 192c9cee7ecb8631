from __future__ import annotations

import numpy as np

from diorama_core.scene.types import Pose, Scene, SceneObject, Support
from diorama_core.synthesis.layout_rooms import BoxLibrary, room_box


class Room:
    """Writes small scenes in few words: `room.put("table", ...)`, then `room.scene()`."""

    def __init__(self, library: BoxLibrary) -> None:
        self.library = library
        self.objects: list[SceneObject] = []
        self.supports: list[Support] = []

    def put(self, shape: str, at: tuple[float, float, float], on: str | None = "floor", **more) -> str:
        record = self.library.shape(shape)
        name = more.pop("id", f"{shape}_{len(self.objects)}")
        pose = more.pop("pose", None) or Pose.upright(at, more.pop("yaw", 0.0), more.pop("scale", (1.0, 1.0, 1.0)))
        edge = {k: more.pop(k) for k in ("relation", "parent_surface", "child_face", "adheres_to") if k in more}
        self.objects.append(SceneObject(name, name, record.category, shape, record.size_m, pose, **more))
        if on is not None:
            self.supports.append(Support(name, on, **edge))
        return name

    def scene(self, **more) -> Scene:
        more.setdefault("architecture", room_box(6.0, 5.0))
        return Scene(objects=tuple(self.objects), supports=tuple(self.supports), **more)


def tilted(pose: Pose, degrees: float, axis: int = 0) -> Pose:
    angle = np.deg2rad(degrees)
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turn = np.eye(3)
    turn[i, i], turn[i, j], turn[j, i], turn[j, j] = c, -s, s, c
    return Pose(turn @ pose.R_world_object, pose.position, pose.scale)
