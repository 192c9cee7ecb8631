"""Every format the program exports, those of the library and the viewer that comes with the editor's toolkit, with what
people who choose one want to know."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from diorama_app.strings import N_
from diorama_core.export import FORMATS, Format

Choice = Literal["ceiling", "selection", "textures", "compression", "lights", "photo", "welded"]
"""An export option that means something in a format; see `ExportOptions`."""


@dataclass(frozen=True)
class Guide:
    """What a format is for."""

    group: str
    opens_in: str
    """Programs that were tried, then, after "made for", those that were not."""
    choices: frozenset[Choice]


HTML = Format(
    "html",
    "Viewer in one page",
    (".html",),
    "a web page to look at from all sides in any browser, lit as here",
    "diorama_app.viewport.html_viewer:write_html",
)
EXPORT_FORMATS: Mapping[str, Format] = {**FORMATS, HTML.name: HTML}
"""By the name the command line knows them by."""

MODELS, SIMULATORS = N_("3D models"), N_("Simulators")
PLANS, SHOW = N_("Plans and buildings"), N_("To show and to compare")
_SHAPES = frozenset[Choice]({"ceiling", "selection"})
_TEXTURED = _SHAPES | frozenset[Choice]({"textures"})
_BODIES = _TEXTURED | frozenset[Choice]({"welded"})
_USD = _BODIES | frozenset[Choice]({"lights", "photo"})
_FURNITURE = frozenset[Choice]({"selection"})

GUIDES: Mapping[str, Guide] = {
    "glb": Guide(
        MODELS,
        "Blender, three.js, Babylon.js; made for Unity, Unreal and Godot",
        _TEXTURED | frozenset[Choice]({"compression", "lights", "photo"}),
    ),
    "game": Guide(
        MODELS, "Godot, Blender; made for other engines by `diorama export --engine`", _TEXTURED | {"lights"}
    ),
    "blend": Guide(MODELS, "Blender, with the photo behind the camera", _TEXTURED),
    "usdz": Guide(MODELS, "Blender; made for iPhone and iPad (AR Quick Look)", _USD),
    "usdc": Guide(MODELS, "Blender, newton; made for Isaac Sim, Unreal, Maya", _USD),
    "usda": Guide(MODELS, "Blender; made for the same programs as `usdc`, as readable text", _USD),
    "obj": Guide(MODELS, "Blender, assimp; made for nearly every 3D program", _TEXTURED),
    "hdr": Guide(MODELS, "made for Unity and Blender, as light and reflections beside a GLB", frozenset()),
    "ply": Guide(MODELS, "Blender, Open3D; made for MeshLab and CloudCompare", _SHAPES),
    "stl": Guide(MODELS, "Slic3r, Blender; made for slicers of 3D printers", _SHAPES),
    "mjcf": Guide(SIMULATORS, "MuJoCo", _BODIES),
    "urdf": Guide(SIMULATORS, "MuJoCo, PyBullet, SAPIEN; made for RViz and MoveIt", _BODIES),
    "sdf": Guide(SIMULATORS, "Drake; made for Gazebo", _BODIES),
    "robot": Guide(
        SIMULATORS, "MuJoCo, Drake; made for ROS 2 (nav2) and Isaac Sim: one zip with maps and places", _BODIES
    ),
    "occupancy": Guide(SIMULATORS, "made for ROS 2 (nav2) and other planners", frozenset()),
    "svg": Guide(PLANS, "Chromium, Inkscape; made for other browsers and Illustrator", _FURNITURE),
    "pdf": Guide(PLANS, "poppler; made for any PDF viewer, prints to scale", _FURNITURE),
    "dxf": Guide(PLANS, "LibreCAD; made for AutoCAD and QCAD", _FURNITURE),
    "elevations": Guide(PLANS, "poppler, Chromium, LibreCAD; made for the same programs as the plans", frozenset()),
    "csv": Guide(PLANS, "LibreOffice Calc; made for other spreadsheets", _FURNITURE),
    "xlsx": Guide(PLANS, "LibreOffice Calc; made for other spreadsheets, with pictures", _FURNITURE),
    "sh3d": Guide(PLANS, "version 7.0.2; made for 5.3 and newer", _FURNITURE | frozenset[Choice]({"textures"})),
    "ifc": Guide(PLANS, "IfcOpenShell; made for Revit, Bonsai, IFC viewers", _SHAPES),
    "html": Guide(SHOW, "Chromium; made for any browser, without a network", _TEXTURED),
    "scene-state": Guide(SHOW, "made for SceneEval and SmartScenes tools", _TEXTURED),
}
"""By format name, in the order in which they are offered."""
