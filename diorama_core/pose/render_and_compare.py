"""Nine-degree-of-freedom poses by rendering every hypothesis and comparing it with the picture."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.facing.solve import solve
from diorama_core.arrangement.facing.terms import FacingWeights, facing_weights
from diorama_core.artefacts import DepthMap, DetectedObject, Inputs, ObjectGeometry, PosedCandidates, RankedShapes
from diorama_core.geometry.shape_appearance import SHARED_APPEARANCES, ShapeAppearance
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import category
from diorama_core.pose.hypotheses import Hypotheses, hypotheses_for, unlike_best
from diorama_core.pose.limits import SizeLimits, sides_log_of
from diorama_core.pose.measured import MeasuredObject
from diorama_core.pose.parameter_fit import level_cost
from diorama_core.pose.posing_tasks import (
    PosedShape,
    PosingTask,
    candidates_of,
    likeliest_kinds,
    posing_tasks,
    sort_shapes,
)
from diorama_core.pose.refine import BoxFit
from diorama_core.pose.room_evidence import Trials, TriedShape, facing_room, powers, wall_samples
from diorama_core.pose.sets import equalise_scales, mix_ranks
from diorama_core.pose.settings import SETTINGS, PoseSettings
from diorama_core.processes import map_beside
from diorama_core.progress import Progress
from diorama_core.scene.types import Pose


@dataclass(frozen=True)
class RenderAndCompare:
    """Poses every ranked shape by yaw search, per-axis scaling and refinement; needs no weights.

    Hypotheses are gravity-aligned turns in the object's cuboid and, where depth was measured, turns all around set
    against the measured points. They are scored by silhouette and box, or by silhouette, depth and normals where
    nothing was measured in front; and by where such objects usually face. Unlike ones are refined; the posed fit and
    how little a shape had to be enlarged or stretched choose among shapes; objects of a set share shape and size.
    """

    library: ShapeLibrary
    coarse_cells: int = 32
    """Resolution at which all hypotheses are compared."""
    fine_cells: int = 56
    """Resolution at which the best ones are."""
    refined: int = 2
    """How many hypotheses of each shape are refined where only the outline is known."""
    refined_with_depth: int = 5
    """How many of each promising shape where depth was measured."""
    promising: int = 4
    """Shapes that the coarse comparison likes best; where depth was measured the others are looked at less."""
    facing: FacingWeights = field(default_factory=facing_weights)
    settings: PoseSettings = SETTINGS

    def __repr__(self) -> str:
        numbers = repr(self.facing) + repr(self.settings)
        words = "\n".join(f"{s.id} {s.content_hash}" for s in self.library.shapes()) + numbers
        shapes = hashlib.sha256(words.encode()).hexdigest()[:12]
        settings = (self.coarse_cells, self.fine_cells, self.refined, self.refined_with_depth, self.promising)
        return f"RenderAndCompare({shapes}, {', '.join(map(str, settings))})"

    def pose(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        shapes: tuple[RankedShapes, ...],
        progress: Progress,
    ) -> tuple[PosedCandidates, ...]:
        """Posed candidates, best first, of every object that has a cuboid and at least one ranked shape.

        Args:
            inputs, objects, geometry, depth, shapes, progress: as documented in `protocols.PoseStage`.
        """
        trials = self.trials(inputs, objects, geometry, depth, shapes, progress.part(0.0, 0.5))
        facings = solve(trials.room, self.facing)
        tasks = [task.with_facing(facings.costs_of(task.item.id)) for task in trials.tasks]
        pieces = list(zip(tasks, trials.tried, strict=True))
        tried = map_beside(self._pose_object, pieces, progress.part(0.5, 1.0), "Posing objects")
        ranks = mix_ranks(
            [task.item.category for task in tasks],
            [{posed.shape.id: posed.rank for posed in of_one} for of_one in tried],
            [task.fine.confidence(0.0, 1.0) for task in tasks],
            [task.max_loss for task in tasks],
            self.settings.search,
        )
        ordered = [sort_shapes(of_one, order) for of_one, order in zip(tried, ranks, strict=True)]
        firsts = self._equalise_scales(tasks, [of_one[0] for of_one in ordered])
        ordered = [(first, *of_one[1:]) for first, of_one in zip(firsts, ordered, strict=True)]
        return tuple(candidates_of(*one, facings) for one in zip(tasks, ordered, ranks, strict=True))

    def trials(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        shapes: tuple[RankedShapes, ...],
        progress: Progress,
    ) -> Trials:
        """What is known before it is decided which way objects face; arguments as of `pose`.

        Args:
            inputs, objects, geometry, depth, shapes, progress: as documented in `protocols.PoseStage`.
        """
        ranked = {r.object_id: r.ranked for r in shapes if r.ranked}
        records = {s.id: s for s in self.library.shapes()}
        kinds = likeliest_kinds(objects, ranked, records)
        walls = wall_samples(depth, geometry.camera, objects, self.settings.search)
        cells = (self.coarse_cells, self.fine_cells)
        tasks = posing_tasks(inputs, objects, geometry, depth, kinds, cells, walls, self.settings)
        pieces = [(task, [(records[i], score) for i, score in ranked[task.item.id]]) for task in tasks]
        tried = map_beside(self._try_shapes, pieces, progress, "Trying poses")
        return Trials(
            tasks, tried, facing_room(geometry, kinds, tasks, tried, walls, self.settings.search), self.settings.search
        )

    def _equalise_scales(self, tasks: Sequence[PosingTask], chosen: Sequence[PosedShape]) -> list[PosedShape]:
        """The chosen poses, those of one set equally large where that fits the picture hardly worse."""
        if not tasks:
            return []
        scales = equalise_scales(
            [task.item.category for task in tasks],
            [posed.shape.id for posed in chosen],
            np.array([posed.pose.scale for posed in chosen]),
            [
                task.fine.confidence(posed.error, task.cuboid.confidence)
                for task, posed in zip(tasks, chosen, strict=True)
            ],
            self.settings.search,
        )
        return [self._rescale(*one) for one in zip(tasks, chosen, scales, strict=True)]

    def _rescale(self, task: PosingTask, posed: PosedShape, scale: Float[np.ndarray, "3"]) -> PosedShape:
        if np.array_equal(scale, posed.pose.scale):
            return posed
        R, axis = posed.pose.R_world_object, task.anchor.axis_world
        grown = 0.5 * float(np.abs(axis @ R) @ ((scale - posed.pose.scale) * posed.shape.size_m))
        poses = PoseBatch(R[None], (posed.pose.position + grown * axis)[None], scale[None])
        error = float(task.fine.errors(self._appearance(posed.shape).caster, poses)[0])
        return (
            replace(posed, pose=_only(poses), error=error)
            if error <= posed.error + self.settings.search.loss_for_a_set
            else posed
        )

    def _appearance(self, shape: Shape) -> ShapeAppearance:
        folder = default_cache_dir() / "appearances"
        return SHARED_APPEARANCES.get(shape.content_hash, folder, lambda: self.library.parts(shape.id))

    def _try_shapes(self, task: PosingTask, ranked: Sequence[tuple[Shape, float]]) -> tuple[TriedShape, ...]:
        """Every shape's hypotheses with what the picture alone says of them."""
        best = max(max(score for _, score in ranked), 1e-9)
        return tuple(self._try_shape(task, s, float(np.log(max(score / best, 1e-6)))) for s, score in ranked)

    def _pose_object(self, task: PosingTask, compared: Sequence[TriedShape]) -> tuple[PosedShape, ...]:
        tried = [replace(t, scores=t.scores - task.coarse.facing.cost(t.hypotheses.poses.R)) for t in compared]
        if task.measured is None:
            return tuple(self._with_levels(task, self._pose_by_outline(task, one)) for one in tried)
        order = sorted(range(len(tried)), key=lambda k: -float(tried[k].scores.max()))
        promising = set(order[: self.promising])
        return tuple(
            self._with_levels(task, self._pose_by_depth(task, task.measured, one, k in promising))
            for k, one in enumerate(tried)
        )

    def _with_levels(self, task: PosingTask, posed: PosedShape) -> PosedShape:
        """Ranked by the levels of what it carries, too."""
        if not task.carried:
            return posed
        cost = level_cost(self.library.shape(posed.shape.id), posed.pose, task.carried, self.settings.evidence)
        return replace(posed, rank=posed.rank - cost)

    def _try_shape(self, task: PosingTask, shape: Shape, liked: float) -> TriedShape:
        appearance = self._appearance(shape)
        name = task.item.category
        depth_known = task.measured is not None
        sides = sides_log_of(
            shape.symmetry, name, round=appearance.caster.round_from_above, settings=self.settings.search
        )
        limits = SizeLimits.of(
            shape.size_m, name, task.cuboid.size_m, measured=depth_known, sides_log=sides, settings=self.settings.search
        )
        tried = hypotheses_for(
            task.cuboid,
            name,
            shape.symmetry,
            limits,
            task.anchor,
            sides_known=depth_known,
            settings=self.settings.search,
        )
        if task.measured is not None:
            tried = tried.and_also(task.measured.hypotheses(shape.symmetry, limits))
        errors = task.coarse.errors(appearance.caster, tried.poses)
        scores = task.coarse.log_scores(errors, tried.poses, tried.off_axis_rad, tried.misfit, limits)
        if task.measured is not None:
            scores = scores + task.measured.bounds.log_likelihood(tried.poses, limits.shape_size_m)
        return TriedShape(shape, liked, limits, tried, scores)

    def _pose_by_outline(self, task: PosingTask, tried: TriedShape) -> PosedShape:
        best = np.argsort(-tried.scores, kind="stable")[: self.refined]
        poses, error, score = self._select_best(task, tried, tried.hypotheses[best])
        of_retrieval, of_pose = powers(task.item.label, self.settings.search)
        cost = task.fine.enlargement_cost(poses.scale[0], tried.limits) + task.fine.sure_outline_cost(error)
        cost -= task.fine.see_through_score(self._appearance(tried.shape).caster, poses)
        return PosedShape(tried.shape, _only(poses), error, of_retrieval * tried.liked + of_pose * score - cost)

    def _pose_by_depth(
        self, task: PosingTask, measured: MeasuredObject, tried: TriedShape, promising: bool
    ) -> PosedShape:
        """Unlike hypotheses are refined; the best one is also tried turned by quarters in its place."""
        fold, size_m = tried.shape.symmetry, tried.limits.shape_size_m
        count = self.refined_with_depth if promising else self.refined
        best = unlike_best(tried.hypotheses.poses, tried.scores, fold, size_m, count, self.settings.search)
        poses, error, score = self._select_best(task, tried, tried.hypotheses[best])
        if promising and fold < 3:
            turned = measured.turn_by_quarters(poses, fold, tried.limits)
            nothing = np.zeros(len(turned))
            other = self._select_best(task, tried, Hypotheses(turned, nothing, nothing))
            poses, error, score = max((poses, error, score), other, key=lambda pair: pair[2])
        return PosedShape(tried.shape, _only(poses), error, self._rank(task, measured, tried, poses, error))

    def _select_best(self, task: PosingTask, tried: TriedShape, start: Hypotheses) -> tuple[PoseBatch, float, float]:
        """The best of some poses and their refinements, with its error and score."""
        both, errors, scores = self._finely(task, tried, start)
        chosen = int(np.argmax(scores))
        return both[chosen : chosen + 1], float(errors[chosen]), float(scores[chosen])

    def _finely(
        self, task: PosingTask, tried: TriedShape, start: Hypotheses
    ) -> tuple[PoseBatch, Float[np.ndarray, "p"], Float[np.ndarray, "p"]]:
        """Some poses and their refinements, with errors and scores."""
        caster = self._appearance(tried.shape).caster
        both = start.poses.and_also(self._refine(task, caster, tried.limits, start.poses))
        errors = task.fine.errors(caster, both)
        off_axis, misfit = np.tile(start.off_axis_rad, 2), np.tile(start.misfit, 2)
        scores = task.fine.log_scores(errors, both, off_axis, misfit, tried.limits)
        if task.measured is not None:
            scores = scores + task.measured.log_likelihood(both, tried.limits)
            scores = scores - task.measured.elsewhere_cost(both, tried.limits, errors)
        return both, errors, scores

    def refine_best(self, task: PosingTask, tried: TriedShape, count: int) -> TriedShape:
        """A tried shape with its best unlike poses refined beside the others, which are worth a little less then.

        Args:
            task: of the object.
            tried: the shape with its poses and their scores.
            count: of poses to refine.
        """
        fold, size_m = tried.shape.symmetry, tried.limits.shape_size_m
        start = tried.hypotheses[
            unlike_best(tried.hypotheses.poses, tried.scores, fold, size_m, count, self.settings.search)
        ]
        both, _, scores = self._finely(task, tried, start)
        refined = Hypotheses(both, np.tile(start.off_axis_rad, 2), np.tile(start.misfit, 2))
        others = tried.scores - tried.scores.max() + scores.max() - self.settings.search.left_unrefined
        hypotheses = tried.hypotheses.and_also(refined)
        return replace(tried, hypotheses=hypotheses, scores=np.concatenate([others, scores]))

    def _refine(self, task: PosingTask, caster: ShapeCaster, limits: SizeLimits, start: PoseBatch) -> PoseBatch:
        if task.measured is not None:
            return task.measured.fit(limits).refine(caster, start)
        yaw_sigma = np.deg2rad(9.0 if category(task.item.category).quarter_turns_free else 4.0)
        foot_seen = task.cuboid.foot_seen
        fit = BoxFit(
            task.fine.camera,
            task.fine.seen,
            task.anchor,
            limits,
            float(yaw_sigma),
            foot_seen,
            settings=self.settings.search,
        )
        return fit.refine(caster, start)

    def _rank(
        self, task: PosingTask, measured: MeasuredObject, tried: TriedShape, poses: PoseBatch, error: float
    ) -> float:
        """What retrieval, the picture and what holds the object say of a posed shape, where depth was measured."""
        similarity = task.fine.log_likelihood(error, poses.scale[0], tried.limits)
        stands = max(float(measured.log_likelihood(poses, tried.limits)[0]), self.settings.search.min_standing)
        log_likelihood = 0.0
        if task.details is not None:
            appearance = self._appearance(tried.shape)
            log_likelihood = task.details.log_likelihood(appearance, task.fine.seen.hits(appearance.caster, poses))
        return self.settings.search.retrieval_with_depth * tried.liked + similarity + stands + log_likelihood


def _only(poses: PoseBatch) -> Pose:
    return Pose(poses.R[0], poses.position[0], poses.scale[0])
