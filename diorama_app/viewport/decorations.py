"""Decorations of one browser: selection outlines, name tags, other clients' selections, collisions.

Outlines are drawn by the page (`static/silhouettes.js`), which is told of them; tags are nodes of the scene.
"""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import viser

from diorama_app.strings import _
from diorama_core.scene.types import Scene, SceneObject

SELECTED_COLOUR = (255, 122, 26)
LOCKED_COLOUR = (120, 130, 150)
COLLIDING_COLOUR = (224, 44, 44)
UNSURE, LIKELIER_WRONG = 0.35, 0.5
"""What is marked as uncertain: poses below this confidence, and objects less likely right than this."""

Colour = tuple[int, int, int]
NodeName = Callable[[str], str | None]


@dataclass(frozen=True)
class Outline:
    """The line around what is seen of an object."""

    node: str
    """The shared frame of the object."""
    colour: Colour
    thickness_px: float


@dataclass(frozen=True)
class _Mark:
    """Everything drawn around one object."""

    node: str
    height_m: float
    colour: Colour | None = None
    thickness: float = 2.0
    tag: str = ""


class Decorations:
    """Nodes of one browser below the shared frames of the objects. Used from the UI thread only."""

    def __init__(self, viser_client: viser.ClientHandle) -> None:
        self._viser_client = viser_client
        self._shown: dict[str, tuple[_Mark, viser.SceneNodeHandle | None]] = {}
        self._colliding: frozenset[str] = frozenset()
        self.outlines: tuple[Outline, ...] = ()
        self.on_outlines: Callable[[tuple[Outline, ...]], None] = lambda _: None
        """Told of the outlines when they change."""

    def show(
        self,
        scene: Scene,
        node_name: NodeName,
        selection: tuple[str, ...],
        others: Sequence[tuple[str, Colour, tuple[str, ...]]],
        badges: Mapping[str, Sequence[str]],
        *,
        names: bool,
        unsure: bool = False,
    ) -> None:
        """Draw what differs from what is drawn.

        Args:
            scene: where everything is.
            node_name: the shared frame of an object, by id.
            selection: one's own, the last one drawn boldest.
            others: name, colour and selection of everyone else.
            badges: what is wrong with an object, in a word or two each.
            names: whether everything has a name tag.
            unsure: whether what the photo hardly supports has a question mark.
        """
        wanted: dict[str, _Mark] = {}
        for item in scene.objects:
            node = node_name(item.id)
            if node is None or item.hidden:
                continue
            doubt = " ?" if unsure and is_unsure(item) else ""
            mark = self._mark(item, node, selection, others, badges.get(item.id, ()), names=names, doubt=doubt)
            if mark is not None:
                wanted[item.id] = mark
        with self._viser_client.atomic():
            for object_id in [i for i, (mark, _) in self._shown.items() if wanted.get(i) != mark]:
                tag = self._shown.pop(object_id)[1]
                if tag is not None:
                    remove_quietly(tag)
            for object_id, mark in wanted.items():
                if object_id not in self._shown:
                    self._shown[object_id] = (mark, self._add_tag(mark) if mark.tag else None)
        outlines = tuple(Outline(m.node, m.colour, m.thickness) for m in wanted.values() if m.colour is not None)
        if outlines != self.outlines:
            self.outlines = outlines
            self.on_outlines(outlines)

    def collide(self, ids: Iterable[str]) -> bool:
        """Set the colliding objects; returns whether they changed (then `show` again)."""
        changed = self._colliding != (colliding := frozenset(ids))
        self._colliding = colliding
        return changed

    def _mark(
        self,
        item: SceneObject,
        node: str,
        selection: tuple[str, ...],
        others: Sequence[tuple[str, Colour, tuple[str, ...]]],
        badges: Sequence[str],
        *,
        names: bool,
        doubt: str,
    ) -> _Mark | None:
        height = round(float(item.size_m[2]), 5)
        name = item.label[:40] + (_(" (locked)") if item.locked else "")
        problems = "".join(f" ⚠ {_(badge)}" for badge in badges) + doubt
        short = ("⚠" if badges else "") + doubt
        if item.id in self._colliding:
            return _Mark(node, height, COLLIDING_COLOUR, 3.5, name if names else "")
        if item.id in selection:
            colour = LOCKED_COLOUR if item.locked else SELECTED_COLOUR
            thickness = 3.5 if selection[-1] == item.id else 2.5
            return _Mark(node, height, colour, thickness, name + problems if names else short)
        for who, colour, theirs in others:
            if item.id in theirs:
                return _Mark(node, height, colour, 2.5, who)
        if names or problems:
            return _Mark(node, height, None, 0.0, name + problems if names else short)
        return None

    def _add_tag(self, mark: _Mark) -> viser.SceneNodeHandle:
        return self._viser_client.scene.add_label(
            f"{mark.node}/mark/tag",
            text=mark.tag.strip(),
            position=(0.0, 0.0, mark.height_m / 2 + 0.06),
            anchor="bottom-center",
            font_screen_scale=1.0,
        )


def is_unsure(item: SceneObject) -> bool:
    """Whether an object of the photo is likelier wrong than right, or the photo hardly supports its pose."""
    wrong = item.belief is not None and item.belief.right < LIKELIER_WRONG
    return item.box_px is not None and (item.confidence < UNSURE or wrong)


def remove_quietly(handle: Any) -> None:
    """Remove a node that may have gone with its parent."""
    with contextlib.suppress(Exception), warnings.catch_warnings():  # its parent went first, and took it along
        warnings.simplefilter("ignore")
        handle.remove()
