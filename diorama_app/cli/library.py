"""Commands about shapes: `diorama library ...`."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import diorama_core as diorama
from diorama_app.cli.arguments import command, print_note, progress_bar
from diorama_app.cli.library_add import add_adding
from diorama_core.errors import InputError

if TYPE_CHECKING:
    from diorama_core.library.record import Shape


def add_library(commands: Any) -> None:
    """Declare `diorama library`."""
    p: argparse.ArgumentParser = commands.add_parser("library", help="Manage the shape libraries.")
    actions = p.add_subparsers(dest="action", required=True, metavar="build|add|list|search|info|sheet")
    build = command(
        actions, "build", _library_build, "Prepare a library's shapes once.", "diorama library build --library mine"
    )
    _add_library_name(build)
    build.add_argument("--parts", action="store_true", help="also the convex parts that keep shapes apart (minutes)")
    build.add_argument("--views", action="store_true", help="also the image features for retrieval and image search")
    build.add_argument("--templates", action="store_true", help="also all pose templates, some 2 MB a shape")
    build.add_argument("--workers", type=int, metavar="N", help="processes (default: all cores)")
    build.add_argument("--ray", metavar="ADDRESS", help="work on a Ray cluster: auto, HOST:PORT, or local to start one")
    add_adding(actions)
    lists = command(actions, "list", _library_list, "List the shapes.", "diorama library list --category chair")
    lists.add_argument("--category", help="only this category (synonyms are understood)")
    _add_library_name(lists)
    lists.add_argument("--json", action="store_true")
    search = command(
        actions,
        "search",
        _library_search,
        "Find shapes by words, a picture, or both.",
        'diorama library search "wooden armchair"',
    )
    search.add_argument("text", metavar="TEXT", nargs="?", default="", help="what to find; optional with --image")
    search.add_argument("--image", type=Path, metavar="FILE", help="a picture of the object, best cut out")
    _add_library_name(search)
    search.add_argument("-k", type=int, default=10, help="how many (default: %(default)s)")
    search.add_argument("--json", action="store_true")
    sheet = command(
        actions,
        "sheet",
        _library_sheet,
        "Draw all shapes, or those of one category, on one page.",
        "diorama library sheet --category lamp -o lamps.png",
    )
    sheet.add_argument("-o", "--output", type=Path, default=Path("library.png"), help="PNG (default: %(default)s)")
    sheet.add_argument("--category", help="only this category (synonyms are understood)")
    _add_library_name(sheet)
    sheet.add_argument("--size", type=int, default=240, help="side of one picture in pixels (default: %(default)s)")
    sheet.add_argument("--columns", type=int, default=6, help="pictures side by side (default: %(default)s)")


def _add_library_name(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--library", default="built-in", metavar="NAME", help="one, or several joined by + (default: %(default)s)"
    )


def _library_build(a: argparse.Namespace) -> None:
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
    from diorama_core.library.taxonomy import resolve

    library = diorama.open_library(a.library)
    found = library.shapes() if a.category is None else library.in_category(resolve(a.category).category.name)
    _print_shapes(found, a.json)


def _library_search(a: argparse.Namespace) -> None:
    from diorama_core.library.search import find

    if a.k < 1:
        raise InputError(f"-k {a.k}: ask for at least one shape")
    if a.image is None and not a.text.strip():
        raise InputError("say what to look for, in words or with --image FILE")
    library = diorama.open_library(a.library)
    if a.image is None:
        found = find(library, a.text, a.k)
        notes = [found.note]
    else:
        from diorama_core.render.crops import read_crop
        from diorama_core.render.image_search import ImageSearch

        crop = read_crop(a.image)
        with progress_bar() as progress:
            found = ImageSearch(library).find(crop, a.text, a.k, progress)
        notes = [found.note, crop.note]
    for note in filter(None, notes):
        print_note(note)
    _print_shapes(found.shapes, a.json)


def _library_sheet(a: argparse.Namespace) -> None:
    from diorama_core.library.taxonomy import resolve
    from diorama_core.render.thumbnails import shape_sheet

    if not (16 <= a.size <= 1024 and 1 <= a.columns <= 40):
        raise InputError(f"--size {a.size} --columns {a.columns}: give a side of 16 to 1024 and 1 to 40 columns")
    if a.output.suffix.lower() != ".png":
        raise InputError(f"-o {a.output}: a sheet is a PNG; end the name with .png")
    if not a.output.absolute().parent.is_dir():
        raise InputError(f"-o {a.output}: there is no folder {a.output.parent}; make it first")
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
    try:
        page.save(a.output)
    except OSError as error:
        raise InputError(f"{a.output}: cannot be written ({error.strerror or error}); choose another place") from None
    print(f"{len(shapes)} shapes on {a.output}")


def _print_shapes(shapes: Sequence[Shape], as_json: bool) -> None:
    if as_json:
        rows = [{"id": s.id, "category": s.category, "caption": s.caption, "size_m": list(s.size_m)} for s in shapes]
        print(json.dumps(rows))
        return
    for s in shapes:
        x, y, z = s.size_m
        print(f"{s.id:<28} {s.category:<16} {y:.2f} x {x:.2f} x {z:.2f} m  {s.caption}")
