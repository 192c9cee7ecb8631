"""`diorama export`: a project's scene for other programs, what gravity does to it, and variants of it."""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import diorama_core as diorama
from diorama_app.cli.arguments import WITHOUT_PHOTO, command, progress_bar
from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_core.errors import InputError
from diorama_core.io.text import number_of

if TYPE_CHECKING:
    from diorama_core.export.gathering import ExportOptions, ExportScene


def add_export(commands: Any) -> None:
    """Declare `diorama export`."""

    p = command(commands, "export", _export, "diorama export my-room --format glb -o room.glb")
    p.add_argument("project", type=Path, metavar="PROJECT")
    p.add_argument("--format", choices=tuple(EXPORT_FORMATS), required=True, help="docs/export.md says what each keeps")
    p.add_argument("-o", "--output", type=Path, metavar="FILE", help="(default: in the project's exports folder)")
    p.add_argument("--no-ceiling", action="store_true", help="leave ceilings out, to look into the room from above")
    p.add_argument("--only", metavar="ID,ID", help="write these objects only, without the room")
    p.add_argument(
        "--texture-size",
        type=int,
        metavar="PX",
        help="longest side of pictures; larger ones are reduced (default: as they are, 1024 in a game pack)",
    )
    p.add_argument(
        "--compress",
        nargs="?",
        const="meshopt",
        default="none",
        choices=("meshopt", "draco"),
        help="compress geometry of a GLB (default: meshopt)",
    )
    p.add_argument(
        "--lights",
        choices=("unit", "photometric", "none"),
        default="unit",
        help="of GLB and USD: as bright as pictures where a camera has no exposure, or in lumens and lux "
        "(default: %(default)s)",
    )
    p.add_argument(
        "--engine",
        choices=("godot", "unreal", "unity", "three"),
        default="godot",
        help="of a game pack: whose names colliders have; Unity and three.js have none (default: %(default)s)",
    )
    p.add_argument(
        "--max-triangles",
        type=int,
        default=3000,
        metavar="N",
        help="of a game pack: about how many each object has at most (default: %(default)s)",
    )
    p.add_argument(
        "--max-total-triangles", type=int, metavar="N", help="of a game pack: how many the whole room has at most"
    )
    p.add_argument(
        "--light-uv",
        action="store_true",
        help="of a game pack: second texture coordinates without overlaps, for baked light (needs xatlas)",
    )
    p.add_argument(
        "--robot-radius",
        type=float,
        default=0.25,
        metavar="M",
        help="of a robot pack: the disc that drives there (default: %(default)s)",
    )
    p.add_argument("--photo", action="store_true", help="put the photo into the file, to come back with it (glb, usd)")
    p.add_argument("--welded", action="store_true", help="simulators: nothing moves, objects are welded in place")
    p.add_argument("--simulate", action="store_true", help="report what two seconds of gravity do to the scene")
    p.add_argument(
        "--shake",
        action="store_true",
        help="report what falls while the floor goes to and fro for three seconds (0.3 g at 2 Hz)",
    )
    p.add_argument("--variants", type=int, metavar="N", help="write so many digital cousins of the scene into a folder")
    p.add_argument(
        "--vary",
        default="shapes,textures,poses,light,clutter",
        metavar="WHAT,WHAT",
        help="what differs among variants (default: %(default)s)",
    )
    p.add_argument("--seed", type=int, default=0, metavar="S", help="of the first variant (default: %(default)s)")
    p.add_argument("--json", action="store_true", help="print the result as JSON")


def _export(a: argparse.Namespace) -> None:
    """Write a project's scene for other tools."""
    room = diorama.load(a.project)
    options = _options(a, room)
    assert room.project is not None
    exports = room.project.folder / "exports"
    if a.variants is not None:
        _print(a, *_variants(a, room, options, a.output or exports / f"{room.project.name}_variants"))
        return
    output = a.output or exports / f"{room.project.name}{EXPORT_FORMATS[a.format].suffixes[0]}"
    if a.output is None:
        output.parent.mkdir(parents=True, exist_ok=True)
    with progress_bar() as progress:
        written = diorama.export(room, output, format=EXPORT_FORMATS[a.format], options=options, progress=progress)
    result: dict[str, Any] = {"file": str(output), "objects": len(written.objects), "planes": len(written.planes)}
    lines = [f"{output}: {number_of(len(written.objects))}, {number_of(len(written.planes), 'plane')}"]
    if a.simulate or a.shake:
        simulated, notes = _simulate(a, written, output)
        result, lines = result | simulated, lines + notes
    _print(a, result, lines)


def _print(a: argparse.Namespace, result: dict[str, Any], lines: list[str]) -> None:
    print(json.dumps(result) if a.json else "\n".join(lines))


def _options(a: argparse.Namespace, room: diorama.Reconstruction) -> ExportOptions:
    from diorama_core.export.gathering import ExportOptions

    only = None if a.only is None else frozenset(name.strip() for name in a.only.split(","))
    unknown = sorted(name for name in only or () if not room.scene.has_object(name))
    if unknown:
        raise InputError(f"--only {a.only}: there is no object {unknown[0]!r} in {a.project}; see its scene.json")
    if a.texture_size is not None and a.texture_size < 1:
        raise InputError(f"--texture-size {a.texture_size}: give a number of pixels, such as 1024")
    for name, count in (("max-triangles", a.max_triangles), ("max-total-triangles", a.max_total_triangles)):
        if count is not None and count < 1:
            raise InputError(f"--{name} {count}: give a number of triangles, such as 3000")
    return ExportOptions(
        ceiling=not a.no_ceiling,
        only=only,
        max_texture_px=a.texture_size,
        compression=a.compress,
        lights=a.lights,
        engine=a.engine,
        max_triangles=a.max_triangles,
        max_total_triangles=a.max_total_triangles,
        light_uv=a.light_uv,
        robot_radius_m=a.robot_radius,
        photo=a.photo,
        bodies="welded" if a.welded else "free",
    )


def _simulate(a: argparse.Namespace, written: ExportScene, output: Path) -> tuple[dict[str, Any], list[str]]:
    """What gravity alone, and a floor that shakes, do to what was written: as JSON values, and as lines."""
    from diorama_core.export.stability import EARTHQUAKE, stability

    urdf = output if a.format == "urdf" else None
    what = "the file" if a.format in ("mjcf", "urdf") else "MuJoCo's model of the same bodies, not this file"
    result: dict[str, Any] = {"simulated": what}
    lines: list[str] = []
    if a.simulate:
        report = stability(written, urdf=urdf)
        result |= {"stable_share": report.stable_share, **asdict(report)}
        lines.append(f"gravity: {report.stable_share:.0%} of objects stay within 1 cm and 2 degrees in 2 s ({what})")
        lines += [f"  {d.object_id} moves {100 * d.moved_m:.1f} cm" for d in report.unstable]
        lines += [f"  {note}" for note in report.notes]
    if a.shake:
        shaken = stability(written, urdf=urdf, shake=EARTHQUAKE)
        result["shake"] = {"fallen": [d.object_id for d in shaken.falls], **asdict(EARTHQUAKE), **asdict(shaken)}
        lines.append(
            f"floor shaken by {EARTHQUAKE}: {len(shaken.falls)} of {number_of(len(shaken.drifts))} fall ({what})"
        )
        lines += [
            f"  {d.object_id} falls by {100 * d.fallen_m:.0f} cm, tips {d.tilted_deg:.0f} degrees" for d in shaken.falls
        ]
    return result, lines


def _variants(
    a: argparse.Namespace, room: diorama.Reconstruction, options: ExportOptions, folder: Path
) -> tuple[dict[str, Any], list[str]]:
    """Write the variants with their manifest and contact sheet into a folder."""
    from diorama_app.cli.variants import write_variants

    if a.variants < 1:
        raise InputError(f"--variants {a.variants}: give a number of variants, such as 100")
    with progress_bar() as progress:
        manifest = write_variants(
            room,
            folder,
            EXPORT_FORMATS[a.format],
            count=a.variants,
            seed=a.seed,
            aspects=[name.strip() for name in a.vary.split(",")],
            options=options,
            view=WITHOUT_PHOTO if room.scene.camera is None else "photo",
            progress=progress,
        )
    lines = [
        f"{folder}: {number_of(a.variants, 'variant')}, {manifest['drawn']} drawn; see variants.json and variants.jpg"
    ]
    if manifest["locked"]:
        lines.append(f"locked, since it does not rest in the room itself: {', '.join(manifest['locked'])}")
    return manifest, lines
