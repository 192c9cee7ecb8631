"""One object perceived anew from the photo: outlined, measured, retrieved and posed in the scene as it is now.

Camera, room and everything else stay. The photo's own stages come from the project's saved results; only what is
downstream of the one box runs again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.artefacts import DetectedObject, Inputs, LabelledBox, ObjectGeometry
from diorama_core.errors import InputError
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.colours import photo_colours
from diorama_core.pipeline.network_inputs import with_network_inputs
from diorama_core.pipeline.presets import stages_for
from diorama_core.pipeline.runner import Runner
from diorama_core.progress import Progress
from diorama_core.scene.types import Camera, Candidate, Plane, Pose, Scene, SceneObject, Support, yaw_rotation

NEW_ID = "looked_at_again"


@dataclass(frozen=True, eq=False)
class Found:
    """What the photo says of one box."""

    item: SceneObject
    """Its id is the asked one."""
    support: Support | None
    found_object: DetectedObject


@dataclass(frozen=True, eq=False)
class _Similarity:
    """From the world of a fresh measurement to the scene's: p' = scale R p + t, such that the cameras coincide."""

    R: Float[np.ndarray, "3 3"]
    t: Float[np.ndarray, "3"]
    scale: float

    @classmethod
    def between(cls, measured: Camera, scene: Camera, floor_m: float) -> _Similarity:
        """Both cameras are the photo's; their heights above the floor say how lengths compare."""
        R = scene.T_world_camera[:3, :3] @ measured.T_world_camera[:3, :3].T
        above = float(measured.position[2])
        scale = float(scene.position[2] - floor_m) / above if above > 0.05 else 1.0
        return cls(R, scene.position - scale * R @ measured.position, scale)

    def pose(self, pose: Pose) -> Pose:
        """The pose in the scene; where the scene's camera was tilted since, things stay upright all the same."""
        level = yaw_rotation(float(np.arctan2(self.R[1, 0], self.R[0, 0])))
        position = self.scale * self.R @ pose.position + self.t
        return Pose(level @ pose.R_world_object, position, pose.scale * self.scale)


def reconstruct_object(
    scene: Scene,
    inputs: Inputs,
    library: ShapeLibrary,
    box: LabelledBox,
    object_id: str,
    *,
    mask: Bool[np.ndarray, "h w"] | None = None,
    cache: Path | None = None,
    progress: Progress | None = None,
) -> Found:
    """Find out what is in a box of the photo.

    Args:
        scene: as it is now; gives the camera and the room.
        inputs: the photo and everything that was given with it.
        library: where shapes come from.
        box: where, and what it is called.
        object_id: the id of what is found; the present object of that id is left out of the evidence.
        mask: its outline, where a person drew it; found otherwise.
        cache: folder of the project's stage results.
        progress: reports and cancellation.

    Raises:
        InputError: the scene has no camera, or nothing of the library is like it.
        Cancelled: on request.
    """
    if scene.camera is None:
        raise InputError("this scene has no photo camera; build it from the photo first")
    progress = progress or Progress()
    stages, runner = stages_for("auto", inputs, library), Runner(cache)
    inputs = with_network_inputs(inputs, stages, runner, progress.part(0.0, 0.05))
    camera = runner.run("camera", stages.camera, stages.camera.estimate, (inputs,), progress.part(0.05, 0.1))
    seen = inputs.of_any_camera  # as the build asks, for its saved result
    known = runner.run("objects", stages.objects, stages.objects.segment, (seen,), progress.part(0.1, 0.4))
    geometry = runner.run(
        "geometry", stages.geometry, stages.geometry.measure, (inputs, camera, known), progress.part(0.4, 0.5)
    )
    room = runner.run(
        "architecture",
        stages.architecture,
        stages.architecture.reconstruct,
        (inputs, known, geometry),
        progress.part(0.5, 0.55),
    )
    found_object = _outlined(stages.objects.segment, inputs, box, mask, progress.part(0.55, 0.6))
    others = tuple(o for o in known if o.id != object_id)
    measured = stages.geometry.measure(inputs, camera, (*others, found_object), progress.part(0.6, 0.7))
    alone = replace(measured, cuboids=tuple(c for c in measured.cuboids if c.object_id == NEW_ID))
    depth = stages.depth.depth(inputs, (*others, found_object), measured, room, progress.part(0.7, 0.75))
    shapes = stages.retrieval.retrieve(inputs, (found_object,), alone, progress.part(0.75, 0.85))
    posed = stages.pose.pose(inputs, (found_object,), alone, depth, shapes, progress.part(0.85, 1.0))
    if not posed or not posed[0].candidates:
        raise InputError(f"nothing in the library is like a {box.label}; call it something plainer")
    return _found(scene, library, found_object, measured, posed[0].candidates, posed[0].confidence, inputs, object_id)


def _outlined(
    segment: object, inputs: Inputs, box: LabelledBox, mask: np.ndarray | None, progress: Progress
) -> DetectedObject:
    if mask is None:
        alone = replace(inputs, boxes=(box,), instances=None, instance_boxes=())
        return replace(segment(alone, progress)[0], id=NEW_ID)  # type: ignore[operator]
    return DetectedObject(NEW_ID, box.category, box.label, box.box, mask, 1, 1.0)


def _found(
    scene: Scene,
    library: ShapeLibrary,
    found_object: DetectedObject,
    geometry: ObjectGeometry,
    candidates: tuple[Candidate, ...],
    confidence: float,
    inputs: Inputs,
    object_id: str,
) -> Found:
    assert scene.camera is not None
    floor = scene.architecture.floor
    level = 0.0 if floor is None else float(floor.polygon[:, 2].mean())
    to_scene = _Similarity.between(geometry.camera, scene.camera, level)
    here = tuple(replace(c, pose=to_scene.pose(c.pose)) for c in candidates)
    best = here[0]
    category = found_object.category if found_object.category != "object" else library.shape(best.shape_id).category
    item = SceneObject(
        id=object_id,
        label=found_object.label,
        category=category,
        shape_id=best.shape_id,
        shape_size_m=best.shape_size_m,
        pose=best.pose,
        candidates=here,
        box_px=found_object.box,
        confidence=confidence,
        colour=photo_colours(inputs.photo.rgb, (found_object,)).get(NEW_ID),
    )
    parent = next((s.parent for s in geometry.supports if s.child == NEW_ID), "floor")
    return Found(item, _edge(scene, item, parent), found_object)


def _edge(scene: Scene, item: SceneObject, parent: str) -> Support | None:
    """The edge in the scene's terms: floor, wall and ceiling become planes, what is gone becomes the floor."""
    if scene.has_object(parent) and parent != item.id:
        return Support(item.id, parent)
    role = parent if parent in ("wall", "ceiling") else "floor"
    planes = scene.architecture.by_role(role)  # type: ignore[arg-type]
    if not planes:
        return None

    def far(plane: Plane) -> float:
        return abs(float(plane.normal @ item.pose.position) - plane.offset)

    plane = min(planes, key=far)
    return Support(item.id, plane.id, "placed on" if role == "floor" else "mounted on")
