"""How often the support graph is right, on rendered rooms whose supports are known."""

from __future__ import annotations

from dataclasses import dataclass, replace

from diorama_core.artefacts import CameraEstimate, CameraHypothesis, Inputs, SceneGraph
from diorama_core.perception.graph.geometric import GeometricGraph
from diorama_core.perception.masks import EmbeddedMasks
from diorama_core.perception.measured import MeasuredGeometry
from diorama_core.perception.metrology import SingleViewMetrology
from diorama_core.progress import Progress
from diorama_core.protocols import GraphStage
from diorama_core.provenance import CameraSource
from diorama_core.scene.types import Scene, Support
from diorama_core.synthesis import TruthView


@dataclass(frozen=True)
class RelationCount:
    """Supporters that were named rightly, of those that could be."""

    right: int = 0
    total: int = 0
    mistakes: tuple[tuple[str, str, str], ...] = ()
    """(child's category, true supporter, named supporter)."""

    def __add__(self, other: RelationCount) -> RelationCount:
        return RelationCount(self.right + other.right, self.total + other.total, self.mistakes + other.mistakes)

    @property
    def accuracy(self) -> float:
        """Share of correct relations; 1 where there are none."""
        return self.right / self.total if self.total else 1.0


def judged(supports: tuple[Support, ...], names: dict[str, str], truth: Scene) -> RelationCount:
    """Edges beside the truth's; only objects whose true supporter is itself visible, or a part of the room, count.

    Args:
        supports: of objects by their ids in the photo, or "floor", "wall" and "ceiling".
        names: the truth's object id by id in the photo.
        truth: the room.
    """
    roles: dict[str, str] = {p.id: p.role for p in truth.architecture.planes}
    visible = set(names.values())
    right, total, mistakes = 0, 0, []
    for edge in supports:
        true_edge = truth.support_of(names[edge.child])
        if true_edge is None:
            continue
        wanted = roles.get(true_edge.parent, true_edge.parent)
        if wanted not in visible and wanted not in ("floor", "wall", "ceiling"):
            continue
        named = names.get(edge.parent, edge.parent)
        total += 1
        right += named == wanted
        if named != wanted:
            kind = truth.object(names[edge.child]).category
            mistakes.append((kind, wanted.rsplit("_", 1)[0], named.rsplit("_", 1)[0]))
    return RelationCount(right, total, tuple(mistakes))


def relations_of(view: TruthView, *, with_depth: bool, graph: GraphStage | None = None) -> RelationCount:
    """The graph of one picture, from masks and classes with depth or without; the camera's orientation is given."""
    inputs = view.inputs if with_depth else _without_depth(view.inputs)
    camera = view.camera
    reading = CameraHypothesis(camera.intrinsics, camera.T_world_camera[:3, :3], 1.0)
    height = float(camera.position[2]) if with_depth else None
    estimate = CameraEstimate((reading,), 1.0, CameraSource.given(), height)
    quiet = Progress()
    objects = EmbeddedMasks().segment(inputs, quiet)
    stage = MeasuredGeometry() if with_depth else SingleViewMetrology()
    geometry = stage.measure(inputs, estimate, objects, quiet)
    predicted: SceneGraph = (graph or GeometricGraph()).relate(inputs, objects, geometry, quiet)
    by_mask = {o.mask_id: o.id for o in view.scene.objects if o.mask_id is not None}
    return judged(predicted.supports, {o.id: by_mask[o.mask_id] for o in objects}, view.scene)


def _without_depth(inputs: Inputs) -> Inputs:

    return replace(inputs, depth_m=None)
