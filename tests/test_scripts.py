"""What scripts and examples take from the program is there: nobody runs each of them after every change."""

from __future__ import annotations

import ast
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SCRIPTS = sorted(path for folder in ("scripts", "examples") for path in (ROOT / folder).glob("*.py"))


@pytest.mark.parametrize("path", SCRIPTS, ids=[p.stem for p in SCRIPTS])
def test_what_a_script_imports_is_there(path: Path) -> None:
    for statement in ast.walk(ast.parse(path.read_text())):
        module = statement.module if isinstance(statement, ast.ImportFrom) else None
        if module is None or module.partition(".")[0] not in ("diorama_core", "diorama_app", "tests"):
            continue
        for name in statement.names:
            there = hasattr(import_module(module), name.name)
            assert there or import_module(f"{module}.{name.name}"), f"{module} has no {name.name}"
