"""Every format a scene can be written in, as a table: what it keeps, how its files end, what it needs.

Writers are imported when they are used, so that listing the formats is cheap and a missing optional library stops only
the format that needs it.
"""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, cast, runtime_checkable

from diorama_core.errors import ExportError, UnavailableError
from diorama_core.progress import SILENT, Progress

if TYPE_CHECKING:
    from diorama_core.export.gathering import ExportOptions, ExportScene
    from diorama_core.export.pictures import Picture
    from diorama_core.library.record import ShapeLibrary
    from diorama_core.scene.types import Scene


@runtime_checkable
class Writer(Protocol):
    """Writes a gathered scene whole, or raises `ExportError` or, when asked to stop, `Cancelled`."""

    def __call__(self, gathered: ExportScene, path: Path, progress: Progress) -> None:
        """Write to `path`, replacing what is there only when all went well."""
        ...


@dataclass(frozen=True)
class Format:
    """One format."""

    name: str
    """What the command line knows it by."""
    title: str
    """What people call it."""
    suffixes: tuple[str, ...]
    """How its files may end, the usual ending first."""
    keeps: str
    """What of the scene it keeps, in a few words for people who choose."""
    place: str
    """Where its writer is: `module:function` inside `diorama_core.export`, or with the module's full name."""
    extra: str | None = None
    """Optional dependency group that it needs."""
    needs: str | None = None
    """Module of that group whose absence stops the format."""
    check: str | None = None
    """Function inside `diorama_core.export` (`module:function`) that says what is missing, where no module tells."""
    joints: bool = False
    """Whether shapes that know their joints are written in parts that move."""
    texture_px: int | None = None
    """Longest side of its pictures where no other is asked for."""

    @property
    def missing(self) -> str:
        """What to install before it can be written, in one line; empty when nothing is missing."""
        if self.check is not None:
            return str(_function(self.check)())
        if self.needs is None or importlib.util.find_spec(self.needs) is not None:
            return ""
        return f"{self.title} needs an optional library: pip install 'diorama[{self.extra}]'"

    def writer(self) -> Writer:
        """The function that writes it.

        Raises:
            UnavailableError: when its optional library is not installed.
        """
        if self.missing:
            raise UnavailableError(self.missing)
        return cast(Writer, _function(self.place))


def _function(place: str) -> Callable[..., Any]:
    module, function = place.split(":")
    full = module if "." in module else f"diorama_core.export.{module}"
    return cast("Callable[..., Any]", getattr(importlib.import_module(full), function))


_WHOLE = "and the whole scene: it opens here again"
_USD_KEEPS = f"materials, textures, camera, lights, supports, colliders, masses, joints, {_WHOLE}"
_SIM_KEEPS = "visual meshes with materials, convex colliders, masses, friction, joints"
_PLAN_KEEPS = "walls, openings, footprints, names, lengths"
_LIST_KEEPS = "a row for each object: name, kind, size, place, room, materials"

_TABLE = (
    Format(
        "glb",
        "glTF binary",
        (".glb",),
        f"materials, textures, camera, lights, supports, {_WHOLE}",
        "gltf:write_gathered",
    ),
    Format(
        "game",
        "Game pack (GLB)",
        (".glb",),
        "moving parts on their hinges, convex colliders, few materials and triangles, levels of detail, one mesh for "
        "the room, lights",
        "game:write_game",
        joints=True,
        texture_px=1024,
    ),
    Format("usda", "USD text", (".usda",), _USD_KEEPS, "usd:write_layer", "usd", "pxr", joints=True),
    Format("usdc", "USD binary", (".usdc",), _USD_KEEPS, "usd:write_layer", "usd", "pxr", joints=True),
    Format("usdz", "USD package for AR", (".usdz",), _USD_KEEPS, "usd:write_usdz", "usd", "pxr", joints=True),
    Format("mjcf", "MuJoCo", (".xml", ".zip"), _SIM_KEEPS, "mjcf:write_mjcf", joints=True),
    Format("urdf", "URDF (ROS, PyBullet, Isaac)", (".urdf", ".zip"), _SIM_KEEPS, "urdf:write_urdf", joints=True),
    Format("sdf", "SDFormat (Gazebo)", (".sdf", ".zip"), _SIM_KEEPS, "sdf:write_sdf", joints=True),
    Format(
        "obj", "Wavefront OBJ with materials", (".zip", ".obj"), "named objects, materials, textures", "obj:write_obj"
    ),
    Format(
        "robot",
        "Robot pack",
        (".zip",),
        "MJCF, URDF, SDF and USD of the same bodies, regions to put objects on, grasps, labels, a map for ROS nav2",
        "robot:write_robot",
        "usd",
        "pxr",
        joints=True,
    ),
    Format(
        "occupancy",
        "Occupancy map (ROS nav2)",
        (".zip", ".yaml"),
        "where the floor is free and where something stands, as a grey picture with its scale",
        "navigation:write_occupancy",
    ),
    Format(
        "blend",
        "Blender file",
        (".blend",),
        "collections, supports as parents, materials, textures, lights, camera with the photo behind it",
        "blend:write_blend",
        check="blender:missing_blender",
    ),
    Format("hdr", "Environment map", (".hdr",), "the light from all sides of the room", "environment:write_hdr"),
    Format("ply", "PLY mesh", (".ply",), "one mesh with vertex colours", "ply:write_ply"),
    Format("csv", "Furniture list (CSV)", (".csv",), _LIST_KEEPS, "schedule:write_csv"),
    Format(
        "xlsx",
        "Furniture list (XLSX)",
        (".xlsx",),
        f"{_LIST_KEEPS}, picture",
        "schedule:write_xlsx",
        "plan",
        "xlsxwriter",
    ),
    Format("stl", "STL for printing", (".stl",), "bare triangles in millimetres", "stl:write_stl"),
    Format(
        "scene-state",
        "Scene state (SceneEval, HSSD)",
        (".json", ".zip"),
        "poses, models (in a .zip), walls with openings, supports",
        "scene_state:write_scene_state",
    ),
    Format("svg", "Floor plan as SVG", (".svg",), _PLAN_KEEPS, "drawings:write_plan"),
    Format("pdf", "Floor plan as PDF", (".pdf",), _PLAN_KEEPS, "drawings:write_plan", "plan", "reportlab"),
    Format("dxf", "Floor plan as DXF", (".dxf",), _PLAN_KEEPS, "drawings:write_plan", "plan", "ezdxf"),
    Format(
        "elevations",
        "Wall elevations (PDF, SVG, DXF)",
        (".pdf", ".svg", ".dxf"),
        "each wall by room: openings, what hangs or stands there, widths and heights",
        "drawings:write_elevations",
        "plan",
        "reportlab",
    ),
    Format(
        "sh3d",
        "Sweet Home 3D",
        (".sh3d",),
        "walls, floors, doors and windows, furniture as its models, camera",
        "sweethome:write_sweet_home",
    ),
    Format(
        "ifc",
        "IFC building model",
        (".ifc",),
        "walls with openings, slabs, doors, windows, furniture with colours, ids and supporters",
        "ifc:write_ifc",
        "bim",
        "ifcopenshell",
    ),
)

FORMATS: Mapping[str, Format] = {f.name: f for f in _TABLE}
"""Every format, by name."""


def format_named(name: str) -> Format:
    """The format with this name; raises `ExportError` with those that exist."""
    if name not in FORMATS:
        raise ExportError(f"cannot export as {name!r}; choose one of: {', '.join(FORMATS)}")
    return FORMATS[name]


def export_scene(
    scene: Scene,
    library: ShapeLibrary,
    path: Path,
    format_name: str | Format,
    *,
    options: ExportOptions | None = None,
    textures: Mapping[str, Picture] | None = None,
    photo: Picture | None = None,
    name: str | None = None,
    provenance: Mapping[str, Any] | None = None,
    progress: Progress = SILENT,
) -> ExportScene:
    """Write a scene in one of `FORMATS`, whole or not at all, and return what was written.

    Args:
        scene: What to write; hidden objects are left out.
        library: Where its shapes are.
        path: The file; an existing one is replaced when everything went well.
        format_name: A key of `FORMATS`, or a format of another table.
        options: What of the scene is written, and how.
        textures: Pictures of the planes by `Plane.texture`.
        photo: The photo that the scene was made from.
        name: What the file calls the scene (default: the file's own name).
        provenance: Where the scene comes from, as JSON values.
        progress: Where it is reported and cancelling is noticed.

    Raises:
        ExportError: the format does not exist, its file ends otherwise, or it cannot be written.
        UnavailableError: an optional library is missing.
        LibraryError: a shape is missing.
        Cancelled: when asked to stop; an older file at `path` stays as it was.
    """
    from diorama_core.export.gathering import EVERYTHING, gather

    path = Path(path)
    chosen = format_name if isinstance(format_name, Format) else format_named(format_name)
    if path.suffix.lower() not in chosen.suffixes:
        endings = " or ".join(chosen.suffixes)
        raise ExportError(f"{path}: {chosen.title} files end in {endings}; choose such a name")
    write, options = chosen.writer(), options or EVERYTHING
    gathered = gather(
        scene,
        library,
        options=replace(options, joints=chosen.joints, max_texture_px=options.max_texture_px or chosen.texture_px),
        textures=textures,
        photo=photo,
        name=name or path.stem,
        provenance=provenance,
        progress=progress.part(0.0, 0.5),
    )
    progress.report(0.5, f"writing {path.name}")
    progress.check()
    write(gathered, path, progress.part(0.5, 1.0))
    progress.report(1.0, f"wrote {path.name}")
    return gathered
