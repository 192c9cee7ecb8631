"""Results of `diorama bench`: tables printed, written into a document, and as JSON."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

from diorama_core.errors import InputError


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
