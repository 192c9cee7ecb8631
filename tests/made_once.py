"""What several test files need and takes seconds to make: one process makes it, the others and later runs of the same
code read it.
"""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from filelock import FileLock

FOLDER = "DIORAMA_TESTS_MADE"
"""Names the folder that processes share; without it everybody makes his own."""

T = TypeVar("T")


def made_once(name: str, make: Callable[[], T]) -> T:
    """The value of this name, which everybody who asks for it makes in the same way."""
    folder = os.environ.get(FOLDER)
    if not folder:
        return make()
    path = Path(folder) / f"{name}.pickle"
    path.parent.mkdir(parents=True, exist_ok=True)
    with FileLock(path.with_suffix(".lock")):
        if not path.exists():
            path.write_bytes(pickle.dumps(make(), protocol=pickle.HIGHEST_PROTOCOL))
    return pickle.loads(path.read_bytes())
