"""What a build is asked for besides the photo: one value for a command, a folder of photos and a program's request."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import diorama_core as diorama
from diorama_core.errors import InputError

if TYPE_CHECKING:
    from diorama_core.api import Reconstruction
    from diorama_core.library.record import ShapeLibrary
    from diorama_core.pipeline.choices import NetworkChoice
    from diorama_core.pipeline.stages import Stages
    from diorama_core.progress import Progress
    from diorama_core.protocols import ArchitectureStage, PoseStage

Room = Literal["closed", "plainrecon", "rac", "acdc"]
ROOMS: tuple[Room, ...] = ("closed", "plainrecon", "rac", "acdc")
POSES = ("render-and-compare", "correspondence", "zsp", "gigapose-like", "best-match")
System = Literal["diorama", "acdc"]
SYSTEMS: tuple[System, ...] = ("diorama", "acdc")


@dataclass(frozen=True)
class PhotoFiles:
    """A photo and what is known of it."""

    photo: Path
    boxes: Path | None = None
    masks: Path | None = None
    depth: Path | None = None
    intrinsics: tuple[float, float, float, float] | None = None
    """fx, fy, cx, cy in pixels of the upright original photo."""
    fov_deg: float | None = None
    distortion: tuple[float, ...] = ()
    """Lens coefficients in OpenCV's order: k1, k2, p1, p2, k3."""
    half_turn: bool = False
    """Whether all of them are upside down."""
    camera_height_m: float | None = None
    """Above the floor."""
    flat: bool = False
    """Whether the photo shows one direction although it looks like a panorama."""


@dataclass(frozen=True)
class BuildOptions:
    """How scenes are built; the same for all photos of a folder."""

    depth_scale: float | None = None
    depth_encoding: Literal["linear", "sunrgbd"] = "linear"
    depth_kind: Literal["auto", "depth", "distance", "inverse", "root", "logarithm", "shifted"] = "auto"
    profile: Literal["auto", "embedded", "foundation"] = "auto"
    detector: str | None = None
    depth_network: str | None = None
    recipe: Literal["feasible", "paper", "all-in-one"] = "feasible"
    library: str = "built-in"
    room: Room = "closed"
    pose: str | None = None
    """One of `POSES`; None for the profile's."""
    system: System = "diorama"
    """"acdc" replaces room, retrieval, poses and layout by those of the system that the paper compares with."""

    def networks(self, files: PhotoFiles) -> NetworkChoice:
        """The networks that these options name.

        Raises:
            InputError: a network is named for what was given, or where none is to be used.
        """
        if self.profile == "embedded" and (self.detector or self.depth_network):
            raise InputError("--profile embedded uses no network; leave out --detector and --depth-network")
        if self.detector and (files.boxes or files.masks):
            raise InputError("--detector finds what boxes or masks would say; give one of them")
        if self.depth_network and files.depth:
            raise InputError("--depth-network reads what --depth says; give one of them")
        from diorama_core.pipeline.choices import NetworkChoice

        return NetworkChoice(self.detector, self.depth_network)


def build_files(
    files: PhotoFiles, options: BuildOptions, output: Path, progress: Progress, warn: Callable[[str], None]
) -> Reconstruction:
    """Build the scene of a photo in a project folder; raises what `diorama_core.build` raises.

    Args:
        files: of one photo.
        options: of the build.
        output: folder that is written.
        progress: reports and cancellation.
        warn: called with what is odd about them.
    """
    return diorama.build(
        files.photo,
        boxes=files.boxes,
        masks=files.masks,
        depth=files.depth,
        depth_scale=options.depth_scale,
        depth_encoding=options.depth_encoding,
        depth_kind=options.depth_kind,
        intrinsics=files.intrinsics,
        fov_deg=files.fov_deg,
        camera_height_m=files.camera_height_m,
        distortion=files.distortion,
        half_turn=files.half_turn,
        flat=files.flat,
        profile=options.profile,
        networks=options.networks(files),
        recipe=options.recipe,
        library=options.library,
        stages=lambda stages: with_options(stages, files, options),
        output=output,
        progress=progress,
        warn=warn,
    )


def with_options(stages: Stages, files: PhotoFiles, options: BuildOptions) -> Stages:
    """The profile's stages with those that options name."""
    has_depth = files.depth is not None or stages.depth_prediction is not None
    if options.system == "acdc":
        if options.room != "closed" or options.pose is not None:
            raise InputError("--system acdc has a room and poses of its own; leave out --room and --pose")
        from diorama_core.pipeline.published import acdc_stages

        return acdc_stages(stages, has_depth, diorama.open_library(options.library))
    if options.room != "closed":
        if not has_depth:
            raise InputError(f"--room {options.room} reads depth: add --depth FILE or a profile with a depth network")
        from diorama_core.pipeline.published import with_room

        stages = with_room(stages, room_solver(options.room))
    if options.pose is not None:
        stages = replace(stages, pose=pose_solver(options.pose, diorama.open_library(options.library)))
    return stages


def room_solver(name: Room) -> ArchitectureStage:
    """The solver that finds a room in depth by this name, one of `ROOMS`."""
    from diorama_core.architecture.from_depth import PlanarRoom
    from diorama_core.architecture.plainrecon.stage import PlainRecon
    from diorama_core.architecture.rac.stage import RenderAndCompareRoom
    from diorama_core.provenance import RoomMethod

    acdc = PlainRecon(method=RoomMethod.ACDC)
    solvers: dict[Room, ArchitectureStage] = {
        "closed": PlanarRoom(), "plainrecon": PlainRecon(), "rac": RenderAndCompareRoom(), "acdc": acdc
    }  # fmt: skip
    return solvers[name]


def pose_solver(name: str, library: ShapeLibrary) -> PoseStage:
    """The solver with this name, one of `POSES`."""
    from diorama_core.pose.correspondence.solvers import HALF_GRID, KINDS, CorrespondencePose
    from diorama_core.pose.made_to_measure import MadeToMeasure
    from diorama_core.pose.render_and_compare import RenderAndCompare

    kind = next((kind for kind in KINDS if kind == name), None)
    if kind is None:
        return MadeToMeasure(RenderAndCompare(library), library)
    return CorrespondencePose(library, kind, grid=HALF_GRID)
