"""The room from one photo without depth: a box from vanishing lines, edges and the objects inside it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.architecture.box_planes import box_planes
from diorama_core.architecture.box_search import MARGIN_M, find_box, refined_around
from diorama_core.architecture.colours import coloured
from diorama_core.architecture.evidence import EDGE_NAMES, RoomEvidence, gather_evidence
from diorama_core.architecture.supports import resolve_supports
from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, Inputs, ObjectGeometry
from diorama_core.progress import Progress
from diorama_core.scene.types import Architecture

MAX_PUSH_M = 2.0
"""Walls give way to objects by at most this; a cuboid farther out is taken for a mistake."""
GUESS_CONFIDENCE = 0.15
ENOUGH_BOUNDARY = 0.25
"""Boundaries in view of this length, in picture diagonals, can be relied on as far as they respond."""
_BOUNDARIES = {
    "back": ("floor back", "corner left", "corner right", "ceiling back"),
    "left": ("floor left", "corner left", "ceiling left"),
    "right": ("floor right", "corner right", "ceiling right"),
    "ceiling": ("ceiling left", "ceiling right", "ceiling back"),
}


@dataclass(frozen=True)
class RoomBox:
    """Room box by single-view reasoning (after Hedau et al. 2009, Lee et al. 2009), in the Manhattan frame.

    The floor is z = 0 of the metric camera. Two side walls, a far wall and a ceiling height are searched together:
    lines may not lie on a surface they stand out of, boundaries should be seen as edges, objects stay inside.
    """

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """Floor, walls and ceiling, with "floor" and "wall" supports resolved."""
        progress.report(0.0, "Looking for the room's walls")
        evidence = gather_evidence(inputs.photo.rgb, geometry.camera, objects, geometry.cuboids)
        progress.report(0.3, "Fitting a room to lines and objects")
        box = pushed_out(find_box(evidence)[0], evidence)
        box = pushed_out(refined_around(evidence, box), evidence)
        confidences = face_confidences(box, evidence)
        hung = any(s.parent == "ceiling" for s in geometry.supports)
        planes = box_planes(box, geometry.camera, confidences, with_ceiling=hung)
        planes = coloured(planes, inputs.photo.rgb, geometry.camera, objects)
        architecture = Architecture(planes)
        walls = [p.confidence for p in architecture.by_role("wall")]
        progress.report(1.0, "The room is closed")
        return ArchitectureEstimate(
            architecture=architecture,
            supports=resolve_supports(geometry, architecture),
            confidence=float(np.mean(walls)),
            source=_source(box, confidences, geometry),
        )


def pushed_out(box: Float[np.ndarray, "4"], evidence: RoomEvidence) -> Float[np.ndarray, "4"]:
    """The box with each wall and the ceiling moved outward until no believable object sticks through it."""
    if len(evidence.object_low) == 0:
        return box
    low, high = evidence.object_low, evidence.object_high

    def outermost(reach: np.ndarray, wall: float) -> float:
        believable = reach[reach < wall + MAX_PUSH_M]
        return max(wall, float(believable.max()) + 0.4 * MARGIN_M) if len(believable) else wall

    x0 = -outermost(-low[:, 0], -box[0])
    x1, y1 = outermost(high[:, 0], box[1]), outermost(high[:, 1], box[2])
    return np.array([x0, x1, y1, outermost(high[:, 2], box[3])])


def face_confidences(box: Float[np.ndarray, "4"], evidence: RoomEvidence) -> dict[str, float]:
    """How far each face is supported: the edge response along its visible boundaries, a guess without any."""
    means, lengths = (dict(zip(EDGE_NAMES, v, strict=True)) for v in evidence.boundary_support(box))
    found = {"floor": 0.6}
    for face, names in _BOUNDARIES.items():
        length = sum(float(lengths[n]) for n in names)
        response = sum(float(means[n] * lengths[n]) for n in names) / max(length, 1e-9)
        found[face] = GUESS_CONFIDENCE + 0.75 * response * min(1.0, length / ENOUGH_BOUNDARY)
    return found


def _source(box: Float[np.ndarray, "4"], confidences: dict[str, float], geometry: ObjectGeometry) -> str:
    width, depth = box[1] - box[0], box[2] - geometry.camera.position[1]
    sure = max(confidences["back"], confidences["left"], confidences["right"])
    basis = (
        "lines of the photo and the objects" if sure > 0.3 else "the objects and usual room sizes; few lines were seen"
    )
    return f"room box {width:.1f} x {depth:.1f} x {box[3]:.1f} m from {basis}"
