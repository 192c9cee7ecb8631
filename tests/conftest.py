"""What tests share: the folder of real photos, where it exists, and a cache that never touches the user's own."""

from __future__ import annotations

import gc
import json
import os
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import settings

from tests import made_once, typechecking

if typechecking.wanted():  # before anything of Diorama is imported
    typechecking.install()

from diorama_core.architecture.texture import plane_textures
from diorama_core.artefacts import Inputs
from diorama_core.io.large_libraries import GARBAGE_EVERY
from diorama_core.io.text import clean_text
from diorama_core.library import catalogue
from diorama_core.perception.inputs import ReadInputs, read_inputs
from tests import kept_readers, shared_solids

gc.disable()  # until all tests are collected: what is imported stays

settings.register_profile("deterministic", derandomize=True, deadline=None, max_examples=30)
settings.load_profile("deterministic")

UNCHECKED_FOLDERS = frozenset()
"""Folders whose newest tests still pass values that annotations do not allow; take one out after mending its tests."""

LARGER_PICTURES = ("architecture", "texture")
"""Whose tests ask about the pictures of planes themselves, and get half the texels a side. In others those have a
quarter: to make full ones takes four tenths of a build from a small photo."""
FULL_PX = {name: getattr(plane_textures, name) for name in ("MAX_SIDE_PX", "MAX_CEILING_PX")}

UNTIL = float(os.environ.get("DIORAMA_TEST_UNTIL", "inf"))
"""When the last test may start, in seconds since 1970: `scripts/test --fast` promises an end."""

SHARED = Path(__file__).resolve().parents[2] / "shared"


@dataclass(frozen=True)
class PhotoEntry:
    """One real photo with whatever came with it."""

    id: str
    path: Path
    kind: str
    intrinsics: tuple[float, float, float, float] | None
    depth: Path | None
    depth_encoding: str
    boxes: Path | None
    masks: Path | None

    @cached_property
    def read(self) -> ReadInputs:
        """The checked inputs with everything given, and warnings."""
        return read_inputs(
            self.path,
            intrinsics=self.intrinsics,
            depth=self.depth,
            depth_encoding=self.depth_encoding,
            boxes=self.boxes,
            masks=self.masks,
        )

    @property
    def inputs(self) -> Inputs:
        """The checked inputs with everything given."""
        return self.read.inputs


def photo_entries(folder: Path) -> list[PhotoEntry]:
    """Every photo that the folder's `photos.json` lists."""

    def beside(record: dict[str, Any], key: str) -> Path | None:
        return folder / record[key] if record.get(key) else None

    return [
        PhotoEntry(
            id=r["id"],
            path=folder / r["file"],
            kind=r["kind"],
            intrinsics=tuple(r["K"]) if r.get("K") else None,
            depth=beside(r, "depth_file"),
            depth_encoding="sunrgbd" if "<<13" in r.get("depth_to_metres", "") else "linear",
            boxes=beside(r, "detections_file"),
            masks=beside(r, "instance_mask_file"),
        )
        for r in json.loads((folder / "photos.json").read_text())
    ]


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of shared material beside the repository; tests that need it are skipped without it."""
    if not SHARED.is_dir():
        pytest.skip("needs the folder 'shared' beside the repository (real photos), which is absent")
    return SHARED


@pytest.fixture(scope="session")
def photos(shared: Path) -> list[PhotoEntry]:
    """All shared photos; the pictures are read on first use."""
    return photo_entries(shared / "photos")


def derived_files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What is derived from shapes, by content: made once for all processes of a run, of several runs where one says so.

    `scripts/test` names a folder (DIORAMA_TEST_CACHE) for the tests with and without a browser. The processes of
    pytest-xdist have their temporary folders beside one another.
    """
    if given := os.environ.get("DIORAMA_TEST_CACHE"):
        return Path(given)
    if "PYTEST_XDIST_WORKER" in os.environ:
        return tmp_path_factory.getbasetemp().parent / "cache"
    return tmp_path_factory.mktemp("cache")


@pytest.fixture(scope="session", autouse=True)
def _own_folders(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Caches and libraries of this run go to temporary folders, and no file waits until it has reached the disk: what
    is written need not outlast the machine's power. That it is asked for is tested in `tests/io/test_atomic.py`.
    Solids of built-in shapes, which most tests need, are built once for all processes, and processes that read files
    are kept.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda descriptor: None)
        patch.setattr(catalogue, "built_once", shared_solids.built_once)
        kept_readers.keep(patch)
        derived = derived_files(tmp_path_factory)
        patch.setenv("DIORAMA_CACHE", str(derived))
        patch.setenv("DIORAMA_LIBRARIES", str(tmp_path_factory.mktemp("libraries")))
        if "DIORAMA_TEST_CACHE" in os.environ or "PYTEST_XDIST_WORKER" in os.environ:
            patch.setenv(made_once.FOLDER, str(derived / "made"))
        yield
        kept_readers.end_all()


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Files with slow tests come first: of two processes that share the files, none is left with one at the end."""
    slow = {item.path for item in items if item.get_closest_marker("slow") is not None}
    items.sort(key=lambda item: item.path not in slow)


def pytest_collection_finish() -> None:
    """What is imported and collected is looked through for garbage neither now nor while tests run; the rest as seldom
    as in the program.
    """
    gc.freeze()
    gc.set_threshold(GARBAGE_EVERY)
    gc.enable()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Shapes and types are checked as the test's folder and markers say, and the same items of lists every time.

    Pictures of planes are small but where they are asked about.
    """
    if time.time() > UNTIL:
        pytest.skip("NOT RUN: the time of scripts/test --fast is over")
    if sys.platform == "win32" and item.get_closest_marker("posix") is not None:
        pytest.skip("sends signals or makes links")
    folders = item.path.relative_to(Path(__file__).parent).parts
    for name, side_px in FULL_PX.items():
        setattr(plane_textures, name, side_px // (2 if folders[:2] == LARGER_PICTURES else 4))
    unchecked = folders[0] in UNCHECKED_FOLDERS or item.get_closest_marker("unchecked") is not None
    typechecking.begin_test(unchecked=unchecked)


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport() -> Iterator[None]:
    """Logs of tests may hold halves of characters, which cannot be sent to the process that prints reports."""
    outcome = yield
    report = outcome.get_result()
    report.sections = [(title, clean_text(text)) for title, text in report.sections]


@pytest.fixture
def rng() -> np.random.Generator:
    """A generator with a fixed seed."""
    return np.random.default_rng(0)
