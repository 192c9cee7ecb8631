"""Commands that measure: `diorama bench ...`."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from diorama_app.cli.arguments import command, progress_bar
from diorama_core.errors import InputError


def add_bench(commands: Any) -> None:
    """Declare `diorama bench`."""
    p: argparse.ArgumentParser = commands.add_parser("bench", help="Measure the stages on generated rooms.")
    tables = p.add_subparsers(dest="table", required=True, metavar="layout")
    layout = command(
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
    with progress_bar() as progress:
        bench = run(scenes=a.scenes, seed=a.seed, progress=progress)
    if a.json:
        write_atomically(a.json, json.dumps(bench.to_json(), indent=1).encode())
    print(bench.to_markdown())
