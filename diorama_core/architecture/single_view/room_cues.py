"""Image cues of a room: line orientations, edges, objects and usual room sizes. The world's axes are the room's."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Int

from diorama_core.architecture.single_view.settings import SETTINGS, RoomCueSettings
from diorama_core.artefacts import SURE_MASK, Cuboid, DetectedObject
from diorama_core.geometry.openings import DOOR
from diorama_core.geometry.segments import line_segments_px
from diorama_core.library.taxonomy import CATEGORIES, PORTABLE, UNKNOWN, category, having
from diorama_core.scene.types import Camera

AXIS_TOLERANCE_RAD = np.deg2rad(4.0)
"""A segment belongs to a room axis when it points within this of the axis's vanishing point."""
EDGE_THRESHOLD = 0.3
"""Edge response at which a boundary scores zero."""
SLANT_FROM_AXIS_RAD = np.deg2rad(12.0)
MAX_CEILING_M = 5.0

PRIOR_MEDIAN_M = np.array([4.2, 3.5, 2.6])
"""Width, depth from the camera, ceiling."""
PRIOR_LOG_SIGMA = np.array([0.45, 0.5, 0.18])

BACKED = (having("often_at_wall") - having("seat")) | {DOOR}
"""What usually has a wall behind it, or around it."""
_WALL_CATEGORIES = frozenset(c.name for c in CATEGORIES if c.mount in ("wall", "ceiling"))


@dataclass(frozen=True, eq=False)
class RoomCues:
    """What a photo tells of its room, computed once."""

    camera: Camera
    directions: Float[np.ndarray, "s 3"]
    """World rays through points of segments that lie on the room's surfaces."""
    ray_axes: Int[np.ndarray, "s"]
    """The room axis (0 x, 1 y, 2 z) each ray's segment runs along."""
    ray_weights: Float[np.ndarray, "s"]
    """Sum to one."""
    edge_maps: Float32[np.ndarray, "3 hm wm"]
    """Response to edges along each axis; `EDGE_THRESHOLD`, that is neutral, where objects are."""
    map_scale: float
    """Map pixels per photo pixel."""
    segment_rays: Float[np.ndarray, "n 3"]
    """World rays through the middles of the segments, longest first, whose axis is known: what candidates come from."""
    segment_axes: Int[np.ndarray, "n"]
    object_low: Float[np.ndarray, "k 3"]
    """Least corner of each standing object's cuboid along the room's axes."""
    object_high: Float[np.ndarray, "k 3"]
    object_weights: Float[np.ndarray, "k"]
    object_portable: Bool[np.ndarray, "k"]
    """Whether people put such objects on furniture, too: then they are nearer than where their line of sight meets the
    floor."""
    backed_low: Float[np.ndarray, "b 3"]
    """Least corner of the cuboid of each object that has a wall behind it, or is in one."""
    backed_high: Float[np.ndarray, "b 3"]
    backed_weights: Float[np.ndarray, "b"]
    hung_top_m: float
    """Top of the highest object that hangs from the ceiling; 0 when nothing does."""
    slants_rad: tuple[float, ...] = ()
    """Headings, counter-clockwise from +X and below a half turn, of level lines that run along none of the axes."""
    slant_maps: tuple[Float32[np.ndarray, "hm wm"], ...] = ()
    """Edge maps of those."""


def segment_axes(segments: Float[np.ndarray, "n 4"], camera: Camera) -> Int[np.ndarray, "n"]:
    """The room axis whose vanishing point each segment points to; -1 where none is near enough or two are."""
    if len(segments) == 0:
        return np.zeros(0, dtype=int)
    k = camera.intrinsics
    middle = 0.5 * (segments[:, :2] + segments[:, 2:])
    along = segments[:, 2:] - segments[:, :2]
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    vanishing = (k.matrix @ camera.T_camera_world[:3, :3]).T
    toward = vanishing[:, None, :2] - vanishing[:, None, 2:] * middle
    toward /= np.maximum(np.linalg.norm(toward, axis=-1, keepdims=True), 1e-9)
    sines = np.abs(toward[..., 0] * along[:, 1] - toward[..., 1] * along[:, 0])
    best, second = np.sort(sines, axis=0)[:2]
    return np.where((best < np.sin(AXIS_TOLERANCE_RAD)) & (second > 1.5 * best), sines.argmin(axis=0), -1)


def gather_room_cues(
    rgb: np.ndarray,
    camera: Camera,
    objects: tuple[DetectedObject, ...],
    cuboids: tuple[Cuboid, ...],
    settings: RoomCueSettings = SETTINGS.cues,
) -> RoomCues:
    """Compute the room cues of a photo from its camera and objects.

    Args:
        rgb: the photo, (h, w, 3), sRGB, eight bits.
        camera: of the photo, in the world.
        objects: with masks of shape (h, w); lines within what stands in the room are left out.
        cuboids: of the objects, in the world.
        settings: of the cues.
    """
    segments = line_segments_px(rgb, min_length=0.015)
    axes = segment_axes(segments, camera)
    oblique, segments, axes = segments[axes < 0], segments[axes >= 0], axes[axes >= 0]
    standing = [o for o in objects if o.category not in _WALL_CATEGORIES]
    free = ~_lie_on_objects(segments, standing, rgb.shape[:2])
    map_scale = min(1.0, settings.map_side_px / max(rgb.shape[:2]))
    middle = 0.5 * (segments[:, :2] + segments[:, 2:])
    directions, ray_axes, weights = _surface_rays(segments[free], axes[free], camera)
    hung = {o.id for o in objects if category(o.category).mount == "ceiling"}
    names = {c.object_id: UNKNOWN.name for c in cuboids} | {o.id: o.category for o in objects}
    solid = [c for c in cuboids if names[c.object_id] not in _WALL_CATEGORIES]
    portable = [names[c.object_id] in PORTABLE or category(names[c.object_id]).mount == "surface" for c in solid]
    corners = np.array([c.corners_world for c in solid]).reshape(-1, 8, 3)
    backed = [c for c in cuboids if names[c.object_id] in BACKED]
    backs = np.array([c.corners_world for c in backed]).reshape(-1, 8, 3)
    oblique = oblique[~_lie_on_objects(oblique, standing, rgb.shape[:2])]
    slants = _slants(oblique, segments[free], camera, settings)
    frame = (objects, rgb.shape[:2], map_scale, settings)
    edge_maps = [_edge_map(segments[axes == axis], *frame, level=axis < 2) for axis in range(3)]
    return RoomCues(
        camera=camera,
        directions=directions,
        ray_axes=ray_axes,
        ray_weights=weights,
        edge_maps=np.stack(edge_maps),
        map_scale=map_scale,
        segment_rays=camera.rays(middle[free]),
        segment_axes=axes[free],
        object_low=corners.min(axis=1),
        object_high=corners.max(axis=1),
        object_weights=np.array(
            [max(c.confidence, 0.1) * (1.0 if c.foot_seen else settings.unseen_foot) for c in solid]
        ),
        object_portable=np.array(portable, dtype=bool),
        backed_low=backs.min(axis=1),
        backed_high=backs.max(axis=1),
        backed_weights=np.array([c.confidence for c in backed]),
        hung_top_m=max((float(c.corners_world[:, 2].max()) for c in cuboids if c.object_id in hung), default=0.0),
        slants_rad=tuple(angle for angle, _ in slants),
        slant_maps=tuple(_edge_map(oblique[rows_of_direction], *frame) for _, rows_of_direction in slants),
    )


def _slants(
    oblique: Float[np.ndarray, "n 4"], straight: Float[np.ndarray, "m 4"], camera: Camera, settings: RoomCueSettings
) -> list[tuple[float, Bool[np.ndarray, "n"]]]:
    """Level directions, far from the axes, that much of the oblique segments share; and which those are."""
    if len(oblique) == 0:
        return []
    # A segment lies in a plane with the camera; it runs along a level direction square to that plane's normal.
    normals = np.cross(camera.rays(oblique[:, :2]), camera.rays(oblique[:, 2:]))
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    level = np.linalg.norm(normals[:, :2], axis=1)
    angles = np.arctan2(-normals[:, 0], normals[:, 1]) % np.pi
    lengths = np.linalg.norm(oblique[:, 2:] - oblique[:, :2], axis=1)
    everything = lengths.sum() + np.linalg.norm(straight[:, 2:] - straight[:, :2], axis=1).sum()
    k = camera.intrinsics
    from_axis = np.abs((angles + np.pi / 4) % (np.pi / 2) - np.pi / 4)
    usable = (level > settings.min_level) & (from_axis > SLANT_FROM_AXIS_RAD)
    slants: list[tuple[float, Bool[np.ndarray, "n"]]] = []
    for angle in np.deg2rad(np.arange(0.0, 180.0, 1.0)):
        along = np.array([np.cos(angle), np.sin(angle), 0.0])
        is_along = usable & (np.abs(normals @ along) < np.sin(AXIS_TOLERANCE_RAD / 2))
        slants.append((float(angle), is_along))
    best = max(slants, key=lambda pair: float(lengths[pair[1]].sum()))
    total = float(lengths[best[1]].sum())
    enough = total > max(
        settings.slant_share * everything, settings.slant_diagonals * float(np.hypot(k.width, k.height))
    )
    return [best] if enough else []


def _lie_on_objects(
    segments: Float[np.ndarray, "n 4"], objects: list[DetectedObject], shape: tuple[int, ...]
) -> Bool[np.ndarray, "n"]:
    """Segments whose middle or both ends lie on a standing object."""
    if not objects or len(segments) == 0:
        return np.zeros(len(segments), dtype=bool)
    union = np.any([o.mask for o in objects], axis=0).astype(np.uint8)
    union = cv2.dilate(union, np.ones((5, 5), np.uint8)).astype(bool)

    def is_covered(points: np.ndarray) -> np.ndarray:
        columns, rows = points.astype(int).T
        return union[rows.clip(0, shape[0] - 1), columns.clip(0, shape[1] - 1)]

    ends = is_covered(segments[:, :2]) & is_covered(segments[:, 2:])
    return is_covered(0.5 * (segments[:, :2] + segments[:, 2:])) | ends


def _surface_rays(
    segments: Float[np.ndarray, "n 4"], axes: Int[np.ndarray, "n"], camera: Camera
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rays through three points of each segment, its axis, and its length capped and shared among them."""
    if len(segments) == 0:
        return np.zeros((0, 3)), np.zeros(0, dtype=int), np.zeros(0)
    lengths = np.linalg.norm(segments[:, 2:] - segments[:, :2], axis=1)
    lengths = np.minimum(lengths, np.quantile(lengths, 0.95))
    shares = np.array([0.15, 0.5, 0.85])[None, :, None]
    points = segments[:, None, :2] + shares * (segments[:, 2:] - segments[:, :2])[:, None]
    weights = np.repeat(lengths, 3)
    return camera.rays(points.reshape(-1, 2)), np.repeat(axes, 3), weights / weights.sum()


def _edge_map(
    segments: Float[np.ndarray, "n 4"],
    objects: tuple[DetectedObject, ...],
    shape: tuple[int, ...],
    scale: float,
    settings: RoomCueSettings,
    *,
    level: bool = True,
) -> Float32[np.ndarray, "hm wm"]:
    """How near the nearest segment of one direction is: a Gaussian of the distance, neutral on objects.

    Level ones say less where they crowd, as bricks' and boards' do.
    """
    rows, columns = max(1, round(shape[0] * scale)), max(1, round(shape[1] * scale))
    sigma = settings.edge_sigma * float(np.hypot(rows, columns))
    canvas = np.full((rows, columns), 255, np.uint8)
    for x1, y1, x2, y2 in np.round(segments * scale - 0.5).astype(int):
        cv2.line(canvas, (x1, y1), (x2, y2), 0, 1)
    edge_map = np.zeros((rows, columns), np.float32)
    if (canvas == 0).any():
        edge_map = np.exp(-0.5 * (cv2.distanceTransform(canvas, cv2.DIST_L2, 3) / sigma) ** 2)
        side = round(settings.crowd_share * float(np.hypot(rows, columns))) | 1
        crowd = cv2.blur((edge_map > 0.6).astype(np.float32), (side, side)) if level else 0.0
        edge_map *= np.clip(1.0 - settings.crowd_loss * (crowd - settings.crowd_free), settings.crowd_min, 1.0)
    for item in objects:
        edge_map[_neutral(item, (rows, columns), scale)] = EDGE_THRESHOLD
    return np.asarray(edge_map, np.float32)


def _neutral(detected: DetectedObject, shape: tuple[int, int], scale: float) -> Bool[np.ndarray, "hm wm"]:
    """Region in which an object's own edges are ignored: its dilated mask when reliable, else its box."""
    covered = np.zeros(shape, np.uint8)
    if detected.mask_confidence >= SURE_MASK:
        covered = cv2.resize(detected.mask.astype(np.uint8), shape[::-1], interpolation=cv2.INTER_AREA)
        return cv2.dilate(covered, np.ones((9, 9), np.uint8)).astype(bool)
    x1, y1, x2, y2 = (round(v * scale) for v in detected.box)
    covered[y1:y2, x1:x2] = 1
    return covered.astype(bool)
