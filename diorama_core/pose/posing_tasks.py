"""What posing knows of every object (its place, what it may face, what the picture shows of it), and its shapes in
their best poses, with the candidates that they make.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from diorama_core.arrangement.facing.evidence import HeadingCosts, WallSamples
from diorama_core.arrangement.facing.solve import Facings
from diorama_core.artefacts import Cuboid, DepthMap, DetectedObject, Inputs, ObjectGeometry, PosedCandidates
from diorama_core.library.labels import is_named
from diorama_core.library.record import Shape
from diorama_core.library.taxonomy import SETS, category
from diorama_core.pose.details import Details
from diorama_core.pose.hypotheses import Anchor, anchor_of
from diorama_core.pose.mask_observations import Evidence
from diorama_core.pose.measured import MeasuredObject, foot_height_m
from diorama_core.pose.seen_objects import Surroundings
from diorama_core.pose.settings import SETTINGS, PoseSearchSettings, PoseSettings
from diorama_core.scene.types import Candidate, Pose
from diorama_core.workers import map_threads


@dataclass(frozen=True, eq=False)
class PosingTask:
    """One object with the observations for posing its shapes."""

    item: DetectedObject
    cuboid: Cuboid
    anchor: Anchor
    carried: tuple[Cuboid, ...]
    """What lies on it."""
    coarse: Evidence
    fine: Evidence
    measured: MeasuredObject | None
    """Where depth was measured."""
    details: Details | None
    """Where depth was measured: doubtful poses put a shape's edges and parts elsewhere."""
    settings: PoseSearchSettings

    @property
    def hangs(self) -> bool:
        """Whether it is held by a wall."""
        return abs(float(self.anchor.axis_world[2])) < 0.5

    def with_facing(self, facing: HeadingCosts) -> PosingTask:
        """The task once it is known what the room says of its headings."""
        return replace(self, coarse=replace(self.coarse, facing=facing), fine=replace(self.fine, facing=facing))

    @property
    def max_loss(self) -> float:
        """What agreeing on a shape may cost: it averages doubtful outlines; sure ones and depth show who differs."""
        if self.measured is not None:
            return self.settings.max_loss_with_depth
        in_sets, colours = self.item.category in SETS, self.fine.see_through
        if in_sets and colours is not None and colours.share > self.settings.tells:
            return self.settings.max_loss_where_colours_tell
        return np.inf if self.item.mask_confidence < 1.0 or in_sets else self.settings.max_loss_of_sure_outlines


def likeliest_kinds(
    objects: Sequence[DetectedObject], ranked: Mapping[str, tuple[tuple[str, float], ...]], records: Mapping[str, Shape]
) -> dict[str, str]:
    """What every object with shapes most likely is: what its word means, or the kind of its first shape."""
    return {
        o.id: o.category if is_named(o.label) else records[ranked[o.id][0][0]].category
        for o in objects
        if o.id in ranked
    }


def posing_tasks(
    inputs: Inputs,
    objects: tuple[DetectedObject, ...],
    geometry: ObjectGeometry,
    depth: DepthMap,
    kinds: Mapping[str, str],
    cells: tuple[int, int],
    walls: WallSamples,
    settings: PoseSettings = SETTINGS,
) -> list[PosingTask]:
    """One task for every object that has a cuboid and kinds, in the order of `objects`.

    Args:
        inputs: with the photo.
        objects: all of the photo.
        geometry: their cuboids, and what carries what.
        depth: of the photo.
        kinds: by object what it most likely is.
        cells: resolutions at which all hypotheses, and the best ones, are compared.
        walls: where walls are seen.
    """
    scene = Surroundings(inputs, objects, geometry, depth, settings.evidence)
    posed = [i for i, item in enumerate(scene.items) if item.id in kinds]
    return map_threads(lambda i: _task(scene, i, kinds[scene.items[i].id], cells, walls, settings), posed)


def _task(
    scene: Surroundings, i: int, kind: str, cells: tuple[int, int], walls: WallSamples, settings: PoseSettings
) -> PosingTask:
    """One object's, as a kind."""
    item, cuboid, camera = scene.items[i], scene.cuboids[i], scene.geometry.camera
    held_by = next((s.parent for s in scene.geometry.supports if s.child == item.id), None)
    on_wall = held_by == "wall" and category(kind).mount != "floor"
    anchor = anchor_of(cuboid, on_wall, camera.position[:2] - cuboid.centre[:2])
    coarse, fine = (scene.evidence(i, count) for count in cells)
    foot_m = foot_height_m(scene.depth, item.mask, camera, settings.search) if held_by == "floor" else None
    measured = MeasuredObject.of(item.mask, fine, cuboid, anchor, walls, foot_m, settings)
    details = None if measured is None else Details.of(scene.inputs.photo.rgb, fine.seen, settings.evidence)
    return PosingTask(item, cuboid, anchor, scene.loads(i), coarse, fine, measured, details, settings.search)


@dataclass(frozen=True, eq=False)
class PosedShape:
    """One shape's best pose."""

    shape: Shape
    pose: Pose
    error: float
    """Disagreement with the picture, 0 to 1."""
    rank: float
    """By which the shapes of one object are ordered: a logarithm, higher is better."""


def sort_shapes(shapes: Sequence[PosedShape], ranks: Mapping[str, float]) -> tuple[PosedShape, ...]:
    """The shapes of one object by rank, the best first."""
    return tuple(sorted(shapes, key=lambda posed: (-ranks[posed.shape.id], posed.shape.id)))


def candidates_of(
    task: PosingTask, ordered: Sequence[PosedShape], ranks: Mapping[str, float], facings: Facings
) -> PosedCandidates:
    """The posed shapes of one object; scores are relative to the best one's agreement with the picture.

    Args:
        task: of the object.
        ordered: its posed shapes, best first.
        ranks: log score of each shape id.
        facings: what was decided about all objects' fronts, with reasons.
    """
    best = ordered[0]
    top = ranks[best.shape.id]
    candidates = tuple(
        Candidate(p.shape.id, p.shape.size_m, float(np.exp(ranks[p.shape.id] - top) * (1.0 - best.error)), p.pose)
        for p in ordered
    )
    confidence = task.fine.confidence(best.error, task.cuboid.confidence)
    reasons = tuple(share for share in facings.shares if share.object_id == task.item.id)
    headings = facings.probabilities_of(task.item.id)
    return PosedCandidates(task.item.id, candidates, confidence, reasons, headings)
