"""Lists the module-level numbers of the reconstruction, and the names that mean another number in another module.

    python scripts/module_numbers.py [--list]

A number that decides what a scene looks like belongs into a frozen settings value, a field of the stage that it steers:
there it has a name by which it can be fitted and left out (`diorama_core.pipeline.settings`, `scripts/ablate.py`), and
`docs/log/certificates.json` says what it is worth. What stays at the top of a module should be one concept with one
name in one place. Both counts may only fall: lower the ceilings with them.

Exits with 1 when a ceiling is exceeded.
"""

from __future__ import annotations

import argparse
import ast
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = (
    *("perception", "architecture", "pose", "layout", "appearance", "retrieval", "multiview", "pipeline"),
    *("geometry", "arrangement"),
)
"""Those of `diorama_core` that reconstruct."""
READERS = "diorama_core.perception.inputs."
"""What reads files is no stage: its numbers are limits and forms of files."""
MAX_NUMBERS = 273
MAX_AMBIGUOUS = 5
"""Names that are defined in several modules with different values."""


@dataclass(frozen=True)
class Number:
    """A numeric constant at the top of a module, or several that are assigned at once."""

    module: str
    names: tuple[str, ...]
    value: str
    """As written."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--list", action="store_true", help="print every number, not only the ambiguous names")
    listed = parser.parse_args().list
    found = list(numbers(ROOT))
    unclear = ambiguous(found)
    for number in found if listed else ():
        print(f"{number.module:<60} {', '.join(number.names)} = {number.value}")
    for name, places in unclear.items():
        print(f"{name}: {', '.join(f'{n.module} {n.value}' for n in places)}")
    print(f"{len(found)} numbers at the top of modules, at most {MAX_NUMBERS} may be")
    print(f"{len(unclear)} names mean different numbers in different modules, at most {MAX_AMBIGUOUS} may")
    return int(len(found) > MAX_NUMBERS or len(unclear) > MAX_AMBIGUOUS)


def numbers(root: Path) -> Iterator[Number]:
    """The numbers of all reconstruction packages, by module."""
    for package in PACKAGES:
        for path in sorted((root / "diorama_core" / package).rglob("*.py")):
            module = ".".join(path.relative_to(root).with_suffix("").parts)
            if module.startswith(READERS):
                continue
            yield from numbers_of(module, path.read_text(encoding="utf-8"))


def numbers_of(module: str, text: str) -> Iterator[Number]:
    """The numbers at the top of one module."""
    for node in ast.parse(text).body:
        if isinstance(node, ast.Assign):
            target = node.targets[0]
        elif isinstance(node, ast.AnnAssign):
            target = node.target
        else:
            continue
        if node.value is not None and _is_number(node.value):
            names = target.elts if isinstance(target, ast.Tuple) else [target]
            yield Number(module, tuple(map(ast.unparse, names)), ast.unparse(node.value))


def ambiguous(found: list[Number]) -> dict[str, list[Number]]:
    """Names of single numbers that have different values in different modules, by name."""
    of: dict[str, list[Number]] = {}
    for number in found:
        for name in number.names if len(number.names) == 1 else ():
            of.setdefault(name, []).append(number)
    return {name: of[name] for name in sorted(of) if len({n.value for n in of[name]}) > 1}


def _is_number(node: ast.expr) -> bool:
    if isinstance(node, ast.UnaryOp):
        node = node.operand
    if isinstance(node, ast.Constant):
        return isinstance(node.value, (int, float)) and not isinstance(node.value, bool)
    if isinstance(node, ast.BinOp):
        return _is_number(node.left) and _is_number(node.right)
    return isinstance(node, ast.Tuple) and bool(node.elts) and all(map(_is_number, node.elts))


if __name__ == "__main__":
    sys.exit(main())
