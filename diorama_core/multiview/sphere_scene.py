"""One scene of a 360 degree photo: the room from the sphere, its objects from perspective views, one scale."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.architecture.walls.settings import SETTINGS as WALLS
from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.geometry.sphere import directions, sampled
from diorama_core.library.record import ShapeLibrary
from diorama_core.multiview.joining import RoomPhoto, Track
from diorama_core.multiview.joint_fit import JointCuboid
from diorama_core.multiview.joint_room import SeenRoom, with_open_doorways
from diorama_core.multiview.one_scene import moved_to_room
from diorama_core.multiview.rooms import (
    JoinedRoom,
    PosedInputs,
    ReadPhoto,
    joined_scene,
    placed_picture,
    read_photo,
    said_alone,
    track_name,
)
from diorama_core.multiview.sphere_frame import room_axes, sphere_lines
from diorama_core.multiview.sphere_room import SphereRoom, room_on_sphere
from diorama_core.multiview.sphere_views import (
    SphereBox,
    SphereView,
    drawn_on_sphere,
    found_in_views,
    marked_views,
    sphere_views,
    view_photo,
)
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.floor import HEIGHTS_M, scan_heights_together
from diorama_core.perception.metrology.problem import View
from diorama_core.pipeline.given_stages import GivenRoom
from diorama_core.pipeline.plan import evaluate
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import LayoutStage
from diorama_core.scene.types import Architecture, Plane, Scene

LEVEL_WIDTH_PX = 1024
"""Of the picture in which the room is looked for."""


@dataclass(frozen=True)
class SphereSceneSettings:
    """Numbers that say how sure a room on the sphere is."""

    ceiling_log_sigma: float = 0.08
    """Deviation of the logarithm of rooms' heights from `WallSettings.usual_ceiling_m`: 2.4 to 2.8 m are usual."""
    tails: float = 4.0
    """Degrees of freedom of its tails: lofts and halls."""
    seen_support: float = 0.3
    """Evidence of a wall's borders, 0 to 1, from which it counts as seen: half the usual one."""
    seen_confidence: float = 0.9
    unseen_confidence: float = 0.3


SETTINGS = SphereSceneSettings()


@dataclass(frozen=True, eq=False)
class SphereScene:
    """The scene of a 360 degree photo with its views."""

    room: JoinedRoom
    views: tuple[PosedInputs, ...]
    """Views with their marks and cameras; the first is the one that the scene opens with."""
    names: tuple[str, ...]
    R_room_sphere: Float[np.ndarray, "3 3"]
    things: tuple[tuple[SphereBox, str], ...]
    """Objects of the picture, each with the id that it has in the scene if it is there."""


def build_sphere(
    photo: Photo,
    boxes: Sequence[LabelledBox],
    library: ShapeLibrary,
    choose: Callable[[Inputs], Stages],
    layout: LayoutStage,
    progress: Progress = SILENT,
    *,
    camera_height_m: float | None = None,
) -> SphereScene:
    """Build one scene of a 360 degree photo.

    Args:
        photo: equirectangular, the whole sphere.
        boxes: objects in its pixels; none for a detector to find them in views.
        library: where shapes come from.
        choose: the stages for a view.
        layout: the optimiser of the whole room.
        progress: reports and cancellation.
        camera_height_m: above the floor, where it is known.

    Raises:
        Cancelled: on request.
        DioramaError: when a stage cannot do its work.
    """
    progress.report(0.0, "reading the room's directions all round")
    R = room_axes(sphere_lines(photo.rgb))
    progress.report(0.03, "looking for the room's borders all round")
    border = room_on_sphere(sampled(photo.rgb, directions(LEVEL_WIDTH_PX) @ R))
    views = sphere_views(photo.width)
    stem = photo.name.rsplit(".", 1)[0]
    pictures = [(v, view_photo(photo.rgb, R, v, f"{stem}-{_degrees(v):03d}.png")) for v in views]
    things = drawn_on_sphere(boxes, (photo.width, photo.height), R)
    if not boxes:
        things = _found(pictures, choose, progress.part(0.05, 0.15))
    read, sightings, height_m = _read(pictures, things, border, choose, progress.part(0.15, 0.3), camera_height_m)
    room_photos = [said_alone(r) for r in read]
    shown = [(thing, seen) for thing, seen in zip(things, sightings, strict=True) if seen]
    tracks = [_track(seen, room_photos) for _, seen in shown]
    rooms = _rooms(sphere_planes(border, height_m), read, tracks)
    room = joined_scene(read, room_photos, tuple(tracks), rooms, library, layout, progress.part(0.3, 1.0))
    tilt = float(np.rad2deg(np.arccos(np.clip(R[2, 2], -1.0, 1.0))))
    notes = (
        f"a 360 degree photo: the room has {len(border.outline)} walls, the camera is {height_m:.2f} m above the floor",
        *((f"its horizon was tilted by {tilt:.1f} degrees",) if tilt >= 1.0 else ()),
    )
    return SphereScene(
        replace(room, notes=(*notes, *room.notes)),
        tuple(PosedInputs(r.inputs, r.posed.camera) for r in read),
        tuple(r.inputs.photo.name for r in read),
        R,
        tuple((thing, track_name(number)) for number, (thing, _) in enumerate(shown)),
    )


def _track(seen: tuple[tuple[int, int], ...], photos: Sequence[RoomPhoto]) -> Track:
    """One thing, as the view shows it that shows it best; `seen` are its views and boxes, that one first."""
    one = photos[seen[0][0]].alone[seen[0][1]]
    cuboid = JointCuboid(one.centre, one.yaw_rad, one.size_m, 0.0)
    return Track(tuple(sorted(seen)), one.kind, cuboid, tuple(seen[1:]))


def _degrees(view: SphereView) -> int:
    """Compass-like direction of a view: to the right from the first one."""
    return round(-np.rad2deg(view.azimuth)) % 360


def _found(
    pictures: Sequence[tuple[SphereView, Photo]], choose: Callable[[Inputs], Stages], progress: Progress
) -> tuple[SphereBox, ...]:
    """Objects that a detector finds in the views."""
    rows = []
    for number, (view, photo) in enumerate(pictures):
        given = Inputs(photo, intrinsics=view.intrinsics)
        part = progress.part(number / len(pictures), (number + 1) / len(pictures))
        rows.append((view, evaluate(choose(given), {"given": given}, ("inputs",), Runner(None), part)["inputs"].boxes))
    return found_in_views(rows)


def _read(
    pictures: Sequence[tuple[SphereView, Photo]],
    things: Sequence[SphereBox],
    room: SphereRoom,
    choose: Callable[[Inputs], Stages],
    progress: Progress,
    camera_height_m: float | None,
) -> tuple[list[ReadPhoto], tuple[tuple[tuple[int, int], ...], ...], float]:
    """The views, the one with most things first; where each thing is seen, best first; and the camera's height."""
    posed, sightings = marked_views(pictures, things, camera_height_m or 1.0)
    counts = [sum(bool(s) and s[0][0] == number for s in sightings) for number in range(len(posed))]
    first = max(range(len(posed)), key=lambda n: (counts[n], len(posed[n].inputs.boxes)))
    order = [*range(first, len(posed)), *range(first)]
    read = []
    for number, index in enumerate(order):
        part = progress.part(number / len(order), (number + 1) / len(order))
        stages = choose(posed[index].inputs)
        read.append(read_photo(posed[index], replace(stages, detection=None), part))
    place = {index: number for number, index in enumerate(order)}
    shown = tuple(tuple((place[view], box) for view, box in seen) for seen in sightings)
    height_m = camera_height_m or _height(read, shown, room)
    return [_at_height(r, height_m) for r in read], shown, height_m


def _height(read: Sequence[ReadPhoto], sightings: Sequence[tuple[tuple[int, int], ...]], room: SphereRoom) -> float:
    """The camera's height by the sizes of all things, each as the view shows it that shows it best, and the room's."""
    pictures = []
    for number, r in enumerate(read):
        k = r.posed.camera.intrinsics
        voters = [seen[0][1] for seen in sightings if seen and seen[0][0] == number]
        pictures.append((gather(r.objects, k.width, k.height), View(k, r.camera.T_world_camera[:3, :3]), voters))
    high = np.log(HEIGHTS_M * (1.0 + room.ceiling) / WALLS.usual_ceiling_m) / SETTINGS.ceiling_log_sigma
    cost = (SETTINGS.tails + 1) * np.log1p(high**2 / SETTINGS.tails)
    return scan_heights_together(pictures, cost).height_m


def _at_height(read: ReadPhoto, height_m: float) -> ReadPhoto:
    T = read.posed.camera.T_world_camera.copy()
    T[2, 3] = height_m
    return replace(read, posed=replace(read.posed, camera=replace(read.posed.camera, T_world_camera=T)))


def sphere_planes(room: SphereRoom, height_m: float) -> Architecture:
    """Floor, walls and ceiling of a room, the floor at 0.

    Args:
        room: in heights of the camera.
        height_m: of the camera.
    """
    outline, top = height_m * room.outline, height_m * (1.0 + room.ceiling)
    count = len(outline)
    base, lid = (np.column_stack([outline, np.full(count, z)]) for z in (0.0, top))
    planes = [Plane("floor", "floor", base, confidence=SETTINGS.seen_confidence)]
    for k in range(count):
        start, end = k, (k + 1) % count
        # Seen from the room, a wall's foot from left to right runs against the outline.
        polygon = np.stack([base[end], base[start], lid[start], lid[end]])
        seen = room.support[k] >= SETTINGS.seen_support
        sure = SETTINGS.seen_confidence if seen else SETTINGS.unseen_confidence
        planes.append(Plane(f"wall_{k + 1}", "wall", polygon, confidence=sure))
    planes.append(Plane("ceiling", "ceiling", lid[::-1], confidence=SETTINGS.seen_confidence))
    return Architecture(tuple(planes))


def _rooms(room: Architecture, read: Sequence[ReadPhoto], tracks: Sequence[Track]) -> tuple[GivenRoom, ...]:
    """The room, for each view in its own world, with the open doorways that the view shows best."""
    seen = []
    for index, r in enumerate(read):
        ids = {b: track_name(n) for n, track in enumerate(tracks) for v, b in track.boxes if v == index}
        seen.append(SeenRoom(room, r.posed.camera, placed_picture(r, ids).objects))
    whole, passages = with_open_doorways(room, seen)
    worlds = [moved_to_room(Scene(architecture=whole), np.linalg.inv(r.T_room_photo)).architecture for r in read]
    return tuple(GivenRoom(world, marks) for world, marks in zip(worlds, passages, strict=True))
