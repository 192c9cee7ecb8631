"""Undo and redo over immutable scenes. The history is a value, so it can be shared and tested.

A person's change is taken back even if others made later changes that do not depend on it: the change moves to the end
of the history and is undone there, so redo brings it back. If somebody else has since changed the same object, wall or
setting, or needs what would be removed, undo is refused, and the message names the reason.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

from diorama_core.errors import EditRefused, SceneError
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Scene

if TYPE_CHECKING:
    from diorama_core.scene.light_settings import LightSettings
    from diorama_core.scene.types import Camera, RoomLight


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


Part = tuple[str, str]
"""What of a state is changed as one: a kind ("item", "support", "plane" or a field's name) and an id."""
_FIELDS = ("camera", "light", "light_settings")


def move_last(history: History, index: int) -> History:
    """The history with one change after all others up to the current state, which stays as it is.

    Args:
        history: whose current state is the last of those.
        index: of the entry that the change led to; at least 1.

    Raises:
        EditRefused: a later change is of the same things.
    """
    before, after = history.entries[index - 1], history.entries[index]
    later = history.entries[index + 1 : history.cursor + 1]
    without = [_replay(entry, after, before, after.label) for entry in later]
    last = replace(history.current, label=after.label, author=after.author, merge_key=None, selection=after.selection)
    entries = (*history.entries[:index], *without, last if later else after, *history.entries[history.cursor + 1 :])
    return replace(history, entries=entries)


def move_next(history: History, index: int) -> History:
    """The history with one undone change before all others that were undone; what follows it stays as it is.

    Args:
        history: whose current state the change is done after.
        index: of the entry that the change led to, beyond the current one.

    Raises:
        EditRefused: a change before it is of the same things.
    """
    before, after = history.entries[index - 1], history.entries[index]
    between = history.entries[history.cursor : index]
    done = [_replay(entry, before, after, after.label) for entry in between]
    first = replace(done[0], label=after.label, author=after.author, merge_key=None, selection=after.selection)
    rest = [replace(entry, selection=was.selection) for entry, was in zip(done[1:], between[1:], strict=True)]
    entries = (*history.entries[: history.cursor + 1], first, *rest, *history.entries[index + 1 :])
    return replace(history, entries=entries)


def _replay(entry: Entry, before: Entry, after: Entry, label: str) -> Entry:
    """An entry's state with the change from one state to another made in it; the label is that of the change."""
    old, new, now = _parts_of(before), _parts_of(after), _parts_of(entry)
    changed = [part for part in {**old, **new} if old.get(part) != new.get(part)]
    for part in changed:
        if now.get(part) != old.get(part):
            raise EditRefused(_since(part, before, after, entry, label))
    parts = {**now, **{part: new[part] for part in changed if part in new}}
    for part in changed:
        if part not in new:
            parts.pop(part, None)
    scene = _scene_of(parts, entry.scene, after.scene)
    try:
        check_scene(scene)
    except (EditRefused, SceneError) as error:
        who = entry.author or "somebody"
        raise EditRefused(f"{who} has since built on what would go, so “{label}” stays ({error})") from error
    if before.beside == after.beside:
        return replace(entry, scene=scene)
    if entry.beside != before.beside:
        raise EditRefused(f"{entry.author or 'somebody'} has since marked the photo otherwise, so “{label}” stays")
    return replace(entry, scene=scene, beside=after.beside)


def _parts_of(entry: Entry) -> Mapping[Part, object]:
    """Everything of a state that is changed as one."""
    scene = entry.scene
    return {
        **{("item", o.id): o for o in scene.objects},
        **{("support", s.child): s for s in scene.supports},
        **{("plane", p.id): p for p in scene.architecture.planes},
        **{("room", r.id): r for r in scene.rooms},
        **{("field", name): getattr(scene, name) for name in _FIELDS},
    }


def _scene_of(parts: Mapping[Part, object], now: Scene, after: Scene) -> Scene:
    """A scene of parts, in the order of the present one; what is new in it, in the order of the other."""

    def order_parts(kind: str, ids: Iterable[str]) -> tuple[Any, ...]:
        return tuple(parts[(kind, i)] for i in dict.fromkeys(ids) if (kind, i) in parts)

    order = [o.id for o in after.objects]
    known = {o.id for o in now.objects}
    # What comes back stands where it stood, if all others are there.
    objects = order if known <= set(order) else [*(o.id for o in now.objects), *order]
    planes = [*(p.id for p in now.architecture.planes), *(p.id for p in after.architecture.planes)]
    children = [child for kind, child in parts if kind == "support"]
    return replace(
        now,
        objects=order_parts("item", objects),
        supports=order_parts("support", children),
        architecture=replace(now.architecture, planes=order_parts("plane", planes)),
        rooms=order_parts("room", (r.id for r in (*now.rooms, *after.rooms))),
        camera=cast("Camera | None", parts[("field", "camera")]),
        light=cast("RoomLight | None", parts[("field", "light")]),
        light_settings=cast("LightSettings", parts[("field", "light_settings")]),
    )


def _since(part: Part, before: Entry, after: Entry, entry: Entry, label: str) -> str:
    """Why a change is not taken back."""
    kind, name = part
    scene = next((e.scene for e in (entry, before, after) if e.scene.has_object(name)), None)
    what = (
        scene.object(name).label
        if scene is not None
        else "the room"
        if kind in ("plane", "room")
        else "the view or the light"
    )
    who = entry.author or "somebody"
    return f"{who} has changed {what} since, so “{label}” stays; undo takes back what nobody else has changed"
