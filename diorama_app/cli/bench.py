"""Commands that measure: `diorama bench ...`."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any, Protocol

from diorama_app.cli.arguments import command, progress_bar
from diorama_core.errors import InputError


class _Bench(Protocol):
    """What every bench returns."""

    def tables(self) -> Any: ...

    def to_json(self) -> dict[str, object]: ...


TABLES = (
    ("rooms", 60, "The rooms themselves: valid, varied, and worth a picture."),
    ("architecture", 20, "The empty room: planes against the truth."),
    ("retrieval", 20, "Shapes for objects, offered and never offered."),
    ("pose", 6, "Poses with true and estimated depth, groups, ablations."),
    ("layout", 40, "The layout recipes against each other."),
    ("system", 20, "Pictures to scenes, end to end."),
    ("speed", 1, "Time and memory against size, and against the committed figures."),
)


def add_bench(commands: Any) -> None:
    """Declare `diorama bench`."""
    p: argparse.ArgumentParser = commands.add_parser("bench", help="Measure the stages on rooms of known truth.")
    tables = p.add_subparsers(dest="table", required=True, metavar="|".join(name for name, _, _ in TABLES))
    runs = {"layout": _bench_layout, "speed": _bench_speed, "rooms": _bench_survey, "system": _bench_system}
    for name, scenes, summary in TABLES:
        one = command(tables, name, runs.get(name, _bench_rooms), summary, f"diorama bench {name} --scenes {scenes}")
        one.add_argument("--scenes", type=int, default=scenes, metavar="N", help="rooms (default: %(default)s)")
        one.add_argument("--seed", type=int, default=0, metavar="S", help="of the rooms (default: %(default)s)")
        one.add_argument("--json", type=Path, metavar="FILE", help="write the results as JSON too")
        one.add_argument("--markdown", type=Path, metavar="FILE", help="write the tables as Markdown too")
        if name == "rooms":
            one.add_argument("--sheet", type=Path, metavar="FILE", help="write a sheet of all pictures (PNG or JPEG)")
        if name == "system":
            one.add_argument("--physics", action="store_true", help="measure drift under gravity too (needs MuJoCo)")
            one.add_argument(
                "--dataset", choices=("ssdb", "scan2cad", "sunrgbd"), help="other people's pictures instead"
            )
            one.add_argument("--path", type=Path, metavar="DIR", help="where the dataset's local copy is")
            one.add_argument("--offered", action="store_true", help="search the shapes that stand in the rooms too")
            one.add_argument("--pictures", type=Path, metavar="DIR", help="write every photo beside its two results")
        if name == "speed":
            one.add_argument("--keep", type=Path, metavar="FILE", help="write the figures as a regression file")


def _bench_layout(a: argparse.Namespace) -> None:
    from diorama_core.evaluation.layout_bench import run

    _check(a)
    with progress_bar() as progress:
        bench = run(scenes=a.scenes, seed=a.seed, progress=progress)
    _write(a.json, bench.to_json())
    _write_text(a.markdown, bench.to_markdown())
    print(bench.to_markdown())


def _bench_rooms(a: argparse.Namespace) -> None:
    """Architecture, retrieval or pose on rendered rooms."""
    from diorama_core.evaluation import architecture_bench, pose_bench, retrieval_bench
    from diorama_core.library.catalogue import built_in_library

    _check(a)
    library = built_in_library()
    with progress_bar() as progress:
        bench: _Bench
        if a.table == "architecture":
            bench = architecture_bench.run(library, a.scenes, a.seed, progress)
        elif a.table == "retrieval":
            bench = retrieval_bench.run(library, a.scenes, a.seed, progress)
        else:
            bench = pose_bench.run(library, a.scenes, a.seed, progress)
    _show(bench, a)


def _bench_system(a: argparse.Namespace) -> None:
    from diorama_core.evaluation import system_bench
    from diorama_core.evaluation.case_pictures import case_writer
    from diorama_core.library.catalogue import built_in_library

    _check(a)
    if a.dataset or a.path:
        _bench_dataset(a)
        return
    library = built_in_library()
    show = case_writer(a.pictures, library) if a.pictures else None
    with progress_bar() as progress:
        bench = system_bench.run(library, a.scenes, a.seed, progress, offered=a.offered, physics=a.physics, show=show)
    _show(bench, a)


def _bench_dataset(a: argparse.Namespace) -> None:
    """The whole system on a local copy of other people's pictures."""
    from diorama_core.evaluation import local_bench
    from diorama_core.library.catalogue import built_in_library

    if not (a.dataset and a.path):
        raise InputError("--dataset and --path belong together: name the dataset and say where its copy is")
    if not a.path.is_dir():
        raise InputError(f"{a.path}: there is no such folder; give the local copy of {a.dataset}")
    with progress_bar() as progress:
        bench = local_bench.run(a.dataset, a.path, built_in_library(), a.scenes, progress)
    _show(bench, a)


def _bench_survey(a: argparse.Namespace) -> None:
    from diorama_core.evaluation import rooms_bench
    from diorama_core.evaluation.case_pictures import write_picture
    from diorama_core.library.catalogue import built_in_library

    _check(a)
    with progress_bar() as progress:
        bench, sheet = rooms_bench.run(built_in_library(), a.scenes, a.seed, progress)
    if a.sheet:
        write_picture(a.sheet, sheet)
    _show(bench, a)
    for name, faults in bench.faulty_views:
        print(f"{name}: {', '.join(faults)}")


def _bench_speed(a: argparse.Namespace) -> None:
    from diorama_core.evaluation.speed_bench import regression_file, run
    from diorama_core.library.catalogue import built_in_library
    from diorama_core.project.files import write_atomically

    _check(a)
    with progress_bar() as progress:
        bench = run(built_in_library(), a.seed, progress)
    if a.keep:
        write_atomically(a.keep, regression_file(bench))
    _show(bench, a)


def _check(a: argparse.Namespace) -> None:
    if a.scenes < 1:
        raise InputError(f"--scenes {a.scenes}: ask for at least one")


def _show(bench: _Bench, a: argparse.Namespace) -> None:
    _write(a.json, bench.to_json())
    text = "\n".join(table.to_markdown() for table in bench.tables())
    _write_text(a.markdown, text)
    print(text)


def _write(path: Path | None, document: dict[str, object]) -> None:
    from diorama_core.project.files import write_atomically

    if path:
        write_atomically(path, json.dumps(document, indent=1).encode())


def _write_text(path: Path | None, text: str) -> None:
    from diorama_core.project.files import write_atomically

    if path:
        write_atomically(path, text.encode())
