"""What measured depth says about one object, ready for fitting shapes to it: its points, and the walls measured around
it, through which no pose may reach.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.arrangement.facing.evidence import WallSamples
from diorama_core.artefacts import Cuboid, DepthMap
from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.library.record import SymmetryFold
from diorama_core.pose.depth_fit import Contact, DepthFit, SeenOutline, SeenPoints
from diorama_core.pose.hypotheses import Anchor, Hypotheses
from diorama_core.pose.limits import SizeLimits
from diorama_core.pose.mask_observations import Evidence
from diorama_core.pose.settings import SETTINGS, PoseEvidenceSettings, PoseSearchSettings, PoseSettings
from diorama_core.scene.types import Camera, yaw_rotation

_ALL_WAYS = ((False, False), (True, False), (False, True), (True, True))


@dataclass(frozen=True, eq=False)
class MeasuredObject:
    """One object's measured points, outline and where it stands."""

    observations: Evidence
    cuboid: Cuboid
    contact: Contact
    points: SeenPoints
    outline: SeenOutline | None
    bounds: WallBounds
    settings: PoseSearchSettings

    @classmethod
    def of(
        cls,
        mask: Bool[np.ndarray, "h w"],
        observations: Evidence,
        cuboid: Cuboid,
        anchor: Anchor,
        walls: WallSamples,
        floor_foot_m: float | None = None,
        settings: PoseSettings = SETTINGS,
    ) -> MeasuredObject | None:
        """What can be used of the depth under a mask; None where hardly any was measured.

        Args:
            mask: the object's visible pixels.
            observations: what is known of it.
            cuboid: its box.
            anchor: the face of the box that touches what holds it.
            walls: where walls were measured.
            floor_foot_m: for objects on the floor, whose height is known even where they hide it: the height at which
                their lowest pixels were measured.
        """
        if observations.surface is None:
            return None
        points = SeenPoints.of(
            observations.seen,
            observations.surface.depth_m,
            observations.surface.weight,
            observations.surface.spread_m,
            settings.search,
        )
        if len(points.depth_m) < settings.search.min_rays:
            return None
        outline = SeenOutline.of(observations.seen, mask, settings.search)
        contact = _contact(anchor, floor_foot_m, points, outline, settings.search)
        # What hangs on a wall may be set into it.
        bounds = WallBounds.of(walls, points, settings.evidence) if anchor.axis_world[2] > 0.5 else NO_BOUNDS
        return cls(observations, cuboid, contact, points, outline, bounds, settings.search)

    def fit(self, limits: SizeLimits) -> DepthFit:
        """The fit of a shape with these limits."""
        return DepthFit(
            self.observations.camera,
            self.observations.seen,
            self.points,
            self.outline,
            self.contact,
            limits,
            settings=self.settings,
        )

    def log_likelihood(self, poses: PoseBatch, limits: SizeLimits) -> Float[np.ndarray, " p"]:
        """What the places where it stands and where it cannot be say of poses."""
        size_m = limits.shape_size_m
        return self.contact.log_likelihood(poses, size_m) + self.bounds.log_likelihood(poses, size_m)

    def elsewhere_cost(
        self, poses: PoseBatch, limits: SizeLimits, errors: Float[np.ndarray, " p"]
    ) -> Float[np.ndarray, " p"]:
        """What speaks against poses away from the measured box, the more the worse they agree with the picture.

        A shape that fits badly wherever it is put does not tell where its thing is; then the box does.

        Args:
            poses: of the shape.
            limits: its size.
            errors: 0 to 1 (`Evidence.errors`).
        """
        iou = _upright_iou(poses, limits.shape_size_m, self.cuboid, self.settings)
        return self.settings.elsewhere * self.cuboid.confidence * errors**2 * (1.0 - iou)

    def hypotheses(self, symmetry: SymmetryFold, limits: SizeLimits) -> Hypotheses:
        """Turns all around, each set against the measured points; where a part may be hidden, also from behind."""
        count = max(self.settings.turns // symmetry, 1)
        turns = np.arange(count) * 2 * np.pi / (symmetry * count)
        R = np.array([self.cuboid.R_world_object @ yaw_rotation(angle) for angle in turns])
        fit = self.fit(limits)
        ways = _ALL_WAYS if self.partly_hidden else _ALL_WAYS[:1]
        poses = [fit.starts(R, far) for far in ways]
        quarter = np.mod(turns + np.pi / 4, np.pi / 2) - np.pi / 4
        batch = poses[0]
        for more in poses[1:]:
            batch = batch.and_also(more)
        return Hypotheses(batch, np.tile(np.abs(quarter), len(ways)), np.zeros(count * len(ways)))

    @property
    def partly_hidden(self) -> bool:
        """Whether the picture's border or something nearer may hide a part."""
        return self.outline is None or not self.outline.known.all()

    def turn_by_quarters(self, best: PoseBatch, symmetry: SymmetryFold, limits: SizeLimits) -> PoseBatch:
        """A pose turned by quarters in its place, each turn that the symmetry tells apart, at an even scale.

        Axes along which the shape is thin keep their scale.

        Args:
            best: one pose.
            symmetry: number of turns about the up axis that leave the shape as it is.
            limits: which axes keep their scale, because the shape is thin along them.
        """
        turns = np.arange(1, max(4 // symmetry, 1)) * np.pi / 2
        R = np.array([best.R[0] @ yaw_rotation(angle) for angle in turns]).reshape(-1, 3, 3)
        even = np.exp(np.log(best.scale[0][~limits.thin]).mean()) if not limits.thin.all() else 1.0
        scale = np.where(limits.thin, best.scale[0], even)
        return PoseBatch(R, np.tile(best.position[0], (len(R), 1)), np.tile(scale, (len(R), 1)))


def _upright_iou(
    poses: PoseBatch, shape_size_m: Float[np.ndarray, "3"], cuboid: Cuboid, settings: PoseSearchSettings
) -> Float[np.ndarray, " p"]:
    """Intersection over union of poses' boxes with a cuboid, all upright; of their plans by a grid of points."""
    steps = (np.arange(settings.fit_steps) + 0.5) / settings.fit_steps - 0.5
    grid = np.stack(np.meshgrid(steps, steps, [0.0]), axis=-1).reshape(-1, 3)
    size, half = poses.scale * shape_size_m, 0.5 * cuboid.size_m
    points = poses.position[:, None] + np.einsum("pij,pkj->pki", poses.R, size[:, None] * grid)
    inside = (np.abs((points - cuboid.centre) @ cuboid.R_world_object)[..., :2] <= half[:2]).all(axis=2).mean(axis=1)
    low = np.maximum(poses.position[:, 2] - 0.5 * size[:, 2], cuboid.centre[2] - half[2])
    high = np.minimum(poses.position[:, 2] + 0.5 * size[:, 2], cuboid.centre[2] + half[2])
    shared = inside * size[:, 0] * size[:, 1] * np.maximum(high - low, 0.0)
    return np.asarray(shared / (size.prod(axis=1) + float(np.prod(cuboid.size_m)) - shared))


def foot_height_m(
    depth: DepthMap, mask: Bool[np.ndarray, "h w"], camera: Camera, settings: PoseSearchSettings = SETTINGS.search
) -> float | None:
    """Height in the world of the lowest measured pixels of a mask; None where hardly any was measured.

    Legs have too few points to count among those of the whole object, but their ends are the lowest of its mask.

    Args:
        depth: z in camera in metres.
        mask: of the object.
        camera: in the world.
        settings: number of pixels that are the lowest.
    """
    rows, columns = np.nonzero(mask & (depth.depth_m > 0))
    if len(rows) < settings.foot_px:
        return None
    lowest = np.argsort(rows, kind="stable")[-settings.foot_px :]
    pixels = np.column_stack([columns[lowest] + 0.5, rows[lowest] + 0.5])
    metres = depth.depth_m[rows[lowest], columns[lowest]].astype(np.float64)
    return float(np.median(camera.position[2] + metres * camera.rays(pixels)[:, 2]))


def _contact(
    anchor: Anchor,
    floor_foot_m: float | None,
    points: SeenPoints,
    outline: SeenOutline | None,
    settings: PoseSearchSettings,
) -> Contact:
    """Where the object stands: where the cuboid ends, unless its own lower end is seen elsewhere or is hidden."""
    if anchor.axis_world[2] < 0.5 or outline is None or len(points.depth_m) < 12:
        return Contact(anchor, settings.sure_contact_m, settings)
    lowest = float(points.span(np.eye(3)[None])[0][0, 2])
    gap = lowest - float(anchor.point_world[2])
    noise_m = 0.0
    if floor_foot_m is not None:
        noise_m = settings.noise_reach * float(np.median(points.spread_m))
        gap = min(gap, floor_foot_m - float(anchor.point_world[2]))
    if abs(gap) < settings.floats_m + noise_m or (floor_foot_m is not None and not outline.lower_end_seen):
        return Contact(anchor, settings.sure_contact_m, settings)
    seen = replace(anchor, point_world=np.array([*anchor.point_world[:2], float(anchor.point_world[2]) + gap]))
    if outline.lower_end_seen or gap < 0:
        return Contact(seen, 1.5 * settings.sure_contact_m, settings)
    return Contact(anchor, 0.5 * gap, settings)


@dataclass(frozen=True, eq=False)
class WallBounds:
    """Points of the walls that an object is in front of."""

    walls: WallSamples
    settings: PoseEvidenceSettings = SETTINGS.evidence

    @classmethod
    def of(
        cls, walls: WallSamples, points: SeenPoints, settings: PoseEvidenceSettings = SETTINGS.evidence
    ) -> WallBounds:
        """The walls near an object that none of its measured points is behind."""
        xy = points.points_world[:, :2]
        middle, reach = xy.mean(axis=0), np.ptp(xy, axis=0).max() + 2.0
        near = np.flatnonzero(np.linalg.norm(walls.points_xy - middle, axis=1) < reach)
        near = near[:: max(1, -(-len(near) // settings.max_samples))]
        at, normals = walls.points_xy[near], walls.normals_xy[near]
        behind = (normals @ xy.T) - (normals * at).sum(axis=1, keepdims=True) < -settings.wall_sigma_m
        bounding = behind.mean(axis=1) < settings.seen_behind_share
        return cls(WallSamples(at[bounding], normals[bounding]), settings)

    def penetration_m(self, poses: PoseBatch, shape_size_m: Float[np.ndarray, "3"]) -> Float[np.ndarray, " p"]:
        """Depth to which the lower corners of poses' boxes reach through walls; 0 where they reach through none."""
        at, normals = self.walls.points_xy, self.walls.normals_xy
        if len(at) == 0:
            return np.zeros(len(poses))
        half = 0.5 * poses.scale * shape_size_m
        signs = np.array([[1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, -1.0]])
        corners = poses.position[:, None] + np.einsum("pij,pkj->pki", poses.R, half[:, None] * signs)
        offset = corners[..., None, :2] - at
        depth = -(offset * normals).sum(axis=-1)
        beside = np.abs(offset[..., 0] * normals[:, 1] - offset[..., 1] * normals[:, 0])
        met = (beside < self.settings.beside_m) & (depth > 0.0)
        return np.where(met, depth, 0.0).max(axis=(1, 2))

    def log_likelihood(self, poses: PoseBatch, shape_size_m: Float[np.ndarray, "3"]) -> Float[np.ndarray, " p"]:
        """What the walls say of poses: the layout will bring them into the room, away from where they were seen."""
        return (
            -0.5
            * np.minimum(
                self.penetration_m(poses, shape_size_m) / self.settings.wall_sigma_m, self.settings.max_wall_sigmas
            )
            ** 2
        )


NO_BOUNDS = WallBounds(WallSamples(np.zeros((0, 2)), np.zeros((0, 2))))
