"""Decodes uploads in a separate process, so that the editor stays responsive."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

from diorama_app.projects.dropped import Dropped, interpret
from diorama_app.projects.uploads import Upload, decode
from diorama_core.errors import EditRefused, SphericalPhotoError
from diorama_core.io.limited import LimitedProcess
from diorama_core.perception.inputs import ReadInputs
from diorama_core.perception.inputs.depth.scale import AmbiguousDepthError

MAX_WAITING = 2
"""Uploads of one person that are read or wait for it."""

Post = Callable[[Callable[[], None]], None]


class Reader:
    """Reads uploads one after another. May be used from any thread."""

    def __init__(self) -> None:
        self._process = LimitedProcess()
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="reading")
        self._lock = threading.Lock()
        self._waiting: dict[int, int] = {}

    def read(
        self,
        upload: Upload,
        client_id: int,
        post: Post,
        then: Callable[[ReadInputs], None],
        ask: Callable[[AmbiguousDepthError | SphericalPhotoError], None] | None = None,
    ) -> None:
        """Decode an upload, then do something with it.

        Args:
            upload: what came.
            client_id: whose it is.
            post: runs a task where errors are told to that person.
            then: given the checked inputs, there.
            ask: given what a depth map may be, or that the photo shows all directions, there; None where that is an
                error.

        Raises:
            EditRefused: two uploads of this person are being read already.
        """
        self._begin(client_id)
        self._pool.submit(self._read, upload, client_id, post, then, ask)

    def recognise(
        self,
        content: bytes,
        name: str,
        photo_size: tuple[int, int] | None,
        client_id: int,
        post: Post,
        then: Callable[[Dropped], None],
    ) -> None:
        """Say what a file, or a zip archive of several, may be, in the decoding process.

        Args:
            content: of the file.
            name: of the file.
            photo_size: of the photo that is open.
            client_id: whose it is.
            post: as for `read`.
            then: given what it may be, there.
        """
        self._begin(client_id)
        self._pool.submit(self._recognise, (content, name, photo_size), client_id, post, then)

    def _begin(self, client_id: int) -> None:
        with self._lock:
            if self._waiting.get(client_id, 0) >= MAX_WAITING:
                raise EditRefused("your last files are still being read; wait a moment and try again")
            self._waiting[client_id] = self._waiting.get(client_id, 0) + 1

    def wait(self, timeout_s: float = 60.0) -> bool:
        """Block until what was asked for is read; False when that took too long."""
        done = threading.Event()
        self._pool.submit(done.set)
        return done.wait(timeout_s)

    def close(self) -> None:
        """End the process; what waits is dropped."""
        self._pool.shutdown(wait=False, cancel_futures=True)
        self._process.stop()

    def _read(
        self,
        upload: Upload,
        client_id: int,
        post: Post,
        then: Callable[[ReadInputs], None],
        ask: Callable[[AmbiguousDepthError | SphericalPhotoError], None] | None,
    ) -> None:
        try:
            read = decode(upload, self._process)
            post(lambda: then(read))
        except (AmbiguousDepthError, SphericalPhotoError) as error:
            post(_raising(error) if ask is None else partial(ask, error))
        except Exception as error:  # raised again on the UI thread, for whoever uploaded
            post(_raising(error))
        finally:
            self._end(client_id)

    def _recognise(
        self,
        file: tuple[bytes, str, tuple[int, int] | None],
        client_id: int,
        post: Post,
        then: Callable[[Dropped], None],
    ) -> None:
        try:
            readings = self._process.call(file[1], interpret, *file)
            post(lambda: then(readings))
        except Exception as error:  # as above
            post(_raising(error))
        finally:
            self._end(client_id)

    def _end(self, client_id: int) -> None:
        with self._lock:
            self._waiting[client_id] -= 1
            if not self._waiting[client_id]:
                del self._waiting[client_id]


def _raising(error: Exception) -> Callable[[], Any]:
    def fail() -> None:
        raise error

    return fail
