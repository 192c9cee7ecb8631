"""The models that a person brought along, in order: their names, their folders, the deleted ones.

A deleted model is listed nowhere, but stays in its library: scenes that hold it open as before, and it can be restored.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from diorama_core.errors import LibraryError
from diorama_core.io.atomic import write_json
from diorama_core.io.bounded import read_bytes, shortened
from diorama_core.io.text import clean_text

MAX_NAME = 80
"""Characters of a name or a folder that a person gives."""
MAX_BYTES = 16_000_000
"""Bytes of the document: some hundred thousand models."""


@dataclass(frozen=True)
class OwnModels:
    """What a person says of the models of a library."""

    names: dict[str, str] = field(default_factory=dict)
    """By shape id; a model without one has its caption."""
    folders: dict[str, str] = field(default_factory=dict)
    """By shape id; a model without one is in none."""
    deleted: tuple[str, ...] = ()
    """Ids, the last deleted last."""
    in_builds: bool = False
    """Whether builds and rooms made from words may use these models."""

    def named(self, shape_id: str, name: str) -> OwnModels:
        """With a model's name; an empty one leaves it to the caption."""
        return replace(self, names=_with(self.names, shape_id, name))

    def filed(self, shape_id: str, folder: str) -> OwnModels:
        """With a model in a folder, which is there as long as something is in it; an empty name is no folder."""
        return replace(self, folders=_with(self.folders, shape_id, folder))

    def without(self, shape_id: str) -> OwnModels:
        """With a model deleted."""
        return replace(self, deleted=(*(i for i in self.deleted if i != shape_id), shape_id))

    def restored(self, shape_id: str) -> OwnModels:
        """With a model deleted no more."""
        return replace(self, deleted=tuple(i for i in self.deleted if i != shape_id))

    def superseded(self, shape_id: str, by: str) -> OwnModels:
        """With a corrected model in the place of the one that it was made from."""
        known = self.without(shape_id).restored(by)
        return known.named(by, self.names.get(shape_id, "")).filed(by, self.folders.get(shape_id, ""))


class _File(BaseModel):
    model_config = ConfigDict(extra="ignore", strict=False)
    names: dict[str, str] = {}
    folders: dict[str, str] = {}
    deleted: tuple[str, ...] = ()
    in_builds: bool = False


def read_own_models(path: Path) -> OwnModels:
    """The document; of a file that is not there everything is as at first.

    Raises:
        LibraryError: it cannot be read; says which file.
    """
    try:
        about = path.stat()
    except OSError:
        return OwnModels()
    return _read(path, about.st_mtime_ns, about.st_size, about.st_ino)


@lru_cache(maxsize=8)
def _read(path: Path, written_ns: int, size: int, inode: int) -> OwnModels:
    """The document as it was written then; asked for at every redraw of a page."""
    try:
        return OwnModels(**dict(_File.model_validate_json(read_bytes(path, MAX_BYTES, LibraryError))))
    except ValidationError as error:
        raise LibraryError(f"{path} cannot be read ({shortened(str(error))}); delete it to start again") from error


def write_own_models(path: Path, models: OwnModels) -> None:
    """Keep the document; raises `LibraryError` when it cannot be written."""
    write_json(path, asdict(models), LibraryError, most=MAX_BYTES)


def _with(known: dict[str, str], shape_id: str, words: str) -> dict[str, str]:
    """The words of one model replaced, or taken away where there are none."""
    text = " ".join(clean_text(words).split())[:MAX_NAME].strip()
    rest = {key: value for key, value in known.items() if key != shape_id}
    return {**rest, shape_id: text} if text else rest
