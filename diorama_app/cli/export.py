"""`diorama export`: a project's scene for other programs, what gravity does to it, and variants of it."""

from __future__ import annotations

import argparse
import io
import json
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from PIL import Image

import diorama_core as diorama
from diorama_app.cli.arguments import WITHOUT_PHOTO, command, progress_bar
from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_core.appearance.surface_finish import with_finish_pictures
from diorama_core.errors import InputError
from diorama_core.export import Format
from diorama_core.io.atomic import write_atomically
from diorama_core.io.text import number_of
from diorama_core.progress import Progress
from diorama_core.synthesis.variants import ASPECTS, Aspect, Variant, VariantMaker, locked_where_restless

if TYPE_CHECKING:
    from diorama_core.export.gathering import ExportOptions, ExportScene

PICTURE_PX = (320, 240)
COLUMNS = 10
MAX_DRAWN = 3
"""Seeds that are tried for each variant that is asked for, at most."""


def add_export(commands: Any) -> None:
    """Declare `diorama export`."""

    p = command(
        commands,
        "export",
        _export,
        "Write a project's scene for other tools.",
        "diorama export my-room --format glb -o room.glb",
    )
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
        simulated, notes = _simulated(a, written, output)
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


def _simulated(a: argparse.Namespace, written: ExportScene, output: Path) -> tuple[dict[str, Any], list[str]]:
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
        result["shake"] = {"fallen": [d.object_id for d in shaken.fallen], **asdict(EARTHQUAKE), **asdict(shaken)}
        lines.append(
            f"floor shaken by {EARTHQUAKE}: {len(shaken.fallen)} of {number_of(len(shaken.drifts))} fall ({what})"
        )
        lines += [
            f"  {d.object_id} falls by {100 * d.fallen_m:.0f} cm, tips {d.tilted_deg:.0f} degrees"
            for d in shaken.fallen
        ]
    return result, lines


def _variants(
    a: argparse.Namespace, room: diorama.Reconstruction, options: ExportOptions, folder: Path
) -> tuple[dict[str, Any], list[str]]:
    """Write the variants with their manifest and contact sheet into a folder."""

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


def write_variants(
    room: diorama.Reconstruction,
    folder: Path,
    chosen: Format,
    *,
    count: int,
    seed: int,
    aspects: Sequence[str],
    options: ExportOptions,
    view: str,
    progress: Progress,
) -> dict[str, Any]:
    """Write so many variants, every one of which is at rest, and return the manifest, which is written last.

    Args:
        room: what varies.
        folder: for the files; it is made where it is missing.
        chosen: the format of the variants.
        count: how many.
        seed: of the first; those whose rooms do not come to rest are passed over.
        aspects: of `ASPECTS`.
        options: of the export.
        view: of the pictures, as `diorama picture` names them.
        progress: reports and cancellation.

    Raises:
        InputError: there is no such aspect, or too few seeds lead to a room at rest.
        ExportError: a file cannot be written.
    """
    if unknown := sorted(set(aspects) - set(ASPECTS)):
        raise InputError(f"--vary {unknown[0]}: choose of {', '.join(ASPECTS)}")
    scene, locked = locked_where_restless(room.scene, room.library)
    maker = VariantMaker(scene, room.library, cast("Sequence[Aspect]", aspects))
    folder.mkdir(parents=True, exist_ok=True)
    rows: list[dict[str, Any]] = []
    pictures = []
    for drawn in range(count * MAX_DRAWN):
        progress.report(len(rows) / count, f"variant {len(rows) + 1} of {count}")
        variant = maker.draw(seed + drawn)
        if variant is None:
            continue
        finished, finishes = with_finish_pictures(variant.scene, room.textures)
        shown = replace(room, scene=finished, textures={**room.textures, **finishes})
        path = folder / f"variant_{len(rows):03d}{chosen.suffixes[0]}"
        diorama.export(shown, path, format=chosen, options=options, progress=Progress(token=progress.token))
        pictures.append(diorama.render(shown, view=view, size=PICTURE_PX))
        rows.append(_row(path, variant))
        if len(rows) == count:
            break
    else:
        raise InputError(f"{folder}: {len(rows)} of {count} variants come to rest; vary less, such as --vary textures")
    manifest = {"seed": seed, "vary": list(aspects), "drawn": drawn + 1, "locked": list(locked), "variants": rows}
    _write_sheet(folder / "variants.jpg", pictures)
    text = json.dumps(manifest, indent=1) + "\n"
    write_atomically(folder / "variants.json", text.encode(), error=InputError)
    return manifest


def _row(path: Path, variant: Variant) -> dict[str, Any]:
    moved = round(variant.max_moved_m, 5)
    return {"file": path.name, "seed": variant.seed, "max_moved_m": moved, "changes": dict(variant.changes)}


def _write_sheet(path: Path, pictures: Sequence[np.ndarray]) -> None:
    """All pictures side by side, row by row."""
    width, height = PICTURE_PX
    columns = min(COLUMNS, len(pictures))
    sheet = Image.new("RGB", (columns * width, -(-len(pictures) // columns) * height), "white")
    for number, picture in enumerate(pictures):
        sheet.paste(Image.fromarray(picture), (number % columns * width, number // columns * height))
    buffer = io.BytesIO()
    sheet.save(buffer, "JPEG", quality=85)
    write_atomically(path, buffer.getvalue(), error=InputError)
