"""Joins pairs of rooms, each built from one photo, at a door that both photos show, and compares with the true rooms.

    python scripts/eval_joins.py --pairs 6 --seeds 0,91 [--keep FOLDER]

The two rooms of a pair have the same door; boxes are given, cameras and depth are not. Told of each pair: how far
the door is from the nearest seen wall that meets its own, against the truth, in both rooms together; the turn of one
room in the frame of the other (asked: 10 cm and 3 degrees); and how far off the camera of the one is in the frame of
the other's, which the scale of both rooms is in.
"""

from __future__ import annotations

import argparse
import pickle
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from diorama_core.editing.homes import as_one_door, place_at_door
from diorama_core.errors import DioramaError
from diorama_core.evaluation.benchmarks.cases import SIZE, furnish, parse_seeds, recipe
from diorama_core.geometry.openings import DOOR, wall_of
from diorama_core.library.catalogue import built_in_library
from diorama_core.pipeline.run import build_scene
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.scene.types import Plane, Pose, Scene, SceneObject
from diorama_core.synthesis import sample_cameras
from diorama_core.synthesis.artefacts import photo_only
from diorama_core.synthesis.truth import Studio, TruthView

LIBRARY = built_in_library()
VIEWS = 6
LEAST_SEEN = 0.5
"""Share of the door that the photo shows."""
MEETS_M = 0.3
"""Walls whose ends are nearer meet."""
LEAST_PIXELS = 1500
"""Of a wall that counts as seen."""


def main() -> None:
    """Measure the joins that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=6, help="of each series")
    parser.add_argument("--seeds", default="development")
    parser.add_argument("--keep", type=Path, help="folder for what was built, to measure again without building")
    a = parser.parse_args()
    rows = []
    for seed in parse_seeds(a.seeds, 0):
        for rooms in kept(seed, a.pairs, a.keep):
            rows.append(row := measured(*rooms))
            print("walls off {:.2f} m, turned {:.0f} deg, camera off {:.2f} m".format(*row), flush=True)
    off, turned, camera = np.array(rows).T
    print(f"{len(rows)} pairs: {int(((off < 0.1) & (turned < 3)).sum())} within 10 cm and 3 degrees, ", end="")
    print(f"median {np.median(off):.2f} m, camera {np.median(camera):.2f} m ({int((camera < 0.1).sum())} within 10 cm)")


Room = tuple[TruthView, SceneObject, Scene]


def kept(seed: int, count: int, folder: Path | None) -> Iterator[tuple[Room, Room]]:
    """Pairs of rooms as they were built before, where the folder has them; built and written to it otherwise."""
    path = None if folder is None else folder / f"{seed}-{count}.pickle"
    if path is not None and path.exists():
        yield from pickle.loads(path.read_bytes())
        return
    pairs = []
    for pair in built_pairs(seed, count):
        pairs.append(pair)
        if path is not None:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(pickle.dumps(pairs))
        yield pair


def built_pairs(seed: int, count: int) -> Iterator[tuple[Room, Room]]:
    """Rooms by twos, the second with the door of the first."""
    first: Room | None = None
    made = 0
    for case in recipe(10 * count, 1, seed):
        try:
            scene = furnish(case, LIBRARY)
            view, door = photo_of_door(scene if first is None else with_door_of(scene, first[1]), case.seed)
        except (DioramaError, StopIteration) as error:
            print(f"{case.name} passed over: {error or 'its door is not seen'}", flush=True)
            continue
        inputs = photo_only(view)
        room = view, door, build_scene(inputs, LIBRARY, stages=embedded_stages(inputs, LIBRARY)).scene
        print(case.name, end=" ", flush=True)
        if first is None:
            first = room
            continue
        yield first, room
        first, made = None, made + 1
        if made == count:
            return


def with_door_of(scene: Scene, door: SceneObject) -> Scene:
    """The room with another door in the place of its own, as high above the floor."""
    old = next(o for o in scene.objects if o.category == DOOR)
    position = np.array([*old.pose.position[:2], door.pose.position[2]])
    pose = Pose(old.pose.R_world_object, position, door.pose.scale)
    new = replace(door, id=old.id, pose=pose, mask_id=None, box_px=None)
    return replace(scene, objects=tuple(new if o is old else o for o in scene.objects))


def photo_of_door(scene: Scene, seed: int) -> tuple[TruthView, SceneObject]:
    """The first good picture that shows enough of the room's door, and a wall that meets the door's."""
    studio = Studio(scene, LIBRARY)
    number = next(k for k, o in enumerate(scene.objects) if o.category == DOOR)
    views = (studio.view(c, SIZE, with_empty_room=False) for c in sample_cameras(scene, LIBRARY, seed, VIEWS, SIZE))
    shown = (v for v in views if number in v.indices and v.visible_fraction[number] > LEAST_SEEN)
    view = next(v for v in shown if sides(v.scene.objects[number], v.scene, seen_walls(v)))
    return view, view.scene.objects[number]


def seen_walls(view: TruthView) -> list[Plane]:
    """Planes of the room that the picture shows enough of."""
    planes = view.scene.architecture.planes
    return [p for k, p in enumerate(planes) if (view.plane_ids == k).sum() > LEAST_PIXELS]


def measured(first: Room, second: Room) -> tuple[float, float, float]:
    """Metres the door is off, degrees of the turn, metres the camera is off; all large where no door was built."""
    doors = [built_door(*room) for room in (first, second)]
    if doors[0] is None or doors[1] is None:
        return 9.0, 90.0, 9.0
    names = doors[0].id, doors[1].id
    scenes = as_one_door(first[2], second[2], *names)
    off = sum(wall_error(r, s, s.object(n)) for r, s, n in zip((first, second), scenes, names, strict=True))
    made = place_at_door(*scenes, *names)
    true = place_at_door(first[0].scene, second[0].scene, first[1].id, second[1].id)
    seen = ((first[2], made, second[2]), (first[0].scene, true, second[0].scene))
    cameras = [np.linalg.inv(view_of(a)) @ T @ view_of(b) for a, T, b in seen]
    turn = np.degrees(np.arccos(np.clip((np.trace(cameras[0][:3, :3].T @ cameras[1][:3, :3]) - 1) / 2, -1, 1)))
    return off, float(turn), float(np.linalg.norm(cameras[0][:3, 3] - cameras[1][:3, 3]))


def view_of(scene: Scene) -> Float[np.ndarray, "4 4"]:
    """The pose of the scene's camera in its world."""
    assert scene.camera is not None
    return scene.camera.T_world_camera


def built_door(view: TruthView, door: SceneObject, built: Scene) -> SceneObject | None:
    """The object that was built from the door's box, if it is a door in a wall."""
    item = next((o for o in built.objects if o.box_px == door.box_px and o.category == DOOR), None)
    return None if item is None or wall_of(item, built.architecture.by_role("wall"), built) is None else item


def wall_error(room: Room, built: Scene, made: SceneObject) -> float:
    """How far off the door is from the nearest side wall that the photo shows, metres."""
    view, door, _ = room
    true, mine = sides(door, view.scene, seen_walls(view)), sides(made, built, built.architecture.by_role("wall"))
    side = min(true, key=lambda k: abs(true[k]))
    return abs(mine[side] - true[side]) if side in mine else 9.0


def sides(door: SceneObject, scene: Scene, planes: tuple[Plane, ...] | list[Plane]) -> dict[bool, float]:
    """Distances along the door's wall to the walls at its left and right."""
    face = wall_of(door, scene.architecture.by_role("wall"), scene)
    assert face is not None
    along, found = np.cross([0.0, 0.0, 1.0], face.normal), dict[bool, float]()
    meeting = [p for p in planes if np.abs(p.polygon @ face.normal - face.offset).min() < MEETS_M]
    for wall in (p for p in meeting if p.role == "wall" and abs(p.normal @ along) > 0.7):
        away = float((wall.offset - wall.normal @ door.pose.position) / (wall.normal @ along))
        if abs(away) < abs(found.get(away > 0, np.inf)):
            found[away > 0] = away
    return found


if __name__ == "__main__":
    main()
