"""Objects that nothing in the scene reaches where they were seen: what holds them is not marked, or has another shape.

With measured depth a cup at the height of a night stand that the bed hides does not hang on the wall 30 cm behind it.
Nothing is known to hold it, and it stays where it was measured.
"""

from __future__ import annotations

from diorama_core.arrangement.support_hypotheses import ObservationNoise
from diorama_core.arrangement.support_terms import FAR_TOLERANCES
from diorama_core.arrangement.surfaces import (
    FLAT,
    OUT_OF_REACH_M,
    choose_surface,
    is_soft,
    label_of,
    overhang_m,
    plane_surface,
    reaches,
    resting_cost,
)
from diorama_core.library import taxonomy
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.types import Scene, SceneObject, Support

REASONED_M = 0.3
"""The distance from a place for heights that were reasoned from a photo alone."""


def detach_out_of_reach(scene: Scene, library: ShapeLibrary, noise: ObservationNoise) -> tuple[Scene, tuple[str, ...]]:
    """Detach the objects that their supporters do not reach; the new scene, and what people should look at.

    What was reasoned from a photo alone only contradicts the height of furniture.
    """
    reasons = []
    for item in scene.objects:
        edge = scene.support_of(item.id)
        if edge is None or (not noise.measured and not scene.has_object(edge.parent)):
            continue
        if is_out_of_reach(scene, library, item, edge, noise):
            scene = edits.detach(scene, item.id)
            reasons.append(
                f"please check what holds {item.label}: it was seen away from {label_of(scene, edge.parent)}"
            )
    return scene, tuple(reasons)


def is_out_of_reach(
    scene: Scene, library: ShapeLibrary, item: SceneObject, edge: Support, noise: ObservationNoise
) -> bool:
    """Whether an object was seen clearly away from where an edge puts it.

    Where distances were reasoned only its height tells: over what it was seen follows from what holds it.

    Args:
        scene: with the object and its supporter.
        library: of the scene's shapes.
        item: the object as it was seen.
        edge: its support.
        noise: of the observed positions.
    """
    kind = taxonomy.resolve(item.category).category
    if noise.measured and kind.mount == "wall" and scene.has_plane(edge.parent) and edge.relation == "mounted on":
        # What was measured turned from a wall, or far before it, hangs on another one; a wall before it was not seen.
        wall = scene.plane(edge.parent)
        turned = abs(float(item.pose.R_world_object[:, 0] @ wall.normal)) < FLAT
        before_m = float((item.corners_world @ wall.normal).min()) - wall.offset
        return turned or before_m > FAR_TOLERANCES * noise.tolerance_m(scene.camera, item.pose.position, wall.normal)
    if item.locked or is_soft(item) or not (taxonomy.lies_on_furniture(kind.name) or noise.measured):
        return False
    if kind.mount != "surface" and scene.has_plane(edge.parent):
        return False
    if scene.has_plane(edge.parent):
        plane = plane_surface(scene.plane(edge.parent))
        away = resting_cost(scene, item, edge, plane)
        # How far the floor reaches is a guess where it was not seen; how high it is, is not.
        return away - overhang_m(plane, item.pose.position) > OUT_OF_REACH_M
    parent = scene.object(edge.parent)
    place = choose_surface(scene, item, edge, library.shape(parent.shape_id)).to_world(parent.pose)
    if edge.relation == "mounted on":
        return resting_cost(scene, item, edge, place) > OUT_OF_REACH_M
    if noise.measured:
        return not reaches(item, place)
    return abs(float((item.corners_world @ place.normal).min()) - place.level) > REASONED_M
