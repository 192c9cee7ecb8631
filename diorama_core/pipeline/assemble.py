"""From the stages' artefacts to a scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, ObjectGeometry, PosedCandidates
from diorama_core.library.labels import meanings
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.library.taxonomy import UNKNOWN
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Scene, SceneObject


def assemble(
    objects: tuple[DetectedObject, ...],
    geometry: ObjectGeometry,
    architecture: ArchitectureEstimate,
    posed: tuple[PosedCandidates, ...],
    library: ShapeLibrary,
    colours: Mapping[str, tuple[float, float, float]],
) -> Scene:
    """The scene before layout optimisation: every object in its best candidate's pose, in its colour of the photo.

    Objects without candidates are left out, and objects on them are reassigned to their supporter.

    Args:
        objects: what was found in the photo, with masks.
        geometry: the objects' cuboids, the camera, and what supports what.
        architecture: the room.
        posed: candidates in their poses.
        library: where shapes come from.
        colours: sRGB 0 to 1, by object id.
    """
    candidates: Mapping[str, PosedCandidates] = {p.object_id: p for p in posed if p.candidates}
    items = tuple(_scene_object(o, candidates[o.id], library, colours.get(o.id)) for o in objects if o.id in candidates)
    ids = {item.id for item in items} | {p.id for p in architecture.architecture.planes}
    parent_of = {edge.child: edge.parent for edge in architecture.supports}
    supports = []
    for edge in architecture.supports:
        parent: str | None = edge.parent
        while parent is not None and parent not in ids:
            parent = parent_of.get(parent)
        if edge.child in ids and parent is not None:
            supports.append(replace(edge, parent=parent))
    scene = Scene(
        camera=geometry.camera, architecture=architecture.architecture, objects=items, supports=tuple(supports)
    )
    check_scene(scene)
    return scene


def _scene_object(
    item: DetectedObject,
    posed: PosedCandidates,
    library: ShapeLibrary,
    colour: tuple[float, float, float] | None,
) -> SceneObject:
    best = posed.candidates[0]
    kind = record_of(library, best.shape_id).category  # a chair that looks like an office chair is one
    category = kind if item.category == UNKNOWN.name or kind in meanings(item.label, item.category) else item.category
    return SceneObject(
        id=item.id,
        label=category if item.label == UNKNOWN.name else item.label,
        category=category,
        shape_id=best.shape_id,
        shape_size_m=best.shape_size_m,
        pose=best.pose,
        candidates=posed.candidates,
        mask_id=item.mask_id,
        box_px=item.box,
        confidence=posed.confidence,
        colour=colour,
    )
