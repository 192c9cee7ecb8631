"""`diorama bench photos` and `bench questions`: annotated photos as they are, perturbed, in folds, and reviewed."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from diorama_app.cli.arguments import command, progress_bar
from diorama_core.errors import InputError

if TYPE_CHECKING:
    from diorama_core.evaluation.benchmarks.photos import PhotoPlan, PhotoSource


def add_photos(tables: Any) -> None:
    """Declare `diorama bench photos`."""
    example = "diorama bench photos annotations.json --photos pictures"
    one = command(tables, "photos", _bench_photos, example)
    _add_sources(one)
    one.add_argument(
        "--perturbed",
        nargs="?",
        const="",
        metavar="NAME,...",
        help="perturbed photos too: mirrored, jittered, dropped, exposed, rolled, cropped, blurred (default: all)",
    )
    one.add_argument("--folds", type=int, default=0, metavar="K", help="figures of K folds of the photos")
    one.add_argument(
        "--settings",
        type=Path,
        nargs="+",
        default=(),
        metavar="FILE",
        help="other values of settings (JSON): one file for all photos, or one for each fold, fitted on the others",
    )
    one.add_argument("--workers", type=int, default=1, metavar="N", help="photos built at once (default: %(default)s)")
    one.add_argument("--sheet", type=Path, metavar="FILE", help="write a sheet of photos beside their scenes")


def add_questions_bench(tables: Any) -> None:
    """Declare `diorama bench questions`."""
    example = "diorama bench questions annotations.json --photos pictures"
    text = "What answers to a review's questions are worth, by annotated photos or rendered rooms; how sure builds are."
    one = command(tables, "questions", _bench_questions, example, text)
    _add_sources(one, needed=False)
    one.add_argument("--scenes", type=int, default=0, metavar="N", help="review N rendered rooms in place of photos")
    one.add_argument("--seed", type=int, default=0, metavar="N", help="of the series of rooms (default: %(default)s)")


def _add_sources(one: argparse.ArgumentParser, *, needed: bool = True) -> None:
    """Declare which photos are built, and where results go."""
    one.add_argument(
        "annotations",
        type=Path,
        nargs="+" if needed else "*",
        metavar="ANNOTATIONS",
        help="boxes, kinds, colours, fronts... (JSON)",
    )
    one.add_argument(
        "--photos",
        type=Path,
        nargs="+",
        required=needed,
        default=(),
        metavar="DIR",
        help="pictures named by the annotations' ids: one folder for each file of annotations",
    )
    one.add_argument("--unnamed", action="store_true", help="give the boxes without their words")
    one.add_argument("--only", nargs="+", default=(), metavar="ID", help="take these photos only")
    one.add_argument("--stages", type=Path, metavar="DIR", help="keep stage results, so that a later run resumes")
    one.add_argument("--json", type=Path, metavar="FILE", help="write the results as JSON too")
    one.add_argument("--markdown", type=Path, metavar="FILE", help="write the tables as Markdown, or into their place")


def _bench_questions(a: argparse.Namespace) -> None:
    from diorama_core.evaluation.benchmarks import photos as photos_bench
    from diorama_core.evaluation.benchmarks import review, review_rooms
    from diorama_core.library.catalogue import built_in_library

    if bool(a.scenes) == bool(a.annotations):
        raise InputError("give annotations with --photos, or --scenes N")
    if a.scenes:
        with progress_bar() as progress:
            rooms = review_rooms.run(built_in_library(), a.scenes, a.seed, progress, named=not a.unnamed)
        show_bench(rooms, a)
        return
    sources = _sources(a.annotations, a.photos)
    asked = photos_bench.plan(sources, named=not a.unnamed, only=tuple(a.only), cache=a.stages)
    with progress_bar() as progress:
        bench = review.run(asked.tasks, built_in_library(), progress)
    show_bench(bench, a)


def _bench_photos(a: argparse.Namespace) -> None:
    """Photos against what a person annotated in them."""

    from diorama_core.evaluation.benchmarks import photos as photos_bench
    from diorama_core.evaluation.benchmarks.photo_build import write_picture
    from diorama_core.library.catalogue import built_in_library

    asked = _plan(a)
    known = photos_bench.read_results(a.json) if a.json else []
    with progress_bar() as progress:
        bench = photos_bench.run(
            asked,
            built_in_library(),
            known=known,
            processes=a.workers,
            after_photo=lambda so_far: write_json(a.json, so_far.to_json()),
            progress=progress,
        )
    show_bench(bench, a)
    for result in bench.results:
        if result.failure:
            print(f"diorama: {result.title} failed: {result.failure}", file=sys.stderr)
    if a.sheet:
        write_picture(a.sheet, photos_bench.sheet(bench))


def _plan(a: argparse.Namespace) -> PhotoPlan:
    from diorama_core.evaluation.benchmarks import photos as photos_bench
    from diorama_core.evaluation.benchmarks.photo_perturbations import perturbations_named

    if a.folds < 0 or a.folds == 1:
        raise InputError(f"--folds {a.folds}: ask for at least two")
    if a.workers < 1:
        raise InputError(f"--workers {a.workers}: ask for at least one")
    names = () if a.perturbed is None else perturbations_named([n for n in a.perturbed.split(",") if n])
    return photos_bench.plan(
        _sources(a.annotations, a.photos),
        named=not a.unnamed,
        only=tuple(a.only),
        perturbations=names,
        folds=a.folds,
        settings=[photos_bench.read_settings(path) for path in a.settings],
        cache=a.stages,
        tiles=a.sheet.with_suffix("") if a.sheet else None,
    )


def _sources(annotations: Sequence[Path], photos: Sequence[Path]) -> list[PhotoSource]:
    from diorama_core.evaluation.benchmarks.photos import PhotoSource

    if len(photos) not in (1, len(annotations)):
        raise InputError(f"--photos: {len(photos)} folders for {len(annotations)} files; give one folder for each file")
    for folder in photos:
        if not folder.is_dir():
            raise InputError(f"{folder}: there is no such folder; give the folder of the annotated pictures")
    folders = photos if len(photos) > 1 else [*photos] * len(annotations)
    return [PhotoSource(*pair) for pair in zip(annotations, folders, strict=True)]


@runtime_checkable
class Bench(Protocol):
    """What every bench returns."""

    def tables(self) -> Any:
        """Tables for people."""
        ...

    def to_json(self) -> dict[str, object]:
        """Everything measured."""
        ...


def show_bench(bench: Bench, a: argparse.Namespace) -> None:
    """Print a bench's tables, and write what `--json` and `--markdown` ask for."""
    write_json(a.json, bench.to_json())
    text = "\n".join(table.to_markdown() for table in bench.tables())
    write_text(a, text)
    print(text)


def write_json(path: Path | None, document: dict[str, object]) -> None:
    """Write a document as JSON, where a path is given."""
    if path:
        from diorama_core.io.atomic import write_atomically  # loads numpy

        write_atomically(path, json.dumps(document, indent=1).encode(), error=InputError)


def write_text(a: argparse.Namespace, text: str) -> None:
    """Write tables into a file: between `<!-- bench NAME -->` and `<!-- end NAME -->` where it has them, else whole."""
    if not a.markdown:
        return
    begin, end = f"\n<!-- bench {a.table} -->\n", f"\n<!-- end {a.table} -->\n"  # each on a line of its own
    document = a.markdown.read_text(encoding="utf-8") if a.markdown.exists() else ""
    if begin in document and end in document:
        before, _, after = document.partition(begin)
        rest = f"\n{after}".partition(end)[2]  # an empty section has one line break for both marks
        text = f"{before}{begin}\n{text.strip()}\n{end}{rest}"
    from diorama_core.io.atomic import write_atomically  # loads numpy

    write_atomically(a.markdown, text.encode(), error=InputError)
