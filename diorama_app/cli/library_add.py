"""Commands about one's own models: `diorama library add` and `diorama library info`."""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import diorama_core as diorama
from diorama_app.cli.arguments import command, progress_bar, unit
from diorama_core.errors import InputError

if TYPE_CHECKING:
    from diorama_core.library.ingest.adding import Added
    from diorama_core.library.ingest.finding import Trouble
    from diorama_core.library.record import Shape

AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
DATASETS = ("auto", "none", "objaverse-lvis", "shapenetcore", "hssd", "3d-future", "abo")
TABLE_ROWS = 60
SHOWN = 20
"""Lines of each kind in the report; `--json` has all."""


def add_adding(actions: Any) -> None:
    """Declare `diorama library add` and `diorama library info`."""
    p = command(actions, "add", _add, "diorama library add ~/models --name mine")
    p.add_argument("folder", type=Path, metavar="DIR", help="searched with all folders in it; links are not followed")
    p.add_argument("--name", metavar="NAME", help="the library to add to (default: the folder's own name)")
    p.add_argument("--up", type=axis, metavar="AXIS", help="axis of the files that points up: x, y, z, or --up=-z")
    p.add_argument("--front", type=axis, metavar="AXIS", help="axis that the front looks along: z, or --front=-y")
    p.add_argument("--unit", type=unit, metavar="m|cm|mm|in|ft|METRES", help="unit of the files (default: guessed)")
    p.add_argument("--category", help="category of all models, such as chair (default: guessed)")
    p.add_argument("--table", type=Path, metavar="CSV", help="columns file and any of up,front,unit,category,caption")
    p.add_argument("--dataset", choices=DATASETS, default="auto", help="layout of the folder (default: %(default)s)")
    p.add_argument("--ray", metavar="ADDRESS", help="work on a Ray cluster: auto, HOST:PORT, or local to start one")
    p.add_argument("--workers", type=int, metavar="N", help="processes (default: all cores)")
    p.add_argument("--json", action="store_true", help="print the report as JSON")
    p.epilog = f"{p.epilog}\n\nWhat was guessed is shown by 'diorama library info ID --library NAME'."
    info = command(actions, "info", _info, "diorama library info chair --library mine")
    info.add_argument("id", metavar="ID")
    info.add_argument("--library", default="built-in", metavar="NAME", help="(default: %(default)s)")
    info.add_argument("--json", action="store_true")


def axis(text: str) -> str:
    """`y`, `+y` or `-y`."""
    name = text.lower() if text[:1] in "+-" else f"+{text.lower()}"
    if name not in AXES:
        raise argparse.ArgumentTypeError(f"{text!r} is no axis; write x, y or z, or a minus as in --front=-y")
    return name


def _add(a: argparse.Namespace) -> None:
    """Take a folder of models into a library: GLB, glTF, OBJ with MTL, PLY, STL, DAE, 3MF, 3DS, zip, USD, FBX."""

    from diorama_core.library.datasets import as_sources, dataset_named, recognise
    from diorama_core.library.ingest.adding import add_models
    from diorama_core.library.ingest.finding import model_files, read_table, sources
    from diorama_core.library.ingest.given import Given
    from diorama_core.library.store import create_library, library_folder
    from diorama_core.render.thumbnails import thumbnail
    from diorama_core.workers import workers

    folder = a.folder.expanduser().absolute()
    given = Given(a.up, a.front, a.unit, a.category)
    paths, skipped = model_files(folder)
    dataset = recognise(folder) if a.dataset == "auto" else None if a.dataset == "none" else dataset_named(a.dataset)
    if dataset is not None and a.table is None:
        print(f"diorama: read as a copy of {dataset.name}", file=sys.stderr)
        models = as_sources(dataset, folder, given)
    else:
        table = read_table(a.table) if a.table is not None else {}
        absent = sorted(set(table) - {p.relative_to(folder).as_posix() for p in paths})
        if absent:
            raise InputError(f"{a.table}: there is no model {absent[0]!r} in {folder}; paths are relative to it")
        models = sources(folder, paths, given, table)
    if not models:
        raise InputError(f"{folder}: no model lies there, but {_what_lies_in(folder, skipped)}; {_formats()} are read")
    name = a.name or folder.name.lower().replace(" ", "-")
    pool = workers(a.ray, a.workers)
    place = library_folder(name)
    existed = place.exists()
    library = create_library(name)
    with progress_bar() as progress:
        report = add_models(
            models, library, pool, painter=partial(thumbnail, size=160), skipped=skipped, progress=progress
        )
    if not report.added and not existed:
        library.close()
        shutil.rmtree(place, ignore_errors=True)
    if a.json:
        print(json.dumps(_as_json(report, name), default=str))
    else:
        _print_report(report, name)
    if report.failed and not report.added and not report.retained:
        raise InputError(f"none of {len(report.failed)} models could be used; the reasons are above")


def _formats() -> str:
    from diorama_core.library.ingest.models import MODEL_FORMS

    return ", ".join(form.name for form in MODEL_FORMS)


def _what_lies_in(folder: Path, skipped: Sequence[Trouble]) -> str:
    """The files of a folder without models, by what they are or by their endings."""
    if skipped:
        return "; ".join(_lines_by_reason(skipped))
    endings = Counter(p.suffix.lower() or p.name for p in folder.rglob("*") if p.is_file())
    return ", ".join(f"{count} {ending}" for ending, count in endings.most_common(6)) or "nothing at all"


def _as_json(report: Added, name: str) -> dict[str, Any]:
    return {"library": name, **asdict(replace(report, shapes=()))}


def _print_report(report: Added, name: str) -> None:
    for title, lines in (
        ("not read", _lines_by_reason(report.skipped)),
        ("repaired", _lines_by_note(report)),
        ("unsure how it stands or what it is", list(report.unsure)),
        ("against glTF's promise of +Y up, since the whole folder stands so", _broken_promises(report)),
        ("refused", _lines_by_reason(report.failed)),
    ):
        for line in lines[:SHOWN]:
            print(f"{title}: {line}", file=sys.stderr)
        if len(lines) > SHOWN:
            print(f"{title}: and {len(lines) - SHOWN} more", file=sys.stderr)
    for row in _table(report):
        print(row)
    before = f", {report.retained} were there already" if report.retained else ""
    refused = f", {len(report.failed)} refused" if report.failed else ""
    print(f"{name}: {len(report.added)} shapes added{before}{refused}")
    if report.added:
        print(f"Use them: diorama build PHOTO -o ROOM --library {name} (or --library {name}+built-in)")


def _broken_promises(report: Added) -> list[str]:
    from diorama_core.library.ingest.joint import FOLDERS

    guesses = ((s.id, s.guess) for s in report.shapes if s.guess is not None)
    return [f"{name} has {guess.up.value} up" for name, guess in guesses if FOLDERS in guess.up.reason]


def _lines_by_reason(troubles: Sequence[Trouble]) -> list[str]:
    """Each reason once, with the files that it is about."""
    files: dict[tuple[str, str], list[Path]] = {}
    for trouble in troubles:
        reason = trouble.reason.replace(str(trouble.path), trouble.path.name)
        general = reason.replace(trouble.path.name, "the file")
        files.setdefault((trouble.path.suffix.lower(), general), []).append(trouble.path)
    lines = []
    for (suffix, reason), paths in files.items():
        names = ", ".join(p.name for p in paths[:3]) + (f" and {len(paths) - 3} more" if len(paths) > 3 else "")
        lines.append(f"{paths[0]}: {reason}" if len(paths) == 1 else f"{len(paths)} {suffix} files: {reason} ({names})")
    return lines


def _table(report: Added) -> list[str]:
    """What was added: kind, size and how its file was read, a line each."""
    unsure = set(report.unsure)
    rows = []
    for shape in report.shapes[:TABLE_ROWS]:
        depth, width, height = shape.size_m
        read = "" if shape.guess is None else f"up {shape.guess.up.value}, front {shape.guess.front.value}, "
        unit = "" if shape.guess is None else f"unit {shape.guess.unit.value} m"
        mark = "  unsure" if shape.id in unsure else ""
        rows.append(
            f"{shape.id:<28} {shape.category:<16} {width:.2f} x {depth:.2f} x {height:.2f} m  {read}{unit}{mark}"
        )
    left = len(report.shapes) - TABLE_ROWS
    return [*rows, f"and {left} more: diorama library list --library NAME"] if left > 0 else rows


def _lines_by_note(report: Added) -> list[str]:
    """Each note once, with the shapes that it is about."""
    shapes: dict[str, list[str]] = {}
    for shape_id, notes in report.repaired:
        for note in notes:
            shapes.setdefault(note, []).append(shape_id)
    return [
        f"{note} ({', '.join(ids[:3])}{f' and {len(ids) - 3} more' if len(ids) > 3 else ''})"
        for note, ids in sorted(shapes.items())
    ]


def _info(a: argparse.Namespace) -> None:
    """Show the properties of a shape."""

    from diorama_core.library.record import shape_to_json

    shape = diorama.open_library(a.library).shape(a.id)
    print(shape_to_json(shape) if a.json else _describe(shape))


def _describe(shape: Shape) -> str:
    depth, width, height = shape.size_m
    turns = {1: "none", 2: "half a turn", 4: "quarter turns", 36: "round"}.get(
        shape.symmetry, f"{360 / shape.symmetry:g} degrees"
    )
    rows = [
        ("id", shape.id),
        ("category", shape.category),
        ("caption", shape.caption),
        ("size", f"{width:.3f} wide x {depth:.3f} deep x {height:.3f} high, metres"),
        ("source", f"{shape.source} ({shape.licence})"),
        ("symmetry", turns),
        ("touches", " or ".join(shape.contact_faces)),
        ("mass", f"about {shape.mass_kg:g} kg"),
    ]
    rows += [("also called", ", ".join(shape.synonyms))] if shape.synonyms else []
    rows += [("triangles", str(shape.triangles))] if shape.triangles else []
    for number, surface in enumerate(shape.surfaces, 1):
        above = "open above" if surface.clearance_m == float("inf") else f"{surface.clearance_m:.2f} m free above"
        inside = ", inside" if surface.interior else ""
        rows.append((f"surface {number}", f"{surface.height_m + height / 2:.3f} m above its foot, {above}{inside}"))
    if shape.guess is not None:
        for name in ("up", "front", "unit", "category"):
            assumption = getattr(shape.guess, name)
            value = f"{assumption.value} m" if name == "unit" else assumption.value
            rows.append((f"assumed {name}", f"{value} ({assumption.confidence:.0%}, from {assumption.reason})"))
    width_of_names = max(len(name) for name, _ in rows)
    return "\n".join(f"{name:<{width_of_names}}  {value}" for name, value in rows)
