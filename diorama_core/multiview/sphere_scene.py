"""One scene of a 360 degree photo: the room from the sphere, its objects from perspective views, one scale.

Gravity and the room's axes from straight lines all around: a line of the room is a great circle on the sphere.

A segment with the normal n of its great circle may run in a direction v where n . v = 0. The vertical is the direction
near the picture's own that most segments may run in; the room's axes are the two level directions, a quarter turn
apart, that most of the others may run in. All three are then refined together.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.architecture.walls.settings import SETTINGS as WALLS
from diorama_core.artefacts import FurtherPhoto, Inputs, LabelledBox, Photo
from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.geometry.segments import line_segments_px
from diorama_core.geometry.sphere import directions, level_axes, perspective, sample
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import category, is_furniture
from diorama_core.models.room_surfaces import own_surface_reader
from diorama_core.multiview.joining import RoomPhoto, Track
from diorama_core.multiview.joint_room import SeenRoom
from diorama_core.multiview.rooms import (
    JoinedRoom,
    PosedInputs,
    ReadPhoto,
    build_joined_scene,
    estimate_room_photo,
    ids_in,
    read_photo,
    rooms_in_photos,
    to_placed_picture,
    track_name,
)
from diorama_core.multiview.sphere_room import SETTINGS as ROOM
from diorama_core.multiview.sphere_room import SphereRoom, SphereThing, room_on_sphere
from diorama_core.multiview.sphere_views import (
    SphereBox,
    SphereView,
    merge_detections,
    picture_boxes,
    project_to_views,
    sphere_surfaces,
    sphere_views,
    to_sphere_boxes,
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
from diorama_core.scene.types import Architecture, Camera, Intrinsics, Plane, SceneObject, rigid, yaw_rotation

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

    def further_photos(self, inputs: Inputs) -> tuple[FurtherPhoto, ...]:
        """The 360 degree photo and its views without the first, which the scene opens with.

        Args:
            inputs: the 360 degree photo; without boxes it gets those of what was found.
        """
        photo, T = inputs.photo, rigid(self.R_room_sphere, self.views[0].camera.position)
        known = {o.id: o for o in self.room.scene.objects}
        things = [_relabel(thing, known[name]) if name in known else thing for thing, name in self.things]
        found = picture_boxes(things, (photo.width, photo.height), self.R_room_sphere)
        whole = FurtherPhoto(Path(photo.name).stem, replace(inputs, boxes=inputs.boxes or found), T_world_sphere=T)
        views = zip(self.names[1:], self.views[1:], self.room.seen[1:], strict=True)
        return (whole, *(FurtherPhoto(Path(name).stem, v.inputs, v.camera, seen) for name, v, seen in views))


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
    views = sphere_views(photo.width)
    stem = photo.name.rsplit(".", 1)[0]
    pictures = [(v, view_photo(photo.rgb, R, v, f"{stem}-{_degrees(v):03d}.png")) for v in views]
    things = to_sphere_boxes(boxes, (photo.width, photo.height), R)
    if not boxes:
        things = _detect_objects(pictures, choose, progress.part(0.03, 0.12))
    progress.report(0.12, "looking for the room's borders all round")
    level, reader = sample(photo.rgb, directions(LEVEL_WIDTH_PX) @ R), own_surface_reader()
    surfaces = None if reader is None else sphere_surfaces(level, reader)
    border = room_on_sphere(level, occluders(things), surfaces)
    read, sightings, height_m = _read(pictures, things, border, choose, progress.part(0.15, 0.3), camera_height_m)
    room_photos = [estimate_room_photo(r) for r in read]
    shown = [(thing, seen) for thing, seen in zip(things, sightings, strict=True) if seen]
    tracks = [_track(seen, room_photos) for _, seen in shown]
    rooms = _rooms(sphere_planes(border, height_m), read, tracks)
    room = build_joined_scene(read, room_photos, tuple(tracks), rooms, library, layout, progress.part(0.3, 1.0))
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


def _relabel(thing: SphereBox, item: SceneObject) -> SphereBox:
    """A thing that was found, called what it became."""
    return replace(thing, labelled=replace(thing.labelled, label=item.label, category=item.category, guessed=True))


def occluders(things: Sequence[SphereBox]) -> tuple[SphereThing, ...]:
    """Extents that hide the room's borders; of what hangs on a wall, which ends at them, only the middle."""
    hiding = []
    for t in things:
        kind = t.labelled.category
        inset = 2 * ROOM.margin_rad if category(kind).mount == "wall" else 0.0
        hiding.append(SphereThing(t.azimuth, t.half_width, t.low + inset, t.high - inset, is_furniture(kind)))
    return tuple(hiding)


def _track(seen: tuple[tuple[int, int], ...], photos: Sequence[RoomPhoto]) -> Track:
    """One thing, as the view shows it that shows it best; `seen` are its views and boxes, that one first."""
    one = photos[seen[0][0]].alone[seen[0][1]]
    return Track(tuple(sorted(seen)), one.kind, one.cuboid, seen[1:])


def _degrees(view: SphereView) -> int:
    """Compass-like direction of a view: to the right from the first one."""
    return round(-np.rad2deg(view.azimuth)) % 360


def _detect_objects(
    pictures: Sequence[tuple[SphereView, Photo]], choose: Callable[[Inputs], Stages], progress: Progress
) -> tuple[SphereBox, ...]:
    """Objects that a detector finds in the views."""
    rows = []
    for (view, photo), part in zip(pictures, progress.parts(len(pictures)), strict=True):
        given = Inputs(photo, intrinsics=view.intrinsics)
        rows.append((view, evaluate(choose(given), {"given": given}, ("inputs",), Runner(None), part)["inputs"].boxes))
    return merge_detections(rows)


def _read(
    pictures: Sequence[tuple[SphereView, Photo]],
    things: Sequence[SphereBox],
    room: SphereRoom,
    choose: Callable[[Inputs], Stages],
    progress: Progress,
    camera_height_m: float | None,
) -> tuple[list[ReadPhoto], tuple[tuple[tuple[int, int], ...], ...], float]:
    """The views, the one with most things first; where each thing is seen, best first; and the camera's height."""
    posed, sightings = project_to_views(pictures, things, camera_height_m or 1.0)
    counts = [sum(bool(s) and s[0][0] == number for s in sightings) for number in range(len(posed))]
    first = max(range(len(posed)), key=lambda n: (counts[n], len(posed[n].inputs.boxes)))
    order = [*range(first, len(posed)), *range(first)]
    read = []
    for index, part in zip(order, progress.parts(len(order)), strict=True):
        stages = choose(posed[index].inputs)
        read.append(read_photo(posed[index], replace(stages, detection=None), part))
    place = {index: number for number, index in enumerate(order)}
    shown = tuple(tuple((place[view], box) for view, box in seen) for seen in sightings)
    height_m = camera_height_m or _height(read, shown, room)
    return [_set_camera_height(r, height_m) for r in read], shown, height_m


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


def _set_camera_height(read: ReadPhoto, height_m: float) -> ReadPhoto:
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
    marked = (to_placed_picture(r, ids_in(tracks, index)).objects for index, r in enumerate(read))
    seen = [SeenRoom(room, r.posed.camera, objects) for r, objects in zip(read, marked, strict=True)]
    return rooms_in_photos(room, seen, read)


@dataclass(frozen=True)
class SphereFrameSettings:
    """Numbers by which straight lines are read from the sphere."""

    side_px: int = 640
    """Side of the views in which segments are looked for: a quarter turn each."""
    max_tilt_deg: float = 15.0
    """Cameras that stitch level the horizon; a tripod or a hand is off by less than this."""
    level_deg: float = 5.0
    level_weight: float = 0.03
    """Deviation of cameras from level, and what it counts beside all lines, as `LineCameraSettings.prior_weight`."""
    coarse_deg: float = 1.0
    sigma_deg: float = 1.0
    """Deviation of a segment's great circle from the direction in which it runs."""
    rounds: int = 8


FRAME_SETTINGS = SphereFrameSettings()


@dataclass(frozen=True, eq=False)
class SphereLines:
    """Segments all around."""

    normals: Float[np.ndarray, "n 3"]
    """Normals of their great circles, unit, in the sphere's frame."""
    weights: Float[np.ndarray, "n"]
    """Their angular lengths."""


def sphere_lines(picture: UInt8[np.ndarray, "h w 3"]) -> SphereLines:
    """Straight segments of an equirectangular picture, from perspective views that overlap by half."""
    side, T = FRAME_SETTINGS.side_px, np.eye(4)
    k = Intrinsics.from_fov(side, side, np.pi / 2)
    looks = [(turn * np.pi / 4, 0.0) for turn in range(8)] + [(0.0, np.pi / 2), (0.0, -np.pi / 2)]
    normals, weights = [np.zeros((0, 3))], [np.zeros(0)]
    for azimuth, elevation in looks:
        T[:3, :3] = level_axes(azimuth, elevation)
        ends = line_segments_px(perspective(picture, T[:3, :3], k)).reshape(-1, 2, 2)
        away = Camera(k, T).rays(ends)
        away /= np.linalg.norm(away, axis=-1, keepdims=True)
        across = np.cross(away[:, 0], away[:, 1])
        length = np.linalg.norm(across, axis=1)
        normals.append(across / np.maximum(length, 1e-9)[:, None])
        weights.append(np.arcsin(np.clip(length, 0.0, 1.0)))
    return SphereLines(np.concatenate(normals), np.concatenate(weights))


def room_axes(lines: SphereLines) -> Float[np.ndarray, "3 3"]:
    """The turn from the sphere's frame to +Z up with the room's axes along x and y, by the least turn about +Z.

    A picture without lines stays as it is.
    """
    if not len(lines.weights):
        return np.eye(3)
    R = _with_yaw(lines, _levelling_rotation(lines))
    sigma = np.sin(np.deg2rad(FRAME_SETTINGS.sigma_deg))
    for _ in range(FRAME_SETTINGS.rounds):
        # A small turn w moves an axis a by w x a: the sine n . a changes by w . (a x n).
        sines = lines.normals @ R.T
        axis = np.abs(sines).argmin(axis=1)
        off = np.take_along_axis(sines, axis[:, None], 1)[:, 0]
        slopes = np.cross(R[axis], lines.normals)
        w = lines.weights * np.exp(-0.5 * (off / sigma) ** 2)
        step = -np.linalg.solve((slopes * w[:, None]).T @ slopes + 1e-6 * np.eye(3), slopes.T @ (w * off))
        R = R @ rotation_from_vector(step).T
    return R


def _levelling_rotation(lines: SphereLines) -> Float[np.ndarray, "3 3"]:
    """The least turn that makes upright lines upright."""
    reach = np.deg2rad(
        np.arange(-FRAME_SETTINGS.max_tilt_deg, FRAME_SETTINGS.max_tilt_deg + 1e-6, FRAME_SETTINGS.coarse_deg)
    )
    tilts = np.stack(np.meshgrid(reach, reach), axis=-1).reshape(-1, 2)
    tilts = tilts[np.linalg.norm(tilts, axis=1) <= reach[-1]]
    ups = np.column_stack([np.sin(tilts), np.sqrt(1 - (np.sin(tilts) ** 2).sum(axis=1))])
    votes = np.exp(-0.5 * (ups @ lines.normals.T / np.sin(np.deg2rad(FRAME_SETTINGS.coarse_deg))) ** 2) @ lines.weights
    weight = FRAME_SETTINGS.level_weight * lines.weights.sum()
    votes -= weight * 0.5 * (np.rad2deg(tilts) ** 2).sum(axis=1) / FRAME_SETTINGS.level_deg**2
    up = ups[int(np.argmax(votes))]
    turn = np.cross(up, [0.0, 0.0, 1.0])
    return rotation_from_vector(turn * (np.arcsin(np.linalg.norm(turn)) / max(float(np.linalg.norm(turn)), 1e-12)))


def _with_yaw(lines: SphereLines, R: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3 3"]:
    """The turn with the room's axes along x and y."""
    n = lines.normals @ R.T
    upright = np.hypot(n[:, 0], n[:, 1])
    angle = np.arctan2(n[:, 1], n[:, 0])  # a level line runs a quarter turn from its normal's: alike modulo that
    # Upright lines may run in no level direction, and lines at the horizon in all of them.
    w = lines.weights * upright * (np.abs(n[:, 2]) > np.sin(2 * np.deg2rad(FRAME_SETTINGS.coarse_deg)))
    turns = np.deg2rad(np.arange(-45.0, 45.0, FRAME_SETTINGS.coarse_deg / 2))
    off = np.angle(np.exp(4j * (angle[None] - turns[:, None]))) / 4
    sines = upright * np.sin(off)
    votes = np.exp(-0.5 * (sines / np.sin(np.deg2rad(FRAME_SETTINGS.coarse_deg))) ** 2) @ w
    return yaw_rotation(-float(turns[int(np.argmax(votes))])) @ R
