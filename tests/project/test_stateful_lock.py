"""Several programs want one project while the disk fills, the clock jumps and programs die: one at most has it."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from diorama_core.errors import ProjectError
from diorama_core.project.lock import OWNER, ProjectLock, ProjectLockedError, owner
from diorama_core.project.storage import Project
from tests.faults import Faults, Killed

PROGRAMS = st.sampled_from(["the editor", "diorama build", "diorama api"])


class LockMachine(RuleBasedStateMachine):
    """Programs that take the lock, give it back or die with it."""

    @initialize()
    def begin(self) -> None:
        self.folder = Project.create(Path(tempfile.mkdtemp()) / "room").folder
        self.over = list[object]()
        """Locks that were given back, and errors: while they are there, nothing but the program ends what they had."""
        self.faults, self.held, self.by, self.named = Faults(), None, "", False
        """`held` is the lock that `by` has; `named` whether the file that says so is whole."""

    @rule(program=PROGRAMS)
    def take(self, program: str) -> None:
        if self.held:
            with self.faults.injected(), pytest.raises(ProjectLockedError) as told:
                ProjectLock(self.folder, program)
            assert (self.by if self.named else "another program") in str(told.value)
            assert "\n" not in str(told.value)
            return
        try:
            with self.faults.injected():
                self.held, self.by, self.named = ProjectLock(self.folder, program), program, True
        except ProjectError as error:
            self.over.append(error)
            assert self.faults.full
        except Killed:
            pass  # the operating system ends the lock with the program

    @precondition(lambda self: self.held)
    @rule(times=st.integers(1, 2))
    def give_back(self, times: int) -> None:
        for _ in range(times):
            self.held.release()
        assert not (self.folder / OWNER).exists()
        self.over.append(self.held)
        self.held = None

    @precondition(lambda self: self.held)
    @rule()
    def die(self) -> None:
        """The operating system ends the lock; the file that names the program stays."""
        self.held._lock.release()
        self.held = None

    @rule(content=st.sampled_from([b"", b"\xff[[", b"{}", b"[1]", b"null"]))
    def damage_the_name(self, content: bytes) -> None:
        (self.folder / OWNER).write_bytes(content)
        self.named = False

    @rule(full=st.booleans())
    def fill_or_empty_the_disk(self, full: bool) -> None:
        self.faults.full = full

    @rule(steps=st.integers(0, 3))
    def be_killed_soon(self, steps: int) -> None:
        self.faults.kill_at = steps

    @rule(ahead_s=st.sampled_from([-1e9, -3600.0, 0.0, 3600.0, 1e9]))
    def jump_in_time(self, ahead_s: float) -> None:
        self.faults.ahead_s = ahead_s

    @invariant()
    def whoever_has_it_is_known_and_keeps_it(self) -> None:
        if getattr(self, "held", None):
            with pytest.raises(ProjectLockedError):
                ProjectLock(self.folder)
            assert owner(self.folder).startswith(self.by if self.named else "another program")

    def teardown(self) -> None:
        if hasattr(self, "folder"):
            shutil.rmtree(self.folder.parent)


TestLock = LockMachine.TestCase
TestLock.settings = settings(max_examples=20, stateful_step_count=25, deadline=None)
