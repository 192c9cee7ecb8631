"""Where the values of an artefact come from: facts that stages state, projects store and tests compare.

`diorama_core.pipeline.findings` makes the sentences that users read.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class FocalSource(StrEnum):
    """Where a camera's focal length comes from."""

    GIVEN = "given"
    HEADER = "header"
    """The photo file's header."""
    VANISHING_POINTS = "vanishing points"
    NETWORK = "network"
    ASSUMED = "assumed"


class AttitudeSource(StrEnum):
    """Where a camera's pitch and roll come from."""

    GIVEN = "given"
    FLOOR = "floor"
    """The floor in the depth."""
    LEVEL_SURFACES = "level surfaces"
    """Level surfaces in the depth that are not the floor."""
    VANISHING_POINTS = "vanishing points"
    ASSUMED = "assumed"


class HeadingSource(StrEnum):
    """Where the horizontal axes of the room come from."""

    GIVEN = "given"
    WALLS = "walls"
    """Walls in the depth."""
    VANISHING_POINTS = "vanishing points"
    ASSUMED = "assumed"


@dataclass(frozen=True)
class CameraSource:
    """Where intrinsics and orientation of a camera come from."""

    focal: FocalSource
    attitude: AttitudeSource
    heading: HeadingSource
    few_lines: bool = False
    """Whether few lines agree on the vanishing points."""
    no_level_surface: bool = False
    """Whether depth was searched for a level surface in vain."""
    attitude_corrected: bool = False
    """Whether a person's pitch and roll replaced those of `attitude`."""

    @classmethod
    def exact(cls) -> CameraSource:
        """The source of a camera that is known."""
        return cls(FocalSource.GIVEN, AttitudeSource.GIVEN, HeadingSource.GIVEN)


class ScaleSource(StrEnum):
    """Where the metric scale of objects and the height of the camera come from."""

    GIVEN = "given"
    OBJECT_SIZES = "object sizes"
    """The usual sizes of the objects and the usual height of a camera."""
    CAMERA_HEIGHT = "camera height"
    """The usual height of a camera alone."""
    DEPTH = "depth"
    """Depth; the camera's height from the floor in it."""
    DEPTH_WITHOUT_FLOOR = "depth without floor"
    """Depth; the camera's height is assumed."""

    @property
    def is_measured(self) -> bool:
        """Whether distances were measured or given; those reasoned from a photo alone may still be moved."""
        return self in (ScaleSource.GIVEN, ScaleSource.DEPTH, ScaleSource.DEPTH_WITHOUT_FLOOR)


class DepthSource(StrEnum):
    """Where depth comes from."""

    MEASURED = "measured"
    """A sensor."""
    NETWORK = "network"
    """A network that predicted it from the photo."""
    RENDERED = "rendered"
    """The cuboids and the room."""


class RoomMethod(StrEnum):
    """How the room was reconstructed."""

    GIVEN = "given"
    DEPTH_PLANES = "depth planes"
    PHOTO_CUES = "photo cues"
    """Lines, edges and colours of the photo, and the objects."""
    USUAL_SIZES = "usual sizes"
    """The objects and usual room sizes; the photo shows few lines."""
    SEVERAL_VIEWS = "several views"
    """All photos of the room, or the whole of a 360 degree one."""
    PLAINRECON = "plainrecon"
    """PlainRecon as published."""
    RENDER_AND_COMPARE = "render and compare"
    """A discrete search after Stekovic et al. 2020."""
    ACDC = "acdc"
    """A plane for each segment, as ACDC has them."""

    @property
    def is_reasoned(self) -> bool:
        """Whether places of walls were reasoned from a photo alone: they may be moved to what stands against them."""
        return self in (RoomMethod.PHOTO_CUES, RoomMethod.USUAL_SIZES)


@dataclass(frozen=True)
class RoomSource:
    """How the room was reconstructed, what of it was found and what was assumed."""

    method: RoomMethod
    walls_found: int = 0
    """Walls that depth or the photo shows."""
    walls_assumed: int = 0
    floor_found: bool = False
    wall_height_m: float | None = None
    ceilings_m: tuple[float, ...] = ()
    """Heights of the flat ceilings found."""
    sloped_ceilings: int = 0
    doorways: int = 0
    windows: int = 0
    furniture_inpainted: bool = False
    """Whether furniture was painted out of the photo first."""


class GraphMethod(StrEnum):
    """Who says what holds up what."""

    GIVEN = "given"
    GEOMETRY = "geometry"
    LANGUAGE_MODEL = "language model"


@dataclass(frozen=True)
class LanguageModelUse:
    """What asking a language model took and gave."""

    model: str
    replies: int
    """Usable ones."""
    unusable: int
    """Questions that no reply answered usably."""
    calls: int = 0
    tokens: int = 0
    cost: float | None = None
    """In units of the user's prices; None where no prices are known."""
    trouble: str = ""
    """The line of the error that ended the questions; empty where none did."""


@dataclass(frozen=True)
class GraphSource:
    """Where a scene graph comes from."""

    method: GraphMethod = GraphMethod.GEOMETRY
    asked: LanguageModelUse | None = None
    """None where no language model was asked."""
    repaired: int = 0
    """Relations that geometry had to mend or add to the language model's."""
