"""Ground truth substituted for one input of a stage at a time, to measure the cost of each input's error.

A substitution replaces one quantity of an estimate by the true one and leaves everything else as the stages found it.
Worlds differ by the estimated camera: true quantities are carried over by heading alone, with either camera above the
origin and the floor at 0, so that an error of gravity stays an error of the camera.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from diorama_core.architecture.supports import resolve_supports
from diorama_core.artefacts import (
    ArchitectureEstimate,
    CameraEstimate,
    Cuboid,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    RankedShapes,
)
from diorama_core.errors import InputError
from diorama_core.geometry.projection import box_iou
from diorama_core.layout.recipes import recipe
from diorama_core.layout.refinement.stage import MaskRefinement
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.given_stages import GivenCamera
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import Progress
from diorama_core.protocols import ArchitectureStage, GeometryStage, RetrievalStage
from diorama_core.provenance import RoomMethod, RoomSource, ScaleSource
from diorama_core.scene.types import Plane, SceneObject, Support, yaw_rotation
from diorama_core.synthesis.artefacts import true_geometry
from diorama_core.synthesis.truth import TruthView

SUBSTITUTES: Mapping[str, str] = {
    "room": "the true room, in metres, turned into the estimated heading",
    "height": "everything scaled so that the camera is at its true height",
    "scale": "everything scaled by the one factor that mends the distances best (their median)",
    "distance": "every object at its true distance along its ray; its size follows",
    "rotation": "every object's true heading; its extents stay with the axes they are along",
    "size": "every object's true extents; its middle on the floor plan and its base stay",
    "shape": "the true shape of every object",
    "camera": "the true intrinsics and gravity",
    "supports": "the true support graph",
    "cuboids": "the true cuboids with the true camera",
    "masks": "the true masks",
}
"""What may be substituted, and what that means."""
PLACES = frozenset({"cuboids", "distance"})
"""Substitutes that give every object's place: it counts as measured in all later stages."""
SAME_BOX = 0.5
"""Boxes that overlap less than this are of different objects."""


def parse_substitutes(words: str) -> tuple[frozenset[str], ...]:
    """Rows of the substitution table: `room,height+room` is two rows, the second with both substituted.

    Raises:
        InputError: for a name that is not in `SUBSTITUTES`.
    """
    rows = tuple(frozenset(part.strip() for part in row.split("+")) for row in words.split(",") if row.strip())
    for name in sorted({name for row in rows for name in row} - set(SUBSTITUTES)):
        raise InputError(f"--substitute {name}: give one or more of {', '.join(SUBSTITUTES)}")
    return rows


def substitute(stages: Stages, view: TruthView, given: frozenset[str], library: ShapeLibrary) -> Stages:
    """Stages whose results carry the truth where `given` says so ("masks" belongs to the inputs).

    Args:
        stages: Those that see the picture.
        view: The truth.
        given: Names of `SUBSTITUTES`.
        library: Where shapes come from.
    """
    if given & {"camera", "cuboids"}:
        stages = replace(stages, camera=GivenCamera(view.camera))
    if given & {"height", "scale", "distance", "rotation", "size", "supports", "cuboids"}:
        stages = replace(stages, geometry=_TrueGeometry(stages.geometry, view, given))
    if given & PLACES:
        layout = recipe("feasible", library, depth_measured=True)
        stages = replace(stages, layout=layout, refinement=MaskRefinement.of(library, depth_measured=True))
    if "room" in given:
        stages = replace(stages, architecture=_TrueRoom(stages.architecture, view))
    if "shape" in given:
        stages = replace(stages, retrieval=_TrueShape(stages.retrieval, view))
    return stages


@dataclass(frozen=True)
class _TrueGeometry:
    stage: GeometryStage
    view: TruthView = field(repr=False)
    given: frozenset[str]

    def measure(
        self, inputs: Inputs, camera: CameraEstimate, objects: tuple[DetectedObject, ...], progress: Progress
    ) -> ObjectGeometry:
        """Return the stage's geometry with the true camera, sizes or places that the benchmark substitutes.

        Args:
            inputs, camera, objects, progress: as documented in `protocols.GeometryStage`.
        """
        truth = true_objects_of(objects, self.view)
        geometry = self.stage.measure(inputs, camera, objects, progress)
        return geometry_with(geometry, truth, self.view, self.given)


@dataclass(frozen=True)
class _TrueRoom:
    stage: ArchitectureStage
    view: TruthView = field(repr=False)

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """Return the true room, turned to the heading of the estimated one.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.ArchitectureStage`.
        """
        Q = heading_change(geometry, self.view)
        planes = tuple(_rotate(p, Q) for p in self.view.scene.architecture.planes)
        room = replace(self.view.scene.architecture, planes=planes)
        return ArchitectureEstimate(room, resolve_supports(geometry, room), 1.0, RoomSource(RoomMethod.GIVEN))


@dataclass(frozen=True)
class _TrueShape:
    stage: RetrievalStage
    view: TruthView = field(repr=False)

    def retrieve(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> tuple[RankedShapes, ...]:
        """Return the stage's shapes, with the true one alone where an object's truth is known.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.RetrievalStage`.
        """
        truth = true_objects_of(objects, self.view)
        rankings = self.stage.retrieve(inputs, objects, geometry, progress)
        return tuple(
            replace(r, ranked=((truth[r.object_id].shape_id, 1.0),)) if r.object_id in truth else r for r in rankings
        )


def true_objects_of(objects: tuple[DetectedObject, ...], view: TruthView) -> dict[str, SceneObject]:
    """For the id of every detected object the true one whose box is most alike, each used once."""
    left = {k: view.scene.objects[k] for k in view.indices}
    objects_by_id: dict[str, SceneObject] = {}
    for item in objects:
        scored = [(float(box_iou(np.array(item.box), np.array(o.box_px))), -k) for k, o in left.items()]
        best, index = max(scored, default=(0.0, 0))
        if best >= SAME_BOX:
            objects_by_id[item.id] = left.pop(-index)
    return objects_by_id


def heading_change(geometry: ObjectGeometry, view: TruthView) -> Float[np.ndarray, "3 3"]:
    """The turn about up from the true world to the estimated one."""
    R = geometry.camera.T_world_camera[:3, :3] @ view.camera.T_world_camera[:3, :3].T
    return yaw_rotation(float(np.arctan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1])))


def geometry_with(
    geometry: ObjectGeometry, truth: Mapping[str, SceneObject], view: TruthView, given: frozenset[str]
) -> ObjectGeometry:
    """An estimate with the true quantities that `given` names; objects without a true counterpart stay.

    Args:
        geometry: The estimate.
        truth: The true object of every object's id.
        view: The truth.
        given: Names of `SUBSTITUTES`.
    """
    if given & PLACES:
        geometry = replace(geometry, source=ScaleSource.GIVEN)
    if "cuboids" in given:
        geometry = _with_true_cuboids(geometry, truth, view)
    if "supports" in given:
        geometry = replace(geometry, supports=_with_true_supports(geometry.supports, truth, view))
    if "height" in given:
        geometry = enlarge(geometry, float(view.camera.position[2] / geometry.camera.position[2]))
    if "scale" in given:
        factors = [_farther(c, geometry, truth[c.object_id], view) for c in geometry.cuboids if c.object_id in truth]
        geometry = enlarge(geometry, float(np.median(factors)) if factors else 1.0)
    Q = heading_change(geometry, view)
    cuboids = tuple(
        _with_true(c, geometry, truth[c.object_id], view, given, Q) if c.object_id in truth else c
        for c in geometry.cuboids
    )
    return replace(geometry, cuboids=cuboids)


def enlarge(geometry: ObjectGeometry, factor: float) -> ObjectGeometry:
    """The estimate made larger about the point on the floor below its camera: the picture stays the same."""
    T = geometry.camera.T_world_camera.copy()
    T[2, 3] *= factor
    base = np.array([*geometry.camera.position[:2], 0.0])
    cuboids = tuple(
        replace(c, centre=base + factor * (c.centre - base), size_m=factor * c.size_m) for c in geometry.cuboids
    )
    return replace(geometry, camera=replace(geometry.camera, T_world_camera=T), cuboids=cuboids)


def _farther(cuboid: Cuboid, geometry: ObjectGeometry, true: SceneObject, view: TruthView) -> float:
    """How many times as far from the camera the true object is."""
    distance_m = np.linalg.norm(cuboid.centre - geometry.camera.position)
    return float(np.linalg.norm(true.pose.position - view.camera.position) / max(float(distance_m), 1e-6))


def _with_true(
    cuboid: Cuboid,
    geometry: ObjectGeometry,
    true: SceneObject,
    view: TruthView,
    given: frozenset[str],
    Q: Float[np.ndarray, "3 3"],
) -> Cuboid:
    R_true = Q @ true.pose.R_world_object
    if "distance" in given:
        factor, eye = _farther(cuboid, geometry, true, view), geometry.camera.position
        cuboid = replace(cuboid, centre=eye + factor * (cuboid.centre - eye), size_m=factor * cuboid.size_m)
    if "rotation" in given:
        size = size_along_axes(cuboid.size_m, cuboid.R_world_object, R_true)
        cuboid = replace(cuboid, R_world_object=R_true, size_m=size, front_known=True)
    if "size" in given:
        size = size_along_axes(np.asarray(true.size_m), R_true, cuboid.R_world_object)
        rise = np.array([0.0, 0.0, (size[2] - cuboid.size_m[2]) / 2])
        cuboid = replace(cuboid, size_m=size, centre=cuboid.centre + rise)
    return cuboid


def size_along_axes(
    size: Float[np.ndarray, "3"], R_from: Float[np.ndarray, "3 3"], R_to: Float[np.ndarray, "3 3"]
) -> Float[np.ndarray, "3"]:
    """Extents along the axes of `R_from` as extents along those axes of `R_to` that are nearest to them."""
    nearest = np.abs(R_from.T @ R_to)
    swapped = nearest[0, 1] + nearest[1, 0] > nearest[0, 0] + nearest[1, 1]
    return np.asarray(size)[[1, 0, 2]] if swapped else np.asarray(size)


def _with_true_cuboids(geometry: ObjectGeometry, truth: Mapping[str, SceneObject], view: TruthView) -> ObjectGeometry:
    true = {c.object_id: c for c in true_geometry(view).cuboids}
    cuboids = tuple(
        replace(true[truth[c.object_id].id], object_id=c.object_id) if c.object_id in truth else c
        for c in geometry.cuboids
    )
    return replace(geometry, camera=view.camera, cuboids=cuboids)


def _with_true_supports(
    edges: tuple[Support, ...], truth: Mapping[str, SceneObject], view: TruthView
) -> tuple[Support, ...]:
    """True edges under the estimate's ids; planes by role, for the architecture to resolve."""
    names = {t.id: name for name, t in truth.items()}
    true = {}
    for edge in true_geometry(view).supports:
        plane = view.scene.plane(edge.parent).role if view.scene.has_plane(edge.parent) else ""
        parent = plane or names.get(edge.parent)
        if edge.child in names and parent is not None:
            true[names[edge.child]] = Support(names[edge.child], parent, edge.relation)
    return tuple(true.get(edge.child, edge) for edge in edges)


def _rotate(plane: Plane, Q: Float[np.ndarray, "3 3"]) -> Plane:
    return replace(plane, polygon=plane.polygon @ Q.T)
