"""One person edits a project while the world is odd: what was acknowledged is there afterwards, whatever happened."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from diorama_app.session import recovery
from diorama_app.session.autosave import Autosave
from diorama_app.session.document import Document
from diorama_app.session.recovery import Recovery
from diorama_core.project.backups import MAX_BACKUPS
from diorama_core.project.lock import ProjectLock, ProjectLockedError
from diorama_core.project.storage import Project, read_scene
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.small_room import furnished_scene, make_project
from tests.faults import Faults, Killed

DAY_S = 86400.0


def _label(scene: Scene) -> str:
    return scene.object("chair_1").label


class SteppedAutosave(Autosave):
    """Autosave of which the test does the steps that its thread does."""

    def _work(self) -> None:
        pass


class ProjectMachine(RuleBasedStateMachine):
    """Edits, saves, undoes and redoes as the editor does; the program is killed and started again."""

    @initialize()
    def begin(self) -> None:
        self.place = Path(tempfile.mkdtemp())
        self.project = make_project(self.place / "demo")
        self.faults = Faults()
        self.number = 0
        self.acknowledged = self.pending = _label(furnished_scene())
        """What was said to be kept, and what was being kept when the program was killed."""
        self._start(furnished_scene())

    def _start(self, scene: Scene) -> None:
        self.lock = ProjectLock(self.project.folder, "the test")
        self.document, self.told = Document(), list[str]()
        recovery = Recovery(self.place / "unsaved")
        self.saver = SteppedAutosave(self.told.append, recovery, on_saved=self.told.append)
        self.document.open(scene)
        self.past, self.future = [_label(scene)], list[str]()

    def _meeting_faults(self) -> None:
        """Save the scene as it is."""
        self.pending = _label(self.document.scene)
        self.saver.save_soon(self.project, self.document.scene)
        self.save_what_waits()

    @rule()
    def save_what_waits(self) -> None:
        """What the thread does, and does again while something is not saved."""
        try:
            with self.faults.injected():
                self.saver.flush()
        except Killed:
            self._start_again()
        else:
            assert not self.saver.trouble or self.faults.full
            self.acknowledged = self.acknowledged if self.faults.full else self.pending

    @rule()
    def edit(self) -> None:
        self.number += 1
        self.document.commit("rename", edits.rename(self.document.scene, "chair_1", f"edit {self.number}"))
        self.past.append(f"edit {self.number}")
        self.future.clear()
        self._meeting_faults()

    @precondition(lambda self: len(self.past) > 1)
    @rule()
    def undo(self) -> None:
        self.document.undo()
        self.future.append(self.past.pop())
        self._meeting_faults()

    @precondition(lambda self: self.future)
    @rule()
    def redo(self) -> None:
        self.document.redo()
        self.past.append(self.future.pop())
        self._meeting_faults()

    @rule(full=st.booleans())
    def fill_or_empty_the_disk(self, full: bool) -> None:
        self.faults.full = full

    @rule(steps=st.integers(0, 6))
    def be_killed_soon(self, steps: int) -> None:
        self.faults.kill_at = steps

    @rule(ahead_s=st.sampled_from([-3650 * DAY_S, -DAY_S, -3600.0, 0.0, 61.0, 3600.0, 20 * DAY_S]))
    def jump_in_time(self, ahead_s: float) -> None:
        self.faults.ahead_s = ahead_s

    @rule()
    def another_program_tries(self) -> None:
        with pytest.raises(ProjectLockedError):
            ProjectLock(self.project.folder, "another")

    @rule()
    def be_killed_now(self) -> None:
        self.pending = self.acknowledged
        self._start_again()

    def _start_again(self) -> None:
        """What the next program finds is what was acknowledged last, or what was just being kept."""
        self.faults.full, self.faults.kill_at = False, None
        self.lock.release()
        later = Recovery(self.place / "unsaved")
        with self.faults.injected(), pytest.MonkeyPatch.context() as patch:
            patch.setattr(recovery, "SETTLED_S", -1.0)
            found = later.find_unsaved(self.project)
            scene = self.project.load_scene() if found is None else found.scene()
            assert _label(scene) in (self.acknowledged, self.pending)
            self.acknowledged = self.pending = _label(scene)
            later.clean_up(self.project)
            if found is not None:
                assert found.path.exists(), "what is offered is not cleaned up"
                self.project.save_scene(scene)
                found.discard()
        self._start(scene)

    @invariant()
    def the_document_is_what_was_done(self) -> None:
        if hasattr(self, "document"):
            assert _label(self.document.scene) == self.past[-1]
            assert self.document.history.can_undo == (len(self.past) > 1)
            assert self.document.history.can_redo == bool(self.future)

    @invariant()
    def trouble_is_told_once_and_its_end_too(self) -> None:
        if hasattr(self, "told"):
            assert [m.startswith("Not saved") for m in self.told] == [i % 2 == 0 for i in range(len(self.told))]
            assert bool(self.saver.trouble) == (len(self.told) % 2 == 1)

    @invariant()
    def everything_reads_back(self) -> None:
        if hasattr(self, "project"):
            Project.open(self.project.folder).load_scene()
            versions = self.project.backups()
            assert len(versions) <= MAX_BACKUPS
            for path in versions:
                read_scene(path)

    def teardown(self) -> None:
        if hasattr(self, "place"):
            self.lock.release()
            shutil.rmtree(self.place)


TestProject = ProjectMachine.TestCase
TestProject.settings = settings(max_examples=12, stateful_step_count=25, deadline=None)


def test_a_full_disk_is_told_once_though_each_earlier_version_would_have_its_own_name(tmp_path: Path) -> None:
    project, told, faults = make_project(tmp_path / "demo"), list[str](), Faults(full=True)
    saver = SteppedAutosave(told.append, Recovery(tmp_path / "unsaved"))
    for number in range(3):
        faults.ahead_s = 61.0 * number
        saver.save_soon(project, edits.rename(furnished_scene(), "chair_1", f"edit {number}"))
        with faults.injected():
            saver.flush()
    assert [m.startswith("Not saved") for m in told] == [True]
