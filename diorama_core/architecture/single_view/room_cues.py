"""Image cues of a room: line orientations, edges, objects and usual room sizes.

A box is a row (x0, x1, y1, ceiling): left, right and far wall and ceiling height in the world frame, whose floor is
z = 0 and whose axes are the room's. Boxes are scored many at a time.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Int

from diorama_core.architecture.single_view.settings import SETTINGS, RoomCueSettings
from diorama_core.artefacts import SURE_MASK, Cuboid, DetectedObject
from diorama_core.geometry.projection import NEAR_M
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

BACKED = having("often_at_wall") - having("seat")
"""What usually has a wall behind it."""
_WALL_CATEGORIES = frozenset(c.name for c in CATEGORIES if c.mount in ("wall", "ceiling"))


@dataclass(frozen=True, eq=False)
class RoomCues:
    """The cues for scoring boxes, computed once per photo."""

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
    settings: RoomCueSettings = SETTINGS.cues

    def hits(self, boxes: Float[np.ndarray, "b 4"], directions: Float[np.ndarray, "s 3"]) -> Int[np.ndarray, "b s"]:
        """The axis of the face that each ray meets first: 0 a side wall, 1 the far wall, 2 floor or ceiling."""
        ox, oy, oz = self.camera.position
        dx, dy, dz = np.where(np.abs(directions) < 1e-9, 1e-9, directions).T
        x0, x1, y1, top = (boxes[:, i : i + 1] for i in range(4))
        tx = np.where(dx > 0, (x1 - ox) / dx, (x0 - ox) / dx)
        ty = np.where(dy > 0, (y1 - oy) / dy, np.inf)
        tz = np.where(dz > 0, (top - oz) / dz, -oz / dz)
        return np.stack([tx, ty, tz]).argmin(axis=0)

    def orientation(self, boxes: Float[np.ndarray, "b 4"]) -> Float[np.ndarray, "b"]:
        """Minus the share of line evidence lying on a surface that the line would have to stand out of."""
        if len(self.directions) == 0:
            return np.zeros(len(boxes))
        return -((self.hits(boxes, self.directions) == self.ray_axes) * self.ray_weights).sum(axis=1)

    def edges(self, boxes: Float[np.ndarray, "b 4"]) -> Float[np.ndarray, "b 8"]:
        """Edge evidence along the visible part of each of the eight boundaries, in picture diagonals."""
        response, lengths = self._responses(boxes)
        return (response - EDGE_THRESHOLD).mean(axis=-1) * lengths

    def _responses(
        self, boxes: Float[np.ndarray, "b 4"]
    ) -> tuple[Float[np.ndarray, "b 8 samples"], Float[np.ndarray, "b 8"]]:
        """Edge response at points along the visible part of each boundary, and that part's length in diagonals."""
        ends = self.camera.to_camera(box_edges(boxes, self.camera.position[1]))
        clipped, visible = self._clipped(ends)
        lengths = np.where(visible, np.linalg.norm(clipped[..., 1, :] - clipped[..., 0, :], axis=-1), 0.0)
        steps = (np.arange(self.settings.edge_samples) + 0.5) / self.settings.edge_samples
        points = clipped[..., 0, None, :] + steps[:, None] * (clipped[..., 1, :] - clipped[..., 0, :])[..., None, :]
        columns, rows = np.moveaxis((points * self.map_scale).astype(int), -1, 0)
        _, map_height, map_width = self.edge_maps.shape
        axes = EDGE_AXES[None, :, None]
        response = self.edge_maps[axes, rows.clip(0, map_height - 1), columns.clip(0, map_width - 1)]
        k = self.camera.intrinsics
        return response, lengths / np.hypot(k.width, k.height)

    def _clipped(
        self, ends: Float[np.ndarray, "b 8 2 3"]
    ) -> tuple[Float[np.ndarray, "b 8 2 2"], Bool[np.ndarray, "b 8"]]:
        """Boundaries in pixels, cut to what is before the camera and within the picture."""
        a, b = ends[..., 0, :], ends[..., 1, :]
        za, zb = a[..., 2], b[..., 2]
        span = np.where(np.abs(zb - za) < 1e-9, 1e-9, zb - za)
        cut = ((NEAR_M - za) / span)[..., None]
        at_near = a + cut * (b - a)
        start = np.where((za < NEAR_M)[..., None], at_near, a)
        end = np.where((zb < NEAR_M)[..., None], at_near, b)
        k = self.camera.intrinsics
        scale, centre = np.array([k.fx, k.fy]), np.array([k.cx, k.cy])
        p = start[..., :2] / np.maximum(start[..., 2:], NEAR_M) * scale + centre
        q = end[..., :2] / np.maximum(end[..., 2:], NEAR_M) * scale + centre
        low, high, inside = _clip_to_picture(p, q, k.width, k.height)
        clipped = np.stack([p + low[..., None] * (q - p), p + high[..., None] * (q - p)], axis=-2)
        return clipped, inside & ~((za < NEAR_M) & (zb < NEAR_M))

    def objects(self, boxes: Float[np.ndarray, "b 4"]) -> Float[np.ndarray, "b"]:
        """Negative protrusion of objects from the box: standing ones 0 to 2, hanging ones half."""
        hung = -0.5 * np.clip((self.hung_top_m - boxes[:, 3]) / (2.0 * self.settings.protrusion_scale_m), 0.0, 1.0)
        if len(self.object_low) == 0:
            return hung
        out = np.stack(
            [
                boxes[:, 0:1] - self.object_low[:, 0],
                self.object_high[:, 0] - boxes[:, 1:2],
                self.object_high[:, 1] - boxes[:, 2:3],
                self.object_high[:, 2] - boxes[:, 3:4],
            ]
        )
        cost = np.minimum(np.maximum(out, 0.0).max(axis=0) / self.settings.protrusion_scale_m, 2.0)
        return hung - (cost * self.object_weights).sum(axis=1) / self.object_weights.sum()

    def prior(self, boxes: Float[np.ndarray, "b 4"]) -> Float[np.ndarray, "b"]:
        """Log-normal preference for rooms of usual size."""
        sizes = np.stack([boxes[:, 1] - boxes[:, 0], boxes[:, 2] - self.camera.position[1], boxes[:, 3]], axis=1)
        deviation = np.log(np.maximum(sizes, 1e-3) / PRIOR_MEDIAN_M) / PRIOR_LOG_SIGMA
        # Beyond two sigma the cost grows linearly: halls and lofts exist.
        far = np.maximum(np.abs(deviation) - 2.0, 0.0)
        return -(0.5 * np.minimum(np.abs(deviation), 2.0) ** 2 + far).sum(axis=1)

    def score(self, boxes: Float[np.ndarray, "b 4"]) -> Float[np.ndarray, "b"]:
        """The objective of the search; impossible boxes get minus infinity."""
        ox, oy, oz = self.camera.position
        possible = (boxes[:, 0] < ox - 0.2) & (boxes[:, 1] > ox + 0.2) & (boxes[:, 2] > oy + 0.5)
        possible &= boxes[:, 3] > oz + 0.1
        total = self.settings.orientation_weight * self.orientation(boxes) + self.settings.edge_weight * self.edges(
            boxes
        ).sum(axis=1)
        total += self.settings.object_weight * self.objects(boxes) + self.settings.prior_weight * self.prior(boxes)
        return np.where(possible, total, -np.inf)


EDGE_AXES = np.array([1, 1, 0, 2, 2, 1, 1, 0])
"""Axis of each boundary of `box_edges`."""


def box_edges(boxes: Float[np.ndarray, "b 4"], y0: float) -> Float[np.ndarray, "b 8 2 3"]:
    """World ends of a box's boundaries: floor left, right and back, corners left and right, ceiling likewise.

    Side boundaries run from `y0` to the far wall.
    """
    x0, x1, y1, top = boxes.T
    near, zero = np.full_like(x0, y0), np.zeros_like(x0)
    a, b = np.stack([x0, y1, zero], -1), np.stack([x1, y1, zero], -1)
    c, d = np.stack([x0, y1, top], -1), np.stack([x1, y1, top], -1)
    a0, b0 = np.stack([x0, near, zero], -1), np.stack([x1, near, zero], -1)
    c0, d0 = np.stack([x0, near, top], -1), np.stack([x1, near, top], -1)
    pairs = [(a0, a), (b0, b), (a, b), (a, c), (b, d), (c0, c), (d0, d), (c, d)]
    return np.stack([np.stack(pair, axis=1) for pair in pairs], axis=1)


def _clip_to_picture(
    p: Float[np.ndarray, "*n 2"], q: Float[np.ndarray, "*n 2"], width: int, height: int
) -> tuple[Float[np.ndarray, "*n"], Float[np.ndarray, "*n"], Bool[np.ndarray, "*n"]]:
    """Where segments p..q enter and leave the picture, as shares of their length (Liang and Barsky 1984)."""
    step = q - p
    safe = np.where(np.abs(step) < 1e-9, 1e-9, step)
    first, second = -p / safe, (np.array([width, height]) - p) / safe
    low = np.minimum(first, second).max(axis=-1).clip(0.0, 1.0)
    high = np.maximum(first, second).min(axis=-1).clip(0.0, 1.0)
    return low, high, high > low


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
    free = ~_inside_masks(segments, standing, rgb.shape[:2])
    map_scale = min(1.0, settings.map_side_px / max(rgb.shape[:2]))
    middle = 0.5 * (segments[:, :2] + segments[:, 2:])
    directions, ray_axes, weights = _surface_rays(segments[free], axes[free], camera)
    hung = {o.id for o in objects if category(o.category).mount == "ceiling"}
    solid = [c for c in cuboids if not _on_wall(c, objects)]
    corners = np.array([c.corners_world for c in solid]).reshape(-1, 8, 3)
    backed = [c for c in cuboids if _category_of(c, objects) in BACKED]
    backs = np.array([c.corners_world for c in backed]).reshape(-1, 8, 3)
    oblique = oblique[~_inside_masks(oblique, standing, rgb.shape[:2])]
    slants = _slants(oblique, segments[free], camera, settings)
    return RoomCues(
        camera=camera,
        directions=directions,
        ray_axes=ray_axes,
        ray_weights=weights,
        edge_maps=_edge_maps(segments, axes, objects, rgb.shape[:2], map_scale, settings),
        map_scale=map_scale,
        segment_rays=camera.rays(middle[free]),
        segment_axes=axes[free],
        object_low=corners.min(axis=1),
        object_high=corners.max(axis=1),
        object_weights=np.array(
            [max(c.confidence, 0.1) * (1.0 if c.foot_seen else settings.unseen_foot) for c in solid]
        ),
        object_portable=np.array([_is_portable(c, objects) for c in solid], dtype=bool),
        backed_low=backs.min(axis=1),
        backed_high=backs.max(axis=1),
        backed_weights=np.array([c.confidence for c in backed]),
        hung_top_m=max((float(c.corners_world[:, 2].max()) for c in cuboids if c.object_id in hung), default=0.0),
        slants_rad=tuple(angle for angle, _ in slants),
        slant_maps=tuple(
            _edge_map(oblique[rows_of_direction], objects, rgb.shape[:2], map_scale, settings=settings)
            for _, rows_of_direction in slants
        ),
        settings=settings,
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


def _on_wall(cuboid: Cuboid, objects: tuple[DetectedObject, ...]) -> bool:
    return _category_of(cuboid, objects) in _WALL_CATEGORIES


def _is_portable(cuboid: Cuboid, objects: tuple[DetectedObject, ...]) -> bool:
    name = _category_of(cuboid, objects)
    return name in PORTABLE or category(name).mount == "surface"


def _category_of(cuboid: Cuboid, objects: tuple[DetectedObject, ...]) -> str:
    return next((o.category for o in objects if o.id == cuboid.object_id), UNKNOWN.name)


def _inside_masks(
    segments: Float[np.ndarray, "n 4"], objects: list[DetectedObject], shape: tuple[int, ...]
) -> Bool[np.ndarray, "n"]:
    """Segments whose middle or both ends lie on a standing object."""
    if not objects or len(segments) == 0:
        return np.zeros(len(segments), dtype=bool)
    union = np.any([o.mask for o in objects], axis=0).astype(np.uint8)
    union = cv2.dilate(union, np.ones((5, 5), np.uint8)).astype(bool)

    def covered(points: np.ndarray) -> np.ndarray:
        columns, rows = points.astype(int).T
        return union[rows.clip(0, shape[0] - 1), columns.clip(0, shape[1] - 1)]

    ends = covered(segments[:, :2]) & covered(segments[:, 2:])
    return covered(0.5 * (segments[:, :2] + segments[:, 2:])) | ends


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


def _edge_maps(
    segments: Float[np.ndarray, "n 4"],
    axes: Int[np.ndarray, "n"],
    objects: tuple[DetectedObject, ...],
    shape: tuple[int, ...],
    scale: float,
    settings: RoomCueSettings,
) -> Float32[np.ndarray, "3 hm wm"]:
    """For each axis, how near the nearest segment along it is: a Gaussian of the distance, neutral on objects."""
    return np.stack(
        [
            _edge_map(segments[axes == axis], objects, shape, scale, level=axis < 2, settings=settings)
            for axis in range(3)
        ]
    )


def _edge_map(
    segments: Float[np.ndarray, "n 4"],
    objects: tuple[DetectedObject, ...],
    shape: tuple[int, ...],
    scale: float,
    *,
    level: bool = True,
    settings: RoomCueSettings,
) -> Float32[np.ndarray, "hm wm"]:
    """Edges of one direction's segments; level ones say less where they crowd, as bricks' and boards' do."""
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
