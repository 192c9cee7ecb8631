"""Precomputation of everything derived from a library's shapes, so that the first photo or search is fast."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from diorama_core.errors import DioramaError
from diorama_core.geometry.shape_appearance import SHARED_APPEARANCES
from diorama_core.layout.problem.parts import are_cached, parts_of_shape
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.store import BUILT_IN, open_library
from diorama_core.progress import SILENT, Progress
from diorama_core.render.image_search import ImageSearch
from diorama_core.render.template_cache import TemplateCache
from diorama_core.retrieval.appearance_similarity import EmbeddedSimilarity
from diorama_core.retrieval.seen_forms import has_form, shape_form
from diorama_core.retrieval.usual_forms import usual_form_factor
from diorama_core.workers import Workers, workers


@dataclass(frozen=True)
class Prepared:
    """What was done, and what could not be."""

    count: int
    """Shapes in the library."""
    made: int = 0
    """Shapes with missing data that was computed now."""
    failures: tuple[tuple[str, str], ...] = ()
    """Ids of shapes that could not be prepared, and why."""


def prepare_library(
    name: str = BUILT_IN,
    *,
    parts: bool = False,
    views: bool = False,
    templates: bool = False,
    pool: Workers | None = None,
    progress: Progress = SILENT,
) -> Prepared:
    """Compute and cache models, support surfaces and outlines of every shape of a library.

    Only what is missing is made: after a change to one design, that shape's. So this can be run at any time, resumed
    after an interruption, and costs next to nothing when all is there. A shape that fails never stops the others.

    Args:
        name: Of the library, as in `open_library`.
        parts: Also the convex parts that the layout optimiser keeps apart, several times the work of all else; else
            they are made for a scene's own shapes when they are first needed.
        views: Also what retrieval and a search by picture compare; else it is made of shapes when they are first
            candidates, some 60 ms a shape.
        templates: Also all pose templates, some two megabytes a shape; else they are made for candidates only.
        pool: Where the work is done; by default all cores of this machine.
        progress: Reports and cancellation.

    Raises:
        Cancelled: on request; what was made stays kept.
        LibraryError: when there is no such library.
    """
    pool = pool or workers()
    library = open_library(name, anew=True)
    shapes = library.shapes()
    wanted = _Wanted(parts, views, templates)
    missing = [s.id for s in shapes if not wanted.is_prepared(library, s)]
    whole = progress.part(0.0, 0.7 if views else 1.0)
    failures: list[tuple[str, str]] = []
    done = 0
    size = 12
    chunks = [tuple(missing[i : i + size]) for i in range(0, len(missing), size)]
    for finished in pool.map(partial(_prepare, name, wanted), chunks):
        failures += finished.value if finished.value is not None else [(i, str(finished.error)) for i in finished.item]
        done += len(finished.item)
        whole.report(done / len(missing), f"shapes: {done} of {len(missing)}")
    if views:
        broken = {shape_id for shape_id, _ in failures}
        usable = [s for s in shapes if s.id not in broken]
        ImageSearch(library).prepare(usable, progress.part(0.7, 1.0), pool, name)
    return Prepared(len(shapes), len(missing) - len(failures), tuple(sorted(failures)))


@dataclass(frozen=True)
class _Wanted:
    """What is to be derived from every shape beside its model, surfaces and outline."""

    parts: bool
    views: bool
    templates: bool

    def is_prepared(self, library: ShapeLibrary, shape: Shape) -> bool:
        """Whether all of it is on disk."""
        is_built = getattr(library, "is_built", None)  # stored libraries have models and surfaces from the start
        return (
            (is_built is None or is_built(shape.id))
            and SHARED_APPEARANCES.has(shape.content_hash, _appearances())
            and (not self.parts or are_cached(shape))
            and (not self.views or (EmbeddedSimilarity(library).is_prepared(shape) and has_form(shape)))
            and (not self.templates or TemplateCache().has(shape))
        )


def _appearances() -> Path:
    return default_cache_dir() / "appearances"


def _prepare(name: str, wanted: _Wanted, shape_ids: Sequence[str]) -> list[tuple[str, str]]:
    """Prepare some shapes; returns those that could not be, and why."""
    library, templates = open_library(name, anew=True), TemplateCache(cached=1)
    similarity = EmbeddedSimilarity(library)
    failures = []
    for shape_id in shape_ids:
        try:
            shape = library.shape(shape_id)
            library.glb(shape_id)
            appearance = SHARED_APPEARANCES.get(shape.content_hash, _appearances(), partial(library.parts, shape_id))
            if wanted.parts:
                parts_of_shape(library, shape)
            if wanted.views:
                similarity.prepare(shape)
                shape_form(library, shape, appearance)
                usual_form_factor(library, shape, appearance)
            if wanted.templates:
                templates.get(library, shape)
        except DioramaError as error:
            failures.append((shape_id, str(error)))
    return failures
