"""What flows between the stages: frozen values that can be looked at, saved, corrected and resumed from.

Stages do not import each other; they meet in these types. Frames and units: `diorama_core.scene.frames`.
Image arrays have the photo's height and width (h w); `Photo` is already rotated upright.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float, Float32, Int32, UInt8

from diorama_core.geometry.rotations import CameraAttitude
from diorama_core.provenance import CameraSource, DepthSource, GraphSource, RoomSource, ScaleSource
from diorama_core.scene.types import Architecture, Camera, Candidate, Intrinsics, Support
from diorama_core.scene.values import ArrayValue

Box = tuple[float, float, float, float]
"""x1, y1, x2, y2 in photo pixels, clipped to the photo, with x1 < x2 and y1 < y2."""
SURE_MASK = 0.95
"""Confidence from which on a mask is taken as it is: a person gave it, or it was found without doubt."""


@dataclass(frozen=True, eq=False)
class Photo(ArrayValue):
    """The picture, upright, eight bits, three channels; possibly reduced from a very large original."""

    rgb: UInt8[np.ndarray, "h w 3"]
    name: str
    """File name of the original, for people."""
    original_size: tuple[int, int]
    """Width and height of the upright original without its border; boxes and intrinsics of users refer to it."""
    exif_focal_px: float | None = None
    """Focal length in pixels of `rgb`, where the file states it."""
    offset: tuple[int, int] | None = field(default=None, metadata={"absent when none": True})
    """Left and top of the picture in its file, pixels of the upright original, where a border was cut off."""
    half_turned: bool | None = field(default=None, metadata={"absent when none": True})
    """True where the file shows the room upside down, and the picture was turned by 180 degrees; never False."""
    straightened: float | None = field(default=None, metadata={"absent when none": True})
    """The radial coefficient, for half the diagonal as focal length, of the distortion that the file has and that was
    taken out by the photo's own lines."""
    equirectangular: bool | None = field(default=None, metadata={"absent when none": True})
    """True for a 360 degree photo, whose columns are azimuths and whose rows are elevations; never False."""

    @property
    def width(self) -> int:
        """Pixels across."""
        return int(self.rgb.shape[1])

    @property
    def height(self) -> int:
        """Pixels down."""
        return int(self.rgb.shape[0])


@dataclass(frozen=True)
class LabelledBox:
    """An object marked by the user or found by a detector."""

    box: Box
    category: str
    """Canonical category, or "object" when unknown."""
    label: str
    """The word as given, for people."""
    score: float = 1.0
    guessed: bool = False
    """Whether its word is no more than what the box looks like: size, place and neighbours may know better."""


@dataclass(frozen=True, eq=False)
class Inputs(ArrayValue):
    """Everything the user gave, checked and in photo pixels."""

    photo: Photo
    boxes: tuple[LabelledBox, ...] = ()
    instances: Int32[np.ndarray, "h w"] | None = None
    """Instance map: 0 is background; id k belongs to the object whose `mask_id` is k."""
    instance_boxes: tuple[tuple[int, LabelledBox], ...] = ()
    """For each instance id the box and class it was matched with."""
    depth_m: Float32[np.ndarray, "h w"] | None = None
    """Measured depth (z in camera), 0 where missing."""
    intrinsics: Intrinsics | None = None
    normals_camera: Float32[np.ndarray, "h w 3"] | None = None
    """Unit normals that came with the depth, toward the camera; zero where unknown."""
    depth_source: DepthSource = DepthSource.MEASURED
    """Whether a sensor measured the depth or a network predicted it."""
    camera_attitude: CameraAttitude | None = field(default=None, metadata={"absent when none": True})
    """Given camera attitude; None where it is estimated from the photo."""
    camera_height_m: float | None = field(default=None, metadata={"absent when none": True})
    """Given camera height above the floor, also from a known length; None where it is estimated."""

    @property
    def without_camera(self) -> Inputs:
        """The inputs without what is known of the camera, on which outlines do not depend."""
        return replace(self, intrinsics=None, camera_attitude=None, camera_height_m=None)


@dataclass(frozen=True, eq=False)
class FurtherPhoto(ArrayValue):
    """Another photo of the room, beside the one that the scene was built from."""

    name: str
    """Its own among the photos of the project, and a file name."""
    inputs: Inputs
    camera: Camera | None = None
    """In the scene's world; None until the photo has joined."""
    seen: tuple[tuple[str, Box], ...] = ()
    """Objects of the scene by their ids, each with its box in this photo."""
    T_world_sphere: Float[np.ndarray, "4 4"] | None = field(default=None, metadata={"absent when none": True})
    """A 360 degree photo has this in place of a camera: its frame (`geometry.sphere`) in the scene's world."""

    @property
    def is_placed(self) -> bool:
        """Whether it is known where in the scene it was taken."""
        return self.camera is not None or self.T_world_sphere is not None


@dataclass(frozen=True, eq=False)
class CameraHypothesis(ArrayValue):
    """One camera hypothesis."""

    intrinsics: Intrinsics
    R_world_camera: Float[np.ndarray, "3 3"]
    """World: +Z up, x and y along the room's axes, +Y the axis nearest to the viewing direction."""
    score: float
    """0 to 1; comparable within one photo."""


@dataclass(frozen=True, eq=False)
class CameraEstimate(ArrayValue):
    """Intrinsics and orientation; the height above the floor is metric only with depth."""

    hypotheses: tuple[CameraHypothesis, ...]
    """Best first, at least one."""
    confidence: float
    source: CameraSource
    """Where intrinsics and gravity come from."""
    height_m: float | None = None
    """Camera height above the floor, when depth measured it."""

    @property
    def best(self) -> CameraHypothesis:
        """The most likely reading."""
        return self.hypotheses[0]


@dataclass(frozen=True, eq=False)
class DetectedObject(ArrayValue):
    """One object in the picture: class, box and mask."""

    id: str
    """Stable within the photo, also the scene object's id."""
    category: str
    label: str
    box: Box
    mask: Bool[np.ndarray, "h w"]
    mask_id: int
    mask_confidence: float
    """Agreement of segmentations, 0 to 1; 1 for a mask given by the user."""
    looks_like: tuple[tuple[str, float], ...] = ()
    """Kinds with the probabilities that its picture gives them; empty where it was not looked at."""
    seen_form: tuple[float, ...] = ()
    """`SeenKinds.form`; empty where it was not looked at."""
    meanings: tuple[tuple[str, float], ...] = ()
    """Kinds that its word may mean here with their probabilities, likeliest first; empty where it means one."""

    @cached_property
    def pixels(self) -> int:
        """Area of the mask."""
        return int(np.count_nonzero(self.mask))


@dataclass(frozen=True, eq=False)
class SeenKinds(ArrayValue):
    """Which kinds and forms the picture of one object looks like."""

    object_id: str
    kinds: tuple[str, ...]
    probabilities: Float[np.ndarray, "k"]
    """Probabilities of those kinds, all equally frequent."""
    form: tuple[float, ...] = ()
    """Probability of every value of every attribute of form, one attribute after another; empty where nobody looked."""


Decision = Literal["place", "support", "front", "kind", "size"]
"""What is decided about an object."""


@dataclass(frozen=True)
class Reason:
    """One term that speaks for or against what was decided about an object."""

    object_id: str
    decision: Decision
    term: str
    """Its name: of a piece of evidence, a stage or a rule."""
    amount: float
    """How much it counts: nats for what was decided, negative against it; or by how far it moved the object."""
    unit: Literal["nats", "cm"]
    sentence: str
    """Why, in plain words, for people."""


@dataclass(frozen=True, eq=False)
class Cuboid(ArrayValue):
    """The oriented box of one object in metres, before any shape is chosen."""

    object_id: str
    R_world_object: Float[np.ndarray, "3 3"]
    """Object frame: +X front (its sign may still be undecided), +Z up."""
    centre: Float[np.ndarray, "3"]
    size_m: Float[np.ndarray, "3"]
    confidence: float
    front_known: bool = False
    """Whether +X is known to be the front; otherwise yaw is meant modulo a quarter turn."""
    foot_seen: bool = True
    """Whether the picture shows its lower end; otherwise what it is tells how far away it is, by its size."""

    @property
    def corners_world(self) -> Float[np.ndarray, "8 3"]:
        """Corners in the world, ordered as `scene.types.box_corners`."""
        from diorama_core.scene.types import box_corners

        return box_corners(self.size_m) @ self.R_world_object.T + self.centre


@dataclass(frozen=True, eq=False)
class ObjectGeometry(ArrayValue):
    """The metric camera, every object's cuboid, and what stands on what."""

    camera: Camera
    cuboids: tuple[Cuboid, ...]
    supports: tuple[Support, ...]
    """Parents are object ids, or "floor", "ceiling" or "wall", for which the architecture will say which plane."""
    source: ScaleSource
    confidence: float = 1.0
    scale_sigma: float | None = field(default=None, metadata={"absent when none": True})
    """Standard deviation of the logarithm of all lengths together; None where the stage does not tell."""
    reasons: tuple[Reason, ...] | None = field(default=None, metadata={"absent when none": True})
    """What decided places, sizes and supports; None where the stage does not tell."""


@dataclass(frozen=True, eq=False)
class DepthMap(ArrayValue):
    """Depth and normals of every pixel."""

    depth_m: Float32[np.ndarray, "h w"]
    """z in camera, 0 where unknown."""
    normals_world: Float32[np.ndarray, "h w 3"]
    """Unit, toward the camera; zero where unknown."""
    source: DepthSource


@dataclass(frozen=True, eq=False)
class DepthPrediction(ArrayValue):
    """What a network says of a photo's geometry, before the camera's pose is known."""

    depth_m: Float32[np.ndarray, "h w"]
    """z in camera, 0 where unknown."""
    normals_camera: Float32[np.ndarray, "h w 3"]
    """Unit, toward the camera; zero where unknown."""
    intrinsics: Intrinsics


@dataclass(frozen=True)
class SceneGraph:
    """The support graph, and known facing directions of objects."""

    supports: tuple[Support, ...]
    """One edge per object; parents as in `ObjectGeometry.supports`."""
    scores: tuple[float, ...]
    """How sure each edge is, 0 to 1."""
    facing: tuple[tuple[str, str], ...] = ()
    """(object id, direction seen from the camera): "toward camera", "away from camera", "left" or "right"."""
    captions: tuple[tuple[str, str], ...] = ()
    """(object id, brief description); may hold anything, to be shown escaped."""
    source: GraphSource = field(default_factory=GraphSource)
    """Who says so."""
    provisional: bool = False
    """Whether it stands in for what could not be asked just now: the next build asks again."""


@dataclass(frozen=True)
class ArchitectureEstimate:
    """The room, with what is known about how well it is known."""

    architecture: Architecture
    supports: tuple[Support, ...]
    """The support edges with "floor" and "wall" resolved to plane ids."""
    confidence: float
    source: RoomSource
    openings: tuple[str, ...] = ()
    """Objects that are holes in the walls, open doorways, and get no shape."""


@dataclass(frozen=True)
class RankedShapes:
    """Retrieved shapes of one object, best first: (shape id, score)."""

    object_id: str
    ranked: tuple[tuple[str, float], ...]
    note: str = ""
    """Shown to the user when the class was unknown and a near one was taken."""


@dataclass(frozen=True)
class PosedCandidates:
    """The ranked shapes of one object, each posed; `confidence` speaks of the best."""

    object_id: str
    candidates: tuple[Candidate, ...]
    confidence: float
    reasons: tuple[Reason, ...] = ()
    """What decided which way it faces."""
    headings: tuple[float, ...] = ()
    """Probabilities of evenly spread headings, from +X of the world on; empty where the stage does not tell."""


@dataclass(frozen=True)
class PhotoDisagreement:
    """An object that a layout took clearly away from where the camera saw it."""

    object_id: str
    label: str
    moved_m: float
    outline_shared: float
    """Intersection over union of the bounds in the picture before and after."""


@dataclass(frozen=True)
class LayoutReport:
    """What an optimiser did: costs before and after, structure, collisions, distance moved."""

    recipe: str
    before: dict[str, float]
    after: dict[str, float]
    seconds: float
    reasons: tuple[str, ...] = field(default=())
    """Reasons why a constraint could not be met (an object larger than its support, a cycle), and `disagreements` in
    words."""
    disagreements: tuple[PhotoDisagreement, ...] = ()
    """What agrees less with the photo than before."""
