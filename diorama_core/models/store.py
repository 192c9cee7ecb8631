"""Where networks lie on disk, and which of them may be used: complete, checked, recorded.

A network's folder is `<store>/<id>/`, with its files at their paths in the repository, so that a graph's external data
lies beside it. `installed.json` in it lists size and sha256 of every file that was checked; a file without such an
entry, or of another size, counts as absent. Downloads happen in `<store>/.part/` and are moved when they are whole.

Where nobody published a checksum, the first download's is kept in `<store>/first-seen.json`, which outlives the
network's folder, and every later download of that revision is held to it.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar, cast

import platformdirs
from pydantic import BaseModel, ConfigDict, TypeAdapter, ValidationError

from diorama_core.errors import InputError, UnavailableError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import read_bytes
from diorama_core.models.manifest import NETWORKS
from diorama_core.models.network import ModelFile, Network
from diorama_core.models.runtime import NetworkError

RECORD = "installed.json"
LICENCES = "licences.json"
FIRST_SEEN = "first-seen.json"
MAX_RECORD_BYTES = 4_000_000
_Kept = TypeVar("_Kept")
_SAME_WEIGHTS = 0.1
"""Relative difference of size up to which files are compared by their content."""


class FileRecord(BaseModel):
    """A file that was checked."""

    model_config = ConfigDict(frozen=True)

    bytes: int
    sha256: str


class Installed(BaseModel):
    """The record of one network."""

    model_config = ConfigDict(frozen=True)

    revision: str = ""
    files: dict[str, FileRecord] = {}


@dataclass(frozen=True)
class Check:
    """What a thorough look at one network found."""

    network: Network
    state: str
    """"ok", "absent", or what is wrong."""


def default_folder() -> Path:
    """DIORAMA_MODELS; else below HF_HOME where that is set; else in Diorama's own cache."""
    if folder := os.environ.get("DIORAMA_MODELS"):
        return Path(folder).expanduser()
    if hub := os.environ.get("HF_HOME"):
        return Path(hub).expanduser() / "diorama"
    if cache := os.environ.get("DIORAMA_CACHE"):
        return Path(cache).expanduser() / "models"
    return Path(platformdirs.user_cache_dir("diorama")) / "models"


@dataclass(frozen=True)
class ModelStore:
    """The networks on this machine."""

    folder: Path
    without: frozenset[str] = frozenset()
    """Ids of networks that are not used although they are here, because they failed."""

    @classmethod
    def default(cls) -> ModelStore:
        """The store that commands and editor use."""
        return cls(default_folder())

    def folder_of(self, network: Network) -> Path:
        """Where the network's files lie."""
        return self.folder / network.id

    def record(self, network: Network) -> Installed:
        """What was checked and recorded; nothing where the record is absent or damaged."""
        path = self.folder_of(network) / RECORD
        try:
            about = path.stat()
        except OSError:
            return Installed()
        return _record(path, about.st_mtime_ns, about.st_size)

    def has(self, network: Network) -> bool:
        """Whether every file is there, whole and checked, and may be used."""
        return network.id not in self.without and not self.missing(network)

    def missing(self, network: Network) -> tuple[ModelFile, ...]:
        """Files that still have to be fetched."""
        record, folder = self.record(network), self.folder_of(network)

        def is_whole(file: ModelFile) -> bool:
            known, path = record.files.get(file.path), folder / file.path
            return known is not None and path.is_file() and path.stat().st_size == known.bytes

        return tuple(f for f in network.files if not is_whole(f))

    def path(self, network: Network, file: str) -> Path:
        """The path of one file, ready to load.

        Raises:
            UnavailableError: when the network is not (wholly) on this machine.
            NetworkError: when another file was put in its place since it was checked.
        """
        if not self.has(network):
            raise UnavailableError(f"{network.title} is not on this machine; {how_to_get(network)}")
        path = self.folder_of(network) / file
        self._check_unchanged(network, file, path)
        return path

    def _check_unchanged(self, network: Network, file: str, path: Path) -> None:
        """Compare the content of a file that was written after its record, once."""
        record, about = self.folder_of(network) / RECORD, path.stat()
        if about.st_mtime_ns <= record.stat().st_mtime_ns:
            return
        if _digest(path, about.st_mtime_ns, about.st_size) != self.record(network).files[file].sha256:
            raise NetworkError(path, "this file was changed since it was fetched; run: diorama models verify")

    def network_of(self, graph: Path) -> Network | None:
        """The network that a file in this store belongs to."""
        try:
            network_id = graph.resolve().relative_to(self.folder.resolve()).parts[0]
        except (ValueError, IndexError):
            return None
        return next((n for n in NETWORKS if n.id == network_id), None)

    def identity(self, network: Network) -> str:
        """Changes with the weights: for cache keys."""
        record = self.record(network)
        digests = "".join(record.files[f.path].sha256 for f in network.files if f.path in record.files)
        return f"{network.id}:{hashlib.sha256(digests.encode()).hexdigest()[:12]}"

    def adopt(self, network: Network, file: ModelFile, arrived: Path, revision: str, digest: str | None = None) -> None:
        """Check a file that arrived whole, move it into place and record it.

        Args:
            network: whose file it is.
            file: as the manifest has it.
            arrived: where it lies now.
            revision: of the repository.
            digest: SHA-256, where it is known.

        Raises:
            UnavailableError: when its content is not what the manifest (or an earlier pull) names; it is deleted then.
        """
        record = self.record(network)
        digest_of_file = digest or sha256_of(arrived)
        key = f"{network.id}@{revision}/{file.path}"
        first = _read(self.folder / FIRST_SEEN, dict[str, str])
        published = (file.sha256, *file.also_sha256) if file.sha256 else ()
        expected = published or ((first[key],) if key in first and not network.conversion else ())
        if expected and digest_of_file not in expected:
            arrived.unlink(missing_ok=True)
            source = "expected" if published else "the first download had"
            raise UnavailableError(
                f"{network.title}: {file.path} arrived with the wrong content (sha256 {digest_of_file[:12]}…, "
                f"{source} {expected[0][:12]}…); it was deleted: pull again, or from another mirror (HF_ENDPOINT)"
            )
        if not published:
            write_json(self.folder / FIRST_SEEN, {**first, key: digest_of_file})
        target = self.folder_of(network) / file.path
        target.parent.mkdir(parents=True, exist_ok=True)
        size = arrived.stat().st_size
        os.replace(arrived, target)
        files = {**record.files, file.path: FileRecord(bytes=size, sha256=digest_of_file)}
        write_json(self.folder_of(network) / RECORD, Installed(revision=revision, files=files).model_dump())

    def add_folder(self, source: Path) -> tuple[str, ...]:
        """Take up files that were fetched elsewhere: any file below `source` whose content the manifest knows, and
        folders named after networks that users convert themselves.

        Returns:
            The networks that are complete now and were not before.

        Raises:
            InputError: when nothing there belongs to a network.
        """
        if not source.is_dir():
            raise InputError(f"{source}: this is no folder; give the folder that holds the networks' files")
        before = {n.id for n in NETWORKS if self.has(n)}
        taken = sum(self._take_up(source, network, file) for network in NETWORKS for file in self.missing(network))
        if not taken:
            raise InputError(f"{source}: {_why_nothing(source, [n for n in NETWORKS if n.id not in before])}")
        return tuple(n.id for n in NETWORKS if n.id not in before and self.has(n))

    def _take_up(self, source: Path, network: Network, file: ModelFile) -> bool:
        for candidate in _candidates(source, network, file):
            about = candidate.stat()
            digest = _digest(candidate, about.st_mtime_ns, about.st_size)
            if file.sha256 and digest not in (file.sha256, *file.also_sha256):
                continue
            part = self.folder / ".part" / network.id / file.path
            part.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(candidate, part)
            self.adopt(network, file, part, network.revision or "local", digest)
            return True
        return False

    def check(self, network: Network) -> Check:
        """Read every byte of an installed network and compare with the record and the manifest."""
        record = self.record(network)
        if not record.files:
            return Check(network, "absent")
        absent = [f.path for f in self.missing(network)]
        if absent:
            return Check(network, f"incomplete: {', '.join(absent)} is missing or cut off; pull again")
        for file in network.files:
            digest = sha256_of(self.folder_of(network) / file.path)
            if digest != record.files[file.path].sha256:
                return Check(network, f"{file.path} was changed since it was fetched; pull again")
        return Check(network, "ok")

    def forget(self, network: Network) -> None:
        """Delete a network's files."""
        shutil.rmtree(self.folder_of(network), ignore_errors=True)

    def read_accepted_licences(self) -> frozenset[str]:
        """Read the ids of the networks whose licence was accepted on this machine."""
        return frozenset(_read(self.folder / LICENCES, list[str]))

    def accept_licences(self, network_ids: frozenset[str]) -> None:
        """Remember that the licences of these networks were accepted."""
        write_json(self.folder / LICENCES, sorted(self.read_accepted_licences() | network_ids))


def _candidates(source: Path, network: Network, file: ModelFile) -> list[Path]:
    """Where a file may lie below a folder: in the repository's layout; where its content is known, anywhere."""
    name = Path(file.path).name
    places = [source / network.id / file.path, source / network.id / name]
    if source.resolve().name in (network.id, network.repo.split("/")[-1]):  # the network's own folder
        places += [source / file.path, source / name]
    if network.repo:
        places += [source / network.repo / file.path, source / network.repo.split("/")[-1] / file.path]
    if file.sha256:
        places += sorted(source.rglob(name))
        places += [p for p in _files(source) if _is_about(p.stat().st_size, file.bytes)]
    return [p for p in dict.fromkeys(places) if p.is_file()]


def _files(folder: Path) -> list[Path]:
    return sorted(p for p in folder.rglob("*") if p.is_file())


def _is_about(size: int, expected: int | None) -> bool:
    """Whether a file may be another publication of the same weights, whatever it is called."""
    return expected is not None and abs(size - expected) <= _SAME_WEIGHTS * expected


def _why_nothing(source: Path, missing: Sequence[Network]) -> str:
    """What is wrong with a folder that gave nothing."""
    names = {p.name for p in _files(source)}
    named = [(n, f) for n in missing for f in n.files if Path(f.path).name in names]
    unsure = [(n, Path(f.path).name) for n, f in named if not f.sha256]
    if unsure:
        listed = ", ".join(dict.fromkeys(n.id for n, _ in unsure))
        return (
            f"{unsure[0][1]} has no published checksum that would tell whose it is; put it in a folder named after its "
            f"network ({listed}) and give the folder above"
        )
    if named:
        network, file = named[0]
        return f"{Path(file.path).name} is not {network.title}'s published file (another version, or damaged)"
    return "no file there belongs to a network that is missing; see `diorama models list`"


def how_to_get(network: Network) -> str:
    """What a user does to get a network."""
    if network.pullable:
        tier = network.tiers[0] if network.tiers else network.id
        return f"run: diorama models pull {tier}"
    if network.conversion:
        return f"convert your own checkpoint with {network.conversion}, then: diorama models pull --from FOLDER"
    return "put your own copy in a folder named after it, then: diorama models pull --from FOLDER"


@lru_cache(maxsize=256)
def _record(path: Path, written_ns: int, size: int) -> Installed:
    """A record as it was written then; asked for at every redraw of a page."""
    return _read(path, Installed)


def _read(path: Path, kind: Callable[[], _Kept]) -> _Kept:
    """What a file of the store holds; nothing where it is absent or damaged."""
    try:
        kept: _Kept = TypeAdapter(cast("Any", kind)).validate_json(read_bytes(path, MAX_RECORD_BYTES, UnavailableError))
    except (UnavailableError, ValidationError):
        return kind()
    return kept


@lru_cache(maxsize=256)
def _digest(path: Path, written_ns: int, size: int) -> str:
    """The digest of a file as it was written then."""
    return sha256_of(path)


def derive_graph(name: str, make: Callable[[], bytes]) -> Path:
    """The ONNX graph of this name in the cache folder; made where it is not there.

    Args:
        name: changes with whatever the graph is made from, and how.
        make: the graph's bytes.

    Raises:
        UnavailableError: when the cache folder cannot be written.
    """
    cache_dir = os.environ.get("DIORAMA_CACHE") or platformdirs.user_cache_dir("diorama")
    path = Path(cache_dir) / "networks" / f"{name}.onnx"
    if not path.is_file():
        try:
            write_atomically(path, make())
        except OSError as error:
            raise UnavailableError(f"{path}: cannot be written ({error.strerror}); set DIORAMA_CACHE") from error
    return path


def sha256_of(path: Path) -> str:
    """Hexadecimal digest of a file's bytes."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def write_json(path: Path, value: object) -> None:
    """Write a value as JSON, atomically."""
    write_atomically(path, json.dumps(value, indent=1, sort_keys=True).encode())
