"""Decodes uploads in a separate process, so that the editor stays responsive."""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

from diorama_app.projects.dropped import Dropped, interpret
from diorama_app.projects.uploads import Upload, decode
from diorama_app.session.connected_client import ConnectedClient
from diorama_core.errors import EditRefused, SphericalPhotoError
from diorama_core.io.limited import LimitedProcess
from diorama_core.perception.inputs import ReadInputs
from diorama_core.perception.inputs.depth.scale import AmbiguousDepthError

MAX_WAITING = 2
"""Uploads of one person that are read or wait for it."""


class Reader:
    """Reads uploads one after another, each told to whoever uploaded. May be used from any thread."""

    def __init__(self) -> None:
        self._process = LimitedProcess()
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="reading")
        self._lock = threading.Lock()
        self._waiting = Counter[int]()

    def read(
        self,
        upload: Upload,
        client: ConnectedClient,
        then: Callable[[ReadInputs], None],
        ask: Callable[[AmbiguousDepthError | SphericalPhotoError], None] | None = None,
    ) -> None:
        """Decode an upload, then do something with it.

        Args:
            upload: what came.
            client: whose it is.
            then: given the checked inputs.
            ask: given what a depth map may be, or that the photo shows all directions; None where that is an error.

        Raises:
            EditRefused: two uploads of this person are being read already.
        """

        def work() -> None:
            try:
                read = decode(upload, self._process)
            except (AmbiguousDepthError, SphericalPhotoError) as error:
                if ask is None:
                    raise
                client.post(partial(ask, error))
            else:
                client.post(lambda: then(read))

        self._submit(work, client)

    def recognise(
        self,
        content: bytes,
        name: str,
        photo_size: tuple[int, int] | None,
        client: ConnectedClient,
        then: Callable[[Dropped], None],
    ) -> None:
        """Say what a file, or a zip archive of several, may be, in the decoding process.

        Args:
            content: of the file.
            name: of the file.
            photo_size: of the photo that is open.
            client: whose it is.
            then: given what it may be.
        """

        def work() -> None:
            readings = self._process.call(name, interpret, content, name, photo_size)
            client.post(lambda: then(readings))

        self._submit(work, client)

    def wait(self, timeout_s: float = 60.0) -> bool:
        """Block until what was asked for is read; False when that took too long."""
        done = threading.Event()
        self._pool.submit(done.set)
        return done.wait(timeout_s)

    def close(self) -> None:
        """End the process; what waits is dropped."""
        self._pool.shutdown(wait=False, cancel_futures=True)
        self._process.stop()

    def _submit(self, work: Callable[[], None], client: ConnectedClient) -> None:
        with self._lock:
            if self._waiting[client.id] >= MAX_WAITING:
                raise EditRefused("your last files are still being read; wait a moment and try again")
            self._waiting[client.id] += 1

        def run() -> None:
            try:
                work()
            except Exception as error:  # raised again on the UI thread, for whoever uploaded
                client.post(raising(error))
            finally:
                with self._lock:
                    self._waiting[client.id] -= 1

        self._pool.submit(run)


def raising(error: Exception) -> Callable[[], Any]:
    """What raises an error where it is told to somebody."""

    def fail() -> None:
        raise error

    return fail
