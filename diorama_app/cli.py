"""The command line: `diorama COMMAND`. Each command is one function; heavy imports happen inside it."""

from __future__ import annotations

import argparse
import json
import logging
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import diorama_core
from diorama_core.errors import Cancelled, DioramaError, InputError, UnavailableError

if TYPE_CHECKING:
    from diorama_core.library.record import Shape
    from diorama_core.project.storage import Project
    from diorama_core.scene.types import Scene

EXPORT_FORMATS = ("glb",)
RECIPES = ("feasible", "paper", "all-in-one")
PROFILES = ("auto", "embedded", "foundation")


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status: 0 done, 1 failed with one clear line, 2 bad usage, 130 stopped."""
    # Small problems run faster on one thread than on two that wait for each other.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    arguments = _parser().parse_args(argv)
    logging.basicConfig(level=logging.DEBUG if arguments.verbose else logging.ERROR, stream=sys.stderr)
    try:
        return int(arguments.run(arguments) or 0)
    except KeyboardInterrupt:
        print("diorama: stopped; finished stages are kept and the next run resumes there", file=sys.stderr)
        return 130
    except Cancelled as error:
        print(f"diorama: {error}", file=sys.stderr)
        return 130
    except DioramaError as error:
        if arguments.verbose:
            logging.exception("details")
        print(f"diorama: {error}", file=sys.stderr)
        return 1
    except BrokenPipeError:
        return 1
    except Exception as error:
        if arguments.verbose:
            logging.exception("details")
        where = f"{type(error).__name__}: {error}"
        print(f"diorama: internal error ({where}); run again with --verbose and report it", file=sys.stderr)
        return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="diorama", description="One picture of a room becomes an editable 3D scene.", allow_abbrev=False
    )
    parser.add_argument("--version", action="version", version=f"diorama {diorama_core.__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    _add_serve(commands)
    _add_build(commands)
    _add_optimise(commands)
    _add_export(commands)
    _add_picture(commands)
    _add_library(commands)
    _add_bench(commands)
    _add_doctor(commands)
    return parser


def _command(commands: Any, name: str, run: Any, summary: str, example: str) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = commands.add_parser(
        name,
        help=summary,
        description=summary,
        epilog=f"example:\n  {example}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("--verbose", action="store_true", help="log what happens and show tracebacks")
    parser.set_defaults(run=run)
    return parser


def _add_serve(commands: Any) -> None:
    p = _command(commands, "serve", _serve, "Open the editor in the browser.", "diorama serve my-room --port 8081")
    p.add_argument("project", nargs="?", type=Path, metavar="PROJECT", help="project folder (default: the example)")
    p.add_argument("--host", default="127.0.0.1", help="address to listen on (default: %(default)s)")
    p.add_argument("--port", type=int, default=8080, help="port to listen on, 0 for any (default: %(default)s)")
    p.add_argument("--projects", type=Path, metavar="DIR", help="where new projects go (default: ~/Diorama)")
    p.add_argument("--no-open", action="store_true", help="do not open a browser window")
    p.add_argument("--low-graphics", action="store_true", help="no shadows or environment light (software WebGL)")
    p.add_argument("--token", metavar="T", help="browsers must give this token: needed for hosts other than this one")


def _serve(a: argparse.Namespace) -> None:
    from diorama_app.server import serve

    serve(
        project=a.project,
        projects_dir=a.projects or Path.home() / "Diorama",
        host=a.host,
        port=a.port,
        open_browser=not a.no_open,
        low_graphics=a.low_graphics,
        token=a.token,
    )


def _add_build(commands: Any) -> None:
    p = _command(
        commands, "build", _build, "Build a scene from a photo.", "diorama build room.jpg --boxes boxes.json -o my-room"
    )
    p.add_argument("image", type=Path, metavar="IMAGE", help="the photo")
    p.add_argument("-o", "--output", type=Path, required=True, metavar="PROJECT", help="project folder to write")
    p.add_argument("--depth", type=Path, metavar="FILE", help="measured depth: 16-bit PNG, .npy in metres, or EXR")
    p.add_argument("--depth-scale", type=_positive, default=1000.0, help="depth PNG units a metre (default: 1000)")
    p.add_argument("--depth-encoding", choices=("linear", "sunrgbd"), default="linear", help="how a PNG stores depth")
    inner = p.add_mutually_exclusive_group()
    inner.add_argument("--intrinsics", type=_intrinsics, metavar="fx,fy,cx,cy", help="camera intrinsics in pixels")
    inner.add_argument("--fov", type=_field_of_view, metavar="DEG", help="horizontal field of view in degrees")
    p.add_argument(
        "--boxes", type=Path, metavar="FILE", help='JSON list of {"bbox": [x1, y1, x2, y2], "class": "chair"}'
    )
    p.add_argument("--masks", type=Path, metavar="FILE", help="PNG with one colour or id per object, black is none")
    p.add_argument("--profile", choices=PROFILES, default="auto", help="which networks to use (default: %(default)s)")
    p.add_argument("--arrangements", type=int, default=1, metavar="N", help="scenes with other shapes to write beside")
    p.add_argument("--library", default="built-in", metavar="NAME", help="shape library (default: %(default)s)")
    p.add_argument("--recipe", choices=RECIPES, default=RECIPES[0], help="layout optimiser (default: %(default)s)")
    p.add_argument("--seed", type=int, default=0, help="seed of random stages (the embedded ones draw nothing)")
    p.add_argument("--json", action="store_true", help="print the result as JSON")


def _build(a: argparse.Namespace) -> None:
    from diorama_app.building import build_report, library_named, write_arrangements
    from diorama_core.perception.inputs import read_inputs
    from diorama_core.pipeline.build import embedded_stages
    from diorama_core.project.build import build_project
    from diorama_core.project.storage import Project

    if a.profile == "foundation":
        raise UnavailableError(
            "the foundation profile needs networks that this version cannot load yet; use --profile embedded"
        )
    if a.arrangements < 1:
        raise InputError(f"--arrangements {a.arrangements}: ask for at least one")
    read = read_inputs(
        a.image,
        depth=a.depth,
        depth_scale=a.depth_scale,
        depth_encoding=a.depth_encoding,
        intrinsics=a.intrinsics,
        fov_deg=a.fov,
        boxes=a.boxes,
        masks=a.masks,
    )
    for warning in read.warnings:
        print(f"diorama: note: {warning}", file=sys.stderr)
    library = library_named(a.library)
    project = Project.create(a.output)
    stages = embedded_stages(read.inputs, library, recipe=a.recipe)
    with _progress_bar() as progress:
        built = build_project(project, read.inputs, library, stages=stages, warnings=read.warnings, progress=progress)
        scenes = write_arrangements(project, built.scene, stages.layout, a.arrangements, progress)
    report = build_report(project, built, scenes)
    if a.json:
        print(json.dumps(report))
    else:
        print(f"{a.output}: {report['summary']}")
        if not built.objects:
            print(f"No boxes were given: open it with 'diorama serve {a.output}' and draw boxes around the furniture.")


def _add_optimise(commands: Any) -> None:
    p = _command(
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

    from diorama_app.building import library_named
    from diorama_core.layout.recipes import recipe
    from diorama_core.scene.edits import set_metrics

    project, scene = _opened(a.project)
    with _progress_bar() as progress:
        arranged, report = recipe(a.recipe, library_named("built-in")).optimise(scene, progress)
    project.save_scene(set_metrics(arranged, report.after))
    if a.json:
        print(json.dumps(asdict(report)))
        return
    width = max((len(name) for name in report.after), default=0)
    for name, after in report.after.items():
        before = report.before.get(name)
        print(f"{name:<{width}}  {'' if before is None else f'{before:10.4f} ->'} {after:10.4f}")
    for reason in report.reasons:
        print(f"note: {reason}")


def _add_export(commands: Any) -> None:
    p = _command(
        commands,
        "export",
        _export,
        "Write a project's scene for other tools.",
        "diorama export my-room --format glb -o room.glb",
    )
    p.add_argument("project", type=Path, metavar="PROJECT")
    p.add_argument("--format", choices=EXPORT_FORMATS, required=True)
    p.add_argument("-o", "--output", type=Path, required=True, metavar="FILE")


def _export(a: argparse.Namespace) -> None:
    from diorama_app.building import library_named
    from diorama_core.export.gltf import write_glb

    project, scene = _opened(a.project)
    write_glb(scene, library_named("built-in"), a.output, textures=project.textures(scene))
    print(f"{a.output}: {len(scene.objects)} objects, {len(scene.architecture.planes)} planes")


def _add_picture(commands: Any) -> None:
    p = _command(
        commands,
        "picture",
        _picture,
        "Draw a project's scene.",
        "diorama picture my-room -o top.png --view top --size 1200x900",
    )
    p.add_argument("project", type=Path, metavar="PROJECT")
    p.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.png")
    p.add_argument("--view", type=_view, default="photo", metavar="photo|top|front|orbit:DEG", help="(default: photo)")
    p.add_argument("--size", type=_size, metavar="WxH", help="in pixels (default: the photo's, at most 1024 wide)")


def _picture(a: argparse.Namespace) -> None:
    import io

    from PIL import Image

    from diorama_app.building import library_named
    from diorama_core.project.files import write_atomically
    from diorama_core.render.picture import picture

    project, scene = _opened(a.project)
    textures = project.textures(scene)
    image = picture(scene, library_named("built-in"), view=a.view, size=a.size, textures=textures)
    buffer = io.BytesIO()
    kind = {".png": "PNG", ".jpg": "JPEG", ".jpeg": "JPEG"}.get(a.output.suffix.lower())
    if kind is None:
        raise InputError(f"{a.output}: pictures are written as .png or .jpg; choose such a name")
    Image.fromarray(image).save(buffer, kind)
    write_atomically(a.output, buffer.getvalue())
    print(f"{a.output}: {image.shape[1]}x{image.shape[0]}")


def _add_library(commands: Any) -> None:
    p: argparse.ArgumentParser = commands.add_parser("library", help="The shapes that scenes are made of.")
    actions = p.add_subparsers(dest="action", required=True, metavar="build|list|search")
    _command(actions, "build", _library_build, "Prepare the built-in shapes once.", "diorama library build")
    lists = _command(actions, "list", _library_list, "List the shapes.", "diorama library list --category chair")
    lists.add_argument("--category", help="only this category (synonyms are understood)")
    lists.add_argument("--json", action="store_true")
    search = _command(
        actions, "search", _library_search, "Find shapes by words.", 'diorama library search "wooden armchair"'
    )
    search.add_argument("text", metavar="TEXT")
    search.add_argument("-k", type=int, default=10, help="how many (default: %(default)s)")
    search.add_argument("--json", action="store_true")


def _library_build(a: argparse.Namespace) -> None:
    from diorama_core.library.catalogue import default_cache_dir
    from diorama_core.pipeline.prepare import prepare_library

    with _progress_bar() as progress:
        count = prepare_library(progress=progress)
    print(f"{count} shapes ready in {default_cache_dir()}")


def _library_list(a: argparse.Namespace) -> None:
    from diorama_app.building import library_named
    from diorama_core.library.taxonomy import resolve

    library = library_named("built-in")
    found = library.shapes() if a.category is None else library.in_category(resolve(a.category).category.name)
    _print_shapes(found, a.json)


def _library_search(a: argparse.Namespace) -> None:
    from diorama_app.building import library_named
    from diorama_core.library.search import search
    from diorama_core.library.taxonomy import resolve

    if a.k < 1:
        raise InputError(f"-k {a.k}: ask for at least one shape")
    note = resolve(a.text).note
    if note:
        print(f"diorama: note: {note}", file=sys.stderr)
    _print_shapes(search(library_named("built-in"), a.text, a.k), a.json)


def _print_shapes(shapes: Sequence[Shape], as_json: bool) -> None:
    if as_json:
        rows = [{"id": s.id, "category": s.category, "caption": s.caption, "size_m": list(s.size_m)} for s in shapes]
        print(json.dumps(rows))
        return
    for s in shapes:
        x, y, z = s.size_m
        print(f"{s.id:<28} {s.category:<16} {y:.2f} x {x:.2f} x {z:.2f} m  {s.caption}")


def _add_bench(commands: Any) -> None:
    p: argparse.ArgumentParser = commands.add_parser("bench", help="Measure the stages on generated rooms.")
    tables = p.add_subparsers(dest="table", required=True, metavar="layout")
    layout = _command(
        tables, "layout", _bench_layout, "The layout recipes against each other.", "diorama bench layout --scenes 40"
    )
    layout.add_argument("--scenes", type=int, default=40, metavar="N", help="generated rooms (default: %(default)s)")
    layout.add_argument("--seed", type=int, default=0, metavar="S", help="of the rooms (default: %(default)s)")
    layout.add_argument("--json", type=Path, metavar="FILE", help="write the results as JSON too")


def _bench_layout(a: argparse.Namespace) -> None:
    from diorama_core.evaluation.layout_bench import run
    from diorama_core.project.files import write_atomically

    if a.scenes < 1:
        raise InputError(f"--scenes {a.scenes}: ask for at least one")
    with _progress_bar() as progress:
        bench = run(scenes=a.scenes, seed=a.seed, progress=progress)
    if a.json:
        write_atomically(a.json, json.dumps(bench.to_json(), indent=1).encode())
    print(bench.to_markdown())


def _add_doctor(commands: Any) -> None:
    p = _command(commands, "doctor", _doctor, "Check that this machine can run Diorama.", "diorama doctor")
    p.add_argument("--json", action="store_true", help="print the findings as JSON")


def _doctor(a: argparse.Namespace) -> int:
    from diorama_app.doctor import examine

    findings = examine()
    if a.json:
        print(json.dumps([finding.__dict__ for finding in findings]))
    else:
        for finding in findings:
            mark = "ok  " if finding.ok else "FAIL" if finding.needed else "none"
            print(f"{mark}  {finding.name:<22} {finding.detail}")
    broken = [finding.name for finding in findings if finding.needed and not finding.ok]
    if broken:
        print(f"diorama: this machine lacks {', '.join(broken)}; see the lines above", file=sys.stderr)
    return 1 if broken else 0


def _opened(folder: Path) -> tuple[Project, Scene]:
    from diorama_core.project.storage import Project

    project = Project.open(folder)
    return project, project.load_scene()


def _progress_bar() -> Any:
    from diorama_app.progress_bar import progress_bar

    return progress_bar()


def _positive(text: str) -> float:
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return value


def _field_of_view(text: str) -> float:
    value = _positive(text)
    if not 5 <= value <= 150:
        raise argparse.ArgumentTypeError(f"{text} degrees; give a horizontal field of view between 5 and 150")
    return value


def _intrinsics(text: str) -> tuple[float, float, float, float]:
    try:
        fx, fy, cx, cy = (float(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}; give four numbers in pixels: fx,fy,cx,cy") from None
    if not (fx > 0 and fy > 0):
        raise argparse.ArgumentTypeError(f"{text!r}; focal lengths must be positive")
    return fx, fy, cx, cy


def _view(text: str) -> str:
    kind, _, angle = text.partition(":")
    try:
        known = text in ("photo", "top", "front") or (kind == "orbit" and abs(float(angle)) < 1e6)
    except ValueError:
        known = False
    if not known:
        raise argparse.ArgumentTypeError(f"{text!r}; choose photo, top, front or orbit:DEG, such as orbit:30")
    return text


def _size(text: str) -> tuple[int, int]:
    try:
        width, height = (int(part) for part in text.lower().split("x"))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}; give width x height, such as 1024x768") from None
    if not (16 <= width <= 8192 and 16 <= height <= 8192):
        raise argparse.ArgumentTypeError(f"{text!r}; each side must be between 16 and 8192")
    return width, height


if __name__ == "__main__":
    sys.exit(main())
