"""Scores of a predicted scene against the true one: placement, structure, relations, overlap, the picture.

Everything of a prediction is compared in the true camera's world: the two cameras are laid on each other, so an error
of the estimated camera counts. Objects that are asked for and absent are wrong in every share.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial import cKDTree

from diorama_core.evaluation.metrics.pose import (
    Alignment,
    Placed,
    nothing_right,
    object_alignment,
    scene_alignment,
    without_symmetry,
)
from diorama_core.evaluation.metrics.shape import shape_distance, shape_points
from diorama_core.evaluation.reports.tables import mean
from diorama_core.geometry.planes import is_in_plane_polygon
from diorama_core.geometry.projection import box_iou
from diorama_core.geometry.ray_scene import RayScene
from diorama_core.layout.exact import drift, mesh_overlap_m3, stable_share
from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.report import measure
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.room_edits import floor_height
from diorama_core.scene.types import Intrinsics, Scene, SceneObject
from diorama_core.synthesis.artefacts import true_supports
from diorama_core.synthesis.truth import TruthView, transform

SAME_BOX = 0.5
"""Boxes that overlap less than this are of different objects."""
SUPPORT_M = 0.01
"""SceneEval: an object within this of what holds it up is supported."""
PROBE_M = 0.05
"""Supporters are looked for from this far above an object's foot."""
INSIDE_SHARE = 0.99
"""SceneEval: an object with less of its footprint over the floor is out of bounds."""
NEAR_M = 0.1
"""Surfaces within this of one another agree (F-score@0.1)."""
OBJECT_POINTS = 400
"""Points that stand for the surface of an object."""


@dataclass(frozen=True)
class SceneScores:
    """One scene against its truth."""

    asked: int
    """Objects that should be there."""
    found: int
    pairs: Alignment
    """Scene-aware alignment, mean over pairs."""
    every: Alignment
    """Scene-aware alignment, against every other object."""
    own: Alignment
    """Object-focus alignment."""
    headed: Alignment
    """`pairs` with every heading counting: the symmetry of shapes is ignored."""
    each_axis: Alignment
    """`pairs` with relative sizes right along each axis, not only in the mean over the three."""
    height_off: float | None
    """Estimated over true camera height, less 1; None without a camera."""
    shape_distance: float | None
    """Mean chamfer (squared, both ways added) of the chosen shapes to the true ones, times 1000, over found objects;
    None without any."""
    relation: float
    """Share of the true support edges among the objects asked for whose parent and relation were found."""
    orientation: float
    placement: float
    structure: float
    """The layout report's shares (1 degree, 0.1 cm, both)."""
    box_overlap_cm: float | None
    """Overlap of bounding boxes per object; None without any."""
    mesh_overlap_l: float | None
    """Volume in litres shared by meshes of objects that do not hold each other up; None without any."""
    supported: float
    """SceneEval: share of found objects within 1 cm of what the scene's own graph says holds them up."""
    truly_supported: float
    """Share of the true support edges whose child is within 1 cm of the true supporter's counterpart."""
    out_of_bounds: float
    """SceneEval: share of found objects with a part of their footprint not over the scene's own floor."""
    stable: float | None
    """Share that stays put under gravity; None when not asked for."""
    drift_cm: float | None
    """Mean distance that objects move in two seconds of gravity; None when not asked for."""
    image_iou: float
    """Mean intersection over union of rendered and true masks over the objects asked for; absent ones are 0."""
    chamfer_cm: float | None
    """Mean distance from the surfaces of either scene to the nearest of the other, both ways averaged; None without
    any."""
    f_score: float
    """F-score of the surfaces of both scenes, within `NEAR_M`."""
    kind: float
    """Share of the objects asked for whose shape is of the true kind."""

    @classmethod
    def failure(cls, asked: int) -> SceneScores:
        """The prediction failed."""
        pairs, every, own = nothing_right(asked)
        return cls(
            asked, 0, pairs, every, own, pairs, pairs, None, None, relation=0.0, orientation=0.0, placement=0.0,
            structure=0.0, box_overlap_cm=None, mesh_overlap_l=None, supported=0.0, truly_supported=0.0,
            out_of_bounds=1.0, stable=None, drift_cm=None, image_iou=0.0, chamfer_cm=None, f_score=0.0,
            kind=0.0,
        )  # fmt: skip


@dataclass(frozen=True)
class Matched:
    """A prediction in the true camera's world, and what in it stands for each object asked for."""

    scene: Scene
    truth: tuple[SceneObject, ...]
    match: tuple[SceneObject | None, ...]
    """The predicted object with the same box in the photo, for each true one."""

    @classmethod
    def of(cls, view: TruthView, scene: Scene) -> Matched:
        """Move a prediction to the truth and match boxes; each predicted object is used once."""
        scene, truth = align_to_truth(scene, view), tuple(view.scene.objects[k] for k in view.indices)
        left = {o.id: o for o in scene.objects if o.box_px is not None}
        match: list[SceneObject | None] = []
        for item in truth:
            scored = [(float(box_iou(np.array(o.box_px), np.array(item.box_px))), o.id) for o in left.values()]
            best, name = max(scored, default=(0.0, ""))
            match.append(left.pop(name) if best >= SAME_BOX else None)
        return cls(scene, truth, tuple(match))

    @property
    def counterparts(self) -> dict[str, SceneObject]:
        """What stands for the true objects that were found, by their ids."""
        return {t.id: m for t, m in zip(self.truth, self.match, strict=True) if m is not None}

    def poses(self, library: ShapeLibrary) -> tuple[list[Placed], list[Placed | None]]:
        """True and predicted poses as the alignment metrics read them."""
        true = [as_placed(t, library.shape(t.shape_id).symmetry) for t in self.truth]
        return true, [None if m is None else as_placed(m) for m in self.match]


def scene_scores(view: TruthView, scene: Scene, library: ShapeLibrary, *, physics: bool = False) -> SceneScores:
    """Every metric of one predicted scene.

    Args:
        view: The truth.
        scene: The prediction, with its camera.
        library: Where the shapes of both are.
        physics: Whether to switch on gravity (seconds a scene; needs MuJoCo).
    """
    if not scene.objects:
        return SceneScores.failure(len(view.indices))
    height_off, matched = _height_off(scene, view), Matched.of(view, scene)
    scene, (true, placed) = matched.scene, matched.poses(library)
    pairs, every = scene_alignment(true, placed)
    found = [(t, m) for t, m in zip(matched.truth, matched.match, strict=True) if m is not None]
    layout = structure_of(scene, library)
    moved_by = drift(scene, library) if physics else None
    chamfer_m, f_score = surface_agreement(scene_points(scene.objects, library), scene_points(matched.truth, library))
    return SceneScores(
        asked=len(true),
        found=len(found),
        pairs=pairs,
        every=every,
        own=object_alignment(true, placed),
        headed=scene_alignment(without_symmetry(true), placed)[0],
        each_axis=scene_alignment(true, placed, every_axis=True)[0],
        height_off=height_off,
        shape_distance=mean(shape_distance(library, t.shape_id, m.shape_id) for t, m in found),
        relation=relation_accuracy(view, matched),
        orientation=layout["orientation"],
        placement=layout["placement"],
        structure=layout["structure"],
        box_overlap_cm=100 * layout["box_overlap_m"],
        mesh_overlap_l=1000 * mesh_overlap_m3(scene, library),
        supported=support_share(scene, library),
        truly_supported=true_support_share(view, matched, library),
        out_of_bounds=out_of_bounds_share(scene),
        stable=None if moved_by is None else stable_share(moved_by),
        drift_cm=None if moved_by is None else 100 * float(np.mean([d for d, _ in moved_by.values()])),
        image_iou=image_iou(view, matched, library),
        chamfer_cm=100 * chamfer_m,
        f_score=f_score,
        kind=kind_share(matched, library),
    )


def kind_share(matched: Matched, library: ShapeLibrary) -> float:
    """Share of the true objects whose counterpart has a shape of their kind."""
    right = [
        m is not None and record_of(library, m.shape_id).category == record_of(library, t.shape_id).category
        for t, m in zip(matched.truth, matched.match, strict=True)
    ]
    return float(np.mean(right)) if right else 1.0


def _height_off(scene: Scene, view: TruthView) -> float | None:
    if scene.camera is None:
        return None
    above = float(scene.camera.position[2]) - floor_height(scene)
    return above / float(view.camera.position[2]) - 1.0


def align_to_truth(scene: Scene, view: TruthView) -> Scene:
    """A prediction moved so that its camera is the true one."""
    if scene.camera is None:
        return scene
    return transform(scene, view.camera.T_world_camera @ scene.camera.T_camera_world)


def as_placed(item: SceneObject, symmetry: int = 1) -> Placed:
    """An object's pose and size as the alignment metrics read them."""
    return Placed(item.pose.R_world_object, item.pose.position, item.size_m, symmetry)


def relation_accuracy(view: TruthView, matched: Matched) -> float:
    """Share of true edges found: the same parent object, or a plane of the same role, and the same relation."""
    scene, names = matched.scene, {name: item.id for name, item in matched.counterparts.items()}
    edges = true_supports(view)
    right = 0
    for edge in edges:
        support = scene.support_of(names[edge.child]) if edge.child in names else None
        if support is None or support.relation != edge.relation:
            continue
        if view.scene.has_plane(edge.parent):
            role = view.scene.plane(edge.parent).role
            right += scene.has_plane(support.parent) and scene.plane(support.parent).role == role
        else:
            right += support.parent == names.get(edge.parent)
    return right / len(edges) if edges else 1.0


def support_share(scene: Scene, library: ShapeLibrary) -> float:
    """SceneEval's support: share of objects whose lowest point (or back) is within 1 cm of what the graph says."""
    held = [(item, scene.support_of(item.id)) for item in scene.objects]
    good = sum(edge is not None and _gap(item, edge.parent, scene, library) <= SUPPORT_M for item, edge in held)
    return good / max(len(scene.objects), 1)


def true_support_share(view: TruthView, matched: Matched, library: ShapeLibrary) -> float:
    """Share of the true support edges whose child touches (within 1 cm) what stands for its true supporter.

    For a plane any plane of the same role stands; whatever the scene's own graph says does not count.
    """
    scene, found, edges, good = matched.scene, matched.counterparts, true_supports(view), 0
    for edge in edges:
        if view.scene.has_plane(edge.parent):
            parents = [p.id for p in scene.architecture.by_role(view.scene.plane(edge.parent).role)]
        else:
            parents = [found[edge.parent].id] if edge.parent in found else []
        if edge.child in found:
            good += any(_gap(found[edge.child], p, scene, library) <= SUPPORT_M for p in parents)
    return good / len(edges) if edges else 1.0


def _footprint_points(item: SceneObject, shares: Float[np.ndarray, "s"]) -> Float[np.ndarray, "n 3"]:
    """A grid of places at an object's middle height, at shares of its depth and width from its middle, in the world."""
    grid = np.stack(np.meshgrid(shares, shares), axis=-1).reshape(-1, 2)
    return item.pose.apply(np.column_stack([grid * np.asarray(item.shape_size_m)[:2], np.zeros(len(grid))]))


def _gap(item: SceneObject, parent: str, scene: Scene, library: ShapeLibrary) -> float:
    corners = item.corners_world
    if scene.has_plane(parent):
        plane = scene.plane(parent)
        return float(np.abs(corners @ plane.normal - plane.offset).min())
    carrier = scene.object(parent)
    spots = _footprint_points(item, np.linspace(-0.45, 0.45, 7))
    spots[:, 2] = corners[:, 2].min() + PROBE_M
    rays = np.concatenate([spots, np.tile([0.0, 0.0, -1.0], (len(spots), 1))], axis=1).astype(np.float32)
    mesh = library.mesh(carrier.shape_id)
    caster = RayScene(carrier.pose.apply(np.asarray(mesh.vertices)), np.asarray(mesh.faces, np.int32))
    return float(np.abs(caster.first_hits(rays).distance - PROBE_M).min())


def out_of_bounds_share(scene: Scene, samples: int = 12) -> float:
    """SceneEval's out-of-bounds rate: objects with under 99 % of their footprint's samples over the scene's floor."""
    floor = scene.architecture.floor
    if floor is None or not scene.objects:
        return 1.0
    steps = (np.arange(samples) + 0.5) / samples - 0.5
    inside = [is_in_plane_polygon(_footprint_points(item, steps), floor).mean() for item in scene.objects]
    return float(np.mean([share < INSIDE_SHARE for share in inside]))


def image_iou(view: TruthView, matched: Matched, library: ShapeLibrary) -> float:
    """Mean mask agreement of the objects asked for when the prediction is seen by its own camera, hiding included.

    Its own, because that is the picture its user sees; an error of the camera counts in every metric in space.
    """
    ids = (None if placed is None else placed.id for placed in matched.match)
    pairs = [(view.object_ids == k, name) for k, name in zip(view.indices, ids, strict=True)]
    return mean_mask_iou(pairs, matched.scene, library, view.camera.intrinsics)


def mean_mask_iou(
    pairs: Sequence[tuple[Bool[np.ndarray, "h w"], str | None]],
    scene: Scene,
    library: ShapeLibrary,
    intrinsics: Intrinsics | None,
) -> float:
    """Mean agreement of true masks with the objects (by id, None where absent) seen by the scene's own camera.

    Args:
        pairs: true masks and the objects they should be.
        scene: the prediction, with its camera.
        library: where its shapes are.
        intrinsics: whose picture size the masks have; the scene camera's by default.
    """
    if not pairs:
        return 1.0
    if scene.camera is None:
        return 0.0
    k = intrinsics or scene.camera.intrinsics
    items = [o for o in scene.objects if not o.hidden]
    caster = MeshCaster([(library.mesh(o.shape_id), o.pose.matrix) for o in items])
    camera = scene.camera.resize(k.width, k.height)
    seen = caster.buffers(camera).instance
    index = {o.id: number for number, o in enumerate(items)}
    total = 0.0
    for true, name in pairs:
        if name in index:
            mask = seen == index[name]
            total += float((mask & true).sum() / max((mask | true).sum(), 1))
    return total / len(pairs)


def scene_points(objects: Sequence[SceneObject], library: ShapeLibrary) -> Float[np.ndarray, "n 3"]:
    """Points on the surfaces of objects in the world, as many on each."""
    points = [np.zeros((0, 3))]
    for item in objects:
        low, high = library.mesh(item.shape_id).bounds
        local = shape_points(library, item.shape_id, OBJECT_POINTS) * (high - low).max() + (low + high) / 2
        points.append(item.pose.apply(local))
    return np.concatenate(points)


def surface_agreement(points: Float[np.ndarray, "n 3"], true: Float[np.ndarray, "m 3"]) -> tuple[float, float]:
    """Mean distance to the other points, both ways averaged, and the F-score: the harmonic mean of the shares of
    either side's points that have one of the other side within `near_m`.
    """
    forward, back = np.asarray(cKDTree(true).query(points)[0]), np.asarray(cKDTree(points).query(true)[0])
    precision, recall = float((forward <= NEAR_M).mean()), float((back <= NEAR_M).mean())
    both = precision + recall
    return 0.5 * float(forward.mean() + back.mean()), 2 * precision * recall / both if both else 0.0


def structure_of(scene: Scene, library: ShapeLibrary) -> dict[str, float]:
    """The layout report's shares and overlaps of a scene as it is; all 0 for an empty one."""
    if not scene.objects:
        return {"orientation": 0.0, "placement": 0.0, "structure": 0.0, "box_overlap_m": 0.0}
    problem = build_problem(scene, library)
    return measure(problem, problem)
