"""How well a room's planes agree with the true ones: in the picture, in depth, in space, and plane by plane.

The picture metrics follow Stekovic et al. 2020 ("General 3D Room Layout from a Single View by Render-and-Compare"),
the others Diorama, section 4. All compare the empty rooms, so what stands in them does not count.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from diorama_core.geometry.casting import camera_rays, cast_planes
from diorama_core.geometry.planes import is_in_plane_polygon, plane_rectangle
from diorama_core.scene.types import Camera, Plane

VIEW_STEP = 2
"""Every second pixel both ways is compared."""
VISIBLE_SHARE = 0.01
"""Planes that cover less of the picture than this are ignored in scores."""
SAMPLE_M = 0.05
"""Spacing of the points that stand for a plane in space."""
SAME_DEPTH = 0.02
"""A point is seen when nothing lies before it by more than this share of its distance."""


@dataclass(frozen=True, eq=False)
class LayoutView:
    """The empty room as a camera sees it, on a grid of pixels."""

    labels: Int[np.ndarray, "h w"]
    """Index of the plane that is seen; -1 where there is none."""
    depth_m: Float[np.ndarray, "h w"]
    """z in the camera; `inf` where there is none."""


@dataclass(frozen=True)
class ArchitectureScores:
    """One room against the truth."""

    iou: float
    """Mean intersection over union of matched plane segments, 0 to 1; unmatched ones on either side count as 0."""
    pixel_error: float
    """Share of the picture that shows another plane than it should, 0 to 1."""
    edge_error_px: float
    """Symmetric chamfer distance between the edges of the two layouts, photo pixels."""
    depth_rmse_m: float
    """Error of the layouts' depths, where both have one."""
    cdb_m: float
    """Chamfer distance between all planes in space after both rooms are centred on their bounding boxes.

    What lies behind the camera counts: a room without its fourth wall is far from one with it.
    """
    cdb_seen_m: float
    """Distance of what the picture shows of either room; 0 for a perfect reading of the picture."""
    recall: float
    """Share of the visible true planes that were found, within the given tolerances."""
    precision: float
    """Share of the visible found planes that are true ones."""
    angle_deg: float
    """Largest deviation of a found plane's normal."""
    offset_m: float
    """Largest distance of a found plane from the middle of the true plane's visible part."""


def architecture_scores(
    estimated: tuple[Plane, ...],
    true: tuple[Plane, ...],
    camera: Camera,
    *,
    found_camera: Camera | None = None,
    angle_deg: float = 5.0,
    offset_m: float = 0.15,
) -> ArchitectureScores:
    """Every metric of one room.

    Args:
        estimated: The reconstructed planes.
        true: The true planes.
        camera: The true camera, in the world of `true`.
        found_camera: The camera of the reconstruction, in the world of `estimated`; the true one by default.
        angle_deg: Tolerance within which a plane counts as found.
        offset_m: Likewise, of its distance.
    """
    seen_by = found_camera or camera
    aligned = estimated if found_camera is None else tuple(_align_plane(p, seen_by, camera) for p in estimated)
    a, b = layout_view(estimated, seen_by), layout_view(true, camera)
    if a.labels.shape != b.labels.shape:
        raise ValueError("the two cameras must have pictures of one size")
    planes = match_planes(aligned, true, camera, angle_deg=angle_deg, offset_m=offset_m)
    return ArchitectureScores(
        iou=segment_iou(a.labels, b.labels),
        pixel_error=pixel_error(a.labels, b.labels),
        edge_error_px=edge_error(a.labels, b.labels) * VIEW_STEP,
        depth_rmse_m=depth_rmse(a.depth_m, b.depth_m),
        cdb_m=centred_chamfer(plane_points(aligned), plane_points(true)),
        cdb_seen_m=centred_chamfer(
            _move(visible_points(estimated, seen_by), seen_by, camera), visible_points(true, camera)
        ),
        recall=planes.recall,
        precision=planes.precision,
        angle_deg=max((m.angle_deg for m in planes.matches), default=0.0),
        offset_m=max((m.offset_m for m in planes.matches), default=0.0),
    )


def layout_view(planes: tuple[Plane, ...], camera: Camera) -> LayoutView:
    """The empty room seen through every `VIEW_STEP`-th pixel."""
    origin, rays = camera_rays(camera, VIEW_STEP)
    depth, labels = cast_planes(origin, rays, planes)
    return LayoutView(labels, depth)


def segment_pairs(
    estimated: Int[np.ndarray, "h w"], true: Int[np.ndarray, "h w"]
) -> tuple[tuple[tuple[int, int, float], ...], int, int]:
    """Segments matched one to one, the pair of largest overlap first (Stekovic et al. 2020).

    Returns:
        (found label, true label, intersection over union) of each pair, and the number of segments on each side.
    """
    ours, theirs = (sorted(set(np.unique(labels).tolist()) - {-1}) for labels in (estimated, true))
    overlap = np.zeros((len(ours), len(theirs)))
    for i, a in enumerate(ours):
        for j, b in enumerate(theirs):
            either = ((estimated == a) | (true == b)).sum()
            overlap[i, j] = ((estimated == a) & (true == b)).sum() / max(int(either), 1)
    pairs: list[tuple[int, int, float]] = []
    while overlap.size and overlap.max() > 0:
        i, j = divmod(int(overlap.argmax()), len(theirs))
        pairs.append((ours[i], theirs[j], float(overlap[i, j])))
        overlap[i, :] = overlap[:, j] = 0.0
    return tuple(pairs), len(ours), len(theirs)


def segment_iou(labels: Int[np.ndarray, "h w"], true: Int[np.ndarray, "h w"]) -> float:
    """2 / (M + N) times the sum of the matched segments' overlaps; 1 when both are empty."""
    pairs, ours, theirs = segment_pairs(labels, true)
    return 2.0 * sum(p[2] for p in pairs) / (ours + theirs) if ours + theirs else 1.0


def pixel_error(labels: Int[np.ndarray, "h w"], true: Int[np.ndarray, "h w"]) -> float:
    """Share of the pixels with a true plane whose found plane is not the one matched to it."""
    counted = true >= 0
    right = np.zeros(true.shape, dtype=bool)
    for ours, theirs, _ in segment_pairs(labels, true)[0]:
        right |= (labels == ours) & (true == theirs)
    return float((counted & ~right).sum() / max(int(counted.sum()), 1))


def layout_edges(labels: Int[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """Pixels whose right or lower neighbour shows another plane."""
    edges = np.zeros(labels.shape, dtype=bool)
    edges[:, :-1] |= labels[:, 1:] != labels[:, :-1]
    edges[:-1] |= labels[1:] != labels[:-1]
    return edges


def edge_error(labels: Int[np.ndarray, "h w"], true: Int[np.ndarray, "h w"]) -> float:
    """Mean distance from the edges of either layout to the nearest of the other, both ways averaged, in samples.

    Without any edge on one side only, the picture's diagonal; without any at all, 0.
    """
    a, b = layout_edges(labels), layout_edges(true)
    if not (a.any() or b.any()):
        return 0.0
    if not (a.any() and b.any()):
        return float(np.hypot(*labels.shape))
    to_a, to_b = (cv2.distanceTransform((~e).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE) for e in (a, b))
    return float(0.5 * (to_b[a].mean() + to_a[b].mean()))


def depth_rmse(found_m: Float[np.ndarray, "h w"], true_m: Float[np.ndarray, "h w"]) -> float:
    """Root mean square of the depths' difference where both layouts have one; `nan` where none does."""
    both = np.isfinite(found_m) & np.isfinite(true_m)
    return float(np.sqrt(np.mean((found_m[both] - true_m[both]) ** 2))) if both.any() else float("nan")


def plane_points(planes: tuple[Plane, ...], spacing_m: float = SAMPLE_M) -> Float[np.ndarray, "n 3"]:
    """Points spread evenly over planes."""
    points = [np.zeros((0, 3))]
    for plane in planes:
        origin, axes, extents = plane_rectangle(plane)
        steps = [(np.arange(n) + 0.5) * (e / n) for e in extents for n in [max(1, round(float(e) / spacing_m))]]
        grid = np.stack(np.meshgrid(*steps), axis=-1).reshape(-1, 2)
        on_plane = origin + grid @ axes.T
        points.append(on_plane[is_in_plane_polygon(on_plane, plane)])
    return np.concatenate(points)


def visible_points(planes: tuple[Plane, ...], camera: Camera) -> Float[np.ndarray, "n 3"]:
    """Those of the points spread over planes that are in the picture and have no other plane before them."""
    points = plane_points(planes, SAMPLE_M)
    local, k = camera.to_camera(points), camera.intrinsics
    ahead = local[:, 2] > 1e-6
    points, local = points[ahead], local[ahead]
    uv = local[:, :2] / local[:, 2:] * [k.fx, k.fy] + [k.cx, k.cy]
    inside = ((uv >= 0) & (uv < [k.width, k.height])).all(axis=1)
    points = points[inside]
    first, _ = cast_planes(camera.position, points - camera.position, planes)  # a ray reaches its own point at 1
    return points[first >= 1.0 - SAME_DEPTH]


def _move(points: Float[np.ndarray, "n 3"], from_camera: Camera, to_camera: Camera) -> Float[np.ndarray, "n 3"]:
    """Points that lie to the second camera as they did to the first."""
    T = to_camera.T_world_camera @ from_camera.T_camera_world
    return points @ T[:3, :3].T + T[:3, 3]


def centred_chamfer(points: Float[np.ndarray, "n 3"], true: Float[np.ndarray, "m 3"]) -> float:
    """Sum of both mean nearest distances after each set is moved to the centre of its bounding box (CDb).

    `nan` when either set is empty.
    """
    if not (len(points) and len(true)):
        return float("nan")
    a, b = (p - 0.5 * (p.min(axis=0) + p.max(axis=0)) for p in (points, true))
    return float(np.mean(cKDTree(b).query(a)[0]) + np.mean(cKDTree(a).query(b)[0]))


@dataclass(frozen=True)
class PlaneMatch:
    """A found plane and the true one that it is."""

    found_id: str
    true_id: str
    angle_deg: float
    offset_m: float


@dataclass(frozen=True)
class PlaneMatches:
    """Which planes were found, missed and made up, among those that can be seen."""

    matches: tuple[PlaneMatch, ...]
    missed: tuple[str, ...]
    spurious: tuple[str, ...]

    @property
    def recall(self) -> float:
        """Share of the true planes that were found; 1 when there is none."""
        count = len(self.matches) + len(self.missed)
        return len(self.matches) / count if count else 1.0

    @property
    def precision(self) -> float:
        """Share of the found planes that are true; 1 when there is none."""
        count = len(self.matches) + len(self.spurious)
        return len(self.matches) / count if count else 1.0


def match_planes(
    planes: tuple[Plane, ...], true: tuple[Plane, ...], camera: Camera, *, angle_deg: float, offset_m: float
) -> PlaneMatches:
    """Pairs of planes of one role that agree within both tolerances, as many as possible, each used once.

    The offset is measured at the middle of what is seen of the true plane, where it matters.

    Args:
        planes: Planes of the estimate.
        true: Planes of the truth.
        camera: The photo's.
        angle_deg: Tolerance of normals.
        offset_m: Tolerance of offsets.
    """
    ours, theirs = _visible(planes, camera), _visible(true, camera)
    angles = np.zeros((len(ours), len(theirs)))
    offsets = np.zeros_like(angles)
    for i, (a, _) in enumerate(ours):
        for j, (b, middle) in enumerate(theirs):
            angles[i, j] = np.rad2deg(np.arccos(np.clip(a.normal @ b.normal, -1.0, 1.0)))
            offsets[i, j] = abs(float(a.normal @ middle) - a.offset)
    alike = np.array([[a.role == b.role for b, _ in theirs] for a, _ in ours]).reshape(angles.shape)
    fits = alike & (angles <= angle_deg) & (offsets <= offset_m)
    cost = np.where(fits, angles / angle_deg + offsets / offset_m, 1e3)
    pairs = [(i, j) for i, j in zip(*linear_sum_assignment(cost), strict=True) if fits[i, j]]
    matches = tuple(
        PlaneMatch(ours[i][0].id, theirs[j][0].id, float(angles[i, j]), float(offsets[i, j])) for i, j in pairs
    )
    used_ours, used_theirs = {i for i, _ in pairs}, {j for _, j in pairs}
    return PlaneMatches(
        matches,
        missed=tuple(p.id for j, (p, _) in enumerate(theirs) if j not in used_theirs),
        spurious=tuple(p.id for i, (p, _) in enumerate(ours) if i not in used_ours),
    )


def _visible(planes: tuple[Plane, ...], camera: Camera) -> list[tuple[Plane, Float[np.ndarray, "3"]]]:
    """Planes that are seen in enough of the picture, with the middle of what is seen of each."""
    origin, rays = camera_rays(camera, 2 * VIEW_STEP)
    depth, labels = cast_planes(origin, rays, planes)
    seen = []
    for index, plane in enumerate(planes):
        mine = labels == index
        if mine.mean() >= VISIBLE_SHARE:
            seen.append((plane, (origin + depth[mine][:, None] * rays[mine]).mean(axis=0)))
    return seen


def _align_plane(plane: Plane, from_camera: Camera, to_camera: Camera) -> Plane:
    """A plane moved so that it lies to the second camera as it did to the first."""
    polygon = _move(plane.polygon, from_camera, to_camera)
    return Plane(plane.id, plane.role, polygon, plane.thickness, confidence=plane.confidence)
