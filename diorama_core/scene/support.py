"""The support graph: one supporter each, acyclic; children move with their supporters."""

from __future__ import annotations

from collections import Counter

from diorama_core.errors import EditRefused, SceneError
from diorama_core.scene.types import Scene, Support


def descendants(scene: Scene, object_id: str) -> tuple[str, ...]:
    """Ids of everything held up by an object, directly or not, nearest first; without the object itself."""
    names: list[str] = []
    frontier = [object_id]
    while frontier:
        frontier = [child for parent in frontier for child in scene.children_of(parent)]
        frontier = [child for child in frontier if child not in names and child != object_id]
        names.extend(frontier)
    return tuple(names)


def top_down(scene: Scene) -> tuple[str, ...]:
    """Object ids ordered so that every supporter comes before what it supports; stable in scene order."""
    depth = {o.id: len(ancestors(scene, o.id)) for o in scene.objects}
    return tuple(sorted(depth, key=depth.__getitem__))


def ancestors(scene: Scene, object_id: str) -> tuple[str, ...]:
    """Ids of the object's supporters, nearest first, planes included."""
    chain: list[str] = []
    edge = scene.support_of(object_id)
    while edge is not None and edge.parent not in chain:
        chain.append(edge.parent)
        edge = scene.support_of(edge.parent)
    return tuple(chain)


def check_edge(scene: Scene, edge: Support) -> None:
    """Raise `EditRefused` with the reason when the edge cannot be part of the scene's support graph."""
    if not scene.has_object(edge.child):
        raise EditRefused(f"there is no object {edge.child!r} to support; choose one of the outliner's objects")
    if not scene.has_object(edge.parent) and not scene.has_plane(edge.parent):
        raise EditRefused(f"there is no object or plane {edge.parent!r} to stand on; choose an existing supporter")
    if edge.parent == edge.child:
        raise EditRefused(f"{_name(scene, edge.child)} cannot support itself; choose another supporter")
    if edge.parent in descendants(scene, edge.child):
        raise EditRefused(
            f"{_name(scene, edge.child)} already holds up {_name(scene, edge.parent)}, so it cannot also stand on it; "
            "move that one elsewhere first"
        )
    for wall in edge.adheres_to:
        if not scene.has_plane(wall):
            raise EditRefused(f"there is no wall {wall!r} to stand against; choose an existing plane")


def check_scene(scene: Scene) -> None:
    """Raise `SceneError` with the first inconsistency between objects, planes and supports."""
    ids = [o.id for o in scene.objects] + [p.id for p in scene.architecture.planes] + [r.id for r in scene.rooms]
    if len({r.floor for r in scene.rooms}) < len(scene.rooms):
        raise SceneError("two rooms share one floor; give each its own")
    doubles = sorted(i for i, count in Counter(ids).items() if count > 1)
    if doubles:
        raise SceneError(f"ids must be unique; repeated: {', '.join(doubles[:5])}")
    children = [s.child for s in scene.supports]
    if len(children) != len(set(children)):
        raise SceneError("an object has more than one supporter; keep one support edge per object")
    for edge in scene.supports:
        check_edge(scene, edge)


def _name(scene: Scene, any_id: str) -> str:
    return scene.object(any_id).label if scene.has_object(any_id) else any_id
