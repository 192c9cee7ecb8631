"""Small defects put into the modules that keep the promises of docs/reliability.md: does a test fail for each?

    python scripts/mutants.py [--only backups,contained] [--sample 20] [--seed 0] [--minutes 60]

A mutant is a module with one change: a comparison with its neighbour, `and` for `or`, a condition negated, a number one
more, a value not returned, a call or an error left out. Those of the module's own tests that reach the changed line run
in a fork of this process, which has collected them; a mutant that they pass has survived, and its line is printed.
Constants at the top of modules, words for people and what is logged are left alone: they are settings and prose. Needs
the packages of the tests.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import copy
import gc
import json
import os
import random
import resource
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from types import CodeType, FrameType, FunctionType
from typing import TYPE_CHECKING

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import scripts.needs  # noqa: F401  # ends with a line where a package is missing
from scripts.untested_modules import mirror_test

os.environ["DIORAMA_CHECK_SHAPES"] = "0"  # before tests are imported

import pytest
from _pytest.runner import runtestprotocol

if TYPE_CHECKING:
    from _typeshed import TraceFunction

ROOT = Path(__file__).resolve().parents[1]
QUIETLY = ("-s", "-o", "addopts=-p no:dash -p no:terminal -p no:cacheprovider")
PATIENCE, MIN_PATIENCE_S = 6.0, 20.0
"""Times as much of the processor as the tests take without a defect, and seconds: a mutant that takes more is found."""
WAITING, WAITING_S = 20.0, 90.0
"""The same of the clock, for one that waits for ever; other work on the machine must not make a mutant found."""

GUARDED: dict[str, tuple[str, ...]] = {
    "diorama_core/io/atomic.py": (),
    "diorama_core/io/bounded.py": ("project/test_hostile.py",),
    "diorama_core/io/contained.py": (),
    "diorama_core/io/text.py": (),
    "diorama_core/io/arrays.py": (),
    "diorama_core/io/derived.py": (),
    "diorama_core/io/limited.py": (),
    "diorama_core/project/backups.py": ("project/test_storage.py",),
    "diorama_core/project/lock.py": ("project/test_stateful_lock.py",),
    "diorama_core/project/storage.py": ("project/test_hostile.py", "project/test_written_is_readable.py"),
    "diorama_core/project/further_photos.py": (),
    "diorama_core/pipeline/runner.py": (),
    "diorama_core/scene/history.py": (),
    "diorama_app/session/recovery.py": ("app/session/test_stateful_project.py",),
    "diorama_app/session/autosave.py": ("app/session/test_recovery.py", "app/session/test_stateful_project.py"),
    "diorama_app/session/ui_thread.py": (),
    "diorama_app/projects/manage.py": ("app/test_care.py",),
    "diorama_app/http_api/access.py": ("app/http_api/test_connections.py",),
    "diorama_app/http_api/answers.py": ("app/http_api/test_routes.py", "app/http_api/test_jobs.py"),
    "diorama_app/http_api/job.py": ("app/http_api/test_jobs.py",),
    "diorama_app/http_api/jobs.py": ("app/http_api/test_stateful_jobs.py",),
    "diorama_app/web/requests.py": (),
    "diorama_app/web/visitors.py": (),
}
"""Modules, and the tests of each besides the one that mirrors its path."""

ELSEWHERE = {"diorama_core/io/limited.py": ("_serve", "_tell", "_answer")}
"""Functions that another process runs, which reads the module's file itself: a defect here is none there."""


def _both_ways(*pairs: tuple[type[ast.cmpop], type[ast.cmpop]]) -> dict[type[ast.cmpop], type[ast.cmpop]]:
    return {a: b for pair in pairs for a, b in (pair, pair[::-1])}


COMPARED = _both_ways(
    (ast.Lt, ast.LtE), (ast.Gt, ast.GtE), (ast.Eq, ast.NotEq), (ast.In, ast.NotIn), (ast.Is, ast.IsNot)
)
AT_A_CLOCK = _both_ways((ast.Lt, ast.GtE), (ast.LtE, ast.Gt))
"""No clock reads exactly the limit: there the neighbour makes no difference, the contrary does."""
COMPUTED: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.FloorDiv: ast.Mult,
}


@dataclass(frozen=True)
class Mutant:
    """One defect: the node that is changed, as the module's tree is walked, and what becomes of it."""

    number: int
    lines: frozenset[int]
    """Of the statement, without those within it."""
    before: str
    after: ast.AST = field(repr=False)

    def __str__(self) -> str:
        return f"line {min(self.lines)}: {_short(self.before)}  ->  {_short(ast.unparse(self.after))}"


def mutants_of(source: str, spared: tuple[str, ...] = ()) -> list[Mutant]:
    """Every small defect of a module, but for those of the functions that are spared."""
    tree = ast.parse(source)
    changeable = _changeable(tree, spared)
    found: list[Mutant] = []
    lines: dict[ast.AST, frozenset[int]] = {}
    for number, (node, parent, _) in enumerate(_located(tree)):
        lines[node] = _lines(node) if isinstance(node, ast.stmt) else lines.get(parent, frozenset())
        for way in range(2) if number in changeable else ():
            if (new := _changed(node, way)) is not None:
                found.append(Mutant(number, lines[node], ast.unparse(node), new))
    return found


def _lines(statement: ast.stmt) -> frozenset[int]:
    body = getattr(statement, "body", None)
    end = max(body[0].lineno, statement.lineno + 1) if body else (statement.end_lineno or 0) + 1
    return frozenset(range(statement.lineno, end))


def with_defect(source: str, mutant: Mutant) -> ast.Module:
    """The tree of a module with the defect in it."""
    tree = ast.parse(source)
    _, parent, (name, index) = _located(tree)[mutant.number]
    if index is None:
        setattr(parent, name, mutant.after)
    else:
        getattr(parent, name)[index] = mutant.after
    return ast.fix_missing_locations(tree)


def _located(tree: ast.Module) -> list[tuple[ast.AST, ast.AST, tuple[str, int | None]]]:
    """Every node with the one above it and its place there, in a fixed order."""
    rows: list[tuple[ast.AST, ast.AST, tuple[str, int | None]]] = []
    for parent in ast.walk(tree):
        for name, value in ast.iter_fields(parent):
            if isinstance(value, ast.AST):
                rows.append((value, parent, (name, None)))
            elif isinstance(value, list):
                rows += [(v, parent, (name, i)) for i, v in enumerate(value) if isinstance(v, ast.AST)]
    return rows


def _changeable(tree: ast.Module, spared: tuple[str, ...]) -> set[int]:
    """Numbers of the nodes within functions, without annotations, decorators, words and what is logged."""
    left_out: set[int] = set()
    within: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and node.name in spared:
            left_out |= {id(n) for n in ast.walk(node)}
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            within |= {id(n) for statement in node.body for n in ast.walk(statement)}
            outside = [node.args, *node.decorator_list, *([node.returns] if node.returns else [])]
            left_out |= {id(n) for part in outside for n in ast.walk(part)}
        elif isinstance(node, ast.AnnAssign):
            left_out |= {id(n) for n in ast.walk(node.annotation)}
        elif isinstance(node, ast.JoinedStr) or _is_prose(node) or _is_taste(node):
            left_out |= {id(n) for n in ast.walk(node)}
    return {number for number, (node, _, _) in enumerate(_located(tree)) if id(node) in within - left_out}


def _is_prose(node: ast.AST) -> bool:
    """Whether a statement is a docstring, or something that is logged."""
    value = node.value if isinstance(node, ast.Expr) else None
    logged = isinstance(value, ast.Call) and ast.unparse(value.func).split(".")[0] in ("log", "logging", "print")
    return logged or isinstance(value, ast.Constant)


def _is_taste(node: ast.AST) -> bool:
    """Whether it says how long something may take, or how far a file's lines are indented: one more is no defect."""
    return isinstance(node, ast.keyword) and node.arg in ("timeout", "indent")


def _reads_a_clock(node: ast.AST) -> bool:
    clocks = ("time.time", "time.monotonic", "time.perf_counter", "loop.time")
    return any(isinstance(n, ast.Call) and ast.unparse(n.func) in clocks for n in ast.walk(node))


def _changed(node: ast.AST, way: int) -> ast.AST | None:
    """The node with a defect, or None where there is none of this kind."""
    match node:
        case ast.Compare(ops=[op]) if type(op) in COMPARED and way == 0:
            other = AT_A_CLOCK.get(type(op)) if _reads_a_clock(node) else None
            return ast.Compare(node.left, [(other or COMPARED[type(op)])()], node.comparators)
        case ast.BoolOp() if way == 0:
            return ast.BoolOp(ast.Or() if isinstance(node.op, ast.And) else ast.And(), node.values)
        case ast.UnaryOp(op=ast.Not()) if way == 0:
            return node.operand
        case ast.If() | ast.While() if way == 0 and not isinstance(node.test, ast.Compare | ast.UnaryOp | ast.Constant):
            made = copy.copy(node)
            made.test = ast.UnaryOp(ast.Not(), node.test)
            return made
        case ast.Constant(value=bool() as value) if way == 0:
            return ast.Constant(not value)
        case ast.Constant(value=int() | float() as value) if way == 0 and not isinstance(value, bool):
            return ast.Constant(value + 1)
        case ast.BinOp(op=op) if type(op) in COMPUTED and way == 0:
            return ast.BinOp(node.left, COMPUTED[type(op)](), node.right)
        case ast.Return(value=value) if way == 1 and value is not None and not isinstance(value, ast.Constant):
            return ast.Return(ast.Constant(None))
        case ast.Expr(value=ast.Call() | ast.Await()) if way == 1:
            return ast.If(ast.Constant(False), [node], [])  # which leaves the method's cell for `super` in place
        case ast.Raise() if way == 1:
            return ast.Pass()
    return None


@dataclass(frozen=True)
class Ran:
    """What became of tests."""

    passed: bool
    cpu_s: float
    wall_s: float


def in_fork(work: Callable[[], bool], known: Ran | None = None) -> Ran:
    """Do something in a fork of this process, which hears nothing of it but how it ended.

    Args:
        work: True when it went well.
        known: the same without a defect: what takes much longer has failed.
    """
    began = time.monotonic()
    process = os.fork()
    if process == 0:
        os.setpgid(0, 0)
        quiet = os.open(os.devnull, os.O_WRONLY)
        os.dup2(quiet, 1)
        os.dup2(quiet, 2)
        if known is not None:
            most = int(max(MIN_PATIENCE_S, PATIENCE * known.cpu_s))
            resource.setrlimit(resource.RLIMIT_CPU, (most, most))
        try:
            os._exit(0 if work() else 1)
        finally:
            os._exit(1)
    until = None if known is None else began + max(WAITING_S, WAITING * known.wall_s)
    while True:
        done, status, used = os.wait4(process, os.WNOHANG)
        if done:
            cpu_s = used.ru_utime + used.ru_stime
            return Ran(os.waitstatus_to_exitcode(status) == 0, cpu_s, time.monotonic() - began)
        if until is not None and time.monotonic() > until:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process, signal.SIGKILL)
            until = None
        time.sleep(0.05)


class Trial:
    """What pytest does in the place of running the tests that it has collected: see which mutants they find."""

    def __init__(self, path: Path, mutants: list[Mutant]) -> None:
        self.path, self.mutants = path, mutants
        self.survived: list[Mutant] | None = None
        """None where the tests fail without a defect."""
        self._reached: set[int] = set()
        self._by_fixtures: dict[Path, set[int]] = {}

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Run all tests once, and then for each mutant those that reach it, quick ones first."""
        with tempfile.TemporaryDirectory() as folder:
            os.environ["PYTEST_DEBUG_TEMPROOT"] = folder
            notes = Path(folder) / "notes.json"
            if not in_fork(lambda: self._traced(session.items, notes)).passed:
                return True
            rows = sorted(json.loads(notes.read_text()), key=lambda row: row[1])
            source, functions = self.path.read_text(), _functions_of(self.path)
            self.survived = []
            for mutant in self.mutants:
                mine = [row for row in rows if mutant.lines & set(row[3])] or rows
                items = [session.items[number] for number, *_ in mine]
                code = compile(with_defect(source, mutant), str(self.path), "exec")
                known = Ran(True, sum(cpu for _, cpu, _, _ in mine), sum(wall for _, _, wall, _ in mine))
                if in_fork(partial(_passes, items, functions, code), known).passed:
                    self.survived.append(mutant)
        return True

    def pytest_runtest_call(self, item: pytest.Item) -> None:
        """What was reached until here, fixtures did: perhaps for all tests of the file."""
        self._by_fixtures.setdefault(item.path, set()).update(self._reached)
        self._reached.clear()

    def _traced(self, items: list[pytest.Item], notes: Path) -> bool:
        """Run tests; note of each its number, the seconds it took and the module's lines that it reached."""
        here, rows = str(self.path), []

        def trace(frame: FrameType, event: str, about: object) -> TraceFunction | None:
            if frame.f_code.co_filename != here:
                return None
            self._reached.add(frame.f_lineno)
            return trace

        threading.settrace(trace)
        sys.settrace(trace)
        for number, (item, following) in enumerate(zip(items, [*items[1:], None], strict=True)):
            cpu, wall = time.process_time(), time.monotonic()
            if any(report.failed for report in runtestprotocol(item, log=False, nextitem=following)):
                return False
            rows.append((number, time.process_time() - cpu, time.monotonic() - wall, set(self._reached)))
            self._reached.clear()
        found = [(n, c, w, sorted(lines | self._by_fixtures.get(items[n].path, set()))) for n, c, w, lines in rows]
        notes.write_text(json.dumps(found))
        return True


def _passes(items: list[pytest.Item], functions: list[FunctionType], code: CodeType) -> bool:
    _put_in(functions, code)
    return not any(
        report.failed
        for item, following in zip(items, [*items[1:], None], strict=True)
        for report in runtestprotocol(item, log=False, nextitem=following)
    )


def _functions_of(path: Path) -> list[FunctionType]:
    """The functions of a module, wherever they are held: in classes, behind decorators, in tests."""
    gc.unfreeze()  # `tests/conftest.py` has frozen what was imported
    return [f for f in gc.get_objects() if type(f) is FunctionType and f.__code__.co_filename == str(path)]


def _put_in(functions: list[FunctionType], code: CodeType) -> None:
    """Let a module's functions do what its changed code says."""
    changed: dict[str, CodeType] = {}
    waiting = [code]
    while waiting:
        inner = [c for c in waiting.pop().co_consts if isinstance(c, CodeType)]
        changed |= {c.co_qualname: c for c in inner}
        waiting += inner
    for function in functions:
        function.__code__ = changed[function.__code__.co_qualname]


def chosen(options: argparse.Namespace) -> Iterator[tuple[Path, tuple[str, ...], list[Mutant], int]]:
    """The modules that were asked for, with a sample of their mutants and how many there are."""
    for module, tests in GUARDED.items():
        if options.only and Path(module).stem not in options.only.split(","):
            continue
        every = mutants_of((ROOT / module).read_text(), ELSEWHERE.get(module, ()))
        sample = random.Random(options.seed).sample(every, min(options.sample or len(every), len(every)))
        own = mirror_test(ROOT, module.removesuffix(".py").replace("/", "."))
        paths = [path for path in (own, *(ROOT / "tests" / name for name in tests)) if path.exists()]
        yield ROOT / module, tuple(map(str, paths)), sorted(sample, key=lambda m: m.number), len(every)


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--only", default="", help="names of modules, with commas (default: all that are guarded)")
    parser.add_argument("--sample", type=int, default=0, help="mutants of each module (default: all)")
    parser.add_argument("--seed", type=int, default=0, help="of the samples")
    parser.add_argument("--minutes", type=float, default=1e6, help="begin no module after so long")
    options = parser.parse_args()
    os.chdir(ROOT)
    until, total, survived = time.monotonic() + 60.0 * options.minutes, 0, 0
    for path, tests, mutants, count in chosen(options):
        if time.monotonic() > until:
            print(f"{path.relative_to(ROOT)} and what follows: no time", flush=True)
            break
        trial = Trial(path, mutants)
        pytest.main([*QUIETLY, *tests], plugins=[trial])
        if trial.survived is None:
            print(f"{path.relative_to(ROOT)}: its tests fail without a defect", flush=True)
            return 2
        total, survived = total + len(mutants), survived + len(trial.survived)
        print(
            f"{path.relative_to(ROOT)}: {len(mutants)} of {count} mutants, {len(trial.survived)} survived", flush=True
        )
        for mutant in trial.survived:
            print(f"  {mutant}", flush=True)
    print(f"{total} mutants, {survived} survived ({100.0 * survived / max(total, 1):.1f} %, asked: at most 5)")
    return 0


def _short(code: str) -> str:
    line = " ".join(code.split())
    return line if len(line) <= 90 else f"{line[:89]}…"


if __name__ == "__main__":
    sys.exit(main())
