"""Shapes made to measure: the retrieved design built at the measured size, its parameters fitted to the picture.

Retrieval gives the nearest design of the library. Here its parameters (`library.furniture.measures`: heights of bases
and seats, forms of backs and legs, numbers of drawers, doors, boards, cushions and panes) are changed one after the
other, and a change is kept where outline, measured depth and inner edges agree clearly better with it. Objects that
share shape and size are fitted together and stay alike; bodies of revolution get the profile that their outline shows
(`turned_profile`).

Shapes are ranked in the poses in which they were compared as wholes. A design whose profile or size is another is a bad
match there and the right one afterwards: what round things look like is known only when their profile was measured. So
where the first candidate does not fit well at its best, others are fitted too: the likeliest bodies of revolution, of
which a few are enough, since all get the same profile; shapes with a left and a right, which may be the mirror image of
the thing; and the next ones, where the first fits badly in a photo alone.
Measured depth has told them from one another already, with what is seen within the outline (`details`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice

import numpy as np

from diorama_core.artefacts import DepthMap, DetectedObject, Inputs, ObjectGeometry, PosedCandidates, RankedShapes
from diorama_core.geometry.silhouette import ShapeCaster
from diorama_core.library.furniture.measures import Value, can_be_made, can_be_turned, made_id, varied
from diorama_core.library.hands import other_hand
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.stretch import EVEN, relative_scale
from diorama_core.pose.outline_fit import COARSE, FINE, WIDE, fit_pose
from diorama_core.pose.parameter_fit import ParameterFit
from diorama_core.pose.seen_objects import SeenObject, observe_objects
from diorama_core.pose.settings import SETTINGS, PoseSettings, ShapeFitSettings
from diorama_core.pose.turned_profile import fit_profile
from diorama_core.processes import map_beside
from diorama_core.progress import Progress
from diorama_core.protocols import PoseStage
from diorama_core.scene.types import Candidate, Pose


@dataclass(frozen=True)
class MadeToMeasure:
    """Another stage's poses, the first shape of every object made to measure; what was retrieved stays next to it."""

    stage: PoseStage
    library: ShapeLibrary = field(repr=False)
    settings: PoseSettings = SETTINGS

    def pose(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        shapes: tuple[RankedShapes, ...],
        progress: Progress,
    ) -> tuple[PosedCandidates, ...]:
        """Posed candidates, best first; a made shape stands in the pose of the one that it is derived from.

        Args:
            inputs, objects, geometry, depth, shapes, progress: as documented in `protocols.PoseStage`.
        """
        posed = self.stage.pose(inputs, objects, geometry, depth, shapes, progress.part(0.0, 0.8))
        return self.fit(posed, inputs, objects, geometry, depth, progress.part(0.8, 1.0))

    def fit(
        self,
        posed: tuple[PosedCandidates, ...],
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        progress: Progress,
    ) -> tuple[PosedCandidates, ...]:
        """The candidates with the first of each made to measure, where the picture tells how.

        Args:
            posed: candidates of every object, best first.
            inputs, objects, geometry, depth, progress: as documented in `protocols.PoseStage`.
        """
        seen = observe_objects(posed, inputs, objects, geometry, depth, self.settings)
        progress.report(0.0, "Making shapes to measure")
        posed = self._best_fitting(posed, seen)
        pose_of = {p.object_id: p.candidates[0].pose for p in posed if p.candidates}
        seen = {i: replace(one, pose=pose_of[i]) for i, one in seen.items()}
        longest_first = sorted(_sets(posed), key=lambda members: -_variants(members))  # no thread waits for a last one
        shown = [{m.object_id: seen[m.object_id] for m in members if m.object_id in seen} for members in longest_first]
        tasks = list(zip(longest_first, shown, strict=True))
        made = map_beside(self._fit_set, tasks, progress, "Making shapes to measure")
        fitted_by_id = {object_id: candidate for of_set in made for object_id, candidate in of_set.items()}
        return tuple(_with_first(p, fitted_by_id[p.object_id]) if p.object_id in fitted_by_id else p for p in posed)

    def _best_fitting(
        self, posed: tuple[PosedCandidates, ...], seen: Mapping[str, SeenObject]
    ) -> tuple[PosedCandidates, ...]:
        """Objects with the candidate first that fits best, where their first one does not fit well.

        What agreed on a shape stays as it agreed, whatever its sizes; what is outlined surely and comes in no sets did
        not agree (`agree`).
        """
        shared = Counter(p.candidates[0].shape_id for p in posed if p.candidates)
        choice = FittedChoice(self.library, self.settings)

        def is_agreed(one: PosedCandidates) -> bool:
            shown = seen.get(one.object_id)
            return shown is None or (shared[one.candidates[0].shape_id] > 1 and shown.may_have_agreed)

        free = [one for one in posed if not is_agreed(one)]
        tasks = [(one, seen[one.object_id]) for one in free]
        chosen = {one.object_id: one for one in map_beside(choice.best_first, tasks)}
        return tuple(chosen.get(one.object_id, one) for one in posed)

    def _fit_set(self, members: Sequence[PosedCandidates], shown: Mapping[str, SeenObject]) -> dict[str, Candidate]:
        """The first candidates of objects of one shape and size; none where none of them is seen well enough."""
        if not shown:
            return {}
        clear = {i: one for i, one in shown.items() if one.pixels >= self.settings.shapes.min_pixels}
        best, alone = members[0].candidates[0], len(members) == 1
        parameters = ParameterFit(self.library, list(clear.values()), resize=alone, settings=self.settings)
        fit = parameters.fit(best, [one.pose for one in clear.values()]) if clear else None
        changes, poses = fit or (None, ())
        starts = dict(zip(clear, poses, strict=True)) if fit else {}
        placed = {
            m.object_id: self._fit_candidate(
                m.candidates[0],
                changes,
                shown.get(m.object_id),
                starts.get(m.object_id, m.candidates[0].pose),
                resize=alone,
            )
            for m in members
        }
        return self._fit_profiles(members, shown, placed) or placed

    def _fit_profiles(
        self, members: Sequence[PosedCandidates], shown: Mapping[str, SeenObject], placed: Mapping[str, Candidate]
    ) -> dict[str, Candidate] | None:
        """Objects of one shape with the profile that the picture shows; None where they agree as well without."""
        best = members[0].candidates[0]
        sure = {i: one.evidence for i, one in shown.items() if one.is_surely_outlined}
        if not sure or not can_be_turned(best.shape_id):
            return None
        before = [e.error(ShapeCaster(self.library.mesh(placed[i].shape_id)), placed[i].pose) for i, e in sure.items()]
        caster, alone = ShapeCaster(self.library.mesh(best.shape_id)), len(members) == 1
        poses_of_members, size = {m.object_id: m.candidates[0].pose for m in members}, np.asarray(best.shape_size_m)
        poses = [
            fit_pose(e, caster, poses_of_members[i], size, resize=alone, settings=self.settings.shapes)
            for i, e in sure.items()
        ]
        profile = fit_profile(
            self.library, best.shape_id, list(sure.values()), poses, float(np.mean(before)), self.settings
        )
        if profile is None:
            return None
        x, y, z = (float(v) for v in profile.size_m)
        seen_at = dict(zip(sure, profile.poses, strict=True))
        return {
            i: replace(c, shape_id=profile.shape_id, shape_size_m=(x, y, z), pose=seen_at.get(i) or _standing(c, z))
            for i, c in placed.items()
        }

    def _fit_candidate(
        self, best: Candidate, changes: dict[str, Value] | None, seen: SeenObject | None, start: Pose, *, resize: bool
    ) -> Candidate:
        """The candidate with these parameters, its pose fitted; shapes that are nearly as retrieved stay of its id.

        Without changes (None) it is not built but stretched; the fit begins at `start`, whose scale is the retrieved
        shape's.
        """
        shape_id, size_m, pose = best.shape_id, np.asarray(best.shape_size_m), start
        size, before = size_m, best.pose.scale
        if changes:
            size = np.round(size_m * start.scale, 3)
            shape_id, pose = made_id(shape_id, size, changes), Pose(start.R_world_object, start.position, np.ones(3))
            before = best.pose.scale * size_m / size
        if seen is not None:
            caster = ShapeCaster(self.library.mesh(shape_id))
            near = replace(COARSE if seen.has_given_mask else WIDE, scale=before)
            pose = fit_pose(seen.evidence, caster, pose, size, resize=resize, near=near, settings=self.settings.shapes)
            if seen.has_given_mask:
                pose = fit_pose(
                    seen.fine,
                    caster,
                    pose,
                    size,
                    resize=resize,
                    near=replace(FINE, scale=before),
                    settings=self.settings.shapes,
                )
        whole = size * pose.scale
        uneven = relative_scale(whole / size_m) != EVEN
        if changes is None or not (changes or uneven) or not can_be_made(best.shape_id, whole):
            return replace(best, pose=pose)
        x, y, z = (float(v) for v in np.round(whole, 3))
        made = made_id(best.shape_id, np.array([x, y, z]), changes)
        pose = Pose(pose.R_world_object, pose.position, np.ones(3))
        return replace(best, shape_id=made, shape_size_m=(x, y, z), pose=pose)


def _standing(candidate: Candidate, height_m: float) -> Pose:
    """Where a candidate stands, of another height, at scale 1."""
    pose = candidate.pose
    raised = 0.5 * (height_m - candidate.shape_size_m[2] * float(pose.scale[2]))
    return Pose(pose.R_world_object, pose.position + np.array([0.0, 0.0, raised]), np.ones(3))


def _sets(posed: Sequence[PosedCandidates]) -> list[list[PosedCandidates]]:
    """Objects whose first candidates have one shape and one size, together."""
    sets: dict[tuple[str, bytes], list[PosedCandidates]] = {}
    for one in posed:
        if one.candidates:
            best = one.candidates[0]
            sets.setdefault((best.shape_id, np.round(best.pose.scale, 3).tobytes()), []).append(one)
    return list(sets.values())


def _variants(members: Sequence[PosedCandidates]) -> int:
    """About how often a set is set against the picture: for every value of a parameter, each of its objects is."""
    return len(members) * sum(len(values) for _, values in varied(members[0].candidates[0].shape_id))


def _with_first(posed: PosedCandidates, first: Candidate) -> PosedCandidates:
    """The candidates with another first one; what was retrieved stays second where its shape was another."""
    others = posed.candidates if first.shape_id != posed.candidates[0].shape_id else posed.candidates[1:]
    return replace(posed, candidates=(first, *others))


@dataclass(frozen=True)
class FittedChoice:
    """Compares the candidates of single objects; those of sets are the set's."""

    library: ShapeLibrary = field(repr=False)
    settings: PoseSettings = SETTINGS

    def best_first(self, one: PosedCandidates, seen: SeenObject) -> PosedCandidates:
        """The candidates with the best first, all of them as they were."""
        outlined = seen.is_surely_outlined
        first, first_score = self._score_fit(one.candidates[0], seen)
        if first < self.settings.shapes.good_fit:
            return one
        by_rank = seen.evidence.surface is None and first >= self.settings.shapes.poor_fit
        others = {
            *_select_alternatives(one.candidates, by_rank, outlined, self.settings.shapes),
            *(self._uneven(one.candidates) if outlined else ()),
        }
        scores = {0: first_score, **{k: self._score_fit(one.candidates[k], seen)[1] for k in others}}
        best = max(scores, key=lambda k: (scores[k], -k))
        rest = (*one.candidates[:best], *one.candidates[best + 1 :])
        return replace(one, candidates=(one.candidates[best], *rest))

    def _uneven(self, candidates: Sequence[Candidate]) -> list[int]:
        """The next candidates whose mirror image is another shape: none of them was compared as that."""
        places = (k for k, c in enumerate(candidates) if k and other_hand(self.library, c.shape_id) is not None)
        return list(islice(places, self.settings.shapes.uneven))

    def _score_fit(self, candidate: Candidate, seen: SeenObject) -> tuple[float, float]:
        """Disagreement with the picture, 0 to 1, in the fitted pose and with the profile that is seen; and the score.

        Of what has a left and a right, the hand that fits better counts. The score is a logarithm, higher is better.
        """
        evidence, size = seen.evidence, np.asarray(candidate.shape_size_m)
        hands = [i for i in (candidate.shape_id, other_hand(self.library, candidate.shape_id)) if i is not None]
        casters = [ShapeCaster(self.library.mesh(hand)) for hand in hands]
        poses = [
            fit_pose(evidence, c, candidate.pose, size, resize=True, settings=self.settings.shapes) for c in casters
        ]
        errors = [evidence.error(c, p) for c, p in zip(casters, poses, strict=True)]
        best = int(np.argmin(errors))
        error, caster, pose = errors[best], casters[best], poses[best]
        fits = (
            fit_profile(self.library, candidate.shape_id, [evidence], [pose], error, self.settings)
            if seen.is_surely_outlined
            else None
        )
        if fits is not None:
            error = fits.error
        edges = (1.0 - evidence.seen.hidden_share) * seen.edges_in(caster, pose)
        weights = self.settings.shapes
        of_rank = weights.of_rank * float(np.log(max(candidate.score, weights.no_score)))
        of_fit = weights.of_fit * float(np.log(error + self.settings.evidence.noise_floor))
        return error, of_rank - of_fit + weights.of_edges * edges


def _select_alternatives(
    candidates: Sequence[Candidate], by_rank: bool, outlined: bool, settings: ShapeFitSettings
) -> list[int]:
    """Which candidates are fitted beside the first: the next ones, and bodies of revolution."""
    next_ones = range(1, min(settings.compared, len(candidates))) if by_rank else ()
    round_ones = (
        [k for k, c in enumerate(candidates) if can_be_turned(c.shape_id)][: settings.turned] if outlined else []
    )
    return sorted({*next_ones, *round_ones} - {0})
