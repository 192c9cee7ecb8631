from __future__ import annotations

from types import SimpleNamespace

import pytest

from diorama_app.web.upload_limits import (
    MAX_BYTES_IN_FLIGHT,
    MAX_UPLOAD_BYTES,
    MAX_UPLOADS_IN_FLIGHT,
    MAX_UPLOADS_PER_CLIENT,
    RunningUpload,
    why_refused,
)


def request(**changes):
    return SimpleNamespace(
        **{"transfer_uuid": "new", "filename": "a.png", "size_bytes": 1000, "part_count": 1} | changes
    )


PAGE, OTHER_PAGE, ELSEWHERE = (0, 1), (0, 2), (1, 1)
"""The last has the number of the first, in another project."""


def running(count: int, page: tuple[int, int] = PAGE, total_bytes: int = 1000) -> list[RunningUpload]:
    return [RunningUpload(f"1-{i}", page, total_bytes) for i in range(count)]


def test_an_ordinary_file_may_come() -> None:
    assert why_refused(request(), PAGE, running(MAX_UPLOADS_PER_CLIENT - 1)) is None
    assert why_refused(request(size_bytes=MAX_UPLOAD_BYTES, part_count=300), PAGE, []) is None
    assert why_refused(request(size_bytes=0, part_count=0), PAGE, []) is None


@pytest.mark.parametrize(
    "changes",
    [
        {"size_bytes": -1},
        {"size_bytes": "many"},
        {"part_count": None},
        {"filename": 7},
        {"part_count": -1},
        {"size_bytes": 10, "part_count": 3},
    ],
)
def test_requests_that_make_no_sense_are_refused(changes) -> None:
    assert why_refused(request(**changes), PAGE, []) == "the page sent an invalid request; reload it"


def test_each_limit_has_its_line() -> None:
    assert "files up to 134 MB" in why_refused(request(size_bytes=MAX_UPLOAD_BYTES + 1), PAGE, [])
    assert "already" in why_refused(request(transfer_uuid="1-0"), PAGE, running(1))
    assert "other uploads" in why_refused(request(), PAGE, running(MAX_UPLOADS_PER_CLIENT))
    assert "other uploads" in why_refused(request(), OTHER_PAGE, running(MAX_UPLOADS_IN_FLIGHT))
    assert "other large" in why_refused(
        request(size_bytes=2), OTHER_PAGE, running(1, total_bytes=MAX_BYTES_IN_FLIGHT - 1)
    )
    assert why_refused(request(), OTHER_PAGE, running(MAX_UPLOADS_PER_CLIENT)) is None, "another page's turn is its own"
    assert why_refused(request(), ELSEWHERE, running(MAX_UPLOADS_PER_CLIENT)) is None
    assert "other uploads" in why_refused(request(), ELSEWHERE, running(MAX_UPLOADS_IN_FLIGHT))
