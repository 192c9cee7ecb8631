"""Counts kinds of objects that are written out in the code, instead of asked of the table `library/kinds.toml`.

    python scripts/kind_literals.py

What the program knows of a kind is in its row, so that a new kind is one row. Names of kinds are counted in all modules
outside `library`, `synthesis` (the grammar of rooms) and `evaluation` (data sets' classes, and what results are judged
by). Some are other words that are spelt alike ("picture" of a command, "door" of an opening), and some rules are of one
kind; a table of kinds is neither. A table is a constant, or a set, list, tuple or dict literal, of at least three.

Exits with 1 when there are more names than `CEILING`, or a table that `TABLES` does not allow. Whoever makes them fewer
lowers the ceiling.
"""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("diorama_core", "diorama_app")
ELSEWHERE = ("diorama_core/library/", "diorama_core/synthesis/", "diorama_core/evaluation/")
CEILING = 296
SLACK = 25
"""The ceiling is lowered when so many fewer are left."""
MIN_TABLE = 3
TABLES = {
    "diorama_core/export/physics.py": "words of materials",
    "diorama_core/importing/roomplan_parts.py": "RoomPlan's words for attributes",
    "diorama_core/perception/foundation/detection.py": "a detector's words for what a person would call otherwise",
    "diorama_core/text/requested_room.py": "recipes of rooms",
    "diorama_core/text/requested_relations.py": "the order in which furniture is placed",
}
"""Modules that may have tables, and why."""


def main() -> int:
    kinds = read_kinds(ROOT)
    counts = {path: count for path in checked(ROOT) if (count := len(named_kinds(ROOT / path, kinds)))}
    for path, count in sorted(counts.items(), key=lambda row: (-row[1], row[0])):
        print(f"{count:>4} {path}")
    print(f"{sum(counts.values())} names of kinds outside the library, at most {CEILING} may be")
    problems = complaints(ROOT)
    for problem in problems:
        print(problem, file=sys.stderr)
    return int(bool(problems))


def complaints(root: Path, ceiling: int = CEILING) -> list[str]:
    """What is wrong, one line each."""
    kinds = read_kinds(root)
    count = sum(len(named_kinds(root / path, kinds)) for path in checked(root))
    found = []
    if count > ceiling:
        found.append(f"{count} names of kinds outside the library, {ceiling} may be; ask `library.taxonomy` for them")
    if count < ceiling - SLACK:
        found.append(f"{count} names of kinds are left; lower CEILING in scripts/kind_literals.py from {ceiling}")
    for path in checked(root):
        if path not in TABLES:
            found += [
                f"{path}:{line} is a table of kinds; make it a column or a trait in library/kinds.toml"
                for line in tables(root / path, kinds)
            ]
    return found


def read_kinds(root: Path) -> frozenset[str]:
    """Names of all kinds."""
    return frozenset(tomllib.loads((root / "diorama_core/library/kinds.toml").read_text("utf-8")))


def checked(root: Path) -> list[str]:
    """Paths of the modules that are looked at."""
    paths = (p.relative_to(root).as_posix() for package in PACKAGES for p in (root / package).rglob("*.py"))
    return sorted(path for path in paths if not path.startswith(ELSEWHERE))


def named_kinds(path: Path, kinds: frozenset[str]) -> list[str]:
    """The kinds that a module writes out, as often as it does."""
    return [kind for node in ast.walk(_parsed(path, kinds)) for kind in _kind(node, kinds)]


def tables(path: Path, kinds: frozenset[str]) -> list[int]:
    """Lines of a module's tables of kinds: the outermost literals, or calls that hold them, of several."""
    found: list[int] = []
    for node in _parsed(path, kinds).body:
        value = getattr(node, "value", None)
        constant = isinstance(node, ast.Assign | ast.AnnAssign) and value is not None
        literals = [value] if constant else [n for n in ast.walk(node) if isinstance(n, ast.Set | ast.Tuple | ast.List)]
        found += [n.lineno for n in literals if len({k for x in ast.walk(n) for k in _kind(x, kinds)}) >= MIN_TABLE]
    return sorted(set(found))


def _parsed(path: Path, kinds: frozenset[str]) -> ast.Module:
    """A module; an empty one where no kind is quoted, as in most: parsing takes long."""
    code = path.read_text("utf-8")
    quoted = re.search(rf"[\"']({'|'.join(sorted(kinds))})[\"']", code)
    return ast.parse(code if quoted else "")


def _kind(node: ast.AST, kinds: frozenset[str]) -> Iterator[str]:
    if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value in kinds:
        yield node.value


if __name__ == "__main__":
    sys.exit(main())
