"""What the picture says of every posed object, for fitting its shape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diorama_core.artefacts import Cuboid, DepthMap, DetectedObject, Inputs, ObjectGeometry, PosedCandidates
from diorama_core.geometry.observed import observe_among
from diorama_core.geometry.see_through import SeeThrough
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.library.taxonomy import NEVER_OPEN
from diorama_core.pose.agree import SETS
from diorama_core.pose.inner_edges import InnerEdges
from diorama_core.pose.mask_observations import NOISE_FLOOR, Evidence
from diorama_core.pose.surface import measured_surface, noise_of
from diorama_core.scene.types import Pose
from diorama_core.workers import each

CELLS, FINE_CELLS = 56, 84
"""Resolutions at which shapes are compared with the picture and set in place in the end, both ways."""
OUTLINE, OUTLINE_WITH_DEPTH = 1.8, 2.0
"""How much outline and depth say, as a factor of a logarithm; an outline counts as much as its mask is trusted."""
EDGES = 1.0
"""How much the inner edges say beside that."""
SURE_MASK, GIVEN_MASK = 0.9, 1.0
"""Confidence from which on a mask's outline tells a profile, and that of a mask that was given."""
MIN_CELLS = 100.0
"""Objects of which fewer cells are seen tell nothing of their parts."""


@dataclass(frozen=True, eq=False)
class SeenObject:
    """One object with what the picture says of it."""

    evidence: Evidence
    fine: Evidence
    """At a finer resolution where its mask was given."""
    edges: InnerEdges
    pose: Pose
    pixels: int
    """Of its mask."""
    mask_confidence: float
    category: str
    carried: tuple[Cuboid, ...] = ()
    """What lies on it, measured without knowing its shape."""

    @property
    def may_have_agreed(self) -> bool:
        """Whether objects like this one took one shape together."""
        return self.category in SETS or (self.mask_confidence < 1.0 and self.evidence.surface is None)

    @property
    def is_surely_outlined(self) -> bool:
        """Whether its outline tells a profile."""
        return self.mask_confidence >= SURE_MASK

    @property
    def has_given_mask(self) -> bool:
        """Whether its outline tells its place to a hundredth, and its parts."""
        return self.mask_confidence >= GIVEN_MASK

    @property
    def outline_weight(self) -> float:
        """How much outline and depth say, as a factor of a logarithm."""
        return OUTLINE * self.evidence.seen.mask_trust if self.evidence.surface is None else OUTLINE_WITH_DEPTH

    def edges_in(self, caster: ShapeCaster, pose: Pose) -> float:
        """How well the inner edges of a shape agree with the photo's: -1 to 1."""
        poses = PoseBatch(pose.R_world_object[None], pose.position[None], pose.scale[None])
        return float(self.edges.agreement(self.evidence.hits(caster, poses))[0])

    def score(self, caster: ShapeCaster, pose: Pose) -> float:
        """How well a shape agrees in a pose: logarithm, higher is better."""
        hits = self.evidence.hits(caster, PoseBatch(pose.R_world_object[None], pose.position[None], pose.scale[None]))
        error = float(self.evidence.errors_of(caster, hits)[0])
        edges = float(self.edges.agreement(hits)[0])
        trust = self.evidence.seen.mask_trust
        return -self.outline_weight * float(np.log(error + NOISE_FLOOR)) + EDGES * trust * edges


def seen_objects(
    posed: Sequence[PosedCandidates],
    inputs: Inputs,
    objects: tuple[DetectedObject, ...],
    geometry: ObjectGeometry,
    depth: DepthMap,
) -> dict[str, SeenObject]:
    """What the picture says of every posed object of which enough is seen, by its id."""
    pose_of = {p.object_id: p.candidates[0].pose for p in posed if p.candidates}
    cuboid_of = {c.object_id: c for c in geometry.cuboids}
    items = [o for o in objects if o.id in cuboid_of]
    centres = np.array([cuboid_of[o.id].centre for o in items]).reshape(-1, 3)
    positions = {o.id: k for k, o in enumerate(items)}
    parent_of = {s.child: s.parent for s in geometry.supports}
    parents = [positions.get(parent_of.get(o.id, "")) for o in items]
    noise = noise_of(depth)

    def evidence(k: int, cells: int) -> Evidence:
        item = items[k]
        window = observe_among(geometry.camera, items, centres, parents, k, cells, loads_apart=True)
        surface = measured_surface(depth, window, item.mask, noise)
        closed = surface is not None or item.category in NEVER_OPEN
        colours = None if closed else SeeThrough.of(inputs.photo.rgb, window)
        return Evidence(geometry.camera, window, surface, colours)

    def seen(k: int) -> SeenObject | None:
        item, coarse = items[k], evidence(k, CELLS)
        window = coarse.seen
        if float((window.covered * window.weight).sum()) < MIN_CELLS:
            return None
        return SeenObject(
            coarse,
            evidence(k, FINE_CELLS) if item.mask_confidence >= GIVEN_MASK else coarse,
            InnerEdges.of(inputs.photo.rgb, window),
            pose_of[item.id],
            item.pixels,
            item.mask_confidence,
            item.category,
            tuple(cuboid_of[o.id] for o, parent in zip(items, parents, strict=True) if parent == k),
        )

    shown = [k for k, item in enumerate(items) if item.id in pose_of]
    return {items[k].id: one for k, one in zip(shown, each(seen, shown), strict=True) if one is not None}
