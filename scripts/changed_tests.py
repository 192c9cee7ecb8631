"""Checks what changed, in at most 90 seconds: `./scripts/test --fast`.

Changed is what differs from where the branch left `main`, what is not committed included. Format and lint of the
changed files, import directions, types of the changed modules, and these tests, the nearest first:

1. changed tests, and tests that mirror a changed module's path;
2. tests that import a changed module, or a name that a package takes from it: first those in a folder of the same name,
   then those with the fewest imports;
3. the tests of the repository's own rules (`tests/test_*.py` of `RULES`).

What was left out is printed: tests with a browser, tests marked `slow`, what needs a changed module through another one
only, and what the time did not suffice for. `./scripts/test` runs everything.
"""

from __future__ import annotations

import ast
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from untested_modules import MAX_REEXPORTS, dotted, imported_names, mirror_test, reexports

ROOT = Path(__file__).resolve().parents[1]
LIMIT_S = 90.0
LAST_START_S = 70.0
"""When the last test starts: most take less than two seconds, few take ten."""
NO_TESTS = 5
"""pytest's status where every selected test is slow."""
MAX_FILES = 40
"""Files of tests that two processes collect in some twenty seconds."""
RULES = (
    "browser_tests",
    "constraints",
    "docs_names",
    "docs_site",
    "kind_literals",
    "modules_have_tests",
    "module_numbers",
    "style",
)


@dataclass(frozen=True)
class Selection:
    """Files of tests, the nearest to the change first, and those that the change may touch but that are not run."""

    run: tuple[str, ...]
    left_out: tuple[str, ...]


def main() -> int:
    started = time.time()
    changed = changed_files(ROOT)
    if not changed:
        print("nothing differs from main: nothing to check")
        return 0
    code = [name for name in changed if name.endswith(".py") and (ROOT / name).exists()]
    print(f"{len(changed)} changed files, {len(code)} of them Python")
    failed = [tool for tool, command in checks(code).items() if code and subprocess.run(command, cwd=ROOT).returncode]
    modules = [name for name in code if name.startswith(("diorama_", "addons/"))]
    types = subprocess.Popen([".venv/bin/mypy", *modules], cwd=ROOT, start_new_session=True) if modules else None
    selection = select(ROOT, changed)
    failed += run_tests(selection.run, started)
    if types is not None:
        failed += wait(types, "types", started)
    print("\n".join(summary(selection, failed, time.time() - started)))
    return int(bool(failed))


def checks(code: list[str]) -> dict[str, list[str]]:
    """The quick checks of changed files, by name."""
    return {
        "format": [".venv/bin/ruff", "format", "--check", "-q", *code],
        "lint": [".venv/bin/ruff", "check", "-q", *code],
        "import directions": [".venv/bin/lint-imports"],
    }


def changed_files(root: Path) -> list[str]:
    """Paths that differ from where the branch left main; files that git does not know yet included."""

    def git(*words: str) -> list[str]:
        done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True)
        return done.stdout.split("\n")[:-1] if done.returncode == 0 else []

    base = next((line for main in ("main", "origin/main") for line in git("merge-base", main, "HEAD")), "HEAD")
    return sorted({*git("diff", "--name-only", base), *git("ls-files", "--others", "--exclude-standard")})


def select(root: Path, changed: Iterable[str]) -> Selection:
    """The tests for changed files."""
    changed = list(changed)
    modules = {dotted(root, root / name).removesuffix(".py").removesuffix(".__init__") for name in changed}
    passed_on = reexports(root)
    folders = {Path(name).parent.name for name in changed}
    near, importing, browser = [], [], []
    mirrors = {mirror_test(root, module) for module in modules if module.startswith("diorama_")}
    for path in sorted((root / "tests").rglob("test_*.py")):
        name = path.relative_to(root).as_posix()
        if name.startswith("tests/e2e/"):
            browser += [name] if name in changed else []
        elif name in changed or path in mirrors:
            near.append(name)
        elif modules & (imported := _imports(path, passed_on)):
            importing.append((path.parent.name not in folders, len(imported), name))
    rules = [f"tests/test_{rule}.py" for rule in RULES if (root / f"tests/test_{rule}.py").exists()]
    tests = list(dict.fromkeys([*near, *(name for *_, name in sorted(importing)), *rules]))
    first = tests[: MAX_FILES - len(rules)]
    return Selection(
        tuple(dict.fromkeys([*first, *rules])), (*browser, *(t for t in tests[len(first) :] if t not in rules))
    )


def _imports(path: Path, passed_on: dict[str, str]) -> set[str]:
    """Modules that a test imports, by name or by what a package takes from them."""
    found: set[str] = set()
    for name in imported_names(ast.parse(path.read_text("utf-8")), package=""):
        for _ in range(MAX_REEXPORTS):
            found |= {name, name.rpartition(".")[0]}
            name = passed_on.get(name, name)
        found |= {name, name.rpartition(".")[0]}
    return {name for name in found if name.startswith(("diorama_", "tests", "addons"))}


def run_tests(files: tuple[str, ...], started: float) -> list[str]:
    """Runs files of tests until the time is over; what failed."""
    environment = dict(os.environ, DIORAMA_TEST_UNTIL=str(started + LAST_START_S))
    processes = ["-n", "2", "--dist", "loadfile", "--no-loadscope-reorder"] if len(files) > 1 else []
    command = [".venv/bin/python", "-m", "pytest", "-q", "-m", "not slow and not browser", *processes, *files]
    return wait(subprocess.Popen(command, cwd=ROOT, env=environment, start_new_session=True), "tests", started)


def wait(process: subprocess.Popen[bytes], name: str, started: float) -> list[str]:
    """The name of a process that failed or did not end in time."""
    try:
        code = process.wait(max(0.1, started + LIMIT_S - time.time()))
        return [name] if code not in (0, NO_TESTS) else []
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return [f"{name} (stopped: {LIMIT_S:.0f} s are over)"]


def summary(selection: Selection, failed: list[str], seconds: float) -> list[str]:
    """What was run, what was not, and how it ended."""
    lines = [f"{len(selection.run)} files of tests were run. NOT run: slow tests, tests in a browser (tests/e2e),"]
    lines.append("and those that need a changed module only through another one: ./scripts/test runs them.")
    lines += [f"not run: {name}" for name in selection.left_out]
    return [*lines, f"{'FAILED: ' + ', '.join(failed) if failed else 'what was run passed'} in {seconds:.0f} s"]


if __name__ == "__main__":
    sys.exit(main())
