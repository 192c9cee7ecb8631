"""Everything that may hold an object, how well each agrees with where the object was observed, and which objects the
photo shows just below it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.arrangement.surfaces import RestingSurface, choose_contact, object_surfaces, overhang_m, plane_surface
from diorama_core.library import taxonomy
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import Category
from diorama_core.scene.frames import UP_WORLD
from diorama_core.scene.types import Camera, Plane, Scene, SceneObject, Support

Role = Literal["floor", "wall", "ceiling", "object"]
OBJECT: Role = "object"
Box = tuple[float, float, float, float]
"""x1, y1, x2, y2 in the photo."""
FARTHEST_WIDTHS = 3.0
"""Objects that are so many widths beside each other do not hold one another."""


@dataclass(frozen=True)
class SupportEvidence:
    """What is known of supports besides poses and shapes."""

    believed: Mapping[str, Support] = field(default_factory=dict)
    """By object the edge that an earlier stage decided on."""
    below: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    """See `visible_shares_below`."""

    @classmethod
    def of(cls, scene: Scene, below: Mapping[str, Mapping[str, float]]) -> SupportEvidence:
        """What a scene's own edges say, and what the photo shows below each object."""
        return cls({edge.child: edge for edge in scene.supports}, below)


@dataclass(frozen=True)
class SupportHypothesis:
    """One thing that may hold an object."""

    edge: Support
    role: Role
    kind: Category
    """Kind of the object that is held."""
    carrier: Category | None = None
    """Kind of the object that holds it."""
    believed: bool = False
    """Whether an earlier stage decided so."""
    gap: float = 0.0
    """Distance of the touching face from the supporter, in tolerances of the observation."""
    outside: float = 0.0
    """How far beside the supporter the object's middle is, in its widths."""
    turned: float = 0.0
    """1 less the cosine between the object's front and a wall's normal."""
    averted: bool = False
    """Whether a wall turns its back to the line of sight."""
    below: float = 0.0
    """Share of the object's lower rim below which the supporter is seen."""
    foot_in_box: bool = False
    """Whether the object's box in the photo ends within the supporter's."""


def support_hypotheses(
    scene: Scene, library: ShapeLibrary, noise: ObservationNoise, evidence: SupportEvidence
) -> dict[str, tuple[SupportHypothesis, ...]]:
    """By object everything that may hold it: the planes of the room and the other objects.

    Args:
        scene: every object in its observed pose, with the photo's camera.
        library: where shapes come from.
        noise: of the observed poses.
        evidence: what else is known.
    """
    surfaces = {
        o.id: tuple(
            world
            for place in object_surfaces(library.shape(o.shape_id), o)
            if float((world := place.to_world(o.pose)).normal @ UP_WORLD) > np.cos(np.deg2rad(25.0))
        )
        for o in scene.objects
    }
    return {
        item.id: (
            *(_plane_hypothesis(scene, item, plane, noise, evidence) for plane in scene.architecture.planes),
            *(
                hypothesis
                for other in scene.objects
                if other.id != item.id
                and (hypothesis := _object_hypothesis(scene, item, other, surfaces[other.id], noise, evidence))
                is not None
            ),
        )
        for item in scene.objects
    }


def _plane_hypothesis(
    scene: Scene, item: SceneObject, plane: Plane, noise: ObservationNoise, evidence: SupportEvidence
) -> SupportHypothesis:
    edge = Support(item.id, plane.id, "placed on" if plane.role == "floor" else "mounted on")
    surface = plane_surface(plane)
    face = choose_contact(scene, item, edge, surface) * item.size_m / 2
    touching = item.pose.position + item.pose.R_world_object @ face
    gap_m = abs(float(surface.normal @ touching) - surface.level)
    wall = plane.role == "wall"
    sight = np.zeros(3) if scene.camera is None else item.pose.position - scene.camera.position
    # How far the floor reaches is a guess where it was not seen; how high it is, is not.
    beside_m = 0.0 if plane.role == "floor" else overhang_m(surface, item.pose.position)
    return SupportHypothesis(
        edge,
        plane.role,
        taxonomy.resolve(item.category).category,
        believed=_is_believed(scene, edge, evidence),
        gap=gap_m / noise.tolerance_m(scene.camera, item.pose.position, plane.normal),
        outside=beside_m / _width_m(item),
        turned=1.0 - float(item.pose.R_world_object[:, 0] @ plane.normal) if wall else 0.0,
        averted=wall and bool(plane.normal @ sight > 0.0),
    )


def _object_hypothesis(
    scene: Scene,
    item: SceneObject,
    other: SceneObject,
    places: tuple[RestingSurface, ...],
    noise: ObservationNoise,
    evidence: SupportEvidence,
) -> SupportHypothesis | None:
    """The hypothesis that the object rests on the best-matching place of another object.

    None if the object lies far beside all its places, unless an earlier stage that looked at the picture believes it:
    both may have moved apart along their lines of sight.
    """
    corners = item.corners_world
    foot, height = float(corners[:, 2].min()), max(float(np.ptp(corners[:, 2])), 1e-3)
    tolerance = noise.tolerance_m(scene.camera, item.pose.position, UP_WORLD)
    candidates: list[tuple[float, int, float, float]] = []
    for index, place in enumerate(places):
        gap = abs(foot - place.level) / tolerance
        outside = overhang_m(place, item.pose.position) / _width_m(item)
        over = max(height - place.clearance_m, 0.0) / height
        candidates.append((min(gap, 6.0) + outside + over, index, gap, outside))
    edge = Support(item.id, other.id)
    seen_on = (believed := evidence.believed.get(item.id)) is not None and believed.parent == other.id
    if not candidates or (min(candidates)[3] >= FARTHEST_WIDTHS and not seen_on):
        return None
    _, _, gap, outside = min(candidates)
    return SupportHypothesis(
        edge,
        OBJECT,
        taxonomy.resolve(item.category).category,
        taxonomy.resolve(other.category).category,
        _is_believed(scene, edge, evidence),
        gap,
        outside,
        below=evidence.below.get(item.id, {}).get(other.id, 0.0),
        foot_in_box=ends_within(item.box_px, other.box_px),
    )


def _is_believed(scene: Scene, edge: Support, evidence: SupportEvidence) -> bool:
    """Whether an earlier stage named this supporter; which of the walls it is, stages hardly know."""
    believed = evidence.believed.get(edge.child)
    if believed is None:
        return True
    if scene.has_plane(edge.parent) and scene.has_plane(believed.parent):
        return scene.plane(edge.parent).role == scene.plane(believed.parent).role
    return edge.parent == believed.parent


def ends_within(box: Box | None, other: Box | None) -> bool:
    """Whether a box's lower middle lies in another box, or just above it."""
    if box is None or other is None:
        return False
    middle, lower = (box[0] + box[2]) / 2, box[3]
    slack = 0.1 * (other[3] - other[1])
    return other[0] <= middle <= other[2] and other[1] - slack <= lower <= other[3] + 0.2 * slack


def _width_m(item: SceneObject) -> float:
    """The larger extent of an object's footprint, as far as it can be told."""
    return max(float(np.ptp(item.corners_world[:, :2], axis=0).max()), 0.2)


COLUMNS = 320
"""Masks are compared at about this width: a rim is a few pixels wide there, whatever the photo's size."""


RIM_SHARE = 0.01
"""How far below the rim to look, as a share of the picture's height: past the shadow and the error of a mask."""


def visible_shares_below(masks: Mapping[str, Bool[np.ndarray, "h w"]]) -> dict[str, dict[str, float]]:
    """For each object the share of its lower rim below which each other object is seen.

    Where masks overlap, the smaller object lies in front.
    """
    if not masks:
        return {}
    names = sorted(masks, key=lambda name: (-int(masks[name].sum()), name))
    step = max(1, masks[names[0]].shape[1] // COLUMNS)
    owners = np.full(masks[names[0]][::step, ::step].shape, -1)
    for k, name in enumerate(names):
        owners[masks[name][::step, ::step]] = k
    return {
        name: {names[other]: share for other, share in _shares_below(owners, k).items()} for k, name in enumerate(names)
    }


def _shares_below(owners: np.ndarray, k: int) -> dict[int, float]:
    mine = owners == k
    rows, columns = np.flatnonzero(mine.any(axis=1)), np.flatnonzero(mine.any(axis=0))
    if not len(rows):
        return {}
    height = len(owners)
    lowest = height - 1 - mine[::-1, columns].argmax(axis=0)
    ends = lowest >= (rows[0] + rows[-1]) / 2  # the underside of a table top is no lower end
    under = lowest[ends] + max(2, round(RIM_SHARE * height))
    inside = under < height
    seen = owners[under[inside], columns[ends][inside]]
    below, counts = np.unique(seen[seen >= 0], return_counts=True)
    return {int(other): float(count) / max(int(ends.sum()), 1) for other, count in zip(below, counts, strict=True)}


@dataclass(frozen=True)
class ObservationNoise:
    """Standard deviations of an observed position."""

    along: float
    """Along the viewing ray, as a share of the distance."""
    across_m: float
    """Across it, and the least along it."""
    measured: bool = False
    """Whether distances were measured; those reasoned from a photo alone follow from what holds an object."""

    def tolerance_m(
        self, camera: Camera | None, position: Float[np.ndarray, "3"], direction: Float[np.ndarray, "3"]
    ) -> float:
        """Two standard deviations of a position in one direction of the world; without a camera, those across.

        Args:
            camera: in the world.
            position: of the object, in the world (m).
            direction: unit, in the world.
        """
        if camera is None:
            return 2.0 * self.across_m
        sight = position - camera.position
        return 2.0 * float(np.hypot(self.along * float(sight @ direction), self.across_m))


MEASURED = ObservationNoise(along=0.01, across_m=0.02, measured=True)
"""With measured depth; most of it is what the object itself hides."""


REASONED = ObservationNoise(along=0.05, across_m=0.05)
"""From a photo alone, relative to what is beside or below: errors common to the room cancel."""
