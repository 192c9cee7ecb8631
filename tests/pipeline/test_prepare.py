"""Preparing the built-in library makes what is missing, and nothing else."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pytest

from diorama_core.library import furniture
from diorama_core.library.catalogue import built_in_library, default_cache_dir
from diorama_core.library.furniture.model import Design
from diorama_core.pipeline.prepare import prepare_library
from diorama_core.workers import FinishedItem


@dataclass
class Here:
    """Does the work in this process, so that a test's designs are seen, and notes what it was asked for."""

    asked: set[str] = field(default_factory=set)
    count: int = 1

    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[FinishedItem[Any, Any]]:
        for item in items:
            self.asked.update(i if isinstance(i, str) else i[1] for i in item)  # an id, or a key and an id
            yield FinishedItem(item, function(item))


def some(height_m: float) -> tuple[Design, ...]:
    """A few designs in a height that only one test uses: this process remembers what it has made of a shape."""
    return tuple(
        replace(d, size_m=(*d.size_m[:2], height_m)) for d in furniture.designs() if d.category == "remote control"
    )


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DIORAMA_CACHE", str(tmp_path))


def use(monkeypatch: pytest.MonkeyPatch, *designs: Design) -> None:
    monkeypatch.setattr(furniture, "designs", lambda: designs)


def files() -> set[Path]:
    return {p.relative_to(default_cache_dir()) for p in default_cache_dir().rglob("*") if p.is_file()}


def test_a_change_to_one_design_makes_one_shape(monkeypatch: pytest.MonkeyPatch) -> None:
    designs = some(0.0231)[:2]
    use(monkeypatch, *designs)
    first, again = Here(), Here()
    assert prepare_library(pool=first, views=True, templates=True, parts=True).made == len(designs)
    assert first.asked == {d.id for d in designs}
    prepared = prepare_library(pool=again, views=True, templates=True, parts=True)
    assert (prepared.count, prepared.made, again.asked) == (len(designs), 0, set())

    before = files()
    changed = replace(designs[0], size_m=(0.21, 0.05, 0.022))
    use(monkeypatch, changed, *designs[1:])
    after = Here()
    prepared = prepare_library(pool=after, views=True, templates=True, parts=True)
    assert (prepared.count, prepared.made, after.asked) == (len(designs), 1, {changed.id})
    key = built_in_library().shape(changed.id).content_hash
    new = files() - before
    assert new
    assert all(key in path.name for path in new)  # model, surfaces, look, parts, templates and features of one shape


def test_another_caption_makes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    designs = some(0.0232)
    use(monkeypatch, *designs)
    prepare_library(pool=Here())
    use(monkeypatch, replace(designs[0], caption="a remote for the radio"), *designs[1:])
    assert prepare_library(pool=Here()).made == 0


@pytest.mark.parametrize("kind", ["*.glb", "*.surfaces.json"])
def test_what_was_lost_is_made_again(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    use(monkeypatch, *some(0.023 + 0.001 * len(kind)))
    prepare_library(pool=Here())
    lost = next(default_cache_dir().rglob(kind))
    lost.unlink()
    assert prepare_library(pool=Here()).made == 1
    assert lost.exists()
