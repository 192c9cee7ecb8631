"""Undo and redo over immutable scenes: a value itself, so it can be shared and tested."""

from __future__ import annotations

from dataclasses import dataclass, replace

from diorama_core.scene.types import Scene


@dataclass(frozen=True)
class Entry:
    """One committed state."""

    label: str
    """What was done to reach it, in words a person reads: 'move chair'."""
    scene: Scene
    selection: tuple[str, ...] = ()
    """Ids selected when it was committed."""
    merge_key: str | None = None
    """Entries with the same key, committed within the merge window, become one step."""
    time_s: float = 0.0
    beside: object = None
    """What belongs to this state besides the scene, for whoever keeps the history."""
    author: str = ""
    """Who made the change; empty for what nobody in particular did."""


@dataclass(frozen=True)
class History:
    """A line of states with a cursor. Undo and redo move the cursor; a commit cuts off the redo branch."""

    entries: tuple[Entry, ...]
    cursor: int = 0
    limit: int = 200
    """Oldest entries beyond this many are dropped."""

    @classmethod
    def start(cls, scene: Scene, *, label: str = "open", limit: int = 200) -> History:
        """A history whose first state is `scene`.

        Args:
            scene: as it is.
            label: name of the undo step.
            limit: of steps.
        """
        return cls(entries=(Entry(label, scene),), limit=limit)

    @property
    def current(self) -> Entry:
        """The state the user sees."""
        return self.entries[self.cursor]

    @property
    def can_undo(self) -> bool:
        """Whether there is a state before the current one."""
        return self.cursor > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is a state after the current one."""
        return self.cursor + 1 < len(self.entries)

    def commit(self, entry: Entry, *, merge_window_s: float = 0.5) -> History:
        """Add a state after the current one.

        Repeated nudges (same `merge_key`, within the window) replace the current state, so that one undo takes
        them all back.
        """
        last = self.current
        merges = (
            entry.merge_key is not None
            and entry.merge_key == last.merge_key
            and entry.author == last.author
            and self.cursor > 0
            and entry.time_s - last.time_s <= merge_window_s
        )
        retained = self.entries[: self.cursor if merges else self.cursor + 1]
        entries = (*retained, entry)[-self.limit :]
        return replace(self, entries=entries, cursor=len(entries) - 1)

    def undo(self) -> History:
        """One state back; the same history when there is none."""
        return replace(self, cursor=self.cursor - 1) if self.can_undo else self

    def redo(self) -> History:
        """One state forward; the same history when there is none."""
        return replace(self, cursor=self.cursor + 1) if self.can_redo else self
