"""What measured depth says about one object, ready for fitting shapes to it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool

from diorama_core.artefacts import Cuboid
from diorama_core.library.record import SymmetryFold
from diorama_core.pose.depth_fit import FEWEST_RAYS, SURE_CONTACT_M, Contact, DepthFit, Outline, SeenPoints
from diorama_core.pose.evidence import Evidence
from diorama_core.pose.hypotheses import Anchor, Hypotheses
from diorama_core.pose.limits import SizeLimits
from diorama_core.scene.types import yaw_rotation

_TURNS = 24
_FLOATS_M = 0.05
"""A lower end that is seen this far from where the cuboid ends tells where the object stands."""


@dataclass(frozen=True, eq=False)
class MeasuredObject:
    """One object's measured points, outline and where it stands."""

    evidence: Evidence
    cuboid: Cuboid
    contact: Contact
    points: SeenPoints
    outline: Outline | None

    @classmethod
    def of(
        cls, mask: Bool[np.ndarray, "h w"], evidence: Evidence, cuboid: Cuboid, anchor: Anchor, on_floor: bool
    ) -> MeasuredObject | None:
        """What can be used of the depth under a mask; None where hardly any was measured.

        Args:
            mask: the object's visible pixels.
            evidence: what is known of it.
            cuboid: its box.
            anchor: the face of the box that touches what holds it.
            on_floor: whether that is the floor, whose height is known even where the object hides it.
        """
        if evidence.surface is None:
            return None
        points = SeenPoints.of(evidence.seen, evidence.surface.depth_m, evidence.surface.weight)
        if len(points.depth_m) < FEWEST_RAYS:
            return None
        outline = Outline.of(evidence.seen, mask)
        return cls(evidence, cuboid, _contact(anchor, on_floor, points, outline), points, outline)

    def fit(self, limits: SizeLimits) -> DepthFit:
        """The fit of a shape with these limits."""
        return DepthFit(self.evidence.camera, self.evidence.seen, self.points, self.outline, self.contact, limits)

    def hypotheses(self, symmetry: SymmetryFold, limits: SizeLimits) -> Hypotheses:
        """Turns all around, each set against the measured points."""
        count = max(_TURNS // symmetry, 1)
        turns = np.arange(count) * 2 * np.pi / (symmetry * count)
        R = np.array([self.cuboid.R_world_object @ yaw_rotation(angle) for angle in turns])
        poses = self.fit(limits).starts(R)
        quarter = np.mod(turns + np.pi / 4, np.pi / 2) - np.pi / 4
        return Hypotheses(poses, np.abs(quarter), np.zeros(count))


def _contact(anchor: Anchor, on_floor: bool, points: SeenPoints, outline: Outline | None) -> Contact:
    """Where the object stands: where the cuboid ends, unless its own lower end is seen elsewhere or is hidden."""
    if anchor.axis_world[2] < 0.5 or outline is None or len(points.depth_m) < 12:
        return Contact(anchor, SURE_CONTACT_M)
    lowest = float(np.quantile(points.points_world[:, 2], 0.01))
    gap = lowest - float(anchor.point_world[2])
    if abs(gap) < _FLOATS_M or (on_floor and not outline.lower_end_seen):
        return Contact(anchor, SURE_CONTACT_M)
    seen = replace(anchor, point_world=np.array([*anchor.point_world[:2], lowest]))
    if outline.lower_end_seen or gap < 0:
        return Contact(seen, 1.5 * SURE_CONTACT_M)
    return Contact(anchor, 0.5 * gap)
