"""Commands that measure: `diorama bench ...`."""

from __future__ import annotations

import argparse
import sys
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from diorama_app.cli.arguments import command, progress_bar
from diorama_app.cli.bench_photos import add_photos, add_questions_bench, show_bench, write_json, write_text
from diorama_core.errors import InputError

if TYPE_CHECKING:
    from diorama_core.evaluation.benchmarks.look import Picture, Show


TABLES = (
    ("rooms", 60, "The generated rooms themselves: validity, variety, pictures."),
    ("architecture", 20, "Architecture: planes compared with ground truth."),
    ("retrieval", 20, "Retrieval of shapes that are, and are not, in the library."),
    ("relations", 18, "Supports, from geometry and a language model."),
    ("pose", 6, "Poses with true and estimated depth, groups, ablations."),
    ("look", 6, "Shapes made to measure and the photo's materials, the true shapes removed."),
    ("layout", 40, "The layout recipes compared with each other."),
    ("system", 20, "Images to scenes, end to end."),
    ("views", 6, "One, two, four and eight photos of a room with given cameras."),
    ("scans", 6, "Scans of a phone: furniture, its kinds, doors and windows."),
    ("text", 64, "Rooms composed from prompts: what was asked for, and whether people could use the room."),
    ("speed", 1, "Time and memory by scene size, compared with the committed figures."),
)


def add_bench(commands: Any) -> None:
    """Declare `diorama bench`."""
    p: argparse.ArgumentParser = commands.add_parser("bench", help="Measure the stages on rooms of known truth.")
    tables = p.add_subparsers(
        dest="table",
        required=True,
        metavar="|".join([*(name for name, _, _ in TABLES), "photos", "questions", "recognition"]),
    )
    runs = {"layout": _bench_layout, "speed": _bench_speed, "rooms": _bench_survey, "system": _bench_system}
    runs["text"] = _bench_text
    for name, scenes, summary in TABLES:
        one = command(tables, name, runs.get(name, _bench_rooms), f"diorama bench {name} --scenes {scenes}", summary)
        one.add_argument("--scenes", type=int, default=scenes, metavar="N", help="rooms (default: %(default)s)")
        one.add_argument("--seed", type=int, default=0, metavar="S", help="seed of the rooms (default: %(default)s)")
        one.add_argument("--json", type=Path, metavar="FILE", help="write the results as JSON too")
        one.add_argument(
            "--markdown", type=Path, metavar="FILE", help="write the tables as Markdown, or replace them in a document"
        )
        if name == "look":
            one.add_argument("--sheet", type=Path, metavar="DIR", help="write photo, before and after of every room")
        if name in ("rooms", "text"):
            one.add_argument("--sheet", type=Path, metavar="FILE", help="write a sheet of all pictures (PNG or JPEG)")
        if name in ("system", "architecture"):
            one.add_argument(
                "--seeds", metavar="S,S", help="seeds of several series, or a named series: development, reporting"
            )
        if name == "system":
            one.add_argument(
                "--given", default="depth,photo", metavar="A,B", help="inputs to compare (default: %(default)s)"
            )
            one.add_argument("--substitute", default="", metavar="A,B+C", help="add rows with ground-truth inputs")
            one.add_argument("--physics", action="store_true", help="measure drift under gravity too (needs MuJoCo)")
            one.add_argument(
                "--dataset", choices=("ssdb", "scan2cad", "sunrgbd"), help="a public dataset instead of generated rooms"
            )
            one.add_argument("--path", type=Path, metavar="DIR", help="where the dataset's local copy is")
            one.add_argument("--offered", action="store_true", help="add the rooms' own shapes to the searched library")
            one.add_argument("--pictures", type=Path, metavar="DIR", help="write every photo next to its two results")
        if name == "speed":
            one.add_argument("--keep", type=Path, metavar="FILE", help="write the figures to a regression file")
            one.add_argument("--against", type=Path, metavar="FILE", help="figures to compare with (default: built in)")
            one.add_argument(
                "--tolerance",
                type=float,
                default=1.6,
                metavar="T",
                help="allowed slowdown as a factor (default: %(default)s)",
            )
            one.add_argument("--quick", action="store_true", help="small quantities only, about a minute")
    add_photos(tables)
    add_questions_bench(tables)
    _add_recognition(tables)


def _add_recognition(tables: Any) -> None:
    example = "diorama bench recognition annotations.json --photos pictures"
    one = command(tables, "recognition", _bench_recognition, example)
    one.add_argument("annotations", type=Path, metavar="ANNOTATIONS", help="boxes and kinds (JSON)")
    one.add_argument("--photos", type=Path, required=True, metavar="DIR", help="pictures named by the annotations' ids")
    one.add_argument("--json", type=Path, metavar="FILE", help="write the tables and every photo as JSON too")
    one.add_argument("--markdown", type=Path, metavar="FILE", help="write the tables as Markdown, or into their place")


def _bench_recognition(a: argparse.Namespace) -> None:
    """What detectors find in annotated photos."""

    from diorama_core.evaluation.benchmarks import recognition
    from diorama_core.pipeline.presets import clickers, detection_routes, namers

    if not a.photos.is_dir():
        raise InputError(f"{a.photos}: there is no such folder; give the folder of the annotated pictures")
    with progress_bar() as progress:
        bench = recognition.run(a.annotations, a.photos, detection_routes(), namers(), clickers(), progress)
    show_bench(bench, a)


def _bench_layout(a: argparse.Namespace) -> None:
    from diorama_core.evaluation.benchmarks.layout import run

    _check(a)
    with progress_bar() as progress:
        bench = run(scenes=a.scenes, seed=a.seed, progress=progress)
    write_json(a.json, bench.to_json())
    write_text(a, bench.to_markdown())
    print(bench.to_markdown())


def _bench_rooms(a: argparse.Namespace) -> None:
    """Run the architecture, retrieval, relations, look, views, scans or pose benchmark on rendered rooms."""
    from diorama_core.evaluation.benchmarks.cases import parse_seeds
    from diorama_core.library.catalogue import built_in_library
    from diorama_core.models.store import ModelStore
    from diorama_core.perception.language.client import LmmSettings
    from diorama_core.pipeline.network_stages import published_embeddings

    _check(a)
    run = import_module(f"diorama_core.evaluation.benchmarks.{a.table}").run
    seeds: Any = a.seed
    more: tuple[Any, ...] = ()
    if a.table == "architecture":
        seeds = parse_seeds(a.seeds, a.seed)
    elif a.table == "retrieval":
        more = (published_embeddings(ModelStore.default()),)
    elif a.table == "relations":
        more = (LmmSettings.from_environment(),)
    elif a.table == "look":
        more = (_look_writer(a.sheet),)
    with progress_bar() as progress:
        bench = run(built_in_library(), a.scenes, seeds, progress, *more)
    show_bench(bench, a)


def _look_writer(folder: Path | None) -> Show | None:
    """Writes a room's photo, its flat colours and its own look side by side."""
    from diorama_core.evaluation.benchmarks.photo_build import side_by_side, write_picture

    if folder is None:
        return None
    folder.mkdir(parents=True, exist_ok=True)

    def show(name: str, photo: Picture, before: Picture, after: Picture) -> None:
        """Write the pictures of one case beside each other.

        Args:
            name: of the case.
            photo: sRGB, (h, w, 3).
            before: likewise, before the layout.
            after: likewise, after it.
        """
        write_picture(
            folder / f"{name.replace(', ', '-').replace(' ', '-')}.jpg",
            side_by_side(side_by_side(photo, before), after),
        )

    return show


def _bench_system(a: argparse.Namespace) -> None:
    from diorama_core.evaluation.benchmarks import system as system_bench
    from diorama_core.evaluation.benchmarks.cases import parse_seeds
    from diorama_core.evaluation.benchmarks.photo_build import case_writer
    from diorama_core.evaluation.benchmarks.substitution import parse_substitutes
    from diorama_core.library.catalogue import built_in_library

    _check(a)
    if a.dataset or a.path:
        _bench_dataset(a)
        return
    given = [word.strip() for word in a.given.split(",") if word.strip()]
    ways = system_bench.ways_of(given, parse_substitutes(a.substitute))
    library = built_in_library()
    show = case_writer(a.pictures, library) if a.pictures else None
    with progress_bar() as progress:
        bench = system_bench.run(
            library,
            a.scenes,
            parse_seeds(a.seeds, a.seed),
            progress,
            ways=ways,
            offered=a.offered,
            physics=a.physics,
            show=show,
            after_room=lambda so_far: write_json(a.json, so_far.to_json()),
        )
    show_bench(bench, a)


def _bench_dataset(a: argparse.Namespace) -> None:
    """Run the system benchmark on a local copy of a public dataset."""
    from diorama_core.evaluation.benchmarks import local_datasets as local_bench
    from diorama_core.library.catalogue import built_in_library

    if not (a.dataset and a.path):
        raise InputError("--dataset and --path belong together: name the dataset and say where its copy is")
    if not a.path.is_dir():
        raise InputError(f"{a.path}: there is no such folder; give the local copy of {a.dataset}")
    with progress_bar() as progress:
        bench = local_bench.run(a.dataset, a.path, built_in_library(), a.scenes, progress)
    show_bench(bench, a)


def _bench_survey(a: argparse.Namespace) -> None:
    from diorama_core.evaluation.benchmarks import rooms as rooms_bench
    from diorama_core.evaluation.benchmarks.photo_build import write_picture
    from diorama_core.library.catalogue import built_in_library

    _check(a)
    with progress_bar() as progress:
        bench, sheet = rooms_bench.run(built_in_library(), a.scenes, a.seed, progress)
    if a.sheet:
        write_picture(a.sheet, sheet)
    show_bench(bench, a)
    for name, faults in bench.faulty_views:
        print(f"{name}: {', '.join(faults)}")


def _bench_text(a: argparse.Namespace) -> None:
    from diorama_core.evaluation.benchmarks import text as text_bench
    from diorama_core.evaluation.benchmarks.photo_build import write_picture
    from diorama_core.library.catalogue import built_in_library

    _check(a)
    with progress_bar() as progress:
        bench, sheet = text_bench.run(built_in_library(), a.scenes, a.seed, progress, pictures=a.sheet is not None)
    if sheet is not None:
        write_picture(a.sheet, sheet)
    show_bench(bench, a)
    for prompt in bench.prompts:
        if prompt.result.failures or prompt.notes:
            print(f"{prompt.prompt}: {'; '.join((*prompt.result.failures, *prompt.notes))}")


def _bench_speed(a: argparse.Namespace) -> int:
    from diorama_core.evaluation.speed.bench import FULL, QUICK, read_figures, regression_bytes, run, slower
    from diorama_core.io.atomic import write_atomically
    from diorama_core.library.catalogue import built_in_library

    _check(a)
    if a.tolerance <= 1:
        raise InputError(f"--tolerance {a.tolerance:g}: give more than 1, such as 1.6")
    before = read_figures(a.against)
    with progress_bar() as progress:
        bench = run(built_in_library(), a.seed, progress, QUICK if a.quick else FULL, before=before)
    if a.keep:
        committed = read_figures(a.keep) if a.keep.exists() else {}  # a quick run and a full one keep other figures
        write_atomically(a.keep, regression_bytes({**committed, **bench.figures()}), error=InputError)
    show_bench(bench, a)
    worse = slower(bench.figures(), before, a.tolerance)
    for name, times in worse.items():
        print(
            f"diorama: slower than {a.against or 'the committed figures'}: {name}, {times:.1f} times", file=sys.stderr
        )
    return 1 if worse and not a.keep else 0


def _check(a: argparse.Namespace) -> None:
    if a.scenes < 1:
        raise InputError(f"--scenes {a.scenes}: ask for at least one")
