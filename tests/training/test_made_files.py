"""Files of training material: each made once, and what was interrupted goes on."""

from __future__ import annotations

from pathlib import Path

import pytest

from diorama_core.errors import Cancelled
from diorama_core.progress import CancelToken, Progress, ProgressEvent
from diorama_core.training.made_files import make_files


def test_what_is_there_is_not_made_again(tmp_path: Path) -> None:
    folder, asked = tmp_path / "new" / "rooms", list[int]()

    def made(seed: int) -> bytes:
        asked.append(seed)
        return str(seed).encode()

    assert make_files(folder, range(3, 5), "room_{:06d}.npz".format, made) == 2
    assert make_files(folder, range(2, 6), "room_{:06d}.npz".format, made) == 2
    assert asked == [3, 4, 2, 5]
    assert {p.name: p.read_text() for p in folder.iterdir()} == {f"room_{n:06d}.npz": str(n) for n in range(2, 6)}


def test_a_cancelled_run_keeps_what_it_made(tmp_path: Path) -> None:
    token = CancelToken()

    def stop_at_the_third(event: ProgressEvent) -> None:
        if event.message == "2":
            token.cancel()

    with pytest.raises(Cancelled):
        make_files(tmp_path, range(9), "{}.npz".format, lambda _: b"x", Progress(stop_at_the_third, token))
    kept = len(list(tmp_path.iterdir()))
    assert 2 <= kept <= 3
    assert make_files(tmp_path, range(9), "{}.npz".format, lambda _: b"x") == 9 - kept
