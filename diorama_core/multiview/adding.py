"""One more photo of a room that is a scene already, and perhaps changed by hand since.

Objects of the scene claim the new photo's boxes by where their cuboids project. What nobody claims is new and comes
from the new photo, through the same stages as from any photo. Objects that are where the program had put them are
fitted to all photos that show them; what a person moved stays.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import UInt8

from diorama_core.architecture.room_extent import containing_room
from diorama_core.artefacts import Box, FurtherPhoto, Inputs
from diorama_core.errors import InputError
from diorama_core.geometry.projection import box_iou
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import broad, category
from diorama_core.multiview.better_seen import better_seen
from diorama_core.multiview.joining import (
    RoomPhoto,
    Sighted,
    Track,
    claims,
    fit_track,
    overlap,
    visibility_score,
    with_agreeing_boxes,
)
from diorama_core.multiview.joint_fit import JointCuboid
from diorama_core.multiview.mounted_walls import hangs_on_wall, is_seen_whole, walls_at_mounted
from diorama_core.multiview.one_scene import acyclic, edge_in_room, filling, move_to_room
from diorama_core.multiview.room_pictures import room_pictures, with_pictures
from diorama_core.multiview.rooms import (
    PosedInputs,
    ReadPhoto,
    build_photo_scene,
    estimate_room_photo,
    photo_world,
    read_photo,
    room_in_photo,
    textures_of,
    to_placed_picture,
    track_name,
)
from diorama_core.multiview.settings import SETTINGS
from diorama_core.pipeline.given_stages import GivenRoom
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import LayoutStage
from diorama_core.scene.edits import fresh_id, set_metrics
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Camera, Scene, SceneObject

DISTANCES = tuple(float(f) for f in np.geomspace(0.7, 1.43, 13))
"""Factors on the distance between two photos that are tried."""


@dataclass(frozen=True, eq=False)
class AddedPhoto:
    """A scene with what one more photo shows."""

    scene: Scene
    photo: FurtherPhoto
    """The added one, with the boxes that were used and the objects that they are of."""
    new: tuple[str, ...]
    """Ids of objects that were not there before."""
    joined: tuple[str, ...]
    """Ids of objects that were there and are seen in the new photo, too."""
    textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]]
    """Pictures that new objects name."""


def with_photo(
    scene: Scene,
    known: Sequence[FurtherPhoto],
    new: FurtherPhoto,
    movable: frozenset[str],
    changeable: frozenset[str],
    library: ShapeLibrary,
    choose: Callable[[Inputs], Stages],
    layout: Callable[[frozenset[str]], LayoutStage],
    progress: Progress = SILENT,
    *,
    measured_room: bool = False,
) -> AddedPhoto:
    """The scene with one more photo whose camera is known.

    Args:
        scene: as it is now, floor at 0.
        known: photos of the scene with their cameras, and which objects are seen in them.
        new: the photo; where nothing is marked in it, what a detector finds counts. Objects that it is known to show
            keep their boxes; the others are found.
        movable: ids of objects and walls that may be put elsewhere, and of planes that may get new pictures: those
            where the program had put them.
        changeable: ids of objects that may get another shape and other colours: those that have what the program gave
            them.
        library: where shapes come from.
        choose: the stages for a photo.
        layout: the optimiser, given the ids that are free to move.
        progress: reports and cancellation.
        measured_room: whether walls are where they were measured: new things have to fit in.

    Raises:
        InputError: nothing is marked in the photo or found in it.
        Cancelled: on request.
        DioramaError: when a stage cannot do its work.
    """
    if new.camera is None:
        raise InputError(f"{new.name}: its camera is not known yet")
    read = read_photo(PosedInputs(new.inputs, new.camera), choose(new.inputs), progress.part(0.0, 0.15))
    if not read.objects:
        raise InputError(f"nothing is marked in {new.name} and nothing was found; draw a box around each object first")
    new_photo, others = estimate_room_photo(read), _read_known_photos(known, choose, progress.part(0.15, 0.3))
    sightings = {o.id: _boxes_of(o.id, others) for o in scene.objects}
    objects = [o for o in scene.objects if not o.hidden]
    boxes = [(name, box) for name, at in new.seen if (box := _same(at, read)) is not None]
    given = {box: o for o in objects for name, box in boxes if name == o.id}
    rest = [o for o in objects if o not in given.values()]
    claimed = given | _match_boxes_to_objects(
        rest, sightings, [photo for _, _, photo in others], new_photo, movable, set(given)
    )
    progress.report(0.35, "joining objects")
    if len(others) == 1:
        pairs = [(sightings[item.id][0][1], box) for box, item in claimed.items() if sightings[item.id]]
        read, new_photo = _place_at_likeliest_distance(read, new_photo, others[0][2], pairs)
    photos = (*(photo for _, _, photo in others), new_photo)
    scene = _with_fitted(scene, {box: o for box, o in claimed.items() if o.id in movable}, sightings, photos, movable)
    shares = {
        box: share
        for box, item in claimed.items()
        if item.id in changeable and (share := _share_of_new(sightings[item.id], others, new_photo, box)) is not None
    }
    room = GivenRoom(room_in_photo(scene.architecture, read)) if measured_room else None
    scene, names, textures = _with_new(scene, read, new_photo, claimed, shares, library, progress.part(0.4, 0.8), room)
    ids = {**{box: item.id for box, item in claimed.items()}, **names}
    if names and not measured_room:
        scene = containing_room(scene)
    free = (movable & {o.id for o in scene.objects}) | frozenset(names.values())
    if free:
        scene, report = layout(frozenset(free)).optimise(scene, progress.part(0.8, 0.92), None)
        scene = set_metrics(scene, report.after)
    progress.report(0.92, "pictures of floor and walls")
    placed = [to_placed_picture(r, _ids_of(p, r)) for p, r, _ in others] + [to_placed_picture(read, ids)]
    pictures = room_pictures(scene, placed, library, {p.id for p in scene.architecture.planes if p.id in movable})
    scene, named = with_pictures(scene, pictures)
    textures |= named
    check_scene(scene)
    seen = tuple((ids[k], item.box) for k, item in enumerate(read.objects) if k in ids)
    inputs = replace(new.inputs, boxes=read.inputs.boxes)
    photo = replace(new, inputs=inputs, camera=read.posed.camera, seen=seen)
    joined = tuple(item.id for item in claimed.values())
    return AddedPhoto(scene, photo, tuple(names.values()), joined, textures)


def _read_known_photos(
    known: Sequence[FurtherPhoto], choose: Callable[[Inputs], Stages], progress: Progress
) -> list[tuple[FurtherPhoto, ReadPhoto, RoomPhoto]]:
    """The known photos in which objects of the scene are seen, each with what it says by itself."""
    photos = []
    for number, photo in enumerate(known):
        if photo.camera is not None and photo.seen:
            part = progress.part(number / len(known), 1.0)
            read = read_photo(PosedInputs(photo.inputs, photo.camera), choose(photo.inputs), part)
            photos.append((photo, read, estimate_room_photo(read)))
    return photos


def _with_fitted(
    scene: Scene,
    claimed: Mapping[int, SceneObject],
    sightings: Mapping[str, tuple[tuple[int, int], ...]],
    photos: Sequence[RoomPhoto],
    movable: frozenset[str],
) -> Scene:
    """The scene with its movable objects, and walls that these hang on, where all photos together show them.

    Args:
        scene: as it is.
        claimed: the movable objects that the new photo shows, by box.
        sightings: numbers of photo and box in which each object is seen in the known photos.
        photos: the known ones and the new one, which is the last.
        movable: ids of what may be put elsewhere.
    """
    fitted: dict[str, JointCuboid] = {}
    on_walls: list[JointCuboid] = []
    for box, item in claimed.items():
        if sightings[item.id]:
            rows = (*sightings[item.id], (len(photos) - 1, box))
            track = with_agreeing_boxes(fit_track(rows, photos), photos)
            fitted[item.id] = track.cuboid
            if _hangs(item, scene) and is_seen_whole(track.sightings(photos)):
                on_walls.append(track.cuboid)
    scene = replace(scene, objects=tuple(filling(o, fitted[o.id]) if o.id in fitted else o for o in scene.objects))
    if len(photos) <= 2:  # they do not tell how far they are apart
        return scene
    return replace(scene, architecture=walls_at_mounted(scene.architecture, on_walls, movable))


def _hangs(item: SceneObject, scene: Scene) -> bool:
    """Whether an object hangs on a wall by its kind, and in the scene: clocks stand on shelves, too."""
    edge = scene.support_of(item.id)
    on_wall = edge is not None and scene.has_plane(edge.parent) and scene.plane(edge.parent).role == "wall"
    return hangs_on_wall(item.category) and (on_wall or item.category == "door")


def _place_at_likeliest_distance(
    read: ReadPhoto, new_photo: RoomPhoto, known: RoomPhoto, pairs: Sequence[tuple[int, int]]
) -> tuple[ReadPhoto, RoomPhoto]:
    """The new photo so far from the only known one that the objects of both have the likeliest sizes and places.

    Two photos tell the direction from one to the other well, but how far they are apart only by what they show.

    Args:
        read: the new photo.
        new_photo: what it says by itself.
        known: the known photo.
        pairs: boxes of the known and of the new photo that are of one object.
    """
    if len(pairs) < SETTINGS.min_pairs:
        return read, new_photo
    eye = known.boxes.camera.position

    def place_at(factor: float) -> tuple[ReadPhoto, RoomPhoto]:
        T = read.posed.camera.T_world_camera.copy()
        T[:3, 3] = eye + factor * (T[:3, 3] - eye)
        camera = Camera(read.posed.camera.intrinsics, T)
        moved = replace(read, posed=replace(read.posed, camera=camera), T_room_photo=photo_world(camera))
        return moved, estimate_room_photo(moved)

    def against(photo: RoomPhoto) -> float:
        costs = [fit_track(((0, a), (1, b)), (known, photo)).cuboid.cost for a, b in pairs]
        return float(np.minimum(costs, SETTINGS.max_cost).sum())

    tried = [place_at(f) for f in DISTANCES]
    odd = (np.log(DISTANCES) / SETTINGS.distance_log_sigma) ** 2
    return tried[int(np.argmin(odd + [against(photo) for _, photo in tried]))]


def _boxes_of(
    object_id: str, others: Sequence[tuple[FurtherPhoto, ReadPhoto, RoomPhoto]]
) -> tuple[tuple[int, int], ...]:
    """The boxes of an object in the known photos: numbers of photo and box."""
    return tuple(
        (number, index)
        for number, (photo, read, _) in enumerate(others)
        for name, box in photo.seen
        if name == object_id and (index := _same(box, read)) is not None
    )


def _same(box: Box, read: ReadPhoto) -> int | None:
    shares = [float(box_iou(np.array(box), np.array(o.box))) for o in read.objects]
    best = max(range(len(shares)), key=lambda k: shares[k], default=None)
    return best if best is not None and shares[best] >= SETTINGS.same_box else None


def _ids_of(photo: FurtherPhoto, read: ReadPhoto) -> dict[int, str]:
    """The ids of a known photo's objects, by box."""
    return {index: name for name, box in photo.seen if (index := _same(box, read)) is not None}


def _share_of_new(
    sightings: Sequence[tuple[int, int]],
    others: Sequence[tuple[FurtherPhoto, ReadPhoto, RoomPhoto]],
    new_photo: RoomPhoto,
    box: int,
) -> float | None:
    """How much a new photo counts for what an object is; None where a known one shows it about as well.

    What no photo has shown before is as the first one shows it.
    """
    if not sightings:
        return 1.0
    known = max((visibility_score(others[number][2], index) for number, index in sightings), default=0.0)
    new = visibility_score(new_photo, box)
    return new / (new + known) if known > 0.0 and new > SETTINGS.clearly_better * known else None


def _match_boxes_to_objects(
    objects: Sequence[SceneObject],
    sightings: Mapping[str, tuple[tuple[int, int], ...]],
    others: Sequence[RoomPhoto],
    new_photo: RoomPhoto,
    movable: frozenset[str],
    given: Collection[int],
) -> dict[int, SceneObject]:
    """By box of the new photo, the object of the scene that it shows; not for boxes of which that is given."""
    shared = np.zeros((len(objects), len(new_photo.alone)))
    for k, item in enumerate(objects):
        seen = sightings[item.id]
        only = (others[seen[0][0]], seen[0][1]) if len(seen) == 1 and item.id in movable else None
        cuboid = _cuboid_of(item)
        for box, one in enumerate(new_photo.alone):
            if box not in given and broad(item.category) == broad(one.kind.name):
                shared[k, box] = overlap(cuboid, only, new_photo, box)
    return {box: objects[k] for box, k in claims(shared).items()}


def _cuboid_of(item: SceneObject) -> JointCuboid:
    corners = item.corners_world
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    return JointCuboid(middle, item.pose.yaw_rad, item.size_m, 0.0)


def _with_new(
    scene: Scene,
    read: ReadPhoto,
    new_photo: RoomPhoto,
    claimed: Mapping[int, SceneObject],
    shares: Mapping[int, float],
    library: ShapeLibrary,
    progress: Progress,
    room: GivenRoom | None,
) -> tuple[Scene, dict[int, str], dict[str, UInt8[np.ndarray, "_ _ 3"]]]:
    """The scene with the objects of boxes that nobody claims, and those better that the photo shows better.

    Args:
        scene: as it is.
        read: the new photo.
        new_photo: what it says by itself.
        claimed: objects of the scene by box.
        shares: how much the photo counts for those that it shows better, by box.
        library: where shapes come from.
        progress: reports and cancellation.
        room: the scene's, in the photo's own world, where it was measured; otherwise the photo tells one.

    Returns:
        The scene, ids of new objects by box, and the pictures that new and better seen objects name.
    """
    left = [k for k in range(len(read.objects)) if k not in claimed]
    if not left and not shares:
        return scene, {}, {}
    there_now = {box: scene.object(item.id) for box, item in claimed.items()}
    tracks = [_track(k, one, there_now.get(k)) for k, one in enumerate(new_photo.alone)]
    built = build_photo_scene(read, 0, tracks, library, progress, room=room)
    scene_in_room = move_to_room(built.scene, read.T_room_photo)
    ids: dict[str, str] = {track_name(k): item.id for k, item in claimed.items()}
    names: dict[int, str] = {}
    textures: dict[str, UInt8[np.ndarray, "_ _ 3"]] = {}
    for k in left:
        if not scene_in_room.has_object(track_name(k)):
            continue  # nothing of the library is like it, or it is an open doorway
        item = scene_in_room.object(track_name(k))
        names[k] = ids[track_name(k)] = fresh_id(scene, item.category)
        # The boxes and masks of objects are those of the scene's own photo.
        scene = replace(scene, objects=(*scene.objects, replace(item, id=names[k], box_px=None, mask_id=None)))
        textures |= textures_of(item, built)
    for k, share in shares.items():
        if scene_in_room.has_object(track_name(k)):
            item = better_seen(there_now[k], scene_in_room.object(track_name(k)), share)
            scene = replace(scene, objects=tuple(item if o.id == item.id else o for o in scene.objects))
            textures |= textures_of(item, built)
    held = (scene_in_room.support_of(track_name(k)) for k in names)
    edges = (edge_in_room(edge, scene_in_room, scene.architecture) for edge in held if edge is not None)
    new = (replace(e, child=ids[e.child], parent=ids.get(e.parent, e.parent)) for e in edges)
    supports = (*scene.supports, *(e for e in new if scene.has_object(e.parent) or scene.has_plane(e.parent)))
    return replace(scene, supports=acyclic(supports)), names, textures


def _track(number: int, one: Sighted, item: SceneObject | None) -> Track:
    """What a box is of: an object of the scene as it is there, or what the photo says by itself."""
    if item is None:
        return Track(((0, number),), one.kind, one.cuboid)
    return Track(((0, number),), category(item.category), _cuboid_of(item))
