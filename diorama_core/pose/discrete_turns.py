"""Poses as ACDC finds them (Dai et al. 2024): one of a few turns about the vertical, and the box of the points seen.

The publication compares the crop with snapshots of a shape from all around by DINOv2; here by the patch features that
the stage is given, the embedded ones by default, which stand in for it. Every axis is scaled to the extent of the
points that the mask shows, so what is hidden is missing from the size.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import DepthMap, DetectedObject, Inputs, ObjectGeometry, PosedCandidates, RankedShapes
from diorama_core.geometry.casting import pixel_centres
from diorama_core.library.record import Shape
from diorama_core.pose.correspondence.crops import crop_object
from diorama_core.pose.correspondence.rigid import Compared
from diorama_core.pose.correspondence.solvers import CorrespondencePose
from diorama_core.progress import Progress
from diorama_core.scene.types import Camera, Candidate, Pose, yaw_rotation

TURNS = 36
"""Headings that are told apart, evenly spread, as seen from the camera."""
OUTLIERS_PERCENT = 2.0
MIN_POINTS, MIN_SIDE_M = 12, 0.01


@dataclass(frozen=True)
class DiscreteTurns:
    """The heading of the most similar view; size and place from the points under the mask."""

    views: CorrespondencePose
    """Compares pictures with the views of shapes; its own way to poses is not used."""

    def pose(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        shapes: tuple[RankedShapes, ...],
        progress: Progress,
    ) -> tuple[PosedCandidates, ...]:
        """Posed candidates, the most similar first; objects with next to no depth are left out.

        Args:
            inputs, objects, geometry, depth, shapes, progress: as documented in `protocols.PoseStage`.
        """
        ranked = {r.object_id: r.ranked for r in shapes if r.ranked}
        records = {s.id: s for s in self.views.library.shapes()}
        wanted = [o for o in objects if o.id in ranked]
        results = []
        for index, item in enumerate(wanted):
            progress.report(index / len(wanted), f"Turning: {item.label}")
            points = object_points(item, depth, geometry.camera)
            if len(points) < MIN_POINTS:
                continue
            crop = crop_object(
                inputs.photo.rgb,
                item.mask,
                item.box,
                depth.depth_m,
                depth.normals_world,
                geometry.camera,
                self.views.grid,
            )
            candidates = [records[i] for i, _ in ranked[item.id]]
            compared = self.views.compare(crop, candidates)
            posed = [self._candidate(s, c, geometry.camera, points) for s, c in zip(candidates, compared, strict=False)]
            if posed:
                best = sorted(posed, key=lambda c: (-c.score, c.shape_id))
                results.append(PosedCandidates(item.id, tuple(best), best[0].score * item.mask_confidence))
        return tuple(results)

    def _candidate(
        self, shape: Shape, compared: Compared, camera: Camera, points: Float[np.ndarray, "n 3"]
    ) -> Candidate:
        view = int(compared.similarity.argmax())
        R_camera = compared.crop.R_camera_crop @ compared.templates.grid.R_object_camera[view].T
        R_world = camera.T_world_camera[:3, :3] @ R_camera
        looking = camera.T_world_camera[:3, 2]
        from_camera = float(np.arctan2(looking[1], looking[0]))
        step = 2 * np.pi / TURNS
        yaw = from_camera + step * round((float(np.arctan2(R_world[1, 0], R_world[0, 0])) - from_camera) / step)
        R = yaw_rotation(yaw)
        local = points @ R
        low, high = np.percentile(local, (OUTLIERS_PERCENT, 100.0 - OUTLIERS_PERCENT), axis=0)
        size = np.maximum(high - low, MIN_SIDE_M)
        scale = size / np.maximum(shape.size_m, 1e-6)
        score = float(np.clip(compared.similarity[view], 0.0, 1.0))
        return Candidate(shape.id, shape.size_m, score, Pose(R, R @ ((low + high) / 2), scale))


def object_points(item: DetectedObject, depth: DepthMap, camera: Camera) -> Float[np.ndarray, "n 3"]:
    """World points of the pixels of an object that have depth."""
    k = camera.intrinsics
    pixels = pixel_centres(k.width, k.height)[item.mask]
    z = depth.depth_m[item.mask].astype(float)
    known = np.isfinite(z) & (z > 0)
    pixels, z = pixels[known], z[known]
    local = np.stack([(pixels[:, 0] - k.cx) / k.fx * z, (pixels[:, 1] - k.cy) / k.fy * z, z], axis=1)
    return np.asarray(local @ camera.T_world_camera[:3, :3].T + camera.position)
