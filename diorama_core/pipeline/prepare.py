"""Everything derived from the built-in shapes, made once, so that the first photo does not wait for it."""

from __future__ import annotations

import os
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import partial
from multiprocessing import get_context

from diorama_core.geometry.looks import SHARED_LOOKS
from diorama_core.layout.parts import parts_of_shape
from diorama_core.library.catalogue import built_in_library, default_cache_dir
from diorama_core.progress import Progress

_CHUNK = 12


def prepare_library(*, workers: int | None = None, progress: Progress | None = None) -> int:
    """Make and keep models, support surfaces, outlines and convex parts of every built-in shape.

    What is kept already costs next to nothing, so this can be run at any time and resumed.

    Args:
        workers: processes; all cores by default.
        progress: reports and cancellation.

    Returns:
        How many shapes there are.

    Raises:
        Cancelled: on request; finished shapes stay kept.
    """
    progress = progress or Progress()
    ids = [shape.id for shape in built_in_library().shapes()]
    chunks = [tuple(ids[i : i + _CHUNK]) for i in range(0, len(ids), _CHUNK)]
    done = 0
    with ProcessPoolExecutor(workers or os.cpu_count() or 1, mp_context=get_context("spawn")) as pool:
        pending = {pool.submit(_prepare, chunk): len(chunk) for chunk in chunks}
        try:
            for finished in as_completed(pending):
                finished.result()
                done += pending[finished]
                progress.report(done / len(ids), f"shapes: {done} of {len(ids)}")
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return len(ids)


def _prepare(shape_ids: tuple[str, ...]) -> None:
    library = built_in_library()
    looks = default_cache_dir() / "looks"
    for shape_id in shape_ids:
        shape = library.shape(shape_id)
        library.glb(shape_id)
        SHARED_LOOKS.get(shape.content_hash, looks, partial(library.parts, shape_id))
        parts_of_shape(library, shape)
