"""What posing knows of a room for deciding which way its objects face (`diorama_core.arrangement`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.facing.evidence import (
    HEADINGS,
    FacingObject,
    FacingRoom,
    WallSamples,
    picture_of,
    unit,
    yaws_of,
)
from diorama_core.artefacts import DepthMap, DetectedObject, ObjectGeometry
from diorama_core.library.labels import is_named
from diorama_core.library.record import Shape
from diorama_core.library.taxonomy import UNKNOWN
from diorama_core.pose.hypotheses import Hypotheses
from diorama_core.pose.limits import SizeLimits
from diorama_core.pose.posing_tasks import PosingTask
from diorama_core.pose.settings import SETTINGS, PoseSearchSettings
from diorama_core.scene.types import Camera


@dataclass(frozen=True, eq=False)
class TriedShape:
    """One shape with its hypotheses compared at the coarse resolution."""

    shape: Shape
    liked: float
    """By retrieval: a logarithm, 0 for the shape it likes best."""
    limits: SizeLimits
    hypotheses: Hypotheses
    scores: Float[np.ndarray, "p"]


@dataclass(frozen=True, eq=False)
class Trials:
    """All posed objects of a photo before it is decided which way they face."""

    tasks: Sequence[PosingTask]
    tried: Sequence[Sequence[TriedShape]]
    """By task its shapes."""
    room: FacingRoom
    settings: PoseSearchSettings

    def with_shapes(self, tried: Sequence[Sequence[TriedShape]]) -> Trials:
        """These objects with other poses of their shapes."""
        pictures = [_picture(*one, settings=self.settings) for one in zip(self.tasks, tried, strict=True)]
        by_id = {t.item.id: picture for t, picture in zip(self.tasks, pictures, strict=True)}
        objects = tuple(replace(o, picture=by_id.get(o.object_id, o.picture)) for o in self.room.objects)
        return Trials(self.tasks, tried, replace(self.room, objects=objects), self.settings)

    def folds(self) -> dict[str, int]:
        """By posed object how many headings of its likeliest shape look the same."""
        folds: dict[str, int] = {}
        for task, of_one in zip(self.tasks, self.tried, strict=True):
            best = int(np.argmax([likelihood(task.item.label, t, self.settings) for t in of_one]))
            folds[task.item.id] = of_one[best].shape.symmetry
        return folds


def powers(label: str, settings: PoseSearchSettings) -> tuple[float, float]:
    """What retrieval and pose say about the shape of a thing that is called so."""
    return settings.powers if is_named(label) else settings.powers_of_unnamed


def facing_room(
    geometry: ObjectGeometry,
    kinds: Mapping[str, str],
    tasks: Sequence[PosingTask],
    tried: Sequence[Sequence[TriedShape]],
    walls: WallSamples,
    settings: PoseSearchSettings,
) -> FacingRoom:
    """All objects with a cuboid, and what the picture says of those that were posed.

    Args:
        geometry: Their cuboids, and what carries what.
        kinds: By object what it most likely is; what has no shapes is of no kind.
        tasks: Of the posed objects.
        tried: Their shapes.
        walls: Where walls are seen.
    """
    index = {c.object_id: k for k, c in enumerate(geometry.cuboids)}
    parent_of = {s.child: s.parent for s in geometry.supports}
    pictures = {t.item.id: _picture(t, of_one, settings) for t, of_one in zip(tasks, tried, strict=True)}
    out_of_wall = {t.item.id: unit(t.anchor.axis_world[:2]) for t in tasks if t.hangs}
    objects = tuple(
        FacingObject(
            c.object_id,
            kinds.get(c.object_id, UNKNOWN.name),
            c.centre,
            c.size_m,
            float(yaws_of(c.R_world_object)),
            pictures.get(c.object_id, np.zeros(HEADINGS)),
            index.get(parent_of.get(c.object_id, "")),
            out_of_wall.get(c.object_id),
            c.front_known,
        )
        for c in geometry.cuboids
    )
    return FacingRoom(objects, geometry.camera.position[:2], walls)


def _picture(task: PosingTask, tried: Sequence[TriedShape], settings: PoseSearchSettings) -> Float[np.ndarray, "24"]:
    """What the picture says of the headings of one object, whichever of its shapes it is."""
    ranks = [likelihood(task.item.label, t, settings) + t.scores - t.scores.max() for t in tried]
    poses, folds = [t.hypotheses.poses.R for t in tried], [t.shape.symmetry for t in tried]
    return picture_of(task.cuboid.R_world_object, poses, ranks, folds)


def likelihood(label: str, tried: TriedShape, settings: PoseSearchSettings = SETTINGS.search) -> float:
    """How likely an object that is called so is of a shape, by retrieval and its best pose: a logarithm."""
    of_retrieval, of_pose = powers(label, settings)
    return of_retrieval * tried.liked + of_pose * float(tried.scores.max())


def wall_samples(
    depth: DepthMap, camera: Camera, objects: Sequence[DetectedObject], settings: PoseSearchSettings
) -> WallSamples:
    """Pixels outside all boxes whose surface is upright: the walls, as far as they are seen.

    Args:
        depth: z in camera and world normals of every pixel.
        camera: in the world.
        objects: with boxes in pixels.
        settings: number of samples.
    """
    normals = depth.normals_world
    free = np.isfinite(depth.depth_m) & (depth.depth_m > 0) & (np.abs(normals[..., 2]) < 0.25)
    for item in objects:
        x1, y1, x2, y2 = (round(v) for v in item.box)
        free[max(y1, 0) : y2, max(x1, 0) : x2] = False
    rows, columns = np.nonzero(free)
    step = max(len(rows) // settings.wall_samples, 1)
    rows, columns = rows[::step], columns[::step]
    rays = camera.rays(np.stack([columns + 0.5, rows + 0.5], axis=1))
    points = camera.position + rays * depth.depth_m[rows, columns, None].astype(np.float64)
    flat = normals[rows, columns, :2].astype(np.float64)
    length = np.linalg.norm(flat, axis=1)
    good = np.isfinite(points).all(axis=1) & (length > 0.5)
    return WallSamples(points[good, :2], flat[good] / length[good, None])
