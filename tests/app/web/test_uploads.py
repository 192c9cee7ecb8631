"""Uploads through the page's own buttons: capped, counted, and never kept waiting for."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from diorama_app.serve import Running, start
from diorama_app.web import viser_adapter
from diorama_app.web.visitors import (
    MAX_BYTES_IN_FLIGHT,
    MAX_UPLOAD_BYTES,
    MAX_UPLOADS_IN_FLIGHT,
    MAX_UPLOADS_PER_CLIENT,
)
from diorama_core.artefacts import Photo
from tests.app.small_room import PlainLibrary, make_project
from tests.app.wire import WirePage
from tests.io.test_bombs import png
from tests.waiting import until

PATIENCE_S = 240
"""Of one test; a busy machine takes a minute."""
BUTTONS = ("Upload a photo", "Add boxes", "Add depth", "Add masks", "New from a photo")


@pytest.fixture
def running(tmp_path: Path) -> Iterator[Running]:
    project = make_project(tmp_path / "projects" / "demo")
    made = start(project=project.folder, projects_dir=tmp_path / "projects", low_graphics=True, library=PlainLibrary())
    yield made
    made.stop()


@pytest.fixture(autouse=True)
def patience() -> Iterator[None]:
    """Where a cap is missing, the servers wait for bytes that never come: a failure, not a wait without end."""

    def over(*_: object) -> None:
        raise TimeoutError("this test takes too long")

    before = signal.signal(signal.SIGALRM, over)
    signal.alarm(PATIENCE_S)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def in_flight(running: Running) -> dict[str, dict]:
    """Uploads under way in all projects."""
    servers = [e.server for e in running.workspace.editors]
    guis = [gui for s in servers for gui in (s.gui, *(c.gui for c in s.get_clients().values()))]
    return {uuid: state for gui in guis for uuid, state in gui._current_file_upload_states.items()}


def settled(running: Running) -> dict[str, dict]:
    """What is under way when everything that was sent has been looked at."""
    before, count = time.monotonic(), -1
    while time.monotonic() - before < 3.0:
        time.sleep(0.15)  # long enough for a message to be looked at; nothing tells of those that are refused
        if count == len(in_flight(running)):
            break
        count = len(in_flight(running))
    return in_flight(running)


def test_every_button_refuses_what_is_too_large_and_says_so(running: Running) -> None:
    page = WirePage(running.port)
    for number, label in enumerate(BUTTONS):
        page.begin_upload(page.element(label, "UploadButton"), f"{number}.png", MAX_UPLOAD_BYTES + 1, 300)
        page.wait_for(lambda name=f"{number}.png": any(f"{name} was refused" in n for n in page.notices))
    assert not in_flight(running)
    page.close()


def test_more_than_was_announced_ends_the_upload(running: Running) -> None:
    page = WirePage(running.port)
    button = page.element("Upload a photo", "UploadButton")
    transfer = page.begin_upload(button, "small.png", 10, 2)
    for i in range(20):
        page.send_part(button, transfer, i, bytes(4_000_000))
    page.wait_for(lambda: any("more data arrived than announced" in n for n in page.notices))
    assert not settled(running)
    page.close()


def test_uploads_at_once_are_counted_over_all_pages(running: Running) -> None:
    pages = [WirePage(running.port) for _ in range(5)]
    for page in pages:
        button = page.element("Upload a photo", "UploadButton")
        for i in range(8):
            page.begin_upload(button, f"{i}.png", 1_000_000, 2)
    states = settled(running)
    assert len(states) == MAX_UPLOADS_IN_FLIGHT
    owners = [s["client_id"] for s in states.values()]
    assert max(owners.count(o) for o in owners) == MAX_UPLOADS_PER_CLIENT
    for page in pages:
        page.close()


def test_uploads_are_counted_over_all_projects_of_the_server(running: Running, tmp_path: Path) -> None:
    for name in ("second", "third"):
        make_project(tmp_path / "projects" / name)
    pages = [WirePage(running.port, query=f"?project={name}") for name in ("demo", "second", "third") for _ in range(2)]
    for page in pages:
        button = page.element("Upload a photo", "UploadButton")
        for i in range(MAX_UPLOADS_PER_CLIENT + 1):
            page.begin_upload(button, f"{i}.png", 1_000_000, 2)
    states = settled(running)
    assert len(running.workspace.editors) == 3
    assert len(states) == MAX_UPLOADS_IN_FLIGHT
    for page in pages:
        page.close()
    until(lambda: not in_flight(running), "uploads of pages that are gone are given up")
    page = WirePage(running.port, query="?project=third")
    page.begin_upload(page.element("Upload a photo", "UploadButton"), "next.png", 1_000_000, 2)
    assert [s["filename"] for s in settled(running).values()] == ["next.png"]
    page.close()


def test_what_is_announced_together_is_bounded_over_all_projects(running: Running, tmp_path: Path) -> None:
    make_project(tmp_path / "projects" / "second")
    pages = [WirePage(running.port, query=f"?project={name}") for name in ("demo", "second") for _ in range(2)]
    for page in pages:
        page.begin_upload(page.element("Upload a photo", "UploadButton"), "large.png", MAX_UPLOAD_BYTES, 256)
    states = settled(running)
    assert 0 < sum(s["total_bytes"] for s in states.values()) <= MAX_BYTES_IN_FLIGHT
    for page in pages:
        page.close()


def test_an_upload_that_stands_still_gives_its_place_up(running: Running, monkeypatch: pytest.MonkeyPatch) -> None:
    page = WirePage(running.port)
    button = page.element("Upload a photo", "UploadButton")
    for i in range(MAX_UPLOADS_PER_CLIENT):
        page.begin_upload(button, f"{i}.png", 1_000_000, 2)
    assert len(settled(running)) == MAX_UPLOADS_PER_CLIENT
    monkeypatch.setattr(viser_adapter, "UPLOAD_STALLED_S", 0.0)
    page.begin_upload(button, "next.png", 1_000_000, 2)
    states = settled(running)
    assert [s["filename"] for s in states.values()] == ["next.png"]
    page.close()


def newest_photo(running: Running) -> Photo | None:
    """The photo of the project that was opened last: every uploaded photo becomes one."""
    return running.workspace.editors[-1].session.photo


def test_a_large_picture_is_decoded_while_others_go_on(running: Running) -> None:
    """A picture of 63 megapixels in 0.2 MB takes seconds to decode; nobody else waits for that."""
    page, session = WirePage(running.port), running.session
    sent = time.monotonic()
    page.upload(page.element("Upload a photo", "UploadButton"), "large.png", png(9_000, 7_000, 8, 2, 3))
    waits_s: list[float] = []

    def read() -> bool:
        began = time.monotonic()
        assert session.ui_thread.wait(60.0)
        waits_s.append(time.monotonic() - began)
        photo = newest_photo(running)
        return photo is not None and photo.name == "large.png"

    until(read, "the picture is read", seconds=60.0)
    assert max(waits_s) < 0.5 * (time.monotonic() - sent), "the thread that serves everybody was kept"
    photo = newest_photo(running)
    assert photo is not None
    assert photo.width == 1600
    page.close()


def test_a_bomb_is_one_line_and_the_next_photo_is_read(running: Running) -> None:
    page = WirePage(running.port)
    button = page.element("Upload a photo", "UploadButton")
    page.upload(button, "bomb.png", png(12_000, 9_800, 8, 2, 3))
    page.wait_for(lambda: any("12000 x 9800 pixels are more than" in n for n in page.notices))
    page.upload(button, "room.png", png(640, 480, 8, 2, 3))
    until(lambda: (photo := newest_photo(running)) is not None and photo.name == "room.png", page.notices, seconds=30.0)
    page.close()
