"""What the picture says of every posed object, for fitting its shape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from diorama_core.artefacts import Cuboid, DepthMap, DetectedObject, Inputs, ObjectGeometry, PosedCandidates
from diorama_core.geometry.observed import observe_among
from diorama_core.geometry.see_through import SeeThrough
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.library.taxonomy import NEVER_OPEN, SETS
from diorama_core.pose.details import InnerEdges
from diorama_core.pose.mask_observations import Evidence
from diorama_core.pose.settings import SETTINGS, PoseEvidenceSettings, PoseSettings
from diorama_core.pose.surface import measure_surface, noise_of
from diorama_core.scene.types import Pose
from diorama_core.workers import map_threads


@dataclass(frozen=True, eq=False)
class Surroundings:
    """All objects of a photo where they are, to look at one among the others."""

    inputs: Inputs
    objects: tuple[DetectedObject, ...]
    geometry: ObjectGeometry
    depth: DepthMap
    settings: PoseEvidenceSettings

    @cached_property
    def cuboids(self) -> tuple[Cuboid, ...]:
        """Those of the items."""
        cuboid_of = {c.object_id: c for c in self.geometry.cuboids}
        return tuple(cuboid_of[o.id] for o in self.objects if o.id in cuboid_of)

    @cached_property
    def items(self) -> tuple[DetectedObject, ...]:
        """The objects that have a cuboid."""
        placed = {c.object_id for c in self.cuboids}
        return tuple(o for o in self.objects if o.id in placed)

    @cached_property
    def parents(self) -> list[int | None]:
        """For every item the one that carries it."""
        positions = {o.id: i for i, o in enumerate(self.items)}
        parent_of = {s.child: s.parent for s in self.geometry.supports}
        return [positions.get(parent_of.get(o.id, "")) for o in self.items]

    @cached_property
    def _noise(self) -> float:
        return noise_of(self.depth, self.settings)

    def loads(self, i: int) -> tuple[Cuboid, ...]:
        """Cuboids of the items that lie on one."""
        return tuple(cuboid for cuboid, parent in zip(self.cuboids, self.parents, strict=True) if parent == i)

    def evidence(self, i: int, cells: int, *, loads_apart: bool = False) -> Evidence:
        """Observations of an item at a resolution, what lies on it left out where asked."""
        item, camera = self.items[i], self.geometry.camera
        centres = np.array([c.centre for c in self.cuboids]).reshape(-1, 3)
        seen = observe_among(camera, self.items, centres, self.parents, i, cells, loads_apart=loads_apart)
        surface = measure_surface(self.depth, seen, item.mask, self._noise, self.settings)
        closed = surface is not None or item.category in NEVER_OPEN
        colours = None if closed else SeeThrough.of(self.inputs.photo.rgb, seen, self.settings.see_through)
        return Evidence(camera, seen, surface, colours, settings=self.settings)


@dataclass(frozen=True, eq=False)
class SeenObject:
    """One object with what the picture says of it."""

    evidence: Evidence
    fine: Evidence
    """At a finer resolution where its mask was given."""
    edges: InnerEdges
    pose: Pose
    pixels: int
    """Area of its mask."""
    mask_confidence: float
    category: str
    carried: tuple[Cuboid, ...] = ()
    """What lies on it, measured without knowing its shape."""
    settings: PoseSettings = SETTINGS

    @property
    def may_have_agreed(self) -> bool:
        """Whether objects like this one took one shape together."""
        return self.category in SETS or (self.mask_confidence < 1.0 and self.evidence.surface is None)

    @property
    def is_surely_outlined(self) -> bool:
        """Whether its outline tells a profile."""
        return self.mask_confidence >= self.settings.shapes.sure_mask

    @property
    def has_given_mask(self) -> bool:
        """Whether its outline tells its place to a hundredth, and its parts."""
        return self.mask_confidence >= self.settings.shapes.given_mask

    @property
    def outline_weight(self) -> float:
        """How much outline and depth say, as a factor of a logarithm."""
        return (
            self.settings.shapes.outline * self.evidence.seen.mask_trust
            if self.evidence.surface is None
            else self.settings.shapes.outline_with_depth
        )

    def edges_in(self, caster: ShapeCaster, pose: Pose) -> float:
        """How well the inner edges of a shape agree with the photo's: -1 to 1."""
        return float(self.edges.agreement(self.evidence.seen.hits(caster, PoseBatch.single(pose)))[0])

    def score(self, caster: ShapeCaster, pose: Pose) -> float:
        """How well a shape agrees in a pose: logarithm, higher is better."""
        hits = self.evidence.seen.hits(caster, PoseBatch.single(pose))
        error = float(self.evidence.errors_of(caster, hits)[0])
        edges = float(self.edges.agreement(hits)[0])
        trust = self.evidence.seen.mask_trust
        return (
            -self.outline_weight * float(np.log(error + self.settings.evidence.noise_floor))
            + self.settings.shapes.edges * trust * edges
        )


def observe_objects(
    posed: Sequence[PosedCandidates],
    inputs: Inputs,
    objects: tuple[DetectedObject, ...],
    geometry: ObjectGeometry,
    depth: DepthMap,
    settings: PoseSettings,
) -> dict[str, SeenObject]:
    """What the picture says of every posed object of which enough is seen, by its id.

    Args:
        posed: candidates of every object, best first; the first one's pose is taken.
        inputs, objects, geometry, depth: as documented in `protocols.PoseStage`.
        settings: of the pose stage.
    """
    pose_of = {p.object_id: p.candidates[0].pose for p in posed if p.candidates}
    scene = Surroundings(inputs, objects, geometry, depth, settings.evidence)

    def observe(k: int) -> SeenObject | None:
        item, coarse = scene.items[k], scene.evidence(k, settings.shapes.cells, loads_apart=True)
        window, given = coarse.seen, item.mask_confidence >= settings.shapes.given_mask
        if float((window.covered * window.weight).sum()) < settings.shapes.min_cells:
            return None
        return SeenObject(
            coarse,
            scene.evidence(k, settings.shapes.fine_cells, loads_apart=True) if given else coarse,
            InnerEdges.of(inputs.photo.rgb, window, settings.evidence),
            pose_of[item.id],
            item.pixels,
            item.mask_confidence,
            item.category,
            scene.loads(k),
            settings,
        )

    shown = [k for k, item in enumerate(scene.items) if item.id in pose_of]
    found = zip(shown, map_threads(observe, shown), strict=True)
    return {scene.items[k].id: one for k, one in found if one is not None}
