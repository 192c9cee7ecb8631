"""From photos with known cameras to one scene.

Each photo is outlined and read by itself; then objects are joined across photos and fitted to all of them
(`joining`, `joint_fit`). Each object gets its shape, its front and its colours from the photo that shows it best,
through the same stages as a single photo. The room is that of all photos (`joint_room`), extended to hold everything.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.architecture.room_extent import containing_room
from diorama_core.artefacts import (
    Box,
    Cuboid,
    DetectedObject,
    Inputs,
    LayoutReport,
)
from diorama_core.errors import InputError
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import category
from diorama_core.multiview.alignment import PhotoReading, RoomAlignment, align
from diorama_core.multiview.joining import (
    RoomPhoto,
    Sighted,
    Track,
    edges_cut_short,
    join_objects,
    visibility_score,
    with_agreeing_boxes,
)
from diorama_core.multiview.joint_fit import JointCuboid, PosedBoxes
from diorama_core.multiview.joint_room import SeenRoom, joint_room, with_open_doorways
from diorama_core.multiview.mounted_walls import hangs_on_wall, is_seen_whole, room_holding, walls_at_mounted
from diorama_core.multiview.one_scene import acyclic, edge_in_room, filling, move_to_room, set_into_wall
from diorama_core.multiview.room_pictures import PlacedPicture, room_pictures
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.placement import WALL, place_all
from diorama_core.perception.metrology.problem import View
from diorama_core.perception.metrology.reading import heading_and_size
from diorama_core.pipeline.given_stages import (
    AsObserved,
    GivenCamera,
    GivenCuboids,
    GivenObjects,
    GivenRoom,
    exact_camera_estimate,
)
from diorama_core.pipeline.plan import evaluate
from diorama_core.pipeline.run import Built, build_scene
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import LayoutStage
from diorama_core.scene.edits import set_metrics
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Architecture, Camera, Scene, SceneObject, Support, yaw_rotation


@dataclass(frozen=True, eq=False)
class PosedInputs:
    """A photo with what is known of it, and its camera in the room (+Z up, floor at 0, axes along x and y, metres)."""

    inputs: Inputs
    camera: Camera


def align_to_room(
    photos: Sequence[PosedInputs],
    choose: Callable[[Inputs], Stages],
    *,
    metric: bool,
    up: Float[np.ndarray, "3"] | None,
    progress: Progress = SILENT,
) -> tuple[tuple[PosedInputs, ...], RoomAlignment]:
    """Photos whose cameras are in some world of their own, with their cameras in the room.

    Args:
        photos: with cameras in the poses' world.
        choose: the stages for a photo.
        metric: whether that world is in metres.
        up: direction against gravity there, where it is known.
        progress: reports and cancellation.
    """
    readings = []
    for photo, part in zip(photos, progress.parts(len(photos)), strict=True):
        given = replace(photo.inputs, intrinsics=photo.camera.intrinsics)
        artefacts = evaluate(choose(given), {"given": given}, ("camera", "objects"), Runner(None), part)
        k = photo.camera.intrinsics
        observations = gather(artefacts["objects"], k.width, k.height)
        readings.append(PhotoReading(photo.camera, artefacts["camera"], observations))
    found = align(readings, metric=metric, up=up)
    return tuple(replace(p, camera=found.camera(p.camera)) for p in photos), found


@dataclass(frozen=True, eq=False)
class JoinedRoom:
    """One scene of several photos."""

    scene: Scene
    """In the room's frame; its camera is the first photo's."""
    tracks: tuple[Track, ...]
    main: Built
    """The first photo's build, whose room and textures the scene has."""
    textures: dict[str, UInt8[np.ndarray, "_ _ 3"]]
    layout: LayoutReport | None
    notes: tuple[str, ...]
    seen: tuple[tuple[tuple[str, Box], ...], ...] = ()
    """For each photo the objects of the scene that it shows, each with its box there."""


@dataclass(frozen=True, eq=False)
class ReadPhoto:
    """One photo, read by itself."""

    posed: PosedInputs
    stages: Stages
    inputs: Inputs
    """With boxes that were given or found."""
    objects: tuple[DetectedObject, ...]
    """One for each box."""
    T_room_photo: Float[np.ndarray, "4 4"]
    """From the photo's own world (origin on the floor below its camera, +Y the axis it faces) to the room."""

    @property
    def camera(self) -> Camera:
        """In the photo's own world."""
        T = np.linalg.inv(self.T_room_photo) @ self.posed.camera.T_world_camera
        return Camera(self.posed.camera.intrinsics, T)


def build_room(
    photos: Sequence[PosedInputs],
    library: ShapeLibrary,
    choose: Callable[[Inputs], Stages],
    layout: LayoutStage,
    progress: Progress = SILENT,
) -> JoinedRoom:
    """Build one scene of several photos of a room.

    Args:
        photos: with boxes, or for a detector to find; the first is the one the scene is looked at from.
        library: where shapes come from.
        choose: the stages for a photo.
        layout: the optimiser of the whole room; one for measured places, since rays of several photos measure them.
        progress: reports and cancellation.

    Raises:
        InputError: there is no photo.
        Cancelled: on request.
        DioramaError: when a stage cannot do its work.
    """
    if not photos:
        raise InputError("there is no photo with a known camera")
    parts = progress.part(0.0, 0.2).parts(len(photos))
    read = [read_photo(photo, choose(photo.inputs), part) for photo, part in zip(photos, parts, strict=True)]
    room_photos = [estimate_room_photo(r) for r in read]
    joined = join_objects(room_photos, progress.part(0.2, 0.45))
    tracks = tuple(with_agreeing_boxes(t, room_photos) for t in joined)
    single = len(photos) == 1
    rooms = (None,) * len(read) if single else _room_of_all(read, room_photos, tracks, progress.part(0.45, 0.55))
    room = build_joined_scene(read, room_photos, tracks, rooms, library, layout, progress.part(0.55, 1.0))
    several = sum(len(t.boxes) > 1 for t in tracks)
    notes = (f"{len(photos)} photos: {several} of {len(tracks)} objects are seen in more than one",)
    return replace(room, notes=(*notes, *room.notes))


def build_joined_scene(
    read: Sequence[ReadPhoto],
    room_photos: Sequence[RoomPhoto],
    tracks: tuple[Track, ...],
    rooms: Sequence[GivenRoom | None],
    library: ShapeLibrary,
    layout: LayoutStage,
    progress: Progress = SILENT,
) -> JoinedRoom:
    """One scene of photos that were read, whose objects and whose room are known.

    Args:
        read: the photos; the first is the one the scene is looked at from.
        room_photos: what each says by itself.
        tracks: objects of all photos.
        rooms: for each photo the room in its own world; None for what it shows itself.
        library: where shapes come from.
        layout: the optimiser of the whole room.
        progress: reports and cancellation.
    """
    single = len(read) == 1
    best = [max(t.inliers, key=lambda b: (visibility_score(room_photos[b[0]], b[1]), -b[0]))[0] for t in tracks]
    used = sorted({0, *best})
    built = {
        k: build_photo_scene(read[k], k, tracks, library, part, room=rooms[k], plane_pictures=single)
        for k, part in zip(used, progress.part(0.0, 0.65).parts(len(used)), strict=True)
    }
    scene, textures = _merge_scenes(read, built, tracks, best)
    report = None
    if scene.objects:
        scene, report = layout.optimise(scene, progress.part(0.65, 0.9))
        scene = set_metrics(scene, report.after)
    if not single:
        progress.report(0.9, "pictures of floor and walls")
        placed = [to_placed_picture(r, ids_in(tracks, index)) for index, r in enumerate(read)]
        pictures = room_pictures(scene, placed, library)
        planes = tuple(replace(p, texture=p.id if p.id in pictures else None) for p in scene.architecture.planes)
        scene, textures = replace(scene, architecture=Architecture(planes)), {**textures, **pictures}
    progress.report(1.0, "done")
    seen = tuple(
        tuple((name, r.objects[box].box) for box, name in ids_in(tracks, index).items() if scene.has_object(name))
        for index, r in enumerate(read)
    )
    return JoinedRoom(scene, tracks, built[0], textures, report, built[0].notes, seen)


def read_photo(photo: PosedInputs, stages: Stages, progress: Progress) -> ReadPhoto:
    """A photo's boxes and outlines, its camera being known."""
    given = replace(photo.inputs, intrinsics=photo.camera.intrinsics)
    T = photo_world(photo.camera)
    camera = Camera(photo.camera.intrinsics, np.linalg.inv(T) @ photo.camera.T_world_camera)
    known = {"given": given, "camera": exact_camera_estimate(camera)}
    artefacts = evaluate(stages, known, ("inputs", "objects"), Runner(None), progress)
    return ReadPhoto(photo, stages, artefacts["inputs"], artefacts["objects"], T)


def photo_world(camera: Camera) -> Float[np.ndarray, "4 4"]:
    """From a photo's own world to the room: origin on the floor below the camera, +Y the room axis that it faces."""
    forward = camera.T_world_camera[:3, 2]
    quarter = round(float(np.arctan2(forward[1], forward[0]) / (np.pi / 2)))
    T = np.eye(4)
    T[:3, :3] = np.rint(yaw_rotation(np.pi / 2 * (quarter - 1)))
    T[:2, 3] = camera.position[:2]
    return T


def estimate_room_photo(read: ReadPhoto) -> RoomPhoto:
    """What a photo says of its objects by itself, with its camera known."""
    camera = read.camera
    k, R, t = camera.intrinsics, read.T_room_photo[:3, :3], read.T_room_photo[:3, 3]
    observations = gather(read.objects, k.width, k.height)
    placements = place_all(observations, View(k, camera.T_world_camera[:3, :3]), float(camera.position[2]))
    turn = float(np.arctan2(R[1, 0], R[0, 0]))
    alone = []
    for item, placement in zip(read.objects, placements, strict=True):
        yaw, size = heading_and_size(placement, category(item.category))
        centre = R @ placement.cuboid.centre[0] + t
        alone.append(Sighted(category(item.category), centre, yaw + turn, size, placement.supporter))
    away = np.array([np.linalg.norm(a.centre - read.posed.camera.position) for a in alone])
    on = [p.supporter if p.supporter >= 0 else None for p in placements]
    # Boxes before an object say what may hide it, outlines whether something is there.
    covered = np.array([observations.hidden_px(i, parent) for i, parent in enumerate(on)]).reshape(-1, 4)
    hidden_px = np.where(edges_cut_short(read.objects, observations.box_px, away), covered, 0.0)
    return RoomPhoto(PosedBoxes(read.posed.camera, observations, hidden_px), tuple(alone))


def track_name(number: int) -> str:
    """The id of a track's object."""
    return f"object-{number + 1}"


def ids_in(tracks: Sequence[Track], index: int) -> dict[int, str]:
    """The ids of a photo's objects, by box."""
    return {
        box: track_name(number) for number, track in enumerate(tracks) for photo, box in track.boxes if photo == index
    }


def to_placed_picture(read: ReadPhoto, ids: Mapping[int, str]) -> PlacedPicture:
    """A read photo with the ids that its objects have in the scene, by box."""
    named = tuple(replace(item, id=ids.get(k, f"mark-{k}")) for k, item in enumerate(read.objects))
    camera = read.posed.camera.resize(read.inputs.photo.width, read.inputs.photo.height)
    return PlacedPicture(read.inputs, named, camera, read.stages.filler)


def build_photo_scene(
    read: ReadPhoto,
    index: int,
    tracks: Sequence[Track],
    library: ShapeLibrary,
    progress: Progress,
    *,
    room: GivenRoom | None = None,
    plane_pictures: bool = False,
) -> Built:
    """The scene of one photo with the joint cuboids, in a room that is known where it is given, before any layout.

    Args:
        read: the photo.
        index: its number.
        tracks: objects of all photos.
        library: where shapes come from.
        progress: reports and cancellation.
        room: where it is known.
        plane_pictures: whether planes get the photo's pictures.
    """
    stages = _with_joint_cuboids(read, index, tracks)
    stages = stages if room is None else replace(stages, architecture=room)
    return build_scene(read.inputs, library, stages=stages, progress=progress, plane_pictures=plane_pictures)


def room_alone(read: ReadPhoto, index: int, tracks: Sequence[Track], progress: Progress = SILENT) -> Architecture:
    """The room as one photo shows it around the joint cuboids, in the room's frame.

    Args:
        read: the photo.
        index: its number.
        tracks: objects of all photos.
        progress: reports and cancellation.
    """
    stages = _with_joint_cuboids(read, index, tracks)
    artefacts = evaluate(stages, {"given": read.inputs}, ("architecture",), Runner(None), progress)
    architecture: Architecture = artefacts["architecture"].architecture
    return move_to_room(Scene(architecture=architecture), read.T_room_photo).architecture


def _room_of_all(
    read: Sequence[ReadPhoto], alone: Sequence[RoomPhoto], tracks: Sequence[Track], progress: Progress
) -> tuple[GivenRoom, ...]:
    """The room of all photos, for each photo in its own world."""
    seen = []
    for index, (r, part) in enumerate(zip(read, progress.parts(len(read)), strict=True)):
        objects = to_placed_picture(r, ids_in(tracks, index)).objects
        seen.append(SeenRoom(room_alone(r, index, tracks, part), r.posed.camera, objects))
    standing = [_footprint(t.cuboid) for t in tracks if t.kind.mount == "floor" and len(t.inliers) > 1]
    hanging = [t for t in tracks if _hangs(t, alone)]
    mounted = [t.cuboid for t in hanging if is_seen_whole(t.sightings(alone))]
    # A wall that another photo looks past stays where something hangs on it.
    rooms_alone = (room_alone(r, index, _tracks_alone(index, alone[index])) for index, r in enumerate(read))
    whole_room = room_holding(joint_room(seen, standing), rooms_alone, [t.cuboid for t in hanging])
    return rooms_in_photos(walls_at_mounted(whole_room, mounted), seen, read)


def rooms_in_photos(room: Architecture, seen: Sequence[SeenRoom], read: Sequence[ReadPhoto]) -> tuple[GivenRoom, ...]:
    """The room with the open doorways that photos point at, for each photo in its own world."""
    whole, passages = with_open_doorways(room, seen)
    return tuple(GivenRoom(room_in_photo(whole, r), marks) for r, marks in zip(read, passages, strict=True))


def room_in_photo(room: Architecture, read: ReadPhoto) -> Architecture:
    """The room in a photo's own world."""
    return move_to_room(Scene(architecture=room), np.linalg.inv(read.T_room_photo)).architecture


def _tracks_alone(index: int, photo: RoomPhoto) -> tuple[Track, ...]:
    """What a photo says of its objects by itself, as objects that no other photo shows."""
    return tuple(Track(((index, box),), one.kind, one.cuboid) for box, one in enumerate(photo.alone))


def _hangs(track: Track, alone: Sequence[RoomPhoto]) -> bool:
    """Whether an object hangs on a wall by its kind and by what most photos say: clocks stand on shelves, too."""
    on_wall = sum(alone[photo].alone[box].supporter == WALL for photo, box in track.boxes)
    return track.kind.name == "door" or (hangs_on_wall(track.kind.name) and 2 * on_wall > len(track.boxes))


def _footprint(cuboid: JointCuboid) -> Float[np.ndarray, "4 2"]:
    half = cuboid.size_m[:2] / 2 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    corners: Float[np.ndarray, "4 2"] = cuboid.centre[:2] + half @ yaw_rotation(cuboid.yaw_rad)[:2, :2].T
    return corners


def _with_joint_cuboids(read: ReadPhoto, index: int, tracks: Sequence[Track]) -> Stages:
    """A photo's stages with everything that is known given."""
    names, joint = ids_in(tracks, index), {track_name(k): track.cuboid for k, track in enumerate(tracks)}
    objects = tuple(replace(item, id=names[k]) for k, item in enumerate(read.objects))
    cuboids = tuple(_cuboid(o.id, joint[o.id], read) for o in objects)
    return replace(
        read.stages,
        camera=GivenCamera(read.camera),
        objects=GivenObjects(objects),
        geometry=GivenCuboids(read.camera, cuboids),
        layout=AsObserved(),
        refinement=None,
    )


def _cuboid(name: str, joint: JointCuboid, read: ReadPhoto) -> Cuboid:
    """A joint cuboid in a photo's own world; its front is the side that faces the camera most."""
    R, t = read.T_room_photo[:3, :3], read.T_room_photo[:3, 3]
    yaw = joint.yaw_rad - float(np.arctan2(R[1, 0], R[0, 0]))
    centre = R.T @ (joint.centre - t)
    if np.array([np.cos(yaw), np.sin(yaw)]) @ centre[:2] > 0:
        yaw += np.pi
    return Cuboid(name, yaw_rotation(yaw), centre, joint.size_m, 1.0 / (1.0 + joint.cost / 20.0))


def _merge_scenes(
    read: Sequence[ReadPhoto],
    built: dict[int, Built],
    tracks: Sequence[Track],
    best: Sequence[int],
) -> tuple[Scene, dict[str, UInt8[np.ndarray, "_ _ 3"]]]:
    """All objects in the first photo's room, each from the photo that shows it best."""
    scenes = {k: move_to_room(b.scene, read[k].T_room_photo) for k, b in built.items()}
    main = scenes[0]
    objects: list[SceneObject] = []
    textures = dict(built[0].textures)
    supports: list[Support] = []
    for number, (track, index) in enumerate(zip(tracks, best, strict=True)):
        name = track_name(number)
        source = next((k for k in (index, *scenes) if scenes[k].has_object(name)), None)
        if source is None:
            continue  # nothing of the library is like it, or it is an open doorway
        item = scenes[source].object(name)
        if len(track.inliers) > 1:
            item = filling(item, track.cuboid)
        if item.category in OPENING_CATEGORIES:
            item = set_into_wall(item)
        box, mask = (main.object(name).box_px, main.object(name).mask_id) if main.has_object(name) else (None, None)
        objects.append(replace(item, box_px=box, mask_id=mask))
        textures |= textures_of(item, built[source])
        edge = scenes[source].support_of(name)
        if edge is not None:
            supports.append(edge_in_room(edge, scenes[source], main.architecture))
    known = {o.id for o in objects} | {p.id for p in main.architecture.planes}
    edges = tuple(s for s in supports if s.parent in known)
    scene = containing_room(replace(main, objects=tuple(objects), supports=acyclic(edges)))
    check_scene(scene)
    return scene, textures


def textures_of(item: SceneObject, built: Built) -> dict[str, UInt8[np.ndarray, "_ _ 3"]]:
    """The pictures of a build that an object's materials name."""
    names = (m.texture for m in item.photo_materials if m.texture is not None)
    return {name: built.textures[name] for name in names if name in built.textures}
