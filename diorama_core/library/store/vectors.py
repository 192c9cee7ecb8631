"""Nearest features, by whatever is worth it at a library's size: every row in turn, or an approximate index.

Comparing a query with every row is exact, needs nothing prepared and takes some milliseconds at tens of thousands of
shapes; its time grows with the rows. Above a million an index that looks at a small share of them pays for its making.
"""

from __future__ import annotations

import importlib.util
import logging
import os
from typing import Any, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from diorama_core.errors import LibraryError, UnavailableError
from diorama_core.library.store.features import INDEX_FOLDER, FeatureMatrix, NearShape

log = logging.getLogger(__name__)

INDEX_FROM = 1_000_000
"""Shapes from which on an index is used, where LanceDB is installed."""
_BATCH = 20_000
_ITERATIONS = 10
"""Rounds of the clustering that makes the index: 50, LanceDB's own, take five times as long and find hardly more."""


@runtime_checkable
class VectorIndex(Protocol):
    """Finds the features nearest to a query; features and queries of unit length make scores cosines."""

    def top(self, query: Float[np.ndarray, "width"], k: int) -> tuple[NearShape, ...]:
        """The `k` shapes with the greatest dot product with the query, best first."""
        ...


def vector_index(matrix: FeatureMatrix, *, index_from: int = INDEX_FROM) -> VectorIndex:
    """The matrix itself, or a LanceDB index of it where it is large; the index is made or renewed when it is behind.

    Without LanceDB a large matrix is still searched exactly, only slower, which is logged.
    """
    if len(matrix) < index_from:
        return matrix
    if importlib.util.find_spec("lancedb") is None:
        log.info("%d features are compared one by one; pip install 'diorama[vector]' makes an index", len(matrix))
        return matrix
    return LanceIndex(matrix)


class LanceIndex:
    """An approximate index (inverted lists of product-quantised rows) in a LanceDB table beside the matrix.

    What the index proposes is scored again with the matrix's own numbers, so scores are exact, and only a shape whose
    row lies in none of the lists looked at can be missed.

    Args:
        matrix: What to index; rows of unit length.
        probes: Lists looked at in a query; more find more and take longer.

    Raises:
        UnavailableError: when LanceDB is not installed.
        LibraryError: when the table cannot be made.
    """

    def __init__(self, matrix: FeatureMatrix, *, probes: int | None = None) -> None:
        os.environ.setdefault("LANCEDB_LOG", "error")  # its warnings are about its own inner workings
        try:
            import lancedb
            import lancedb.index
        except ImportError as error:
            raise UnavailableError("the index needs LanceDB: pip install 'diorama[vector]'") from error
        self._matrix = matrix
        self._lists = max(int(np.sqrt(len(matrix) * matrix.rows)), 1)
        self._probes = probes or max(self._lists // 20, 16)
        try:
            self._table = self._up_to_date(lancedb)
        except (OSError, RuntimeError, ValueError) as error:
            raise LibraryError(f"the index in {matrix.folder} cannot be used ({error}); delete that folder") from error

    def top(self, query: Float[np.ndarray, "width"], k: int) -> tuple[NearShape, ...]:
        """See `VectorIndex.top`."""
        wanted = max(4 * k, 64) * self._matrix.rows
        asked = self._table.search(np.asarray(query, np.float32)).distance_type("dot").nprobes(self._probes)
        rows = asked.limit(wanted).select(["position", "_distance"]).to_arrow()["position"].to_numpy()
        return self._matrix.best_of(np.unique(rows // self._matrix.rows), query, k)

    def _up_to_date(self, lancedb: Any) -> Any:
        """The table with all rows of the matrix, indexed."""
        database = lancedb.connect(str(self._matrix.folder / INDEX_FOLDER))
        count = len(self._matrix) * self._matrix.rows
        if "features" in database.list_tables().tables:
            table = database.open_table("features")
            if table.count_rows() == count:
                return table
        table = database.create_table("features", data=self._batches(), schema=self._schema(), mode="overwrite")
        config = lancedb.index.IvfPq(
            distance_type="dot",
            num_partitions=self._lists,
            num_sub_vectors=_sub_vectors(self._matrix.width),
            max_iterations=_ITERATIONS,
        )
        table.create_index("vector", config=config)
        return table

    def _schema(self) -> Any:
        """In single precision: where a processor has no arithmetic of half precision, it takes a third of the time."""
        import pyarrow as pa

        vector = pa.list_(pa.float32(), self._matrix.width)
        return pa.schema([pa.field("position", pa.int64()), pa.field("vector", vector)])

    def _batches(self) -> Any:
        import pyarrow as pa

        rows = self._matrix.values.reshape(-1, self._matrix.width)
        for start in range(0, len(rows), _BATCH):
            part = np.ascontiguousarray(rows[start : start + _BATCH], np.float32)
            vectors = pa.FixedSizeListArray.from_arrays(pa.array(part.ravel(), pa.float32()), self._matrix.width)
            positions = pa.array(np.arange(start, start + len(part)))
            yield pa.RecordBatch.from_arrays([positions, vectors], schema=self._schema())


def _sub_vectors(width: int) -> int:
    """Pieces of a row that are quantised on their own: four numbers each where that divides the width."""
    return next(width // size for size in (4, 2, 1) if width % size == 0)
