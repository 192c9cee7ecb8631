from __future__ import annotations

import os
import time

import pytest

from diorama_app.panels.unsaved import UnsavedChanges
from diorama_app.session.recovery import Recovery
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.scene import edits
from tests.app.page import Page


def left_behind(session):
    """What an earlier session could not save, a minute after what it could."""
    scene = edits.remove(session.scene, ["chair_1"])
    now = time.time()
    os.utime(session.project.scene_path, (now - 120, now - 120))
    earlier = Recovery()
    earlier.note(session.project, scene)
    (path,) = default_cache_dir().glob("unsaved/*.json")
    os.utime(path, (now - 60, now - 60))
    return scene


@pytest.fixture(autouse=True)
def _own_cache(tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("DIORAMA_CACHE", str(tmp_path / "cache"))


@pytest.fixture
def session(_own_cache, session):
    """Its recovery looks at this test's own folder."""
    session.autosave.recovery = Recovery()
    return session


def test_unsaved_changes_are_offered_and_restored_as_one_step(session, client, page: Page) -> None:
    lost = left_behind(session)
    page.put(UnsavedChanges)
    assert "were not saved when Diorama ended" in page.html
    page.act("restore")
    assert session.scene == lost
    assert session.document.history.current.label == "restore unsaved changes"
    assert "were not saved" not in page.html


def test_they_can_be_forgotten(session, client, page: Page) -> None:
    left_behind(session)
    page.put(UnsavedChanges)
    before = session.scene
    page.act("discard")
    assert session.scene is before
    assert "were not saved" not in page.html
    assert session.autosave.recovery.find_unsaved(session.project) is None


def test_nothing_is_said_when_everything_was_saved(client, page: Page) -> None:
    UnsavedChanges(page, client).refresh()
    assert "were not saved" not in page.html
