"""Training material in a folder, one file for each room or shape, made once and gone on with after an interruption."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeVar

from diorama_core.io.atomic import write_atomically
from diorama_core.progress import SILENT, Progress

T = TypeVar("T")


def make_files(
    folder: Path,
    items: Sequence[T],
    name_of: Callable[[T], str],
    made: Callable[[T], bytes],
    progress: Progress = SILENT,
) -> int:
    """Make the files of some items that are not in the folder yet.

    Args:
        folder: Is made where it is not there.
        items: Rooms' seeds, or shapes.
        name_of: The name of an item's file.
        made: Its content.
        progress: Reported before each item; honours cancelling, and the next call goes on.

    Returns:
        The number of files made now.
    """
    count = 0
    folder.mkdir(parents=True, exist_ok=True)
    for k, item in enumerate(items):
        target = folder / name_of(item)
        progress.report(k / len(items), target.stem)
        if not target.exists():
            write_atomically(target, made(item))
            count += 1
    return count
