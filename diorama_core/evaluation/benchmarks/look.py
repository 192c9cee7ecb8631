"""The photo's own look on rendered rooms: shapes made to measure, and the photo's materials against flat colours.

The true shape of every object is removed from the library, so that the nearest other one is retrieved and fitted. What
the two steps bring is measured on the same poses: how near the shape comes to the true one, how well its outline lies
on the true outline, and how far the colours of the visible faces are from the photo's in a blurred picture (where
the photo and both models show the object: what hangs behind its wall shows none). Pictures of scenes show white light
(`render.lighting.room_lighting`), so the photo is compared as white light would have it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace

import cv2
import numpy as np
import trimesh
from jaxtyping import Bool, Float, UInt8

from diorama_core.appearance.photo_appearance import PhotoAppearance
from diorama_core.evaluation.benchmarks.cases import attempt_one, make_views, recipe
from diorama_core.evaluation.benchmarks.pose_comparison import (
    ESTIMATED_DEPTH,
    REMOVED,
    TRUE_DEPTH,
    inputs_with,
    predict,
    shapes_of,
)
from diorama_core.evaluation.metrics.colour import delta_e_2000, lab_of, light_error_deg, main_light
from diorama_core.evaluation.metrics.shape import chamfer, points_of, shape_distance
from diorama_core.evaluation.reports.tables import Column, Row, Table, mean
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.geometry.window import Window
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.stretch import relative_scale, stretch_parts
from diorama_core.pose import MadeToMeasure, RenderAndCompare
from diorama_core.progress import SILENT, Progress
from diorama_core.render.picture import instances_seen, picture
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval
from diorama_core.scene.types import Camera, Pose, Scene, SceneObject
from diorama_core.synthesis.artefacts import TrueShapes
from diorama_core.synthesis.light import room_light
from diorama_core.synthesis.truth import TruthView

GIVEN: Mapping[str, str] = {"measured depth": TRUE_DEPTH, "picture alone": ESTIMATED_DEPTH}
"""What is given besides the picture and true masks."""
KEPT = 8
"""Retrieved shapes of every object, without the true one."""
CELLS, MARGIN = 96, 0.3
"""Size and margin of the window in which outlines are compared."""
SIZE, BLUR_PX = (320, 240), 3.0
"""Size of the pictures in which colours are compared, and by how much they are blurred."""
MIN_PIXELS = 30
"""Faces of fewer pixels of such a picture are not compared."""

Picture = UInt8[np.ndarray, "h w 3"]


@dataclass(frozen=True)
class ObjectLook:
    """One object. Chamfer distances are of normalised shapes, times 1000; None where nothing can be said."""

    case: str
    given: str
    category: str
    chamfer_of_shape: float
    """Distance of the retrieved shape in its own proportions."""
    chamfer_before: float
    """Distance of the retrieved shape as it stands, stretched by structure."""
    chamfer_after: float
    """Distance of the shape made to measure."""
    outline_before: float
    """Intersection over union of the whole outlines, in the photo."""
    outline_after: float
    colour_before: float | None
    """Mean CIEDE2000 of the visible faces in blurred pictures, with flat colours on the retrieved shape."""
    colour_after: float | None
    """With the photo's materials on the shape made to measure."""


@dataclass(frozen=True)
class LookBench:
    """All objects of all rooms."""

    seed: int
    objects: tuple[ObjectLook, ...]
    seconds: tuple[tuple[str, float, float], ...]
    """What was given, and the processor time that fitting and materials took for an object, on average."""
    light_errors_deg: tuple[tuple[str, float], ...] = ()
    """What was given, and how far the main direction of the light is off, for every room."""

    def tables(self) -> tuple[Table, ...]:
        """One row for what was given."""
        names = ("chamfer of shape", "chamfer before", "chamfer after", "median before", "median after")
        columns = (
            Column("objects", "d"),
            *(Column(name, ".1f", "↓") for name in names),
            *(Column(f"outline IoU {when}", ".3f", "↑") for when in ("before", "after")),
            *(Column(f"delta E {when}", ".1f", "↓") for when in ("flat", "after")),
            Column("light °", ".0f", "↓"),
            *(Column(f"s/object {step}", ".2f", "↓") for step in ("made", "materials")),
        )
        rows = [self._row(given, made, materials) for given, made, materials in self.seconds]
        note = (
            "True shapes removed, true masks, before any layout. Chamfer: two-way mean squared distance of normalised "
            "shapes x 1000; before is the first shape as it stands, stretched by structure, after is made to measure."
        )
        return (Table("The photo's own look", columns, tuple(rows), note),)

    def _row(self, given: str, made_s: float, materials_s: float) -> Row:
        mine = [o for o in self.objects if o.given == given]
        means = [mean(getattr(o, f"chamfer_{k}") for o in mine) for k in ("of_shape", "before", "after")]
        medians = [float(np.median([getattr(o, f"chamfer_{k}") for o in mine])) for k in ("before", "after")]
        outlines = [mean(getattr(o, f"outline_{k}") for o in mine) for k in ("before", "after")]
        coloured = [o for o in mine if o.colour_before is not None and o.colour_after is not None]
        colours = [mean(getattr(o, f"colour_{k}") for o in coloured) for k in ("before", "after")]
        light = mean(error for of, error in self.light_errors_deg if of == given)
        return Row(given, (len(mine), *means, *medians, *outlines, *colours, light, made_s, materials_s))

    def to_json(self) -> dict[str, object]:
        """Tables and every object."""
        return {
            "bench": "look",
            "seed": self.seed,
            "tables": [t.to_json() for t in self.tables()],
            "objects": [asdict(o) for o in self.objects],
            "light_errors_deg": list(self.light_errors_deg),
        }


Show = Callable[[str, Picture, Picture, Picture], None]
"""Receives a case's name, its photo, and the pictures before and after."""


def run(
    library: ShapeLibrary, scenes: int = 6, seed: int = 0, progress: Progress = SILENT, show: Show | None = None
) -> LookBench:
    """Fit and dress every object of some rooms. Rooms that fail are left out with a warning.

    Args:
        library: what rooms are furnished from.
        scenes: how many rooms.
        seed: of the first one.
        progress: reports and cancellation.
        show: receives the pictures of every room.
    """
    objects: list[ObjectLook] = []
    spent: dict[str, list[tuple[float, float, int]]] = {given: [] for given in GIVEN}
    lights: list[tuple[str, float]] = []
    cases = recipe(scenes, 1, seed)
    for number, (case, view) in enumerate(make_views(cases, library, [])):
        for turn, given in enumerate(GIVEN):
            progress.report((number + turn / len(GIVEN)) / len(cases), f"{case.name}: {given}")
            name = f"{case.name} with {given}"
            result, _ = attempt_one(name, _one_room, case.name, view, given, library, show, fate="is left out")
            if result is None:
                continue
            looks, times, off_deg = result
            objects += looks
            spent[given].append(times)
            lights += [] if off_deg is None else [(given, off_deg)]
    progress.report(1.0, "done")
    seconds = tuple((given, *_mean_times(times)) for given, times in spent.items() if times)
    return LookBench(seed, tuple(objects), seconds, tuple(lights))


def _one_room(
    name: str, view: TruthView, given: str, library: ShapeLibrary, show: Show | None
) -> tuple[list[ObjectLook], tuple[float, float, int], float | None]:
    seen = predict(inputs_with(view, GIVEN[given]), library)
    retrieved = HierarchicalRetrieval(library, keep=KEPT + 1).retrieve(
        seen.inputs, seen.objects, seen.geometry, Progress()
    )
    true = TrueShapes.of(view).retrieve(seen.inputs, seen.objects, seen.geometry, Progress())
    offered = shapes_of(true, retrieved, REMOVED, KEPT)
    fit = MadeToMeasure(RenderAndCompare(library), library)
    posed = fit.stage.pose(seen.inputs, seen.objects, seen.geometry, seen.depth, offered, Progress())
    start = time.process_time()
    made = fit.fit(posed, seen.inputs, seen.objects, seen.geometry, seen.depth, Progress())
    made_s = time.process_time() - start
    fitted, known = (seen.evaluate(("posed_scene",), posed=p, library=library) for p in (posed, made))
    before, after, balanced = fitted["posed_scene"], known["posed_scene"], known["balanced_inputs"].photo.rgb
    dressing = replace(seen, known={**known, "observed": after})
    start = time.process_time()
    look: PhotoAppearance = dressing.evaluate(("appearance",))["appearance"]
    materials_s = time.process_time() - start
    after = look.apply(after)
    flat = picture(replace(before, light=after.light), library, size=SIZE)
    dressed = picture(after, library, size=SIZE, textures=look.pictures)
    if show is not None:
        show(f"{name}, {given}", cv2.resize(balanced, SIZE, interpolation=cv2.INTER_AREA), flat, dressed)
    differences = [_difference(balanced, shown) for shown in (flat, dressed)]
    shown = [(scene, instances_seen(scene, library, size=SIZE)) for scene in (before, after)]
    of_mask = {str(view.scene.objects[k].mask_id): k for k in view.indices}
    looks = []
    for item in seen.objects:
        index = of_mask.get(str(item.mask_id))
        if index is not None and before.has_object(item.id):
            pair = before.object(item.id), after.object(item.id)
            masks = [pixels == _index(scene, item.id) for scene, pixels in shown]
            colours = _colours(view, index, masks, differences)
            looks.append(_measure(name, given, view, index, pair, seen.geometry.camera, colours, library))
    at = np.array([view.scene.objects[k].pose.position for k in view.indices])
    true_light = main_light(room_light(view.scene), at)
    off_deg = light_error_deg(true_light, view.camera, look.light, seen.geometry.camera)
    return looks, (made_s, materials_s, len(seen.objects)), off_deg


def _measure(
    name: str,
    given: str,
    view: TruthView,
    index: int,
    pair: tuple[SceneObject, SceneObject],
    camera: Camera,
    colours: tuple[float | None, float | None],
    library: ShapeLibrary,
) -> ObjectLook:
    true = view.scene.objects[index]
    goal = points_of(_standing(true, library), true.id)
    near = [1000.0 * chamfer(goal, points_of(_standing(o, library), o.id)) for o in pair]
    outlines = [_outline_iou(true, view.camera, item, camera, library) for item in pair]
    alone = shape_distance(library, true.shape_id, pair[0].shape_id)
    return ObjectLook(name, given, true.category, alone, near[0], near[1], outlines[0], outlines[1], *colours)


def _standing(item: SceneObject, library: ShapeLibrary) -> trimesh.Trimesh:
    """The shape in the size at which it stands, stretched by structure as it is shown."""
    parts = stretch_parts(library.parts(item.shape_id), relative_scale(item.pose.scale))
    whole = parts.to_geometry()
    return trimesh.Trimesh(np.asarray(whole.vertices) * item.pose.scale, whole.faces, process=False)


def _outline_iou(
    true: SceneObject, true_camera: Camera, item: SceneObject, camera: Camera, library: ShapeLibrary
) -> float:
    """Intersection over union of both whole outlines within the photo, each through its own camera."""
    assert true.box_px is not None
    window = Window.from_box(true.box_px, MARGIN, CELLS)
    k = true_camera.intrinsics
    inside = window.is_in_photo(k.width, k.height)
    a, b = (
        _outline(library.mesh(o.shape_id), o.pose, seen_by, window) & inside
        for o, seen_by in ((true, true_camera), (item, camera))
    )
    return float((a & b).sum() / max((a | b).sum(), 1))


def _outline(mesh: trimesh.Trimesh, pose: Pose, camera: Camera, window: Window) -> Bool[np.ndarray, "n"]:
    batch = PoseBatch(pose.R_world_object[None], pose.position[None], np.asarray(pose.scale)[None])
    return ShapeCaster(mesh).cast(camera.position, camera.rays(window.centres_px), batch).is_hit[0]


def _difference(photo: Picture, shown: Picture) -> Float[np.ndarray, "h w"]:
    """CIEDE2000 of two blurred pictures."""
    small = cv2.resize(photo, SIZE, interpolation=cv2.INTER_AREA)
    a, b = (lab_of(cv2.GaussianBlur(p, (0, 0), BLUR_PX) / 255.0) for p in (small, shown))
    return delta_e_2000(a, b)


def _colours(
    view: TruthView,
    index: int,
    masks: Sequence[Bool[np.ndarray, "h w"]],
    differences: Sequence[Float[np.ndarray, "h w"]],
) -> tuple[float | None, float | None]:
    """Mean differences where the photo and both models (`masks`) show the object, and nothing before it."""
    mask = (view.object_ids == index).astype(np.uint8)
    visible = cv2.resize(mask, SIZE, interpolation=cv2.INTER_NEAREST).astype(bool)
    is_visible = np.logical_and.reduce([visible, *masks])
    if is_visible.sum() < MIN_PIXELS:
        return None, None
    before, after = (float(d[is_visible].mean()) for d in differences)
    return before, after


def _index(scene: Scene, object_id: str) -> int:
    return next(k for k, item in enumerate(scene.objects) if item.id == object_id)


def _mean_times(times: Sequence[tuple[float, float, int]]) -> tuple[float, float]:
    made, materials, count = np.sum(times, axis=0)
    return float(made / count), float(materials / count)
