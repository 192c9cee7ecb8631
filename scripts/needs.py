"""What a script needs beside the program, said in one line before anything of it is imported.

Importing this module ends the script where a package is missing.
"""

from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path

TESTS = {"pytest": "pytest", "hypothesis": "hypothesis"}
API = {"fastapi": "fastapi", "uvicorn": "uvicorn"}
NEEDS = {
    "crash.py": TESTS,
    "fuzz.py": {**TESTS, "pxr": "usd-core"},
    "mutants.py": {**TESTS, **API},
    "soak.py": {**TESTS, **API},
}
"""By script: what it imports, and the package that has it."""


def line_of_missing(script: str, needed: dict[str, str]) -> str:
    """What to do before a script runs; empty where nothing is missing."""
    missing = [package for module, package in needed.items() if find_spec(module) is None]
    return f"{script} needs more than the program: pip install {' '.join(missing)}" if missing else ""


_script = Path(sys.argv[0]).name
if _line := line_of_missing(_script, NEEDS.get(_script, {})):
    sys.exit(_line)
