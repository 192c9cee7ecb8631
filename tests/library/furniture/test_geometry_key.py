"""Keys name geometry: they differ where shapes do, follow every definition in use, and are the same everywhere."""

from __future__ import annotations

import ast
import dis
import shutil
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

import pytest

from diorama_core.errors import LibraryError
from diorama_core.library import furniture
from diorama_core.library.furniture import designs
from diorama_core.library.furniture import geometry_key as keys
from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.geometry_key import Sources, geometry_key
from diorama_core.library.furniture.model import Design, built, mesh_of, scene_of

PACKAGE = furniture.__name__
FOLDER = Path(furniture.__file__).parent
DESIGNS = {d.id: d for d in designs()}

Place = tuple[str, str]


def place_of(function: Callable[..., Any]) -> Place:
    return function.__module__.removeprefix(f"{PACKAGE}."), function.__qualname__


def digests(folder: Path) -> dict[str, str]:
    """The digest of every design's builder, read from a copy of the package."""
    sources = Sources(folder, PACKAGE)
    return {d.id: sources.digest(place_of(d.builder)) for d in designs()}


@pytest.fixture(scope="module")
def before() -> dict[str, str]:
    return digests(FOLDER)


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    return Path(shutil.copytree(FOLDER, tmp_path / "furniture", ignore=shutil.ignore_patterns("__pycache__")))


def edited(folder: Path, file: str, old: str, new: str) -> dict[str, str]:
    text = (folder / file).read_text()
    assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in {file}"
    (folder / file).write_text(text.replace(old, new))
    return digests(folder)


def renewed(before: dict[str, str], after: dict[str, str]) -> set[str]:
    return {id for id in before if before[id] != after[id]}


def test_every_shape_has_a_key_of_its_own() -> None:
    assert len({geometry_key(d) for d in designs()}) == len(designs())


def test_words_about_a_shape_do_not_count_and_its_form_does() -> None:
    lamp = DESIGNS["floor-lamp-reading"]
    key = geometry_key(lamp)
    assert geometry_key(replace(lamp, id="lamp", caption="a lamp", category="lamp", mass_kg=3.0)) == key
    assert geometry_key(replace(lamp, options=dict(reversed(lamp.options.items())))) == key
    x, y, z = lamp.size_m
    assert geometry_key(replace(lamp, size_m=(x, y, z + 0.01))) != key
    assert geometry_key(replace(lamp, options={**lamp.options, "metal": m.BRASS})) != key
    assert geometry_key(replace(lamp, builder=DESIGNS["floor-lamp-arc"].builder)) != key


def test_another_builder_renews_only_its_own_shapes(before: dict[str, str], copy: Path) -> None:
    after = edited(copy, "lighting/floor_lamps.py", "(x0 + 0.12, 0, h - 0.01)", "(x0 + 0.13, 0, h - 0.01)")
    assert renewed(before, after) == {"floor-lamp-reading"}


def test_another_row_renews_nothing_else(before: dict[str, str], copy: Path) -> None:
    after = edited(copy, "lighting/floor_lamps.py", "(1.15, 0.36, 1.95)", "(1.16, 0.36, 1.95)")
    assert renewed(before, after) == set()


def test_what_builders_share_renews_all_who_use_it(before: dict[str, str], copy: Path) -> None:
    after = edited(copy, "keys.py", "pitch_x * 0.84", "pitch_x * 0.85")
    assert {DESIGNS[id].category for id in renewed(before, after)} == {"laptop", "keyboard"}
    assert len(renewed(before, edited(copy, "solids.py", "CREASE_RAD = np.deg2rad(38.0)", "CREASE_RAD = 0.6"))) > 1000


def test_a_constant_renews_its_users(before: dict[str, str], copy: Path) -> None:
    after = edited(copy, "electronics/gadgets.py", '"#9a4d46"', '"#9a4d47"')
    assert renewed(before, after) == {"remote-control-black", "remote-control-slim", "remote-control-white"}


def test_comments_and_docstrings_renew_nothing(before: dict[str, str], copy: Path) -> None:
    old = '    """A floor reading lamp with a small adjustable head."""\n'
    new = '    """A lamp to read by.\n\n    Its box is small.\n    """  # not a "word"\n\n    # nor this\n'
    assert renewed(before, edited(copy, "lighting/floor_lamps.py", old, new)) == set()


SOURCES = Sources(FOLDER, PACKAGE)


@pytest.mark.parametrize("design", designs()[::26], ids=lambda d: d.id)
def test_all_that_runs_while_a_shape_is_made_is_in_its_key(design: Design) -> None:
    """Every function of the package that is called, and every name of the package that it reads."""
    known = set().union(*(SOURCES.closure(place_of(f)) for f in (design.builder, built, mesh_of, scene_of)))
    names = {name for _, name in known}
    ran: set[Place] = set()
    read: set[str] = set()

    def watch(frame: FrameType, event: str, _: Any) -> None:
        module = str(frame.f_globals.get("__name__", ""))
        if event != "call" or not module.startswith(PACKAGE) or module == PACKAGE:
            return
        if not Path(frame.f_code.co_filename).is_file():  # what checks types while tests run
            return
        top = frame.f_code.co_qualname.split(".")[0]
        if top in frame.f_globals:
            ran.add((module.removeprefix(f"{PACKAGE}."), top))
            read.update(n for n in globals_of(frame.f_code) if is_own(frame.f_globals, n))

    sys.setprofile(watch)
    try:
        solids = built(design)
        scene_of(solids)
        mesh_of(solids)
    finally:
        sys.setprofile(None)
    assert place_of(design.builder) in ran
    assert ran - {("model", "Design")} <= known
    assert read <= names


@cache
def globals_of(code: CodeType) -> frozenset[str]:
    return frozenset(str(i.argval) for i in dis.get_instructions(code) if i.opname == "LOAD_GLOBAL")


def is_own(namespace: dict[str, Any], name: str) -> bool:
    """Whether a global is a definition of the package, as far as its value can tell."""
    value = namespace.get(name)
    home = getattr(value, "__module__", None) or getattr(type(value), "__module__", "")
    return str(home).startswith(PACKAGE)


def test_designs_use_nothing_of_the_library_outside_the_package() -> None:
    """Keys do not follow other packages, so designs may not depend on their code."""
    harmless = {  # names of types and of metadata; errors of `geometry_key`
        "diorama_core.library.record": {"SymmetryFold"},
        "diorama_core.errors": {"LibraryError"},
        "diorama_core.library.slots": {"ROLE", "TILE_M", "Role"},
    }
    for path in sorted(FOLDER.rglob("*.py")):
        if path.name in ("articulation.py", "measures.py"):  # take finished designs apart or vary them; none uses them
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and str(node.module).startswith("diorama"):
                names = {alias.name for alias in node.names}
                allowed = str(node.module).startswith(PACKAGE) or names <= harmless.get(str(node.module), set())
                assert allowed, f"{path}: {node.module}: {sorted(names)}"


def test_what_cannot_be_told_is_refused() -> None:
    lamp = DESIGNS["floor-lamp-reading"]
    with pytest.raises(LibraryError, match="an option of a design"):
        geometry_key(replace(lamp, options={"metal": object()}))
    with pytest.raises(LibraryError, match="is no function"):
        geometry_key(replace(lamp, builder=partial(lamp.builder)))
    with pytest.raises(LibraryError, match="at its top"):
        geometry_key(replace(lamp, builder=lambda size: []))


def test_threads_that_name_shapes_at_once_name_them_alike() -> None:
    chosen = tuple(DESIGNS.values())[::7]
    alone = [geometry_key(d) for d in chosen]
    usual = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for forgets in (keys._code_of, keys._sources):
            forgets.cache_clear()
        with ThreadPoolExecutor(4) as pool:
            found = list(pool.map(lambda _: [geometry_key(d) for d in chosen], range(4)))
    finally:
        sys.setswitchinterval(usual)
    assert found == [alone] * 4
