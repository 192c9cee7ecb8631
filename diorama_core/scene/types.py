"""The scene: one immutable value that the whole product reads and edits.

Meshes and pictures live outside, by id, so that a scene is small, snapshots are cheap and undo is a list of
scenes. Frames and units: `diorama_core.scene.frames`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from jaxtyping import Float

from diorama_core.scene.belief import Belief
from diorama_core.scene.frames import UP_WORLD
from diorama_core.scene.light_settings import PHOTO_LIGHT, LightSettings
from diorama_core.scene.values import ArrayValue, Vector3, read_only_array

PlaneRole = Literal["floor", "ceiling", "wall"]
Relation = Literal["placed on", "mounted on"]
FaceName = Literal["bottom", "top", "front", "back", "left", "right"]
Finish = Literal["matt", "satin", "gloss", "metal"]
TextureLayout = Literal["front", "top", "tiled"]
"""A picture over the whole slot, seen from the front or from above, or one that repeats."""
SurfacePattern = Literal[
    "paint", "plaster", "stripes", "dots", "leaves", "panelling", "tiles", "metro", "checker", "brick", "boards",
    "parquet", "herringbone", "carpet",
]  # fmt: skip
"""What a plane can be finished with (`diorama_core.appearance.surface_finish`)."""
MaterialSource = Literal["photo", "library"]
SEEN_CONFIDENCE = 0.35
"""Planes of at least this confidence were observed."""


@dataclass(frozen=True)
class Intrinsics:
    """A pinhole camera's inner geometry, in pixels of a `width` x `height` image."""

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float

    def __post_init__(self) -> None:
        numbers = (self.width, self.height, self.fx, self.fy)
        if not all(np.isfinite(n) and n > 0 for n in numbers) or not np.isfinite([self.cx, self.cy]).all():
            raise ValueError("image size and focal lengths must be positive, the centre finite")

    @classmethod
    def from_fov(cls, width: int, height: int, horizontal_fov_rad: float) -> Intrinsics:
        """Square pixels, centred principal point, and the given horizontal field of view.

        Args:
            width: in pixels.
            height: in pixels.
            horizontal_fov_rad: full angle.
        """
        focal = 0.5 * width / float(np.tan(0.5 * horizontal_fov_rad))
        return cls(width, height, focal, focal, width / 2, height / 2)

    @property
    def matrix(self) -> Float[np.ndarray, "3 3"]:
        """K, with `pixel = K @ p_camera / z`."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    @property
    def horizontal_fov_rad(self) -> float:
        """Full horizontal field of view."""
        return float(np.arctan2(self.cx, self.fx) + np.arctan2(self.width - self.cx, self.fx))

    @property
    def vertical_fov_rad(self) -> float:
        """Full vertical field of view."""
        return float(np.arctan2(self.cy, self.fy) + np.arctan2(self.height - self.cy, self.fy))

    def resize(self, width: int, height: int) -> Intrinsics:
        """This camera for the picture resized to `width` x `height`."""
        sx, sy = width / self.width, height / self.height
        return Intrinsics(width, height, self.fx * sx, self.fy * sy, self.cx * sx, self.cy * sy)


@dataclass(frozen=True, eq=False)
class Camera(ArrayValue):
    """A posed pinhole camera."""

    intrinsics: Intrinsics
    T_world_camera: Float[np.ndarray, "4 4"]
    """Rigid: `p_world = T_world_camera @ p_camera`, camera axes x right, y down, z forward."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "T_world_camera", read_only_array(self.T_world_camera, (4, 4)))

    @cached_property
    def T_camera_world(self) -> Float[np.ndarray, "4 4"]:
        """Inverse of `T_world_camera`."""
        R, t = self.T_world_camera[:3, :3], self.T_world_camera[:3, 3]
        return rigid(R.T, -R.T @ t)

    @property
    def position(self) -> Float[np.ndarray, "3"]:
        """Optical centre in the world."""
        return self.T_world_camera[:3, 3]

    def resize(self, width: int, height: int) -> Camera:
        """This camera for the picture resized to `width` x `height`."""
        return Camera(self.intrinsics.resize(width, height), self.T_world_camera)

    def to_camera(self, points_world: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
        """World points in camera coordinates."""
        T = self.T_camera_world
        return np.asarray(points_world) @ T[:3, :3].T + T[:3, 3]

    def project(self, points_world: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 2"]:
        """World points in pixels; meaningless (but finite) for points behind the camera."""
        p = self.to_camera(points_world)
        z = np.where(np.abs(p[..., 2]) < 1e-9, 1e-9, p[..., 2])
        k = self.intrinsics
        return np.stack([k.fx * p[..., 0] / z + k.cx, k.fy * p[..., 1] / z + k.cy], axis=-1)

    def rays(self, pixels: Float[np.ndarray, "*n 2"]) -> Float[np.ndarray, "*n 3"]:
        """World directions through pixels, scaled so that one unit is one metre of depth (z)."""
        k, uv = self.intrinsics, np.asarray(pixels, dtype=np.float64)
        camera = np.stack([(uv[..., 0] - k.cx) / k.fx, (uv[..., 1] - k.cy) / k.fy, np.ones(uv.shape[:-1])], axis=-1)
        return camera @ self.T_world_camera[:3, :3].T


@dataclass(frozen=True, eq=False)
class Pose(ArrayValue):
    """Nine degrees of freedom: `p_world = R @ (scale * p_object) + position`."""

    R_world_object: Float[np.ndarray, "3 3"]
    position: Float[np.ndarray, "3"]
    """Centre of the object's bounding box in the world, metres."""
    scale: Float[np.ndarray, "3"]
    """Per-axis scale of the shape along its own axes; positive."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "R_world_object", read_only_array(self.R_world_object, (3, 3)))
        object.__setattr__(self, "position", read_only_array(self.position, (3,)))
        object.__setattr__(self, "scale", read_only_array(self.scale, (3,)))
        R = self.R_world_object
        if not (np.abs(R).max() < 2.0 and np.abs(R @ R.T - np.eye(3)).max() < 1e-5 and np.linalg.det(R) > 0):
            raise ValueError("the rotation must be orthonormal and right-handed")
        if (self.scale <= 0).any():
            raise ValueError("scale must be positive")

    @classmethod
    def upright(cls, position: Vector3, yaw_rad: float = 0.0, scale: Vector3 = (1.0, 1.0, 1.0)) -> Pose:
        """A pose turned by `yaw_rad` about world up, so that the front points to (cos yaw, sin yaw, 0).

        Args:
            position: world, metres.
            yaw_rad: heading, 0 along +X.
            scale: along the axes of the object.
        """
        return cls(yaw_rotation(yaw_rad), np.asarray(position, np.float64), np.asarray(scale, np.float64))

    @property
    def T_world_object(self) -> Float[np.ndarray, "4 4"]:
        """The rigid part, without scale."""
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = self.R_world_object, self.position
        return T

    @property
    def matrix(self) -> Float[np.ndarray, "4 4"]:
        """Rigid part and scale: maps shape vertices to the world."""
        T = self.T_world_object
        T[:3, :3] = T[:3, :3] * self.scale
        return T

    @property
    def yaw_rad(self) -> float:
        """Heading of the front axis about world up."""
        front = self.R_world_object[:, 0]
        return float(np.arctan2(front[1], front[0]))

    def apply(self, points_object: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
        """Shape points in the world."""
        return (np.asarray(points_object) * self.scale) @ self.R_world_object.T + self.position

    def move(self, offset_world: Vector3) -> Pose:
        """The pose shifted by a world offset."""
        return replace(self, position=self.position + np.asarray(offset_world, dtype=np.float64))


def rigid(R: Float[np.ndarray, "3 3"], t: Float[np.ndarray, "3"]) -> Float[np.ndarray, "4 4"]:
    """`p -> R @ p + t` as one matrix."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, t
    return T


def yaw_rotation(yaw_rad: float) -> Float[np.ndarray, "3 3"]:
    """Rotation about world up."""
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


@dataclass(frozen=True)
class SurfaceFinish:
    """What a person finished a wall, the floor or the ceiling with."""

    pattern: SurfacePattern
    colour: tuple[float, float, float]
    """sRGB, 0 to 1."""
    scale: float = 1.0
    """Size of the pattern relative to its usual one."""
    direction_rad: float = 0.0
    """Turn of the pattern about the plane's normal, counter-clockwise seen from inside the room."""


@dataclass(frozen=True, eq=False)
class Plane(ArrayValue):
    """One bounded flat piece of the room: a polygon with a thickness behind it."""

    id: str
    role: PlaneRole
    polygon: Float[np.ndarray, "n 3"]
    """Corners in the world, coplanar, counter-clockwise seen from inside the room."""
    thickness: float = 0.05
    """Metres, extruded away from the room."""
    colour: tuple[float, float, float] = (0.86, 0.85, 0.83)
    """Linear-free sRGB, 0 to 1: the plain material."""
    texture: str | None = None
    """Name of the plane's rectified picture among the project's files, if it has one."""
    confidence: float = 1.0
    """How far the evidence supports it, 0 (a guess) to 1 (measured)."""
    finish: SurfaceFinish | None = None
    """What a person finished it with; `colour` and `texture` are then the finish's."""
    photo_colour: tuple[float, float, float] | None = None
    """Its colour without the finish; None where there is no finish."""
    photo_texture: str | None = None
    """Name of its picture without the finish."""
    sigma_m: float | None = None
    """Standard deviation of its place along the normal; 0 where a person put it, None where nothing is known."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "polygon", read_only_array(self.polygon, (-1, 3)))
        if len(self.polygon) < 3:
            raise ValueError(f"plane {self.id} needs at least three corners")

    @property
    def is_seen(self) -> bool:
        """Whether the plane was observed rather than assumed: assumed ones give way to objects."""
        return self.confidence >= SEEN_CONFIDENCE

    @cached_property
    def normal(self) -> Float[np.ndarray, "3"]:
        """Unit normal, toward the room (Newell's method, robust to collinear corners)."""
        a, b = self.polygon, np.roll(self.polygon, -1, axis=0)
        n = np.cross(a, b).sum(axis=0)
        length = np.linalg.norm(n)
        return n / length if length > 1e-12 else UP_WORLD.copy()

    @cached_property
    def centre(self) -> Float[np.ndarray, "3"]:
        """Mean of the corners."""
        return self.polygon.mean(axis=0)

    @cached_property
    def offset(self) -> float:
        """d of the plane equation `normal . p = d`."""
        return float(self.normal @ self.centre)


@dataclass(frozen=True)
class Architecture:
    """The room: floor, walls, ceiling."""

    planes: tuple[Plane, ...] = ()

    def by_role(self, role: PlaneRole) -> tuple[Plane, ...]:
        """Planes of one role."""
        return tuple(p for p in self.planes if p.role == role)

    def number_of(self, plane: Plane) -> int | None:
        """Which plane of its role it is, from 1; None for the only one."""
        ids = [p.id for p in self.by_role(plane.role)]
        return ids.index(plane.id) + 1 if len(ids) > 1 else None

    @property
    def floor(self) -> Plane | None:
        """The floor, if any; of a home's the lowest."""
        return min(self.by_role("floor"), key=lambda p: float(p.centre[2]), default=None)


@dataclass(frozen=True)
class Candidate:
    """One retrieved alternative for an object, already posed, so that a swap needs no inference."""

    shape_id: str
    shape_size_m: tuple[float, float, float]
    """Extents of the shape at scale 1 along its own axes."""
    score: float
    """Higher is better; comparable only within one object."""
    pose: Pose


@dataclass(frozen=True)
class PhotoMaterial:
    """What the photo shows of one material slot of an object."""

    slot: str
    """Name of the slot, by role and rank: "fabric", "wood 2" (`library.slots`)."""
    colour: tuple[float, float, float]
    """Mean albedo, sRGB 0 to 1; the whole material where there is no texture."""
    texture: str | None = None
    """Name of the picture among the project's files."""
    layout: TextureLayout = "tiled"
    tile_m: float = 1.0
    """Metres of the object that a tiled texture covers."""
    roughness: float = 0.7
    metallic: float = 0.0
    main: bool = False
    """Whether the slot is the one that covers most of the object."""


@dataclass(frozen=True)
class SceneObject:
    """One thing in the room."""

    id: str
    label: str
    """What people call it; free text, shown escaped."""
    category: str
    """Canonical category of the library (`diorama_core.library.taxonomy`)."""
    shape_id: str
    shape_size_m: tuple[float, float, float]
    """Extents of the shape at scale 1 along its own axes (x front-back, y left-right, z height)."""
    pose: Pose
    candidates: tuple[Candidate, ...] = ()
    """Ranked alternatives, best first; the current shape is among them when it was retrieved."""
    mask_id: int | None = None
    """Instance id in the photo's instance map."""
    box_px: tuple[float, float, float, float] | None = None
    """x1, y1, x2, y2 in the photo."""
    confidence: float = 1.0
    """How far the evidence supports the pose, 0 to 1."""
    locked: bool = False
    hidden: bool = False
    colour: tuple[float, float, float] | None = None
    """Override of the main material's colour, sRGB 0 to 1."""
    finish: Finish | None = None
    """Override of how the main material throws light back; its own when None."""
    photo_materials: tuple[PhotoMaterial, ...] = ()
    """Materials taken from the photo; slots that none of them matches keep the shape's own."""
    material_source: MaterialSource = "photo"
    """Whether the object shows them or the shape's own materials."""
    open_share: float = 0.0
    """How far its doors, drawers and lids stand open, 0 to 1; nothing for shapes that have none."""
    by_hand: bool = False
    """Whether a person placed, turned or sized it: no automatic step does so afterwards unless asked."""
    belief: Belief | None = None
    """How sure the build was of it; None for what no build found."""

    @property
    def visible_materials(self) -> tuple[PhotoMaterial, ...]:
        """The materials from the photo that the object shows."""
        return self.photo_materials if self.material_source == "photo" else ()

    @property
    def size_m(self) -> Float[np.ndarray, "3"]:
        """Extents along the object's own axes in metres, scale included."""
        return np.asarray(self.shape_size_m) * self.pose.scale

    @property
    def corners_world(self) -> Float[np.ndarray, "8 3"]:
        """Corners of the oriented bounding box in the world."""
        return self.pose.apply(box_corners(self.shape_size_m))


_HALF_SIGNS = np.array([[(i >> axis) & 1 for axis in range(3)] for i in range(8)]) - 0.5


def box_corners(size_m: Vector3) -> Float[np.ndarray, "8 3"]:
    """Corners of a centred box; index bits 0, 1, 2 are the signs of x, y, z."""
    return _HALF_SIGNS * np.asarray(size_m, dtype=np.float64)


@dataclass(frozen=True)
class Support:
    """One edge of the support graph: what holds a child up."""

    child: str
    """Object id."""
    parent: str
    """Object id or plane id."""
    relation: Relation = "placed on"
    parent_surface: int | None = None
    """Index into the parent shape's support surfaces; None lets the optimiser choose; unused for planes."""
    child_face: FaceName | None = None
    """The face in contact; None lets the optimiser choose (bottom favoured)."""
    adheres_to: tuple[str, ...] = ()
    """Ids of walls the object also stands against."""


@dataclass(frozen=True)
class RoomLight:
    """The main light of a room: surfaces receive `1 + strength * (direction . normal)` relative to an even light."""

    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
    """Unit vector in the world toward where most light comes from."""
    strength: float = 0.25
    """0 is light from everywhere, 1 about a single small source."""
    colour: tuple[float, float, float] = (1.0, 1.0, 1.0)
    """Linear, its largest component 1; the scene's colours and pictures are free of it."""


@dataclass(frozen=True)
class HomeRoom:
    """One room of a home; what stands over its floor is in it (`diorama_core.geometry.rooms`)."""

    id: str
    name: str
    """What people call it; free text, shown escaped."""
    floor: str
    """Id of its floor."""
    storey: int = 0
    """Counted from the lowest."""


@dataclass(frozen=True)
class Scene:
    """Everything that is in the room, where it is and what holds it up."""

    camera: Camera | None = None
    architecture: Architecture = Architecture()
    objects: tuple[SceneObject, ...] = ()
    supports: tuple[Support, ...] = ()
    metrics: tuple[tuple[str, float], ...] = ()
    """The optimiser's last report, as (name, value) pairs."""
    light: RoomLight | None = None
    """As the photo's shades tell it; None where nothing is known."""
    light_settings: LightSettings = PHOTO_LIGHT
    """As a person set it."""
    scale_sigma: float | None = None
    """Standard deviation of the logarithm of all lengths together; None where nothing is known."""
    rooms: tuple[HomeRoom, ...] = ()
    """Of a home; a scene without any is one room. Rooms whose floor is gone are gone."""

    def __post_init__(self) -> None:
        if self.rooms:
            floors = {p.id for p in self.architecture.by_role("floor")}
            object.__setattr__(self, "rooms", tuple(r for r in self.rooms if r.floor in floors))
        # One order for equal graphs, so that equality and the file do not depend on the order of edits.
        rank = {o.id: i for i, o in enumerate(self.objects)}
        ordered = sorted(self.supports, key=lambda s: (rank.get(s.child, len(rank)), s.child))
        object.__setattr__(self, "supports", tuple(ordered))

    @cached_property
    def _objects_by_id(self) -> dict[str, SceneObject]:
        return {o.id: o for o in self.objects}

    @cached_property
    def _planes_by_id(self) -> dict[str, Plane]:
        return {p.id: p for p in reversed(self.architecture.planes)}

    @cached_property
    def _support_of(self) -> dict[str, Support]:
        return {s.child: s for s in self.supports}

    @cached_property
    def _children_of(self) -> dict[str, tuple[str, ...]]:
        children: dict[str, list[str]] = {}
        for support in self.supports:
            children.setdefault(support.parent, []).append(support.child)
        return {parent: tuple(ids) for parent, ids in children.items()}

    def object(self, object_id: str) -> SceneObject:
        """The object with this id; raises `KeyError` when there is none."""
        return self._objects_by_id[object_id]

    def has_object(self, object_id: str) -> bool:
        """Whether an object with this id exists."""
        return object_id in self._objects_by_id

    def plane(self, plane_id: str) -> Plane:
        """The plane with this id; raises `KeyError` when there is none."""
        return self._planes_by_id[plane_id]

    def has_plane(self, plane_id: str) -> bool:
        """Whether a plane with this id exists."""
        return plane_id in self._planes_by_id

    def support_of(self, object_id: str) -> Support | None:
        """The edge that holds the object up, if any."""
        return self._support_of.get(object_id)

    def children_of(self, parent_id: str) -> tuple[str, ...]:
        """Ids of the objects directly held up by an object or plane."""
        return self._children_of.get(parent_id, ())
