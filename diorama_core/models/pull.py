"""Fetching networks: pinned, resumable, checked, with the licence shown first.

`huggingface_hub` does the transfer, so HF_ENDPOINT (mirrors), HF_TOKEN, HF_HUB_OFFLINE and the proxy variables mean
what they mean everywhere.
"""

from __future__ import annotations

import errno
import logging
import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from diorama_core.errors import Cancelled, InputError, UnavailableError
from diorama_core.models.network import ModelFile, Network
from diorama_core.models.store import ModelStore, how_to_get
from diorama_core.progress import SILENT, Progress

SPARE_BYTES = 200_000_000
"""Left free on the disk after a pull."""
_CHUNK = 1 << 18
"""Bytes between two looks at the cancel token."""

Accept = Callable[[Sequence[Network]], bool]
"""Shows the licences of networks that were never fetched before and says whether the user accepts them."""


def pull(
    store: ModelStore, networks: Sequence[Network], *, accept: Accept, progress: Progress = SILENT
) -> tuple[str, ...]:
    """Fetch what is missing of some networks.

    Args:
        store: where they go.
        networks: which; ones that are whole already cost nothing.
        accept: asked once for licences that were not accepted on this machine before.
        progress: bytes done over all files; honours cancellation. What arrived stays for the next try.

    Returns:
        Ids of the networks that were fetched.

    Raises:
        UnavailableError: no network, refused, not found, wrong content, disk full: one line with what to do.
        InputError: the licence was not accepted, or a network cannot be pulled.
        Cancelled: on request.
    """
    wanted = [(n, f) for n in networks for f in store.missing(n)]
    if not wanted:
        return ()
    for network, _ in wanted:
        if not network.pullable:
            raise InputError(f"{network.title} cannot be pulled: {how_to_get(network)}")
    _ask(store, [n for n in networks if store.missing(n)], accept)
    _check_space(store, wanted)
    total = sum(_file_bytes(n, f) for n, f in wanted)
    done = 0
    for network, file in wanted:
        size = _file_bytes(network, file)
        part = progress.part(min(done / total, 1.0), min((done + size) / total, 1.0))
        _fetch(store, network, file, part)
        done += size
    progress.report(1.0, "networks are ready")
    return tuple(dict.fromkeys(n.id for n, _ in wanted))


def _ask(store: ModelStore, networks: Sequence[Network], accept: Accept) -> None:
    known = store.read_accepted_licences()
    unknown = [n for n in networks if n.id not in known]
    if not unknown:
        return
    if not accept(unknown):
        raise InputError("the licences were not accepted; nothing was fetched (accept them with --yes)")
    try:
        store.accept_licences(frozenset(n.id for n in unknown))
    except OSError as error:
        raise _disk_error(store, error) from error


def _file_bytes(network: Network, file: ModelFile) -> int:
    if file.bytes is not None:
        return file.bytes
    return max(1, network.size_bytes // len(network.files))


def _check_space(store: ModelStore, wanted: Sequence[tuple[Network, ModelFile]]) -> None:
    needed = sum(_file_bytes(n, f) for n, f in wanted)
    place = store.folder
    while not place.exists() and place != place.parent:
        place = place.parent
    free = shutil.disk_usage(place).free
    if needed + SPARE_BYTES > free:
        raise UnavailableError(
            f"{store.folder}: {needed / 1e9:.1f} GB are needed and {free / 1e9:.1f} GB are free; "
            "make room, or set DIORAMA_MODELS to a folder on a larger disk"
        )


def _fetch(store: ModelStore, network: Network, file: ModelFile, progress: Progress) -> None:
    """One file: downloaded beside, checked, moved into place."""
    staging = store.folder / ".part" / network.id
    name = f"{network.title}: {Path(file.path).name}"
    progress.report(0.0, name)
    heard = _Heard(progress, name)
    with _one_line(store, network), _hub_told(heard):
        staging.mkdir(parents=True, exist_ok=True)
        meter = _meter(heard, _file_bytes(network, file))
        revision = "" if network.url else _revision(store, network)
        arrived = _download(network, file, revision, staging, meter)
        store.adopt(network, file, arrived, revision)
    progress.report(1.0, name)


class _Heard(logging.Filter):
    """One file's progress; what the hub's library would print about retries becomes part of it."""

    def __init__(self, progress: Progress, name: str) -> None:
        super().__init__()
        self._progress, self._name, self._fraction = progress, name, 0.0

    def bytes(self, done: int, size: int) -> None:
        """So many of so many bytes are here."""
        self._fraction = min(done / max(size, 1), 0.999)
        self._progress.report(self._fraction, f"{self._name} ({done / 1e6:.0f} MB)")

    def filter(self, record: logging.LogRecord) -> bool:
        """Nothing is printed: an error that ends the transfer is said by whoever catches it."""
        if record.levelno >= logging.WARNING and "downloading" in record.getMessage():
            self._progress.report(self._fraction, f"{self._name}: the connection was cut, going on where it stopped")
        return False


def _meter(heard: _Heard, size: int) -> type:
    """A progress-bar class for `huggingface_hub` that draws nothing and reports what was heard."""
    from huggingface_hub.utils import tqdm as hub_tqdm

    class Meter(hub_tqdm):  # type: ignore[misc, unused-ignore]  # tqdm has no types where its stubs are absent
        """Reports the bytes of one file."""

        def __init__(self, *args: Any, **kwargs: Any) -> None:
            self._bytes = int(kwargs.get("initial") or 0)
            super().__init__(*args, **{**kwargs, "disable": True})  # type: ignore[no-untyped-call]  # as above

        def update(self, n: float | None = 1) -> None:
            """So many more bytes."""
            self._bytes += int(n or 0)
            heard.bytes(self._bytes, size)

    return Meter


def _endpoint() -> str | None:
    return os.environ.get("HF_ENDPOINT", "").rstrip("/") or None


def _revision(store: ModelStore, network: Network) -> str:
    """The pinned revision; a branch or nothing is resolved once, and files of one network never mix revisions."""
    pinned = network.revision or ""
    if len(pinned) == 40:
        return pinned
    recorded = store.record(network).revision
    if recorded:
        return recorded
    from huggingface_hub import HfApi

    info = HfApi(endpoint=_endpoint()).model_info(network.repo, revision=network.revision, timeout=20.0).sha
    return info or pinned or "main"


def _address(network: Network, file: ModelFile, revision: str) -> tuple[str, dict[str, str]]:
    """Where a file is, and the headers (token, agent) that belong to a request for it."""
    if network.url:
        return f"{network.url}/{file.path}", {}
    from huggingface_hub import hf_hub_url
    from huggingface_hub.utils import build_hf_headers

    url = hf_hub_url(network.repo, file.path, revision=revision, endpoint=_endpoint())
    return url, build_hf_headers(library_name="diorama")


def _download(network: Network, file: ModelFile, revision: str, staging: Path, meter: type) -> Path:
    """The whole file beside its place; what an earlier try left there is continued."""
    from huggingface_hub import constants
    from huggingface_hub.file_download import http_get

    if constants.is_offline_mode():
        raise UnavailableError(f"{network.title} cannot be fetched: HF_HUB_OFFLINE is set; unset it and pull again")
    constants.DOWNLOAD_CHUNK_SIZE = _CHUNK  # cancellation and progress are looked at between chunks
    url, headers = _address(network, file, revision)
    part = staging / f"{file.path.replace('/', '--')}.{revision[:12] or 'plain'}.incomplete"
    with part.open("ab") as target:
        http_get(
            url,
            target,
            resume_size=target.tell(),
            headers=headers,
            expected_size=file.bytes,
            tqdm_class=meter,
        )
    return part


@contextmanager
def _hub_told(heard: _Heard) -> Iterator[None]:
    """While it lasts, what the hub's library logs about transfers is heard instead of printed."""
    loggers = [logging.getLogger(f"huggingface_hub.{part}") for part in ("file_download", "utils._http")]
    for logger in loggers:
        logger.addFilter(heard)
    try:
        yield
    finally:
        for logger in loggers:
            logger.removeFilter(heard)


@contextmanager
def _one_line(store: ModelStore, network: Network) -> Iterator[None]:
    """Whatever goes wrong in a transfer, as one line that says what to do."""
    try:
        yield
    except (UnavailableError, InputError, Cancelled):
        raise
    except Exception as error:  # of the hub, HTTP, sockets or the disk; each is explained
        raise _explain(store, network, error) from error


def _explain(store: ModelStore, network: Network, error: Exception) -> UnavailableError:
    from huggingface_hub.errors import GatedRepoError, OfflineModeIsEnabled

    chain = list(_causes(error))
    status = next((s for e in chain if (s := _status(e)) is not None), None)
    where = _endpoint() or "https://huggingface.co" if network.repo else network.url
    full = next((e for e in chain if isinstance(e, OSError) and e.errno in (errno.ENOSPC, errno.EDQUOT)), None)
    if full is not None or any(isinstance(e, PermissionError) for e in chain):
        return _disk_error(store, full or error)
    if any(isinstance(e, OfflineModeIsEnabled) for e in chain):
        return UnavailableError(f"{network.title} cannot be fetched: HF_HUB_OFFLINE is set; unset it and pull again")
    if status in (401, 403) or any(isinstance(e, GatedRepoError) for e in chain):
        return UnavailableError(
            f"{where} refused {network.title} ({status or 403}); accept its terms there and set HF_TOKEN, "
            "or use a mirror (HF_ENDPOINT)"
        )
    if status == 404:
        return UnavailableError(
            f"{where} has no {network.repo or network.id} at the pinned revision (404); "
            "use another mirror (HF_ENDPOINT)"
        )
    if status is not None:
        return UnavailableError(f"{where} answered {status} for {network.title}; try again later, the rest is kept")
    if "onsistency" in str(error):
        return UnavailableError(f"{network.title}: the transfer was incomplete; pull again, it resumes there")
    return UnavailableError(
        f"{network.title} could not be fetched from {where} ({_words(chain[-1])}); "
        "check the connection or the proxy (HTTPS_PROXY) and pull again, it resumes where it stopped"
    )


def _causes(error: BaseException | None) -> Iterator[BaseException]:
    seen = 0
    while error is not None and seen < 10:
        yield error
        error, seen = error.__cause__ or error.__context__, seen + 1


def _status(error: BaseException) -> int | None:
    code = getattr(getattr(error, "response", None), "status_code", None)
    return int(code) if isinstance(code, int) else None


def _disk_error(store: ModelStore, error: BaseException) -> UnavailableError:
    reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return UnavailableError(
        f"{store.folder}: networks cannot be written there ({reason}); make room or set DIORAMA_MODELS"
    )


def _words(error: BaseException) -> str:
    return " ".join(str(error).split())[:120] or type(error).__name__
