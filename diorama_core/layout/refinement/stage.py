"""Objects of a finished layout fitted to the photo's masks: they slide, turn and grow a little where they rest.

Shapes were posed one by one, and supports, walls and neighbours have moved them since. Here all are seen together, each
hiding what is behind it, and every step is one that the layout allows: contact stays, and nothing overlaps.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import DetectedObject, LayoutReport
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.layout.feasible.photo_observations import disagreements
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.refinement.freedom import MEASURED, REASONED, PosePrior, Precision
from diorama_core.layout.refinement.pixel_grid import PixelGrid
from diorama_core.layout.refinement.posed_picture import PosedPicture
from diorama_core.layout.refinement.search import Search
from diorama_core.layout.report import measure
from diorama_core.layout.settings import REFINEMENT, RefinementSettings
from diorama_core.layout.what_got_worse import disagreement_in_words
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.scene import edits
from diorama_core.scene.types import Camera, Pose, Scene


@dataclass(frozen=True)
class MaskRefinement:
    """Moves objects within their supports until they cover their masks best."""

    library: ShapeLibrary
    precision: Precision
    settings: RefinementSettings = REFINEMENT

    @classmethod
    def of(cls, library: ShapeLibrary, *, depth_measured: bool) -> MaskRefinement:
        """As is right for measured depth, or for a photo alone."""
        return cls(library, MEASURED if depth_measured else REASONED)

    def refine(
        self,
        scene: Scene,
        report: LayoutReport,
        observed: Scene,
        objects: Sequence[DetectedObject],
        progress: Progress,
    ) -> tuple[Scene, LayoutReport]:
        """The scene in poses that cover the masks better.

        Args:
            scene, report, observed, objects, progress: as documented in `protocols.RefinementStage`.
        """
        begun = time.perf_counter()
        detected = {o.id: o for o in objects}
        problem = build_problem(scene, self.library, adherence_m=self.settings.touching_m)
        detected_objects = [detected.get(name) for name in problem.ids]
        if scene.camera is None or all(item is None for item in detected_objects):
            return scene, report
        seen = [observed.object(name).pose for name in problem.ids]
        priors = [
            PosePrior(scene.camera.position, self._prior_pose(pose, scale), self.precision, self.settings)
            for pose, scale in zip(seen, problem.scale, strict=True)
        ]
        picture = self._picture(scene, scene.camera, problem, detected_objects)
        none = np.zeros(4)
        boxes = np.array([none if o is None else o.box for o in detected_objects], dtype=np.float64)
        trust = np.array([0.0 if o is None else _trust(o, self.settings.outlined) for o in detected_objects])
        sized = _belong_to_sets(observed, problem.ids)
        poses = Search(problem, picture, priors, boxes, trust, sized, self.settings).poses(progress)
        as_observed = problem.with_poses_of(observed)
        now = problem.with_poses(poses.R, poses.position, poses.scale)
        report = replace(report, seconds=report.seconds + time.perf_counter() - begun)
        return edits.place(scene, now.free_poses), _update_report(report, as_observed, now, scene.camera)

    def _prior_pose(self, seen: Pose, settled_scale: Float[np.ndarray, "3"]) -> Pose:
        """The observed pose; of measured objects as high as the layout made them, which knows what was hidden below."""
        if self.precision.sizes_follow:
            return seen
        return replace(seen, scale=np.array([*seen.scale[:2], settled_scale[2]]))

    def _picture(
        self, scene: Scene, camera: Camera, problem: Problem, detected_objects: Sequence[DetectedObject | None]
    ) -> PosedPicture:
        masks = [None if item is None else item.mask for item in detected_objects]
        height, width = next(mask.shape for mask in masks if mask is not None)
        grid = PixelGrid.of(camera, width, height, self.settings.long_side_px)
        shapes = [scene.object(name).shape_id for name in problem.ids]
        casters = {name: ShapeCaster(self.library.mesh(name)) for name in set(shapes)}
        poses = PoseBatch(problem.R, problem.p, problem.scale)
        return PosedPicture.of(grid, grid.labels(masks), [casters[name] for name in shapes], poses, self.settings)


def _trust(detected: DetectedObject, outlined: float) -> float:
    """What a mask counts against the object's box; all where a person gave it, and the box was drawn round it."""
    return 1.0 if detected.mask_confidence == 1.0 else outlined * detected.mask_confidence


def _belong_to_sets(observed: Scene, ids: Sequence[str]) -> list[bool]:
    """True for objects exactly as large as another of their shape: objects of a set stay alike."""
    sizes = {o.id: (o.shape_id, *o.pose.scale.tolist()) for o in observed.objects}
    alike = Counter(sizes.values())
    return [alike[sizes[name]] > 1 for name in ids]


def _update_report(report: LayoutReport, observed: Problem, now: Problem, camera: Camera) -> LayoutReport:
    """The report of a layout whose objects are in other poses now."""
    apart = disagreements(observed, now, camera)
    outdated = set(map(disagreement_in_words, report.disagreements))
    return replace(
        report,
        after=measure(observed, now),
        reasons=(*(r for r in report.reasons if r not in outdated), *map(disagreement_in_words, apart)),
        disagreements=apart,
    )
