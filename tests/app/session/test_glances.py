from __future__ import annotations

from pathlib import Path

import pytest

from diorama_app.session.glances import FRESH_S, Glances


def test_the_disk_is_looked_at_once_a_second_and_after_own_changes() -> None:
    now = [0.0]
    glances, looked = Glances(lambda: now[0]), []

    def look() -> int:
        looked.append(1)
        return len(looked)

    assert [glances.of("name", look), glances.of("name", look)] == [1, 1]
    assert glances.of("versions", lambda: "others") == "others"
    now[0] = 1.5 * FRESH_S
    assert glances.of("name", look) == 2
    glances.forget()
    assert glances.of("name", look) == 3


def test_what_cannot_be_read_is_tried_again() -> None:
    glances = Glances()
    with pytest.raises(OSError):
        glances.of("name", Path("/nowhere/at/all").stat)
    assert glances.of("name", lambda: "there") == "there"
