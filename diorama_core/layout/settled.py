"""A layout as a physics engine leaves it: objects come down onto their supporters and out of one another.

It stands in for the simulator with which ACDC (Dai et al. 2024) resolves floating and collisions: boxes are lowered (or
raised) onto the top of what supports them, and overlapping boxes go apart level by the shortest way, each half of it.
Nothing is placed on an inner surface, and nothing is turned or resized.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import LayoutReport
from diorama_core.progress import Progress
from diorama_core.protocols import Preview
from diorama_core.scene import edits
from diorama_core.scene.support import ancestors
from diorama_core.scene.types import Pose, Scene, SceneObject, box_corners


@dataclass(frozen=True)
class Settled:
    """Lowers objects and pushes them apart."""

    rounds: int = 60

    def optimise(self, scene: Scene, progress: Progress, preview: Preview | None = None) -> tuple[Scene, LayoutReport]:
        """The scene with other places, and the overlap of boxes before and after in metres."""
        begun = time.perf_counter()
        progress.report(0.0, "Lowering objects onto what supports them")
        moved = {o.id: o.pose for o in scene.objects}
        for item in sorted(scene.objects, key=lambda o: (len(ancestors(scene, o.id)), o.id)):
            if not item.locked:
                moved[item.id] = _lower(scene, item, moved)
        before = _overlap(scene, moved)
        for k in range(self.rounds):
            progress.report(k / self.rounds, "Pushing objects apart")
            if not _push_apart(scene, moved):
                break
        result = edits.place(scene, moved)
        report = LayoutReport(
            "settled", {"overlap": before}, {"overlap": _overlap(scene, moved)}, time.perf_counter() - begun
        )
        if preview is not None:
            preview(result, tuple(report.after.items()))
        return result, report


def _lower(scene: Scene, item: SceneObject, poses: Mapping[str, Pose]) -> Pose:
    """Its pose with its bottom on the top of its supporter; unchanged for what hangs."""
    edge = scene.support_of(item.id)
    pose = poses[item.id]
    if edge is None or edge.relation != "placed on":
        return pose
    if scene.has_object(edge.parent):
        top = _span(scene.object(edge.parent), poses[edge.parent])[1]
    else:
        plane = next(p for p in scene.architecture.planes if p.id == edge.parent)
        if plane.role != "floor":
            return pose
        top = float(plane.polygon[:, 2].mean())
    return pose.move((0.0, 0.0, top - _span(item, pose)[0]))


def _push_apart(scene: Scene, poses: dict[str, Pose]) -> bool:
    """One round; whether anything moved."""
    items = [o for o in scene.objects if not o.hidden]
    changed = False
    for i, a in enumerate(items):
        for b in items[i + 1 :]:
            way = _apart(scene, a, b, poses)
            if way is None:
                continue
            free = [o for o in (a, b) if not o.locked]
            for o in free:
                share = (1.0 if o is a else -1.0) * way / len(free)
                for carried in (o.id, *_find_loads(scene, o.id)):
                    poses[carried] = poses[carried].move((share[0], share[1], 0.0))
            changed = changed or bool(free)
    return changed


def _apart(
    scene: Scene, a: SceneObject, b: SceneObject, poses: Mapping[str, Pose], touching_m: float = 0.002
) -> Float[np.ndarray, "2"] | None:
    """The shortest level way of a out of b; None where they overlap by less than `touching_m` or one
    carries the other."""
    if a.id in ancestors(scene, b.id) or b.id in ancestors(scene, a.id):
        return None
    (low_a, high_a), (low_b, high_b) = _span(a, poses[a.id]), _span(b, poses[b.id])
    if min(high_a, high_b) - max(low_a, low_b) < touching_m:
        return None
    corners = [_corners(o, poses[o.id])[:, :2] for o in (a, b)]
    best: tuple[float, np.ndarray] | None = None
    for o in (a, b):
        for axis in poses[o.id].R_world_object[:2, :2].T:
            length = float(np.linalg.norm(axis))
            if length < 0.1:
                continue
            unit = axis / length
            (a0, a1), (b0, b1) = ((float((c @ unit).min()), float((c @ unit).max())) for c in corners)
            out, back = b1 - a0, a1 - b0
            if min(out, back) < touching_m:
                return None
            way = (out, unit) if out < back else (back, -unit)
            best = way if best is None or way[0] < best[0] else best
    return None if best is None else best[0] * best[1]


def _overlap(scene: Scene, poses: Mapping[str, Pose]) -> float:
    """The sum of the ways of all overlapping pairs, metres."""
    items = [o for o in scene.objects if not o.hidden]
    ways = (_apart(scene, a, b, poses) for i, a in enumerate(items) for b in items[i + 1 :])
    return float(sum(np.linalg.norm(way) for way in ways if way is not None))


def _find_loads(scene: Scene, object_id: str) -> list[str]:
    return [o.id for o in scene.objects if object_id in ancestors(scene, o.id)]


def _corners(item: SceneObject, pose: Pose) -> Float[np.ndarray, "8 3"]:
    return pose.apply(box_corners(item.shape_size_m))


def _span(item: SceneObject, pose: Pose) -> tuple[float, float]:
    """Lowest and highest point."""
    heights = _corners(item, pose)[:, 2]
    return float(heights.min()), float(heights.max())
