"""`python -m diorama_app [PROJECT] [options of diorama serve]`: prepares the shapes once, then opens the editor.

What `scripts/serve` does, on every system.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import zlib
from collections.abc import Sequence
from pathlib import Path

from diorama_app.cli import main

LOWEST = 19
"""Priority of what is prepared in the background: it takes what others leave of the processor."""


def open_editor(arguments: Sequence[str]) -> int:
    """Prepare what is derived from the shapes, with a bar the first time, and serve; the exit status."""
    from diorama_core.library.catalogue import default_cache_dir

    if {"-h", "--help"} & set(arguments):
        return main(["serve", "--help"])
    code = _code_sum()
    prepared, compared = (default_cache_dir() / f".{what}-{code:08x}" for what in ("shapes", "views"))
    if not prepared.exists():
        print("Preparing the shape library (about a minute the first time)…", file=sys.stderr)
        status = main(["library", "build"])
        if status:
            return status
        _note(prepared)
    if not compared.exists():
        _prepare_views(compared)
    return main(["serve", *arguments])


def _code_sum() -> int:
    """A checksum of the library's code: after any change what is missing is made, which is little."""
    import diorama_core

    total = 0
    for path in sorted(Path(diorama_core.__file__).parent.rglob("*.py")):
        total = zlib.crc32(path.read_bytes(), total)
    return total


def _note(stamp: Path) -> None:
    """Remember that something is prepared, of this code alone."""
    with contextlib.suppress(OSError):  # it is looked at again the next time then
        for earlier in stamp.parent.glob(f"{stamp.name.partition('-')[0]}-*"):
            earlier.unlink()
        stamp.parent.mkdir(parents=True, exist_ok=True)
        stamp.touch()


def _prepare_views(stamp: Path) -> None:
    """Begin, in the background, with what retrieval compares of shapes: the first photo of a kind would wait for it."""
    code = "import sys; from diorama_app.__main__ import views; sys.exit(views(sys.argv[1]))"
    quiet = subprocess.DEVNULL
    below = getattr(subprocess, "IDLE_PRIORITY_CLASS", 0)
    process = subprocess.Popen(
        [sys.executable, "-c", code, str(stamp)], stdin=quiet, stdout=quiet, stderr=quiet, creationflags=below
    )
    if hasattr(os, "setpriority"):
        with contextlib.suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, process.pid, LOWEST)


def views(stamp: str) -> int:
    """Prepare them in this process; the exit status."""
    status = main(["library", "build", "--views", "--workers", "1"])
    if status == 0:
        _note(Path(stamp))
    return status


if __name__ == "__main__":
    sys.exit(open_editor(sys.argv[1:]))
