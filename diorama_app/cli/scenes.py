"""Commands that make, change and show scenes: serve, build, optimise, export, picture."""

from __future__ import annotations

import argparse
import json
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import diorama_core as diorama
from diorama_app.cli.arguments import (
    PROFILES,
    PROJECTS_HELP,
    RECIPES,
    coefficients,
    command,
    field_of_view,
    intrinsics,
    positive,
    print_note,
    progress_bar,
    projects_folder,
    size,
    view,
)
from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_app.projects.options import POSES, ROOMS, SYSTEMS, BuildOptions, PhotoFiles, build_files
from diorama_core.errors import InputError
from diorama_core.io.text import number_of

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    import numpy as np

    from diorama_app.serve import Beside, Running


WITHOUT_PHOTO = "orbit:35"
"""View of a scene that no photo was taken of."""


def add_serve(commands: Any) -> None:
    """Declare `diorama serve`."""
    p = command(commands, "serve", _serve, "Open the editor in the browser.", "diorama serve my-room --port 8081")
    p.add_argument("project", nargs="?", type=Path, metavar="PROJECT", help="project folder (default: the example)")
    p.add_argument("--host", default="127.0.0.1", help="address to listen on (default: %(default)s)")
    p.add_argument("--port", type=int, default=8080, help="port to listen on, 0 for any (default: %(default)s)")
    p.add_argument("--projects", type=Path, metavar="DIR", help=PROJECTS_HELP)
    p.add_argument("--no-open", action="store_true", help="do not open a browser window")
    p.add_argument("--low-graphics", action="store_true", help="no shadows or environment light (software WebGL)")
    p.add_argument("--token", metavar="T", help="browsers must give this token: needed for hosts other than this one")
    p.add_argument("--library", metavar="NAME", help="shape library (default: the project's own, or built-in)")
    p.add_argument(
        "--frame-origin",
        action="append",
        default=[],
        metavar="ORIGIN",
        help="pages of this origin may show the editor in a frame, such as http://localhost:8888 of a notebook; may be "
        "given several times (default: none may)",
    )


def _serve(a: argparse.Namespace) -> None:
    from diorama_app.serve import serve
    from diorama_core.project.storage import Project

    name = a.library
    if name is None:
        name = "built-in" if a.project is None else Project.open(a.project).shared_library_name
    serve(
        project=a.project,
        library=name,
        projects_dir=projects_folder(a.projects),
        host=a.host,
        port=a.port,
        open_browser=not a.no_open,
        low_graphics=a.low_graphics,
        token=a.token,
        frame_origins=a.frame_origin,
        beside=_api_beside(),
    )


def _api_beside() -> Beside | None:
    """The HTTP interface beside the editor, where its libraries are installed."""
    if any(find_spec(module) is None for module in ("fastapi", "python_multipart", "uvicorn")):
        return None

    def loaded(running: Running, token: str | None) -> AbstractContextManager[object]:
        from diorama_app.http_api.beside import api_beside  # the page comes first

        return api_beside(running, token)

    return loaded


def add_build(commands: Any) -> None:
    """Declare `diorama build`."""
    p = command(
        commands, "build", _build, "Build a scene from a photo.", "diorama build room.jpg --boxes boxes.json -o my-room"
    )
    p.add_argument("image", type=Path, metavar="IMAGE|DIR", help="the photo, or a folder of photos with their files")
    p.add_argument(
        "-o",
        "--output",
        "--out",
        type=Path,
        required=True,
        metavar="PROJECT|DIR",
        help="project folder to write; of a folder of photos, the folder of their projects and of report.html",
    )
    p.add_argument("--workers", type=int, metavar="N", help="photos built at once (default: half the cores)")
    p.add_argument("--ray", metavar="ADDRESS", help="build a folder on a Ray cluster: auto, HOST:PORT, or local")
    p.add_argument(
        "--poses",
        type=Path,
        metavar="PATH|find",
        help="cameras of a folder's photos, which then become one room: COLMAP model, transforms.json, ARKit frames; "
        "'find' finds them by what the photos have in common",
    )
    _add_inputs(p)
    _add_networks(p)
    _add_methods(p)
    p.add_argument("--seed", type=int, default=0, help="seed of random stages (the built-in ones use none)")
    p.add_argument(
        "--explain", type=Path, metavar="FILE", help="file for the reasons of each place, kind and size, as JSON"
    )
    p.add_argument("--json", action="store_true", help="print the result as JSON")


def _add_inputs(p: argparse.ArgumentParser) -> None:
    """Declare what may be given with the photo."""
    p.add_argument("--depth", type=Path, metavar="FILE", help="measured depth: 16-bit PNG, .npy, .npz, EXR or a dump")
    p.add_argument(
        "--depth-scale",
        type=positive,
        metavar="N",
        help="depth units a metre (default: 1000 of whole numbers and 1 of others, unless the picture contradicts it)",
    )
    p.add_argument(
        "--depth-kind",
        choices=("auto", "depth", "distance", "inverse", "root", "logarithm", "shifted"),
        default="auto",
        help="along the optical axis or the rays, inverse, root, logarithm, less a constant (default: by its looks)",
    )
    p.add_argument("--depth-encoding", choices=("linear", "sunrgbd"), default="linear", help="how a PNG stores depth")
    inner = p.add_mutually_exclusive_group()
    inner.add_argument("--intrinsics", type=intrinsics, metavar="fx,fy,cx,cy", help="camera intrinsics in pixels")
    inner.add_argument("--fov", type=field_of_view, metavar="DEG", help="horizontal field of view in degrees")
    p.add_argument(
        "--distortion",
        type=coefficients,
        default=(),
        metavar="k1,k2,p1,p2,k3",
        help="of the lens, as OpenCV has it, k1 alone at least: the photo is straightened before it is used; "
        "0 leaves it as it is (default: what its lines say)",
    )
    p.add_argument(
        "--half-turn", action="store_true", help="the photo and its files are upside down: turn them by 180 degrees"
    )
    p.add_argument(
        "--boxes",
        type=Path,
        metavar="FILE",
        help='JSON list of {"bbox": [x1, y1, x2, y2], "class": "chair"}, or COCO, VOC, YOLO, LabelMe, CVAT...',
    )
    p.add_argument(
        "--masks", type=Path, metavar="PATH", help="PNG with one colour or id per object, or a folder of masks"
    )


def _add_networks(p: argparse.ArgumentParser) -> None:
    p.add_argument("--profile", choices=PROFILES, default="auto", help="which networks to use (default: %(default)s)")
    p.add_argument(
        "--detector",
        metavar="ID|FILE",
        help="network that finds objects, or your own: an ONNX file of YOLO or DETR, its labels in a .txt beside it "
        "(default: the best on this machine)",
    )
    p.add_argument(
        "--depth-network",
        metavar="ID|FILE",
        help="network that reads depth, or your own: an ONNX file from RGB between 0 and 1 to metres "
        "(default: the best on this machine)",
    )


def _add_methods(p: argparse.ArgumentParser) -> None:
    """Declare shapes and layout, and the methods of the paper and of others to compare with."""
    p.add_argument(
        "--arrangements",
        type=int,
        default=1,
        metavar="N",
        help="number of scenes to write, each with other candidate shapes",
    )
    p.add_argument(
        "--library",
        default="built-in",
        metavar="NAME",
        help="shape library, or several joined by + (default: %(default)s)",
    )
    p.add_argument("--recipe", choices=RECIPES, default=RECIPES[0], help="layout optimiser (default: %(default)s)")
    p.add_argument(
        "--room",
        choices=ROOMS,
        default=ROOMS[0],
        help="how planes are found in depth, to compare with: the paper's PlainRecon or the baselines RaC and ACDC "
        "(default: %(default)s)",
    )
    p.add_argument(
        "--pose",
        choices=POSES,
        help="how shapes are posed, to compare with: the paper's correspondences or a baseline, with the embedded "
        "features (default: the profile's)",
    )
    p.add_argument(
        "--system",
        choices=SYSTEMS,
        default=SYSTEMS[0],
        help="acdc: room, retrieval, poses and layout as ACDC has them, to compare with (default: %(default)s)",
    )


def _build(a: argparse.Namespace) -> None:
    from diorama_app.cli.folder import build_folder

    options = BuildOptions(
        depth_scale=a.depth_scale,
        depth_encoding=a.depth_encoding,
        depth_kind=a.depth_kind,
        profile=a.profile,
        detector=a.detector,
        depth_network=a.depth_network,
        recipe=a.recipe,
        library=a.library,
        room=a.room,
        pose=a.pose,
        system=a.system,
    )
    if a.explain is not None and (a.poses is not None or a.image.is_dir()):
        raise InputError("--explain is for one photo; each project of a folder of photos has its reasons.json")
    if a.poses is not None:
        from diorama_app.cli.posed import build_posed

        build_posed(a, options)
    elif a.image.is_dir():
        build_folder(a, options)
    elif a.workers is not None or a.ray is not None:
        raise InputError("--workers and --ray are for a folder of photos; leave them out for one photo")
    else:
        _build_photo(a, options)


def _build_photo(a: argparse.Namespace, options: BuildOptions) -> None:
    from diorama_app.projects.report import build_report, write_arrangements
    from diorama_core.project.reasons import write_reasons

    if a.arrangements < 1:
        raise InputError(f"--arrangements {a.arrangements}: ask for at least one")
    files = PhotoFiles(a.image, a.boxes, a.masks, a.depth, a.intrinsics, a.fov, a.distortion, a.half_turn)
    with progress_bar() as progress:
        room = build_files(files, options, a.output, progress, print_note)
        scenes = write_arrangements(room, a.arrangements, progress)
    if a.explain is not None and room.built is not None:
        write_reasons(a.explain, room.built.reasons, InputError)
    report = build_report(room, scenes)
    if a.json:
        print(json.dumps(report))
    else:
        print(f"{a.output}: {report['summary']}")
        if "left_out" in report:
            print(_about_proposals(a.output, len(room.scene.objects), report["left_out"], _has_detector()))
        if not room.scene.objects:
            print(_invitation(a.output, detected=room.stages is not None and room.stages.detection is not None))


def _about_proposals(project: Path, used: int, left_out: int, detector: bool) -> str:
    """What to expect of a scene whose boxes nobody drew or checked.

    Args:
        project: its folder.
        used: objects in the scene.
        left_out: likely objects that were not used.
        detector: whether a network that finds any furniture is here already.
    """
    more = "" if detector else ", or find more with 'diorama models pull tiny'"
    return (
        f"No boxes were given: {used} of {used + left_out} likely objects were used. "
        f"Open it with 'diorama serve {project}' and correct the boxes{more}."
    )


def _has_detector() -> bool:
    from diorama_core.models.manifest import NETWORKS
    from diorama_core.models.store import ModelStore

    store = ModelStore.default()
    return any(store.has(n) for n in NETWORKS if n.role == "detection")


def _invitation(project: Path, *, detected: bool) -> str:
    """What to do where a scene is empty."""
    drawing = f"open it with 'diorama serve {project}' and draw boxes around the furniture"
    if detected:
        return f"No furniture was found: {drawing}."
    return f"No boxes were given: get the small detector with 'diorama models pull yolox-nano', or {drawing}."


def add_optimise(commands: Any) -> None:
    """Declare `diorama optimise`."""
    p = command(
        commands,
        "optimise",
        _optimise,
        "Run the layout optimiser on a project.",
        "diorama optimise my-room --recipe paper",
    )
    p.add_argument("project", type=Path, metavar="PROJECT")
    p.add_argument("--recipe", choices=RECIPES, default=RECIPES[0], help="(default: %(default)s)")
    p.add_argument("--json", action="store_true", help="print the report as JSON")


def _optimise(a: argparse.Namespace) -> None:
    from dataclasses import asdict

    from diorama_core.project.lock import ProjectLock

    room = diorama.load(a.project)
    with ProjectLock(a.project, "diorama optimise"), progress_bar() as progress:
        room = diorama.optimise(room, recipe=a.recipe, progress=progress)
        room.save(a.project)
    report = room.layout
    assert report is not None
    if a.json:
        print(json.dumps(asdict(report)))
        return
    width = max((len(name) for name in report.after), default=0)
    for name, after in report.after.items():
        before = report.before.get(name)
        print(f"{name:<{width}}  {'' if before is None else f'{before:10.4f} ->'} {after:10.4f}")
    for reason in report.reasons:
        print(f"note: {reason}")


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
    p.add_argument("--texture-size", type=int, metavar="PX", help="longest side of pictures; larger ones are reduced")
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
        choices=("godot", "unreal", "none"),
        default="godot",
        help="of a game pack: whose names colliders have; none leaves them out (default: %(default)s)",
    )
    p.add_argument("--photo", action="store_true", help="put the photo into the file, to come back with it (glb, usd)")
    p.add_argument("--welded", action="store_true", help="simulators: nothing moves, objects are welded in place")
    p.add_argument("--simulate", action="store_true", help="report what two seconds of gravity do to the scene")
    p.add_argument("--json", action="store_true", help="print the result as JSON")


def _export(a: argparse.Namespace) -> None:
    from dataclasses import asdict

    from diorama_core.export.gathering import ExportOptions

    room = diorama.load(a.project)
    only = None if a.only is None else frozenset(name.strip() for name in a.only.split(","))
    unknown = sorted(name for name in only or () if not room.scene.has_object(name))
    if unknown:
        raise InputError(f"--only {a.only}: there is no object {unknown[0]!r} in {a.project}; see its scene.json")
    if a.texture_size is not None and a.texture_size < 1:
        raise InputError(f"--texture-size {a.texture_size}: give a number of pixels, such as 1024")
    options = ExportOptions(
        ceiling=not a.no_ceiling,
        only=only,
        max_texture_px=a.texture_size,
        compression=a.compress,
        lights=a.lights,
        engine=a.engine,
        photo=a.photo,
        bodies="welded" if a.welded else "free",
    )
    assert room.project is not None
    output = a.output or room.project.folder / "exports" / f"{room.project.name}{EXPORT_FORMATS[a.format].suffixes[0]}"
    if a.output is None:
        output.parent.mkdir(parents=True, exist_ok=True)
    with progress_bar() as progress:
        written = diorama.export(room, output, format=EXPORT_FORMATS[a.format], options=options, progress=progress)
    result: dict[str, Any] = {"file": str(output), "objects": len(written.objects), "planes": len(written.planes)}
    lines = [f"{output}: {number_of(len(written.objects))}, {number_of(len(written.planes), 'plane')}"]
    if a.simulate:
        from diorama_core.export.stability import stability

        report = stability(written, urdf=output if a.format == "urdf" else None)
        what = "the file" if a.format in ("mjcf", "urdf") else "MuJoCo's model of the same bodies, not this file"
        result |= {"simulated": what, "stable_share": report.stable_share, **asdict(report)}
        lines.append(f"gravity: {report.stable_share:.0%} of objects stay within 1 cm and 2 degrees in 2 s ({what})")
        lines += [f"  {d.object_id} moves {100 * d.moved_m:.1f} cm" for d in report.unstable]
        lines += [f"  {note}" for note in report.notes]
    print(json.dumps(result) if a.json else "\n".join(lines))


def add_picture(commands: Any) -> None:
    """Declare `diorama picture`."""
    p = command(
        commands,
        "picture",
        _picture,
        "Draw a project's scene.",
        "diorama picture my-room -o top.png --view top --size 1200x900",
    )
    p.add_argument("project", type=Path, metavar="PROJECT")
    p.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.png")
    p.add_argument(
        "--view",
        type=view,
        metavar="photo|planes|top|front|orbit:DEG|turntable",
        help="planes: floor, walls and ceiling drawn over the photo; turntable: a film, .mp4 or .gif (default: photo, "
        f"or {WITHOUT_PHOTO} where there is none)",
    )
    p.add_argument("--size", type=size, metavar="WxH", help="in pixels (default: the photo's, at most 1280 wide)")
    p.add_argument("--cycles", action="store_true", help="path-traced by Blender's Cycles, where it is installed")
    p.add_argument("--samples", type=int, default=64, metavar="N", help="paths a pixel of --cycles (default: 64)")


def _picture(a: argparse.Namespace) -> None:
    import io

    from PIL import Image

    from diorama_core.io.atomic import write_atomically

    room = diorama.load(a.project)
    if a.view is None:
        a.view = "photo" if room.scene.camera is not None else WITHOUT_PHOTO
    if a.view == "turntable":
        _turntable(room, a)
        return
    kind = {".png": "PNG", ".jpg": "JPEG", ".jpeg": "JPEG"}.get(a.output.suffix.lower())
    if kind is None:
        raise InputError(f"{a.output}: pictures are written as .png or .jpg; choose such a name")
    image = _path_traced(room, a) if a.cycles else diorama.render(room, view=a.view, size=a.size)
    buffer = io.BytesIO()
    Image.fromarray(image).save(buffer, kind, compress_level=2)  # PNG: a sixth larger in a quarter of the time
    write_atomically(a.output, buffer.getvalue(), error=InputError)
    print(f"{a.output}: {image.shape[1]}x{image.shape[0]}")


def _path_traced(room: diorama.Reconstruction, a: argparse.Namespace) -> np.ndarray:
    """Render one picture with Cycles."""
    from diorama_core.export.cycles import cycles_picture
    from diorama_core.render.picture import scene_view
    from diorama_core.render.raycast import PinholeView

    view = None if a.view == "planes" else scene_view(room.scene, a.view, a.size)
    if not isinstance(view, PinholeView):
        raise InputError(f"--cycles draws perspective views; choose photo or orbit:DEG instead of {a.view}")
    if a.samples < 1:
        raise InputError(f"--samples {a.samples}: ask for at least one")
    with progress_bar() as progress:
        return cycles_picture(
            room.scene,
            room.library,
            camera=view.camera,
            textures=room.textures,
            samples=a.samples,
            progress=progress,
        )


def _turntable(room: diorama.Reconstruction, a: argparse.Namespace) -> None:
    """Render a turntable video of the scene."""
    from diorama_core.export.turntable import FRAMES, SIZE, write_turntable

    with progress_bar() as progress:
        write_turntable(
            room.scene, room.library, a.output, size=a.size or SIZE, textures=room.textures, progress=progress
        )
    print(f"{a.output}: {FRAMES} frames")
