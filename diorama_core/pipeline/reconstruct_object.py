"""Reconstruction of a single object from the photo: segmented, measured, retrieved and posed in the scene as it is now.

Camera, room and everything else stay. The photo's own artefacts come from the plan, with the project's cached results;
only what is downstream of the one box is evaluated again. Where nothing differs from what was built, nothing changes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, UInt8

from diorama_core.artefacts import DetectedObject, Inputs, LabelledBox, ObjectGeometry, PosedCandidates
from diorama_core.errors import InputError
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.drawn_boxes import find_drawn_box
from diorama_core.pipeline.fallback import with_usable_networks
from diorama_core.pipeline.plan import evaluate
from diorama_core.pipeline.presets import stages_for
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.stages import Stages
from diorama_core.pipeline.steps import Artefacts
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import ObjectStage
from diorama_core.retrieval.seen_kinds import with_seen_kinds
from diorama_core.retrieval.word_senses import with_word_senses
from diorama_core.scene.types import (
    Camera,
    Plane,
    PlaneRole,
    Pose,
    Scene,
    SceneObject,
    Support,
    yaw_rotation,
)


@dataclass(frozen=True, eq=False)
class Found:
    """What the photo says of one box."""

    item: SceneObject
    """Its id is the asked one."""
    support: Support | None
    pictures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]]
    """Textures of its materials from the photo, by name."""
    as_built: bool
    """Whether the correction changes nothing: the scene has this object already."""


@dataclass(frozen=True, eq=False)
class _Similarity:
    """From the world of a fresh measurement to the scene's: p' = scale R p + t, such that the cameras coincide."""

    R: Float[np.ndarray, "3 3"]
    t: Float[np.ndarray, "3"]
    scale: float

    @classmethod
    def from_cameras(cls, measured: Camera, scene: Camera, floor_m: float) -> _Similarity:
        """Both cameras are the photo's; their heights above the floor say how lengths compare.

        In the measurement the floor is at 0.
        """
        if np.array_equal(measured.T_world_camera, scene.T_world_camera):
            return cls(np.eye(3), np.zeros(3), 1.0)
        R = scene.T_world_camera[:3, :3] @ measured.T_world_camera[:3, :3].T
        above = float(measured.position[2])
        scale = float(scene.position[2] - floor_m) / above if above > 0.05 else 1.0
        return cls(R, scene.position - scale * R @ measured.position, scale)

    def pose(self, pose: Pose) -> Pose:
        """The pose in the scene; where the scene's camera was tilted since, objects stay upright all the same."""
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
    progress: Progress = SILENT,
) -> Found:
    """Reconstruct the object in a box of the photo.

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
    reconstruction, _ = with_usable_networks(
        lambda store: stages_for("auto", inputs, library, store=store),
        lambda stages: _reconstruct(stages, scene, inputs, library, box, object_id, mask, Runner(cache), progress),
    )
    return reconstruction


def _reconstruct(
    stages: Stages,
    scene: Scene,
    inputs: Inputs,
    library: ShapeLibrary,
    box: LabelledBox,
    object_id: str,
    mask: Bool[np.ndarray, "h w"] | None,
    runner: Runner,
    progress: Progress,
) -> Found:
    photo = evaluate(stages, {"given": inputs}, ("architecture",), runner, progress.part(0.0, 0.5))
    known = next((o for o in photo["objects"] if o.id == object_id), None)
    outlined = next((o for o in photo["outlined_objects"] if o.id == object_id), None)
    if known is not None and outlined is not None and _says(photo["inputs"], outlined, box, mask):
        built = evaluate(stages, photo, ("posed",), runner, progress.part(0.5, 1.0))
        candidates = next((p for p in built["posed"] if p.object_id == object_id and p.candidates), None)
        if candidates is not None:
            return _build_object(stages, scene, library, known, built, candidates, as_built=True)
    detected = _segment(stages.objects, photo["inputs"], box, mask, object_id, progress.part(0.5, 0.6))
    artefacts, posed = _pose_alone(stages, photo, detected, progress.part(0.6, 1.0))
    if posed is None:
        raise InputError(f"the library has no shape for “{box.label}”; choose a more common name")
    return _build_object(stages, scene, library, detected, artefacts, posed, as_built=False)


def _says(inputs: Inputs, known: DetectedObject, box: LabelledBox, mask: Bool[np.ndarray, "h w"] | None) -> bool:
    """Whether a box, its name and its outline are what the build knew of the object."""
    drawn = find_drawn_box(inputs.boxes, known.box)
    same_box = drawn is not None and (drawn.box, drawn.category, drawn.label) == (box.box, box.category, box.label)
    return same_box and (mask is None or np.array_equal(mask, known.mask))


def _segment(
    stage: ObjectStage,
    inputs: Inputs,
    box: LabelledBox,
    mask: Bool[np.ndarray, "h w"] | None,
    object_id: str,
    progress: Progress,
) -> DetectedObject:
    if mask is None:
        alone = replace(inputs, boxes=(box,), instances=None, instance_boxes=())
        return replace(stage.segment(alone, progress)[0], id=object_id)
    return DetectedObject(object_id, box.category, box.label, box.box, mask, 1, 1.0)


def _pose_alone(
    stages: Stages, photo: Artefacts, detected: DetectedObject, progress: Progress
) -> tuple[Artefacts, PosedCandidates | None]:
    """The photo's artefacts with the object among the others, and the object's candidates, ranked for it alone."""
    others = tuple(o for o in photo["objects"] if o.id != detected.id)
    if stages.naming is not None:
        seen = stages.naming.name(photo["inputs"].photo, (detected,), progress.part(0.0, 0.0))
        detected = with_seen_kinds((detected,), seen)[0]
    objects = (*others, with_word_senses((*others, detected), photo["camera"])[-1])
    fixed = {name: photo[name] for name in ("given", "inputs", "camera", "architecture")}
    uncached = Runner(None)
    whole = evaluate(stages, {**fixed, "objects": objects}, ("geometry", "depth"), uncached, progress.part(0.0, 0.4))
    geometry: ObjectGeometry = whole["geometry"]
    cuboids = tuple(c for c in geometry.cuboids if c.object_id == detected.id)
    alone = {
        **fixed,
        "furniture_objects": (detected,),
        "geometry": replace(geometry, cuboids=cuboids),
        "depth": whole["depth"],
    }
    posed = evaluate(stages, alone, ("posed",), uncached, progress.part(0.4, 1.0))["posed"]
    return whole, posed[0] if posed and posed[0].candidates else None


def _build_object(
    stages: Stages,
    scene: Scene,
    library: ShapeLibrary,
    detected: DetectedObject,
    photo: Artefacts,
    posed: PosedCandidates,
    *,
    as_built: bool,
) -> Found:
    assert scene.camera is not None
    geometry: ObjectGeometry = photo["geometry"]
    floor = scene.architecture.floor
    level = 0.0 if floor is None else float(floor.polygon[:, 2].mean())
    to_scene = _Similarity.from_cameras(geometry.camera, scene.camera, level)
    here = tuple(replace(c, pose=to_scene.pose(c.pose)) for c in posed.candidates)
    alone = {
        **{name: photo[name] for name in ("inputs", "objects", "architecture", "geometry")},
        "library": library,
        "furniture_objects": (detected,),
        "posed": (replace(posed, candidates=here),),
    }
    one = evaluate(stages, alone, ("posed_scene",), Runner(None))
    item: SceneObject = replace(one["posed_scene"].objects[0], mask_id=None)
    parent = next((s.parent for s in geometry.supports if s.child == detected.id), "floor")
    objects = (detected, *(o for o in photo["objects"] if o.id != detected.id))
    shown = {**one, "furniture_objects": objects, "observed": Scene(camera=scene.camera, objects=(item,))}
    look = evaluate(stages, shown, ("appearance",), Runner(None))["appearance"]
    item = look.apply(shown["observed"]).objects[0]
    return Found(item, _edge(scene, item, parent), look.pictures, as_built)


def _edge(scene: Scene, item: SceneObject, parent: str) -> Support | None:
    """The edge in the scene's terms: floor, wall and ceiling become planes, what is gone becomes the floor."""
    if scene.has_object(parent) and parent != item.id:
        return Support(item.id, parent)
    role: PlaneRole = "wall" if parent == "wall" else "ceiling" if parent == "ceiling" else "floor"
    planes = scene.architecture.by_role(role)
    if not planes:
        return None

    def far(plane: Plane) -> float:
        return abs(float(plane.normal @ item.pose.position) - plane.offset)

    plane = min(planes, key=far)
    return Support(item.id, plane.id, "placed on" if role == "floor" else "mounted on")
