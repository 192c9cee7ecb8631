"""Nine-degree-of-freedom poses by rendering every hypothesis and comparing it with the picture."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from diorama_core.artefacts import (
    Cuboid,
    DepthMap,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    PosedCandidates,
    RankedShapes,
)
from diorama_core.geometry.observed import Observed, observe_among
from diorama_core.geometry.silhouette import SHARED_CASTERS, PoseBatch, ShapeCaster
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import category
from diorama_core.pose.evidence import Evidence, MeasuredSurface
from diorama_core.pose.facing import facing_of, wall_samples
from diorama_core.pose.hypotheses import Anchor, anchor_of, hypotheses_for
from diorama_core.pose.limits import SizeLimits
from diorama_core.pose.refine import BoxFit
from diorama_core.progress import Progress
from diorama_core.scene.types import Candidate, Pose


@dataclass(frozen=True, eq=False)
class _Task:
    """One object with everything its shapes are posed against."""

    thing: DetectedObject
    cuboid: Cuboid
    anchor: Anchor
    coarse: Evidence
    fine: Evidence


@dataclass(frozen=True, eq=False)
class _Posed:
    """One shape's best pose."""

    shape: Shape
    pose: Pose
    log_score: float
    error: float


@dataclass(frozen=True)
class RenderAndCompare:
    """Poses every ranked shape by yaw search, per-axis scaling and refinement; needs no weights.

    Hypotheses are gravity-aligned turns in the object's cuboid; they are scored by silhouette and box, by depth and
    normals where these were measured, and by where such things usually face.
    """

    library: ShapeLibrary
    coarse_cells: int = 32
    """Resolution at which all hypotheses are compared."""
    fine_cells: int = 56
    """Resolution at which the best ones are."""
    refined: int = 2
    """How many hypotheses of each shape are refined."""

    def __repr__(self) -> str:
        words = "\n".join(f"{s.id} {s.content_hash}" for s in self.library.shapes())
        shapes = hashlib.sha256(words.encode()).hexdigest()[:12]
        return f"RenderAndCompare({shapes}, {self.coarse_cells}, {self.fine_cells}, {self.refined})"

    def pose(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        shapes: tuple[RankedShapes, ...],
        progress: Progress,
    ) -> tuple[PosedCandidates, ...]:
        """Posed candidates, best first, of every object that has a cuboid and at least one ranked shape."""
        ranked = {r.object_id: r.ranked for r in shapes if r.ranked}
        records = {s.id: s for s in self.library.shapes()}
        tasks = self._tasks(objects, geometry, depth, frozenset(ranked))
        posed = []
        for index, task in enumerate(tasks):
            progress.report(index / len(tasks), f"Posing: {task.thing.label}")
            posed.append(self._pose_object(task, ranked[task.thing.id], records))
        return tuple(posed)

    def _tasks(
        self,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        wanted: frozenset[str],
    ) -> list[_Task]:
        cuboid_of = {c.object_id: c for c in geometry.cuboids}
        things = [o for o in objects if o.id in cuboid_of]
        cuboids = [cuboid_of[o.id] for o in things]
        centres = np.array([c.centre for c in cuboids]).reshape(-1, 3)
        positions = {o.id: i for i, o in enumerate(things)}
        parent_of = {s.child: s.parent for s in geometry.supports}
        parents = [positions.get(parent_of.get(o.id, "")) for o in things]
        categories = {o.id: o.category for o in things}
        walls = wall_samples(depth, geometry.camera, things)
        tasks = []
        for i, thing in enumerate(things):
            if thing.id not in wanted:
                continue
            on_wall = parent_of.get(thing.id) == "wall"
            facing = facing_of(thing, cuboids[i], cuboids, categories, geometry.camera, walls, on_wall)
            coarse, fine = (
                Evidence(geometry.camera, seen, facing, _surface(depth, seen))
                for cells in (self.coarse_cells, self.fine_cells)
                for seen in [observe_among(geometry.camera, things, centres, parents, i, cells)]
            )
            toward = geometry.camera.position[:2] - cuboids[i].centre[:2]
            tasks.append(_Task(thing, cuboids[i], anchor_of(cuboids[i], on_wall, toward), coarse, fine))
        return tasks

    def _pose_object(
        self, task: _Task, ranked: tuple[tuple[str, float], ...], records: Mapping[str, Shape]
    ) -> PosedCandidates:
        posed = [(self._pose_shape(task, records[shape_id]), score) for shape_id, score in ranked]
        best_retrieval = max(max(score for _, score in ranked), 1e-9)
        scored = [(max(score, 0.0) / best_retrieval * np.exp(found.log_score), found) for found, score in posed]
        scored.sort(key=lambda pair: (-pair[0], pair[1].shape.id))
        top = max(scored[0][0], 1e-12)
        candidates = tuple(
            Candidate(found.shape.id, found.shape.size_m, float(score / top * (1.0 - scored[0][1].error)), found.pose)
            for score, found in scored
        )
        confidence = task.fine.confidence(scored[0][1].error, task.cuboid.confidence)
        return PosedCandidates(task.thing.id, candidates, confidence)

    def _pose_shape(self, task: _Task, shape: Shape) -> _Posed:
        """Search, refine and choose: a refinement is taken only where it scores better."""
        caster = SHARED_CASTERS.get(shape.content_hash or shape.id, lambda: ShapeCaster(self.library.mesh(shape.id)))
        name = task.thing.category
        limits = SizeLimits.of(shape.size_m, name, task.cuboid.size_m)
        tried = hypotheses_for(task.cuboid, name, shape.symmetry, limits, task.anchor)
        rough = task.coarse.log_scores(task.coarse.errors(caster, tried.poses), tried.poses, tried.off_axis_rad, limits)
        best = np.argsort(-rough, kind="stable")[: self.refined]
        start, off_axis = tried.poses[best], tried.off_axis_rad[best]
        yaw_sigma = np.deg2rad(9.0 if category(name).quarter_turns_free else 4.0)
        fit = BoxFit(task.fine.camera, task.fine.seen, task.anchor, limits, float(yaw_sigma))
        moved = fit.refined(caster, start)
        both = PoseBatch(
            np.concatenate([start.R, moved.R]),
            np.concatenate([start.position, moved.position]),
            np.concatenate([start.scale, moved.scale]),
        )
        errors = task.fine.errors(caster, both)
        scores = task.fine.log_scores(errors, both, np.tile(off_axis, 2), limits)
        chosen = int(np.argmax(scores))
        pose = Pose(both.R[chosen], both.position[chosen], both.scale[chosen])
        return _Posed(shape, pose, float(scores[chosen]), float(errors[chosen]))


def _surface(depth: DepthMap, seen: Observed) -> MeasuredSurface | None:
    """Depth and normals under an object's mask; None where depth was only rendered from what is already known."""
    if depth.source == "rendered from cuboids and room":
        return None
    metres = seen.window.sample(depth.depth_m).astype(np.float64)
    normals = np.nan_to_num(seen.window.sample(depth.normals_world).astype(np.float64))
    known = np.isfinite(metres) & (metres > 0)
    weight = seen.covered * seen.weight * known
    if weight.sum() < 4.0:
        return None
    return MeasuredSurface(np.where(known, metres, 1.0), normals, weight)
