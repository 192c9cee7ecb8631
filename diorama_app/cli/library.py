"""Commands about shapes: `diorama library ...`."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import diorama_core as diorama
from diorama_app.cli.arguments import command, print_note, progress_bar
from diorama_app.cli.library_add import add_adding
from diorama_core.errors import InputError

if TYPE_CHECKING:
    from PIL import Image

    from diorama_core.library.record import Shape


def add_library(commands: Any) -> None:
    """Declare `diorama library`."""
    p: argparse.ArgumentParser = commands.add_parser("library", help="Manage the shape libraries.")
    actions = p.add_subparsers(dest="action", required=True, metavar="build|add|info|list|search|sheet|show")
    build = command(actions, "build", _library_build, "diorama library build --library mine")
    _add_library_name(build)
    build.add_argument("--parts", action="store_true", help="also the convex parts that keep shapes apart (minutes)")
    build.add_argument("--views", action="store_true", help="also the image features for retrieval and image search")
    build.add_argument("--templates", action="store_true", help="also all pose templates, some 2 MB a shape")
    build.add_argument("--workers", type=int, metavar="N", help="processes (default: all cores)")
    build.add_argument("--ray", metavar="ADDRESS", help="work on a Ray cluster: auto, HOST:PORT, or local to start one")
    add_adding(actions)
    lists = command(actions, "list", _library_list, "diorama library list --category chair")
    lists.add_argument("--category", help="only this category (synonyms are understood)")
    _add_library_name(lists)
    lists.add_argument("--json", action="store_true")
    search = command(actions, "search", _library_search, 'diorama library search "wooden armchair"')
    search.add_argument("text", metavar="TEXT", nargs="?", default="", help="what to find; optional with --image")
    search.add_argument("--image", type=Path, metavar="FILE", help="a picture of the object, best cut out")
    _add_library_name(search)
    search.add_argument("-k", type=int, default=10, help="how many (default: %(default)s)")
    search.add_argument("--json", action="store_true")
    sheet = command(actions, "sheet", _library_sheet, "diorama library sheet --category lamp -o lamps.png")
    sheet.add_argument("-o", "--output", type=Path, default=Path("library.png"), help="PNG (default: %(default)s)")
    sheet.add_argument("--category", help="only this category (synonyms are understood)")
    _add_library_name(sheet)
    sheet.add_argument("--size", type=int, default=240, help="side of one picture in pixels (default: %(default)s)")
    sheet.add_argument("--columns", type=int, default=6, help="pictures side by side (default: %(default)s)")
    show = command(actions, "show", _library_show, "diorama library show floor-lamp-arc --watch")
    show.add_argument("id", metavar="ID")
    show.add_argument("-o", "--output", type=Path, metavar="FILE", help="PNG (default: ID.png)")
    show.add_argument("--watch", action="store_true", help="draw it again whenever its design or its library changes")
    _add_library_name(show)


def _add_library_name(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--library", default="built-in", metavar="NAME", help="one, or several joined by + (default: %(default)s)"
    )


def _library_build(a: argparse.Namespace) -> None:
    """Prepare a library's shapes once."""

    from diorama_core.pipeline.prepare import prepare_library
    from diorama_core.workers import workers

    with progress_bar() as progress:
        prepared = prepare_library(
            a.library,
            parts=a.parts,
            views=a.views,
            templates=a.templates,
            pool=workers(a.ray, a.workers),
            progress=progress,
        )
    for shape_id, reason in prepared.failures:
        print(f"diorama: {shape_id}: {reason}", file=sys.stderr)
    ready = prepared.count - len(prepared.failures)
    print(f"{ready} of {prepared.count} shapes of {a.library} are ready, {prepared.made} made now")


def _library_list(a: argparse.Namespace) -> None:
    """List the shapes."""

    from diorama_core.library.taxonomy import resolve

    library = diorama.open_library(a.library)
    shapes = library.shapes() if a.category is None else library.in_category(resolve(a.category).category.name)
    _print_shapes(shapes, a.json)


def _library_search(a: argparse.Namespace) -> None:
    """Find shapes by words, a picture, or both."""

    from diorama_core.library.search import find

    if a.k < 1:
        raise InputError(f"-k {a.k}: ask for at least one shape")
    if a.image is None and not a.text.strip():
        raise InputError("say what to look for, in words or with --image FILE")
    library = diorama.open_library(a.library)
    if a.image is None:
        matches = find(library, a.text, a.k)
        notes = [matches.note]
    else:
        from diorama_core.render.crops import read_crop
        from diorama_core.render.image_search import ImageSearch

        crop = read_crop(a.image)
        with progress_bar() as progress:
            matches = ImageSearch(library).find(crop, a.text, a.k, progress)
        notes = [matches.note, crop.note]
    for note in filter(None, notes):
        print_note(note)
    _print_shapes(matches.shapes, a.json)


def _library_sheet(a: argparse.Namespace) -> None:
    """Draw all shapes, or those of one category, on one page."""

    from diorama_core.library.taxonomy import resolve
    from diorama_core.render.thumbnails import shape_sheet

    if not (16 <= a.size <= 1024 and 1 <= a.columns <= 40):
        raise InputError(f"--size {a.size} --columns {a.columns}: give a side of 16 to 1024 and 1 to 40 columns")
    _check_picture(a.output)
    library = diorama.open_library(a.library)
    if a.category is None:
        shapes = tuple(sorted(library.shapes(), key=lambda s: s.category))  # stable: siblings side by side
    else:
        named = resolve(a.category)
        if named.note:
            print_note(named.note)
        shapes = library.in_category(named.category.name)
    with progress_bar() as progress:
        page = shape_sheet(library, shapes, a.size, a.columns, progress)
    _save(page, a.output)
    print(f"{len(shapes)} shapes on {a.output}")


def _library_show(a: argparse.Namespace) -> None:
    """Draw one shape from four sides."""
    output = a.output or Path(f"{a.id}.png")
    _check_picture(output)
    if a.watch:
        words = ["library", "show", a.id, "--library", a.library, "--output", str(output)]
        for _ in changes(_folders(a.library)):  # by another process each time: it reads the design as it is now
            subprocess.run([sys.executable, "-m", "diorama_app.cli", *words])
    from diorama_core.render.views import four_views

    library = diorama.open_library(a.library)
    _save(four_views(library, a.id), output)
    x, y, z = library.shape(a.id).size_m
    print(f"{a.id} ({y:.2f} x {x:.2f} x {z:.2f} m) on {output}")


def _folders(names: str) -> tuple[Path, ...]:
    """Folders whose files change what a library's shapes look like."""
    from diorama_core.library import furniture
    from diorama_core.library.store import library_folder

    built_in = Path(furniture.__file__).parent
    return tuple(built_in if name == "built-in" else library_folder(name) for name in names.split("+"))


def changes(folders: Sequence[Path], pause_s: float = 0.3) -> Iterator[None]:
    """An endless iterator: one item at once, and one whenever a file in the folders is written, added or deleted."""
    before = None
    while True:
        files = (path for folder in folders for path in folder.rglob("*") if path.suffix != ".pyc" and path.is_file())
        now = {path: path.stat().st_mtime_ns for path in files}
        if now != before:
            before = now
            yield
        time.sleep(pause_s)


def _check_picture(output: Path) -> None:
    """Refuse, before a picture is drawn, a file that it cannot be written to."""
    if output.suffix.lower() != ".png":
        raise InputError(f"-o {output}: the picture is a PNG; end the name with .png")
    if not output.absolute().parent.is_dir():
        raise InputError(f"-o {output}: there is no folder {output.parent}; make it first")


def _save(picture: Image.Image, output: Path) -> None:
    try:
        picture.save(output)
    except OSError as error:
        raise InputError(f"{output}: cannot be written ({error.strerror or error}); choose another place") from None


def _print_shapes(shapes: Sequence[Shape], as_json: bool) -> None:
    if as_json:
        rows = [{"id": s.id, "category": s.category, "caption": s.caption, "size_m": list(s.size_m)} for s in shapes]
        print(json.dumps(rows))
        return
    for s in shapes:
        x, y, z = s.size_m
        print(f"{s.id:<28} {s.category:<16} {y:.2f} x {x:.2f} x {z:.2f} m  {s.caption}")
