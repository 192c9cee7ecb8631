"""A photo that was taken in a scanned room.

The furniture in it tells where it was taken. Then it tells what things are and look like, what the scan does not know,
and how floor and walls look. Walls and boxes stay as they were measured.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float
from shapely.geometry import MultiPoint, Polygon

from diorama_core.artefacts import DetectedObject, FurtherPhoto, Inputs, LabelledBox
from diorama_core.errors import InputError
from diorama_core.importing.opening import Opened
from diorama_core.importing.roomplan_parts import kinds_of_label
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import UNKNOWN, resolve
from diorama_core.multiview.adding import AddedPhoto, with_photo
from diorama_core.multiview.camera_in_room import FoundCamera, MeasuredThing, camera_in_room
from diorama_core.multiview.one_scene import move_to_room
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.pipeline.plan import evaluate
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import LayoutStage
from diorama_core.scene.types import Pose, Scene, SceneObject, yaw_rotation


def with_photo_of_scan(
    opened: Opened,
    inputs: Inputs,
    library: ShapeLibrary,
    choose: Callable[[Inputs], Stages],
    layout: Callable[[frozenset[str]], LayoutStage],
    progress: Progress = SILENT,
) -> Opened:
    """A scanned room with what a photo shows; the photo is the scene's own from now on.

    Args:
        opened: the scan's scene; it has no photo yet.
        inputs: the photo; where nothing is marked in it, what a detector finds counts.
        library: where shapes come from.
        choose: the stages for a photo.
        layout: the optimiser, given the ids that are free to move.
        progress: reports and cancellation.

    Returns:
        The scene with the floor at 0 and the room's axes along x and y.

    Raises:
        InputError: the photo does not show enough of what was scanned.
        Cancelled: on request.
        DioramaError: when a stage cannot do its work.
    """
    name = inputs.photo.name
    scene = move_to_room(opened.scene, _to_axes(opened.scene))
    artefacts = evaluate(
        choose(inputs), {"given": inputs}, ("inputs", "camera", "objects"), Runner(None), progress.part(0.0, 0.3)
    )
    objects: Sequence[DetectedObject] = artefacts["objects"]
    camera = _camera(scene, artefacts, inputs, progress.part(0.3, 0.4))
    if camera is None:
        raise InputError(
            f"{name} does not join the scan: the furniture in it is not where the scan has any; mark at least three "
            "objects that were scanned, such as chairs, tables, cabinets, doors and windows"
        )
    met = {box: scene.objects[thing] for thing, box in camera.met}
    marked = replace(artefacts["inputs"], boxes=tuple(_label(o, met.get(k)) for k, o in enumerate(objects)))
    seen = tuple((item.id, objects[box].box) for box, item in met.items())
    added = with_photo(
        scene,
        (),
        FurtherPhoto(name, replace(marked, intrinsics=camera.camera.intrinsics), camera.camera, seen),
        frozenset(p.id for p in scene.architecture.planes),
        frozenset(o.id for o in scene.objects),
        library,
        choose,
        layout,
        progress.part(0.4, 1.0),
        measured_room=True,
    )
    note = f"{name}: {len(added.joined)} scanned objects are seen in it, {len(added.new)} objects came from it"
    return Opened(
        _as_measured(added, scene),
        {**opened.textures, **added.textures},
        (*opened.changes, note),
        opened.provenance,
        inputs.photo,
        added.photo.inputs.boxes,
    )


def _as_measured(added: AddedPhoto, scan: Scene) -> Scene:
    """The scene with its scanned objects as large as they were measured; the photo is its own."""
    boxes, measured = dict(added.photo.seen), {o.id: o for o in scan.objects}
    objects = tuple(
        replace(_filling(o, measured[o.id]) if o.id in measured else o, box_px=boxes.get(o.id))
        for o in added.scene.objects
    )
    return replace(added.scene, camera=added.photo.camera, objects=objects)


def _camera(scene: Scene, artefacts: dict, inputs: Inputs, progress: Progress) -> FoundCamera | None:
    estimate = artefacts["camera"]
    k = estimate.best.intrinsics
    boxes = gather(artefacts["objects"], k.width, k.height)
    given = inputs.intrinsics is not None or inputs.photo.exif_focal_px is not None
    return camera_in_room(
        [_thing(o) for o in scene.objects], _floor(scene), estimate, boxes, progress, focal_known=given
    )


def _thing(item: SceneObject) -> MeasuredThing:
    kinds, corners = frozenset((item.category, *kinds_of_label(item.label))), item.corners_world
    return MeasuredThing(kinds, (corners.min(axis=0) + corners.max(axis=0)) / 2, item.pose.yaw_rad, item.size_m)


def _floor(scene: Scene) -> Polygon:
    floor = scene.architecture.floor
    points = floor.polygon if floor is not None else np.vstack([o.corners_world for o in scene.objects])
    return Polygon(points[:, :2]) if floor is not None else MultiPoint(points[:, :2]).convex_hull.buffer(1.0)


def _to_axes(scene: Scene) -> Float[np.ndarray, "4 4"]:
    """To the frame of built scenes: the floor at 0, most of the walls along x and y."""
    walls = [w.polygon[:, :2] for w in scene.architecture.by_role("wall")]
    sides = np.vstack([np.diff(w, axis=0, append=w[:1]) for w in walls]) if walls else np.zeros((0, 2))
    angles, lengths = np.arctan2(sides[:, 1], sides[:, 0]), np.linalg.norm(sides, axis=1)
    turn = float(np.angle((lengths * np.exp(4j * angles)).sum())) / 4.0 if len(sides) else 0.0
    T = np.eye(4)
    T[:3, :3] = yaw_rotation(-turn)
    floor = scene.architecture.floor
    lowest = [float(o.corners_world[:, 2].min()) for o in scene.objects]
    T[2, 3] = -(float(floor.polygon[:, 2].mean()) if floor is not None else min(lowest, default=0.0))
    return T


def _label(item: DetectedObject, scanned: SceneObject | None) -> LabelledBox:
    """A marked thing; what nobody named is called as the scan calls it: a loose word that its picture explains."""
    if scanned is None or item.category != UNKNOWN.name:
        return LabelledBox(item.box, item.category, item.label)
    understood = resolve(scanned.label)
    word = scanned.label if understood.exact else scanned.category  # "storage" is nobody's word for a thing
    return LabelledBox(item.box, resolve(word).category.name, word)


def _filling(item: SceneObject, measured: SceneObject) -> SceneObject:
    """The object, and every candidate, filling its measured box, its front where the scan says."""

    def filling(shape_size_m: tuple[float, float, float]) -> Pose:
        return replace(measured.pose, scale=measured.size_m / np.array(shape_size_m))

    candidates = tuple(replace(c, pose=filling(c.shape_size_m)) for c in item.candidates)
    return replace(item, pose=filling(item.shape_size_m), candidates=candidates)
