"""The geometry stage for a photo alone: metric camera, cuboids and support edges from boxes and known sizes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diorama_core.artefacts import (
    CameraEstimate,
    CameraHypothesis,
    Cuboid,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    Photo,
)
from diorama_core.models.seen_depth import GeometryNetwork
from diorama_core.perception.metrology.box_observations import BoxObservations, gather, observe_depths
from diorama_core.perception.metrology.floor import HeightScan, scan_heights
from diorama_core.perception.metrology.placement import CEILING, FLOOR, WALL, Placement, place_all
from diorama_core.perception.metrology.problem import View
from diorama_core.perception.metrology.reading import confidence_of, foot_seen, heading_and_size, reasons_of
from diorama_core.perception.metrology.settings import SETTINGS, MetrologySettings
from diorama_core.progress import Progress
from diorama_core.provenance import ScaleSource
from diorama_core.scene.types import Camera, Relation, Support, yaw_rotation

_PARENT_NAMES = {FLOOR: "floor", WALL: "wall", CEILING: "ceiling"}


@dataclass(frozen=True)
class SingleViewMetrology:
    """Metric scale and objects from one photo and boxes."""

    max_hypotheses: int = 3
    """Readings of the camera among which the objects decide."""
    settings: MetrologySettings = SETTINGS
    depth: GeometryNetwork | None = None
    """A network whose rough depth is evidence beside boxes and sizes."""

    def measure(
        self, inputs: Inputs, camera: CameraEstimate, objects: tuple[DetectedObject, ...], progress: Progress
    ) -> ObjectGeometry:
        """The camera's height and every object's cuboid, support and confidence.

        Args:
            inputs, camera, objects, progress: as documented in `protocols.GeometryStage`.

        Returns:
            One cuboid and one support edge per object, in the order given.
        """
        observations = gather(objects, inputs.photo.width, inputs.photo.height, self.settings)
        progress.report(0.0, "Measuring the camera's height")
        hypothesis, scan, observations = self._choose(camera.hypotheses, observations, inputs.photo, objects, progress)
        view = View(hypothesis.intrinsics, hypothesis.R_world_camera)
        progress.report(0.6, "Placing objects")
        placements = place_all(observations, view, scan.height_m)
        progress.report(1.0, "Objects measured")
        return ObjectGeometry(
            camera=_camera(hypothesis, scan.height_m),
            cuboids=tuple(_cuboid(o, p, observations, scan) for o, p in zip(objects, placements, strict=True)),
            supports=supports_of(placements, objects),
            source=ScaleSource.OBJECT_SIZES if objects else ScaleSource.CAMERA_HEIGHT,
            confidence=_overall(camera, scan, len(objects)),
            scale_sigma=scan.log_sigma,
            reasons=reasons_of(placements, view, objects, self.settings.fit),
        )

    def _choose(
        self,
        hypotheses: tuple[CameraHypothesis, ...],
        observations: BoxObservations,
        photo: Photo,
        objects: tuple[DetectedObject, ...],
        progress: Progress,
    ) -> tuple[CameraHypothesis, HeightScan, BoxObservations]:
        """The hypothesis under which vanishing points and objects are explained best, with the depths seen by it."""
        scanned = []
        tried = hypotheses[: self.max_hypotheses]
        for done, hypothesis in enumerate(tried):
            progress.report(0.6 * done / len(tried), "Measuring the camera's height")
            view = View(hypothesis.intrinsics, hypothesis.R_world_camera)
            if self.depth is not None:
                seen = self.depth.predict(photo.rgb, hypothesis.intrinsics)
                observations = replace(observations, depths=observe_depths(seen, objects, view, self.settings.observed))
            scanned.append((hypothesis, scan_heights(observations, view), observations))
        return max(scanned, key=lambda tried: tried[0].score - self.settings.heights.cost_weight * tried[1].cost)


def _camera(hypothesis: CameraHypothesis, height_m: float) -> Camera:
    T = np.eye(4)
    T[:3, :3] = hypothesis.R_world_camera
    T[2, 3] = height_m
    return Camera(hypothesis.intrinsics, T)


def _cuboid(item: DetectedObject, placement: Placement, observations: BoxObservations, scan: HeightScan) -> Cuboid:
    category = observations.categories[placement.index]
    yaw, size = heading_and_size(placement, category, observations.settings.heights)
    return Cuboid(
        object_id=item.id,
        R_world_object=yaw_rotation(yaw),
        centre=placement.cuboid.centre[0],
        size_m=size,
        confidence=confidence_of(placement, observations, scan.log_sigma),
        foot_seen=foot_seen(placement, observations),
    )


def supports_of(placements: Sequence[Placement], objects: tuple[DetectedObject, ...]) -> tuple[Support, ...]:
    """One support edge per object, in the order given."""
    edges = []
    for placement in placements:
        parent = _PARENT_NAMES.get(placement.supporter) or objects[placement.supporter].id
        relation: Relation = "mounted on" if placement.supporter in (WALL, CEILING) else "placed on"
        edges.append(Support(objects[placement.index].id, parent, relation))
    return tuple(edges)


def _overall(camera: CameraEstimate, scan: HeightScan, count: int) -> float:
    """Low where the curve over heights is wide."""
    if not count:
        return 0.15
    return float(np.clip(camera.confidence, 0, 1) * np.exp(-scan.log_sigma / 0.25))
