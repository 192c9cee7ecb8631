"""Lists the modules that no test imports, and checks them against the table of reasons, `tests/untested.toml`.

    python scripts/untested_modules.py

A module has a test of its own when a test module (`tests/**/test_*.py`) imports it, a name from it, or a name that a
package re-exports from it; or when the test that mirrors its path exists (`tests/pose/test_limits.py` for
`diorama_core/pose/limits.py`, `tests/app/web/test_html.py` for `diorama_app/web/html.py`). Imports that only a
type checker sees do not count, neither do those of the helper modules beside the tests, nor those of `tests/e2e`,
which drive the whole editor. Packages' `__init__` files need none; the designs of `diorama_core/library/furniture`
are tested by tables in `tests/library/furniture`.

Exits with 1 when a module has neither a test nor a reason, when the table names a module that has a test or does not
exist, or when the table is longer than 20 modules.
"""

from __future__ import annotations

import ast
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("diorama_core", "diorama_app")
FURNITURE = "diorama_core.library.furniture."
MAX_REASONS = 20
MAX_REEXPORTS = 4
"""The longest chain of packages that pass a name on."""


def main() -> int:
    untested = untested_modules(ROOT)
    reasons = read_reasons(ROOT)
    for module in sorted(untested):
        print(f"{module:<58} {reasons.get(module, '-- no reason --')}")
    print(f"{len(untested)} of {len(modules(ROOT))} modules have no test of their own, at most {MAX_REASONS} may")
    problems = complaints(ROOT, untested, reasons)
    for problem in problems:
        print(problem, file=sys.stderr)
    return int(bool(problems))


def complaints(root: Path, untested: set[str], reasons: dict[str, str]) -> list[str]:
    """What is wrong with the tests or the table, one line each."""
    lines = [
        f"{m}: no test imports it; write one, or give a reason in tests/untested.toml" for m in untested - set(reasons)
    ]
    known = modules(root)
    for module in set(reasons) - untested:
        why = "has a test" if module in known else "does not exist"
        lines.append(f"{module}: {why}; take it out of tests/untested.toml")
    lines += [
        f"{module}: its reason in tests/untested.toml is empty" for module, why in reasons.items() if not why.strip()
    ]
    if len(reasons) > MAX_REASONS:
        lines.append(f"tests/untested.toml names {len(reasons)} modules; at most {MAX_REASONS} may go without a test")
    return sorted(lines)


def read_reasons(root: Path) -> dict[str, str]:
    """Why modules need no test of their own."""
    return dict(tomllib.loads((root / "tests" / "untested.toml").read_text())["reasons"])


def untested_modules(root: Path) -> set[str]:
    """Modules of both packages that no test module imports."""
    known, passed_on = modules(root), reexports(root)
    tested: set[str] = set()
    for path in (root / "tests").rglob("test_*.py"):
        if path.relative_to(root / "tests").parts[0] == "e2e":
            continue
        for name in imported_names(ast.parse(path.read_text()), package=""):
            for _ in range(MAX_REEXPORTS):
                name = passed_on.get(name, name)
            tested |= {name, name.rpartition(".")[0]}
    return {module for module in known - tested if not mirror_test(root, module).exists()}


def mirror_test(root: Path, module: str) -> Path:
    """Where the test of one module stands by its name."""
    package, *folders, name = module.split(".")
    return root.joinpath("tests", *(("app",) if package == "diorama_app" else ()), *folders, f"test_{name}.py")


def modules(root: Path) -> set[str]:
    """All modules that need a test of their own."""
    paths = (p for package in PACKAGES for p in (root / package).rglob("*.py") if p.name != "__init__.py")
    return {name for p in paths if not (name := dotted(root, p.with_suffix(""))).startswith(FURNITURE)}


def reexports(root: Path) -> dict[str, str]:
    """Names that packages take from their modules: `package.name` to `package.module.name`."""
    found: dict[str, str] = {}
    for package in PACKAGES:
        for path in (root / package).rglob("__init__.py"):
            name = dotted(root, path.parent)
            for origin in imported_names(ast.parse(path.read_text()), name):
                found[f"{name}.{origin.rpartition('.')[2]}"] = origin
    return found


def imported_names(tree: ast.AST, package: str) -> Iterator[str]:
    """The full dotted names of what a module imports when it runs."""
    for node in _run(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            yield from (f"{base}.{alias.name}" for alias in node.names)


def _run(tree: ast.AST) -> Iterator[ast.AST]:
    """All nodes except those under `if TYPE_CHECKING:`."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            continue
        yield node
        yield from _run(node)


def dotted(root: Path, path: Path) -> str:
    """A path under the root as the name that Python imports."""
    return ".".join(path.relative_to(root).parts)


if __name__ == "__main__":
    sys.exit(main())
