"""The table of shapes: one SQLite file, read quickly as a whole and in detail one by one."""

from __future__ import annotations

import gc
import json
import sqlite3
import threading
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from diorama_core.errors import LibraryError
from diorama_core.io.bounded import parse_json
from diorama_core.library.record import Shape, shape_from_json, shape_to_json

VERSION = 1
_BUSY_S = 20.0

_SCHEMA = f"""
CREATE TABLE shapes (
    id TEXT PRIMARY KEY, category TEXT NOT NULL, caption TEXT NOT NULL,
    size_x REAL NOT NULL, size_y REAL NOT NULL, size_z REAL NOT NULL,
    style TEXT NOT NULL, source TEXT NOT NULL, licence TEXT NOT NULL, symmetry INTEGER NOT NULL, mass_kg REAL NOT NULL,
    content_hash TEXT NOT NULL, synonyms TEXT NOT NULL, contact_faces TEXT NOT NULL, triangles INTEGER NOT NULL
) WITHOUT ROWID;
CREATE INDEX shapes_by_category ON shapes (category, id);
CREATE TABLE details (
    id TEXT PRIMARY KEY REFERENCES shapes (id) ON DELETE CASCADE,
    record TEXT NOT NULL, model TEXT NOT NULL, source_key TEXT NOT NULL, warnings TEXT NOT NULL, thumbnail BLOB
);
CREATE INDEX details_by_source ON details (source_key);
CREATE INDEX details_by_model ON details (model);
PRAGMA user_version = {VERSION};
"""

_COLUMNS = (
    "id, category, caption, size_x, size_y, size_z, style, source, licence, symmetry, mass_kg, content_hash, "
    "synonyms, contact_faces, triangles"
)


@dataclass(frozen=True)
class StoredRow:
    """One shape as it is written."""

    record: Shape
    model: str
    """Name of the file that holds its GLB."""
    source_key: str
    warnings: tuple[str, ...] = ()
    thumbnail: bytes | None = None


class Records:
    """One library's table. Safe to share between threads; other processes may read and write it meanwhile.

    A plain rollback journal is used: it works on network folders too, where a cluster's machines read along.

    Args:
        path: Of the SQLite file.
        create: Make it when it is absent.

    Raises:
        LibraryError: when there is none, it is damaged, or a newer program wrote it.
    """

    def __init__(self, path: Path, *, create: bool = False) -> None:
        self._path = path
        self._lock = threading.Lock()
        fresh = not path.exists()
        if fresh and not create:
            raise LibraryError(f"{path.parent} holds no shape library; make one with 'diorama library add DIR'")
        with self._errors():
            path.parent.mkdir(parents=True, exist_ok=True)
            self._db = sqlite3.connect(path, timeout=_BUSY_S, check_same_thread=False, isolation_level=None)
            self._db.execute("PRAGMA foreign_keys = ON")
            version = self._db.execute("PRAGMA user_version").fetchone()[0]
            if version == 0:
                self._create()
        if version > VERSION:
            raise LibraryError(f"{path} was written by a newer Diorama; update the program to open it")

    def close(self) -> None:
        """Let the file go."""
        with self._lock:
            self._db.close()

    def state(self) -> int:
        """Changes whenever this or another process has changed the table."""
        with self._reading() as db:
            return int(db.execute("PRAGMA data_version").fetchone()[0]) + db.total_changes

    def summaries(self, category: str | None = None) -> tuple[Shape, ...]:
        """All records, or those of a category, by id; without surfaces and guesses, which take long to read."""
        where, arguments = ("", ()) if category is None else ("WHERE category = ?", (category,))
        with self._reading() as db, _no_collection():
            rows = db.execute(f"SELECT {_COLUMNS} FROM shapes {where} ORDER BY id", arguments).fetchall()
            return tuple(_summaries(rows))

    def count(self) -> int:
        """How many shapes there are."""
        with self._reading() as db:
            return int(db.execute("SELECT count(*) FROM shapes").fetchone()[0])

    def detail(self, shape_id: str) -> StoredRow | None:
        """Everything kept of one shape, or None when it is unknown."""
        with self._reading() as db:
            row = db.execute(
                "SELECT record, model, source_key, warnings, thumbnail FROM details WHERE id = ?", (shape_id,)
            ).fetchone()
        if row is None:
            return None
        record, model, source_key, text, thumbnail = row
        warnings = parse_json(
            text, "the warnings of a shape", LibraryError, advice="add the shape to its library again"
        )
        lines = tuple(map(str, warnings)) if isinstance(warnings, list) else ()
        return StoredRow(shape_from_json(record), model, source_key, lines, thumbnail)

    def source_keys(self) -> frozenset[str]:
        """The source key of everything kept."""
        with self._reading() as db:
            return frozenset(key for (key,) in db.execute("SELECT source_key FROM details"))

    def put(self, rows: Iterable[StoredRow]) -> tuple[str, ...]:
        """Write shapes, all or none, replacing those with the same id; returns model files that nothing uses now."""
        dropped: set[str] = set()
        with self._writing() as db:
            for row in rows:
                known = db.execute("SELECT model FROM details WHERE id = ?", (row.record.id,)).fetchone()
                dropped |= set(known or ())
                db.execute(f"INSERT OR REPLACE INTO shapes ({_COLUMNS}) VALUES ({'?,' * 14}?)", _values(row.record))
                db.execute(
                    "INSERT OR REPLACE INTO details VALUES (?, ?, ?, ?, ?, ?)",
                    (
                        row.record.id,
                        shape_to_json(row.record),
                        row.model,
                        row.source_key,
                        json.dumps(row.warnings),
                        row.thumbnail,
                    ),
                )
            return self._find_unused_models(dropped)

    def remove(self, shape_ids: Sequence[str]) -> tuple[str, ...]:
        """Forget shapes; returns model files that nothing uses now."""
        dropped: set[str] = set()
        with self._writing() as db:
            for shape_id in shape_ids:
                known = db.execute("SELECT model FROM details WHERE id = ?", (shape_id,)).fetchone()
                dropped |= set(known or ())
                db.execute("DELETE FROM shapes WHERE id = ?", (shape_id,))
            return self._find_unused_models(dropped)

    def _find_unused_models(self, models: set[str]) -> tuple[str, ...]:
        used = "SELECT 1 FROM details WHERE model = ? LIMIT 1"
        return tuple(m for m in sorted(models) if self._db.execute(used, (m,)).fetchone() is None)

    def _create(self) -> None:
        """Make the tables, unless another process just did."""
        self._db.execute("BEGIN EXCLUSIVE")
        if self._db.execute("PRAGMA user_version").fetchone()[0] == 0:
            for statement in _SCHEMA.split(";"):
                self._db.execute(statement)
        self._db.execute("COMMIT")

    @contextmanager
    def _reading(self) -> Iterator[sqlite3.Connection]:
        with self._lock, self._errors():
            yield self._db

    @contextmanager
    def _writing(self) -> Iterator[sqlite3.Connection]:
        with self._lock, self._errors():
            self._db.execute("BEGIN IMMEDIATE")
            try:
                yield self._db
            except BaseException:
                self._db.execute("ROLLBACK")
                raise
            self._db.execute("COMMIT")

    @contextmanager
    def _errors(self) -> Iterator[None]:
        try:
            yield
        except (sqlite3.Error, OSError) as error:
            raise LibraryError(f"the shape library {self._path} cannot be used ({error})") from error


@contextmanager
def _no_collection() -> Iterator[None]:
    """Without the search for garbage, which would go through all new records again and again and double the time."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def _values(shape: Shape) -> tuple[Any, ...]:
    return (
        *(shape.id, shape.category, shape.caption, *shape.size_m, shape.style, shape.source, shape.licence),
        *(shape.symmetry, shape.mass_kg, shape.content_hash, "\n".join(shape.synonyms)),
        *(" ".join(shape.contact_faces), shape.triangles),
    )


def _summaries(rows: Iterable[tuple[Any, ...]]) -> Iterator[Shape]:
    faces: dict[str, Any] = {}
    for row in rows:
        yield Shape(
            id=row[0],
            category=row[1],
            caption=row[2],
            size_m=row[3:6],
            style=row[6],
            source=row[7],
            licence=row[8],
            symmetry=row[9],
            mass_kg=row[10],
            content_hash=row[11],
            synonyms=tuple(row[12].split("\n")) if row[12] else (),
            contact_faces=faces.get(row[13]) or faces.setdefault(row[13], tuple(row[13].split())),
            triangles=row[14],
        )
