"""Scenes of many sources for `check_exports.py`: projects, edited ones, made rooms, rooms from words, phone scans."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from diorama_core.appearance.surface_finish import usual_finish, with_finish_pictures
from diorama_core.arrangement.surfaces import plane_surface
from diorama_core.editing.placing import Hit, SupportTarget, free_spot, hits_along, insertion, places_of
from diorama_core.export.pictures import Picture
from diorama_core.importing.scene_import import import_scene
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.project.storage import Project
from diorama_core.scene import edits
from diorama_core.scene.room_edits import set_surface_finish
from diorama_core.scene.types import Plane, Pose, Scene
from diorama_core.synthesis import furnish_room, sample_cameras
from diorama_core.synthesis.finishes import finish_textures
from tests.importing.roomplan_files import write_json

ROOMS = ("living", "bedroom", "office", "dining", "kitchen", "bathroom")
PROMPT = "a bedroom with a wardrobe, a desk with a lamp and a laptop, and a rug"


@dataclass(frozen=True)
class Source:
    """One scene to export."""

    name: str
    scene: Scene
    textures: Mapping[str, Picture] = field(default_factory=dict)
    photo: Picture | None = None


def projects(folders: Iterable[Path], library: ShapeLibrary, edited: int) -> Iterator[Source]:
    """Projects, the first ones of them also after edits."""
    for number, folder in enumerate(folders):
        project = Project.open(folder)
        scene = project.load_scene()
        photo = project.photo()
        source = Source(folder.name, scene, project.textures(scene), None if photo is None else photo.rgb)
        yield source
        if number < edited:
            changed, pictures = with_finish_pictures(after_edits(scene, library, number), source.textures)
            textures = {**source.textures, **pictures}
            yield replace(source, name=f"{folder.name}, edited", scene=changed, textures=textures)


def made(seeds: Iterable[int], library: ShapeLibrary) -> Iterator[Source]:
    """Furnished rooms."""
    for seed in seeds:
        kind = ROOMS[seed % len(ROOMS)]
        scene = furnish_room(seed, kind, library)
        camera = next(iter(sample_cameras(scene, library, seed)), None)
        yield Source(f"{kind} room {seed}", replace(scene, camera=camera), finish_textures(scene.architecture))


def from_text(library: ShapeLibrary) -> Source:
    """A room from words."""
    from diorama_core.text.compose import compose_room

    return Source("from text", compose_room(PROMPT, library).scene)


def from_scan() -> Source:
    """A room as RoomPlan measures it."""
    with tempfile.TemporaryDirectory() as folder:
        return Source("RoomPlan scan", import_scene(write_json(Path(folder) / "room.json")).opened.scene)


def after_edits(scene: Scene, library: ShapeLibrary, seed: int) -> Scene:
    """A scene after what a person does to one: turned, recoloured, inserted, put on another, removed, hidden, locked,
    a door and a window put into the widest wall, floor and walls finished."""
    rng = np.random.default_rng(seed)
    standing = [o.id for o in scene.objects if (s := scene.support_of(o.id)) and s.parent == "floor" and not o.locked]
    first = min(map(scene.object, standing), key=lambda o: float(np.prod(o.size_m[:2])))  # turns without a collision
    scene = edits.move(
        scene, first.id, Pose.upright(first.pose.position, first.pose.yaw_rad + 0.3, tuple(first.pose.scale))
    )
    scene = edits.recolour(scene, first.id, tuple(rng.uniform(0.2, 0.8, 3)))
    loads = {s.parent for s in scene.supports}
    free = [o.id for o in scene.objects if o.id not in loads and o.id != first.id]
    scene = edits.remove(scene, free[:1])
    for object_id in free[1:2]:
        scene = edits.set_hidden(scene, object_id, True)
    for object_id in free[2:3]:
        scene = edits.set_locked(scene, object_id, True)
    table = library.in_category("side table")[seed]
    scene = _put(scene, library, table, *free_spot(scene, table, None))
    x, y, _ = scene.objects[-1].pose.position
    scene = _put(scene, library, library.in_category("vase")[seed], float(x), float(y))
    for category in ("stool", "filing cabinet"):
        shape = library.in_category(category)[seed]
        scene = _put(scene, library, shape, *free_spot(scene, shape, None))
    wall = max(scene.architecture.by_role("wall"), key=lambda w: float(np.ptp(w.polygon[:, :2], axis=0).max()))
    for category, along in (("door", 0.25), ("window", 0.7)):
        scene = _hung(scene, library.in_category(category)[seed], wall, along)
    scene = set_surface_finish(scene, ("floor",), usual_finish(("herringbone", "checker")[seed % 2]))
    return set_surface_finish(scene, [w.id for w in scene.architecture.by_role("wall")], usual_finish("stripes"))


def _put(scene: Scene, library: ShapeLibrary, shape: Shape, x: float, y: float) -> Scene:
    """A shape put down at the uppermost place there, as by a click into the view from above."""
    places = [p for p in places_of(scene, library) if p.upward]
    hit = hits_along(np.array([x, y, 10.0]), np.array([0.0, 0.0, -1.0]), places)[0]
    return edits.insert(scene, *insertion(scene, shape, edits.fresh_id(scene, shape.category), hit, 0.0))


def _hung(scene: Scene, shape: Shape, wall: Plane, along: float) -> Scene:
    """A shape hung on a wall at a share of its width, as by a click on the wall."""
    corners = wall.polygon[np.argsort(wall.polygon[:, 2])[:2]]
    point = corners[0] + along * (corners[1] - corners[0]) + np.array([0.0, 0.0, 1.4])
    hit = Hit(SupportTarget(plane_surface(wall), wall.id, of_object=False), point, 0.0)
    return edits.insert(scene, *insertion(scene, shape, edits.fresh_id(scene, shape.category), hit, 0.0))
