"""Truth as the stages would have found it: what to hand to a stage that is measured alone."""

from __future__ import annotations

from dataclasses import dataclass, replace

from diorama_core.artefacts import (
    Cuboid,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    RankedShapes,
)
from diorama_core.progress import Progress
from diorama_core.provenance import ScaleSource
from diorama_core.scene.types import Support
from diorama_core.synthesis.truth import TruthView


def photo_only(view: TruthView) -> Inputs:
    """The picture with boxes and classes, as a person or detector gives them; no masks, depth or intrinsics."""
    return replace(view.inputs, instances=None, instance_boxes=(), depth_m=None, intrinsics=None)


def true_objects(view: TruthView) -> tuple[DetectedObject, ...]:
    """Every object asked for, with its visible mask; the id is the truth's."""
    detected = []
    for index in view.indices:
        item = view.scene.objects[index]
        mask = view.object_ids == index
        assert item.box_px is not None
        assert item.mask_id is not None
        detected.append(DetectedObject(item.id, item.category, item.label, item.box_px, mask, item.mask_id, 1.0))
    return tuple(detected)


def true_supports(view: TruthView) -> tuple[Support, ...]:
    """The support graph among the objects asked for; what an absent object holds up stands on its supporter."""
    ids = {view.scene.objects[k].id for k in view.indices}
    parent_of = {s.child: s.parent for s in view.scene.supports}
    edges = []
    for edge in view.scene.supports:
        if edge.child in ids:
            parent = edge.parent
            while parent not in ids and parent in parent_of:
                parent = parent_of[parent]
            surface = edge.parent_surface if parent == edge.parent else None
            edges.append(replace(edge, parent=parent, parent_surface=surface))
    return tuple(edges)


def true_geometry(view: TruthView) -> ObjectGeometry:
    """Metric camera, a cuboid for every object asked for, and the support graph with plane ids."""
    cuboids = []
    for index in view.indices:
        o = view.scene.objects[index]
        cuboids.append(Cuboid(o.id, o.pose.R_world_object, o.pose.position, o.size_m, 1.0, front_known=True))
    return ObjectGeometry(view.camera, tuple(cuboids), true_supports(view), ScaleSource.GIVEN)


@dataclass(frozen=True)
class TrueShapes:
    """A retrieval stage that knows the answer; `shapes` are (object id, shape id)."""

    shapes: tuple[tuple[str, str], ...]

    @classmethod
    def of(cls, view: TruthView) -> TrueShapes:
        """The shapes of the objects asked for, known by the ids that the object stages give (mask ids)."""
        return cls(tuple((str(view.scene.objects[k].mask_id), view.scene.objects[k].shape_id) for k in view.indices))

    def retrieve(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> tuple[RankedShapes, ...]:
        """The true shape of every object, matched by mask id.

        Args:
            inputs: as given.
            objects: what was found in the photo, with masks.
            geometry: the objects' cuboids, the camera, and what supports what.
            progress: reports and cancellation.
        """
        known = dict(self.shapes)
        return tuple(RankedShapes(o.id, ((known[str(o.mask_id)], 1.0),)) for o in objects if str(o.mask_id) in known)
