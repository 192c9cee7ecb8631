"""Shapes made to measure: the retrieved design built at the measured size, its parameters fitted to the picture.

Retrieval gives the nearest design of the library. Here its parameters (`library.furniture.measures`: heights of bases
and seats, forms of backs and legs, numbers of drawers, doors, boards, cushions and panes) are changed one after the
other, and a change is kept where outline, measured depth and inner edges agree clearly better with it. Objects that
share shape and size are fitted together and stay alike. Where the nearest design does not fit well at its best, others
are fitted as well and the best of them is taken (`fitted_choice`); bodies of revolution get the profile that their
outline shows (`turned_profile`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import (
    DepthMap,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    PosedCandidates,
    RankedShapes,
)
from diorama_core.geometry.observed import observe_among
from diorama_core.geometry.see_through import SeeThrough
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.library.furniture.measures import Value, can_be_made, can_be_turned, made_id, varied
from diorama_core.library.record import BUILT_IN, ShapeLibrary, record_of
from diorama_core.library.stretch import EVEN, relative_scale
from diorama_core.library.taxonomy import NEVER_OPEN
from diorama_core.pose.agree import SETS
from diorama_core.pose.facing import Facing
from diorama_core.pose.fitted_choice import FittedChoice
from diorama_core.pose.inner_edges import InnerEdges
from diorama_core.pose.mask_observations import Evidence
from diorama_core.pose.outline_fit import fitted_pose
from diorama_core.pose.surface import measured_surface, noise_of
from diorama_core.pose.turned_profile import turned
from diorama_core.progress import Progress
from diorama_core.protocols import PoseStage
from diorama_core.render.grid import each
from diorama_core.scene.types import Candidate, Pose

CELLS = 56
"""Resolution at which shapes are compared with the picture, both ways."""
NOISE_FLOOR = 0.03
"""Disagreement below which two shapes count as equal: the resolution of the outlines."""
OUTLINE, OUTLINE_WITH_DEPTH = 1.8, 2.0
"""How much outline and depth say, as a factor of a logarithm; an outline counts as much as its mask is trusted."""
EDGES = 1.0
"""How much the inner edges say beside that."""
WORTH, WORTH_WITH_DEPTH = 0.4, 0.15
"""A changed parameter must agree better by so much: without depth it may make up for a pose that is a little off."""
SIZE_LOSS = 0.1
"""A shape stretched unevenly is rather built at that size, unless it agrees worse by so much."""
MIN_DRAWER_M = (0.2, 0.08)
"""Width and height of the front of a drawer, at least."""
PASSES, MAX_VARIANTS = 2, 32
"""Times that all parameters are gone through, since one may hide another, and shapes built for one object or set."""
MAX_TRIANGLES = 20_000
"""Designs of more triangles, such as plants, are not built again and again."""
MIN_PIXELS = 900
"""Of objects of fewer pixels only place and size are fitted: their parts are a pixel or two."""
SURE_MASK = 0.9
"""The outline of a mask that is trusted less tells no profile."""
MIN_CELLS = 100.0
"""Objects of which fewer cells are seen tell nothing of their parts."""


@dataclass(frozen=True, eq=False)
class _Seen:
    """One object with what the picture says of it."""

    evidence: Evidence
    edges: InnerEdges
    pose: Pose
    pixels: int
    """Of its mask."""
    mask_confidence: float
    category: str

    @property
    def may_have_agreed(self) -> bool:
        """Whether objects like this one took one shape together."""
        return self.category in SETS or (self.mask_confidence < 1.0 and self.evidence.surface is None)

    def score(self, caster: ShapeCaster, scale: Float[np.ndarray, "3"]) -> float:
        """How well a shape agrees: logarithm, higher is better."""
        pose = PoseBatch(self.pose.R_world_object[None], self.pose.position[None], scale[None])
        hits = self.evidence.hits(caster, pose)
        error = float(self.evidence.errors_of(caster, hits)[0])
        edges = float(self.edges.agreement(hits)[0])
        trust = self.evidence.seen.mask_trust
        outline = OUTLINE * trust if self.evidence.surface is None else OUTLINE_WITH_DEPTH
        return -outline * float(np.log(error + NOISE_FLOOR)) + EDGES * trust * edges


@dataclass(frozen=True)
class MadeToMeasure:
    """Another stage's poses, the first shape of every object made to measure; what was retrieved stays next to it."""

    stage: PoseStage
    library: ShapeLibrary = field(repr=False)

    def pose(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        shapes: tuple[RankedShapes, ...],
        progress: Progress,
    ) -> tuple[PosedCandidates, ...]:
        """Posed candidates, best first; a made shape stands in the pose of the one that it is derived from."""
        posed = self.stage.pose(inputs, objects, geometry, depth, shapes, progress.part(0.0, 0.8))
        return self.fitted(posed, inputs, objects, geometry, depth, progress.part(0.8, 1.0))

    def fitted(
        self,
        posed: tuple[PosedCandidates, ...],
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        progress: Progress,
    ) -> tuple[PosedCandidates, ...]:
        """The candidates with the first of each made to measure, where the picture tells how."""
        seen = _seen(posed, inputs, objects, geometry, depth)
        progress.report(0.0, "Making shapes to measure")
        posed = self._best_fitting(posed, seen)
        pose_of = {p.object_id: p.candidates[0].pose for p in posed if p.candidates}
        seen = {i: replace(one, pose=pose_of[i]) for i, one in seen.items()}
        made = each(lambda members: self._of_set(members, seen), _sets(posed), progress, "Making shapes to measure")
        found = {object_id: candidate for of_set in made for object_id, candidate in of_set.items()}
        return tuple(_with_first(p, found[p.object_id]) if p.object_id in found else p for p in posed)

    def _best_fitting(
        self, posed: tuple[PosedCandidates, ...], seen: Mapping[str, _Seen]
    ) -> tuple[PosedCandidates, ...]:
        """Objects with the candidate first that fits best, where their first one does not fit well.

        What agreed on a shape stays as it agreed, whatever its sizes; what is outlined surely and comes in no sets did
        not agree (`agree`).
        """
        shared = Counter(p.candidates[0].shape_id for p in posed if p.candidates)
        choice = FittedChoice(self.library)

        def chosen(one: PosedCandidates) -> PosedCandidates:
            shown = seen.get(one.object_id)
            if shown is None or (shared[one.candidates[0].shape_id] > 1 and shown.may_have_agreed):
                return one
            return choice.best_first(one, shown.evidence, outlined=shown.mask_confidence >= SURE_MASK)

        return tuple(each(chosen, posed))

    def _of_set(self, members: Sequence[PosedCandidates], seen: Mapping[str, _Seen]) -> dict[str, Candidate]:
        """The first candidates of objects of one shape and size; none where none of them is seen well enough."""
        shown = {m.object_id: seen[m.object_id] for m in members if m.object_id in seen}
        if not shown:
            return {}
        clear = [one for one in shown.values() if one.pixels >= MIN_PIXELS]
        changes = self._changes(members[0].candidates[0], clear) if clear else None
        alone = len(members) == 1
        placed = {
            m.object_id: self._placed(m.candidates[0], changes, shown.get(m.object_id), resize=alone) for m in members
        }
        return self._turned(members, shown, placed) or placed

    def _turned(
        self, members: Sequence[PosedCandidates], shown: Mapping[str, _Seen], placed: Mapping[str, Candidate]
    ) -> dict[str, Candidate] | None:
        """Objects of one shape with the profile that the picture shows; None where they agree as well without."""
        best = members[0].candidates[0]
        sure = {i: one.evidence for i, one in shown.items() if one.mask_confidence >= SURE_MASK}
        if not sure or not can_be_turned(best.shape_id):
            return None
        before = [e.error(ShapeCaster(self.library.mesh(placed[i].shape_id)), placed[i].pose) for i, e in sure.items()]
        caster, alone = ShapeCaster(self.library.mesh(best.shape_id)), len(members) == 1
        own, size = {m.object_id: m.candidates[0].pose for m in members}, np.asarray(best.shape_size_m)
        poses = [fitted_pose(e, caster, own[i], size, resize=alone) for i, e in sure.items()]
        found = turned(self.library, best.shape_id, list(sure.values()), poses, float(np.mean(before)))
        if found is None:
            return None
        x, y, z = (float(v) for v in found.size_m)
        seen_at = dict(zip(sure, found.poses, strict=True))
        return {
            i: replace(c, shape_id=found.shape_id, shape_size_m=(x, y, z), pose=seen_at.get(i) or _standing(c, z))
            for i, c in placed.items()
        }

    def _changes(self, best: Candidate, seen: Sequence[_Seen]) -> dict[str, Value] | None:
        """Parameters that differ in the picture; None where the retrieved shape is rather stretched than built."""
        size = np.asarray(best.shape_size_m) * best.pose.scale
        if not self._can_be_made(best.shape_id, size):
            return None
        before = _mean_score(seen, ShapeCaster(self.library.mesh(best.shape_id)), best.pose.scale)
        changes: dict[str, Value] = {}
        as_built = self._score(best.shape_id, size, changes, seen)
        if as_built < before - SIZE_LOSS:
            return None
        score, left = max(as_built, before), MAX_VARIANTS
        worth = WORTH if any(one.evidence.surface is None for one in seen) else WORTH_WITH_DEPTH
        for _ in range(PASSES):
            before_pass = dict(changes)
            for name, values in varied(best.shape_id):
                others = [v for v in values if v != changes.get(name) and can_have(name, v, size)][:left]
                tried = {v: self._score(best.shape_id, size, {**changes, name: v}, seen) for v in others}
                left -= len(tried)
                value = max(tried, key=tried.__getitem__, default=None)
                if value is not None and tried[value] > score + worth:
                    changes, score = {**changes, name: value}, tried[value]
            if changes == before_pass:
                break
        return changes

    def _placed(
        self, best: Candidate, changes: dict[str, Value] | None, seen: _Seen | None, *, resize: bool
    ) -> Candidate:
        """The candidate with these parameters, its pose fitted; shapes that are nearly as retrieved stay of its id."""
        shape_id, size, pose = best.shape_id, np.asarray(best.shape_size_m), best.pose
        if changes:
            size = np.round(size * pose.scale, 3)
            shape_id, pose = made_id(shape_id, size, changes), Pose(pose.R_world_object, pose.position, np.ones(3))
        if seen is not None:
            caster = ShapeCaster(self.library.mesh(shape_id))
            pose = fitted_pose(seen.evidence, caster, pose, size, resize=resize)
        whole = size * pose.scale
        uneven = relative_scale(whole / np.asarray(best.shape_size_m)) != EVEN
        if changes is None or not (changes or uneven) or not can_be_made(best.shape_id, whole):
            return replace(best, pose=pose)
        x, y, z = (float(v) for v in np.round(whole, 3))
        made = made_id(best.shape_id, np.array([x, y, z]), changes)
        pose = Pose(pose.R_world_object, pose.position, np.ones(3))
        return replace(best, shape_id=made, shape_size_m=(x, y, z), pose=pose)

    def _can_be_made(self, shape_id: str, size_m: Float[np.ndarray, "3"]) -> bool:
        if record_of(self.library, shape_id).source != BUILT_IN or not can_be_made(shape_id, size_m):
            return False
        return len(self.library.mesh(shape_id).faces) <= MAX_TRIANGLES

    def _score(
        self, shape_id: str, size_m: Float[np.ndarray, "3"], changes: dict[str, Value], seen: Sequence[_Seen]
    ) -> float:
        mesh = self.library.mesh(made_id(shape_id, size_m, changes))
        return _mean_score(seen, ShapeCaster(mesh), np.ones(3))


def can_have(name: str, value: Value, size_m: Float[np.ndarray, "3"]) -> bool:
    """Whether a shape of this depth, width and height can have a parameter's value: its drawers are for things."""
    drawers = [v for v in value if isinstance(v, int)] if name == "bays" and isinstance(value, tuple) else []
    if not drawers or not isinstance(value, tuple):
        return True
    return bool(size_m[1] / len(value) >= MIN_DRAWER_M[0] and size_m[2] / max(drawers) >= MIN_DRAWER_M[1])


def _standing(candidate: Candidate, height_m: float) -> Pose:
    """Where a candidate stands, of another height, at scale 1."""
    pose = candidate.pose
    raised = 0.5 * (height_m - candidate.shape_size_m[2] * float(pose.scale[2]))
    return Pose(pose.R_world_object, pose.position + np.array([0.0, 0.0, raised]), np.ones(3))


def _mean_score(seen: Sequence[_Seen], caster: ShapeCaster, scale: Float[np.ndarray, "3"]) -> float:
    return float(np.mean([one.score(caster, scale) for one in seen]))


def _sets(posed: Sequence[PosedCandidates]) -> list[list[PosedCandidates]]:
    """Objects whose first candidates have one shape and one size, together."""
    found: dict[tuple[str, bytes], list[PosedCandidates]] = {}
    for one in posed:
        if one.candidates:
            best = one.candidates[0]
            found.setdefault((best.shape_id, np.round(best.pose.scale, 3).tobytes()), []).append(one)
    return list(found.values())


def _seen(
    posed: Sequence[PosedCandidates],
    inputs: Inputs,
    objects: tuple[DetectedObject, ...],
    geometry: ObjectGeometry,
    depth: DepthMap,
) -> dict[str, _Seen]:
    """What the picture says of every posed object of which enough is seen, by its id."""
    pose_of = {p.object_id: p.candidates[0].pose for p in posed if p.candidates}
    centre_of = {c.object_id: c.centre for c in geometry.cuboids}
    items = [o for o in objects if o.id in centre_of]
    centres = np.array([centre_of[o.id] for o in items]).reshape(-1, 3)
    positions = {o.id: k for k, o in enumerate(items)}
    parent_of = {s.child: s.parent for s in geometry.supports}
    parents = [positions.get(parent_of.get(o.id, "")) for o in items]
    noise = noise_of(depth)
    found = {}
    for k, item in enumerate(items):
        if item.id not in pose_of:
            continue
        window = observe_among(geometry.camera, items, centres, parents, k, CELLS)
        if float((window.covered * window.weight).sum()) < MIN_CELLS:
            continue
        surface = measured_surface(depth, window, item.mask, noise)
        closed = surface is not None or item.category in NEVER_OPEN
        colours = None if closed else SeeThrough.of(inputs.photo.rgb, window)
        evidence = Evidence(geometry.camera, window, Facing(()), surface, colours)
        found[item.id] = _Seen(
            evidence,
            InnerEdges.of(inputs.photo.rgb, window),
            pose_of[item.id],
            int(item.mask.sum()),
            item.mask_confidence,
            item.category,
        )
    return found


def _with_first(posed: PosedCandidates, first: Candidate) -> PosedCandidates:
    """The candidates with another first one; what was retrieved stays second where its shape was another."""
    others = posed.candidates if first.shape_id != posed.candidates[0].shape_id else posed.candidates[1:]
    return replace(posed, candidates=(first, *others))
