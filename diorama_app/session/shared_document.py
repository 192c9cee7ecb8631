"""The document as several people and programs change it: each step's author, who may take it back, and the pictures on
the room's planes.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from functools import partial

import numpy as np
from jaxtyping import UInt8

from diorama_app.session.connected_client import ConnectedClient
from diorama_app.session.document import Document, IsMine
from diorama_app.session.project_saving import ProjectSaving
from diorama_app.strings import _
from diorama_app.viewport.client_view import NoticeKind
from diorama_core.artefacts import FurtherPhoto, Inputs, Photo
from diorama_core.editing.hand_placed import mark_by_hand
from diorama_core.errors import DioramaError, EditRefused
from diorama_core.io.bounded import shorten
from diorama_core.project.storage import Project
from diorama_core.scene.history import Entry
from diorama_core.scene.schema import check_limits
from diorama_core.scene.types import Scene


class SharedDocument(ABC):
    """Steps of one document; who derives from it saves and shows what they lead to."""

    def __init__(self, saving: ProjectSaving) -> None:
        self.saving = saving
        self.document = Document()
        self.project: Project | None = None
        self.textures: Textures = {}
        self.clients: dict[int, ConnectedClient] = {}

    @abstractmethod
    def save_and_show(self, by: ConnectedClient | None = None) -> None:
        """The document changed: save and show it."""

    @abstractmethod
    def refresh(self, by: ConnectedClient | None = None) -> None:
        """Bring every browser in line with the document."""

    @property
    def scene(self) -> Scene:
        """The scene as it is now."""
        return self.document.scene

    @property
    def inputs(self) -> Inputs | None:
        """The photo with everything that is said of it; None without one."""
        return self.document.inputs

    @property
    def further_photos(self) -> tuple[FurtherPhoto, ...]:
        """The other photos of the same room."""
        return self.document.further_photos

    @property
    def photo(self) -> Photo | None:
        """The scene's own photo."""
        return None if self.inputs is None else self.inputs.photo

    def notice(self, client_id: int | None, message: str, kind: NoticeKind = "info") -> None:
        """Tell one person, or all when it is not known which."""
        client = self.clients.get(client_id) if client_id is not None else None
        for one in [client] if client is not None else list(self.clients.values()):
            one.notice(message, kind)

    def notice_all(self, message: str, kind: NoticeKind = "info") -> None:
        """Tell every browser."""
        self.notice(None, message, kind)

    def edit(
        self,
        label: str,
        change: Callable[[Scene], Scene],
        *,
        by: ConnectedClient | None = None,
        selection: Iterable[str] | None = None,
        merge_key: str | None = None,
        inputs: Inputs | None = None,
        by_hand: bool = False,
        author: str = "",
    ) -> None:
        """Apply a pure edit as one undo step, show it and save it. A refused edit changes nothing.

        Args:
            label: what is done, as the undo button and the toast say it.
            change: the edit.
            by: who does it.
            selection: what that person has selected afterwards; as before when None.
            merge_key: quick edits of the same key become one step.
            inputs: what is said of the photo from now on; as before when None.
            by_hand: whether objects are put where the person wants them, so that no automatic step moves them.
            author: who does it where no browser does: the name of another program.
        """
        try:
            self.need_writable()
            scene = change(self.scene)
            scene = mark_by_hand(self.scene, scene) if by_hand else scene
            check_limits(scene, self.scene)
            scene, made = refit(self.scene, scene, self.textures)
            self.add_textures(made)
        except DioramaError:
            self.refresh(by)  # fields and gizmo go back to what the document says
            raise
        except ValueError as error:  # the scene's own values refuse what is no number
            self.refresh(by)
            message = _("this is not possible: {reason}; give another value").format(reason=shorten(str(error)))
            raise EditRefused(message) from error
        if scene == self.scene and inputs is None:
            self.refresh(by)
            return
        self.commit(label, scene, by=by, selection=selection, merge_key=merge_key, inputs=inputs, author=author)

    def add_textures(self, made: Textures) -> None:
        """Have pictures for scenes to name, and save them."""
        if not made:
            return
        self.textures = {**self.textures, **made}
        if self.project is not None:
            self.project.save_textures(made)

    def commit(
        self,
        label: str,
        scene: Scene,
        *,
        by: ConnectedClient | None = None,
        selection: Iterable[str] | None = None,
        merge_key: str | None = None,
        inputs: Inputs | None = None,
        further: tuple[FurtherPhoto, ...] | None = None,
        author: str = "",
    ) -> None:
        """Make a whole scene the current state as one undo step, save it and show it.

        Args:
            label: name of the undo step.
            scene: from now on.
            by: who did it; None for the server itself.
            selection: ids that are selected from now on; None leaves it.
            merge_key: steps with the same key become one.
            inputs: from now on; None leaves them.
            further: other photos from now on; None leaves them.
            author: who did it where no browser did: the name of another program.
        """
        self.need_writable()
        if by is not None and selection is not None:
            by.selection = tuple(selection)
        chosen = () if by is None else tuple(i for i in by.selection if scene.has_object(i))
        author = author if by is None else by.name
        self.document.commit(
            label, scene, selection=chosen, merge_key=merge_key, inputs=inputs, further=further, author=author
        )
        for client in self.clients.values():
            who = f"{author}: " if author and client is not by else ""
            client.to_say = (f"{who}{label[:1].upper()}{label[1:]}", by is None or client is by)
        self.save_and_show(by)

    @property
    def read_only(self) -> str:
        """Why the open project is read-only; empty when it is writable."""
        return self.saving.access.read_only

    def need_writable(self) -> None:
        """Raise `EditRefused` when the open project cannot be changed here."""
        self.saving.access.need_writable()

    def need_project(self) -> Project:
        """The open project; raises `EditRefused` where there is none, or it cannot be changed here."""
        self.need_writable()
        if self.project is None:
            raise EditRefused("no project is open")
        return self.project

    def undo(self, by: ConnectedClient | str) -> Entry:
        """Take back the last change of a person, or of a program by its name; see `scene.history` for the rule.

        Of a person, also one of somebody who has left or of a program.
        """
        self.need_writable()
        undone = self.document.undo(self._own(by))
        message = _("Undone: {label}").format(label=undone.label)
        self._time_travelled(by, message, self.document.history.current.selection)
        return undone

    def _own(self, by: ConnectedClient | str) -> IsMine:
        if isinstance(by, str):
            return lambda entry: entry.author == by
        return partial(self.is_of, by)

    def is_of(self, person: ConnectedClient, entry: Entry) -> bool:
        """Whether a change is a person's to take back: nobody else who is here made it."""
        return all(entry.author != c.name for c in self.clients.values() if c is not person)

    def redo(self, by: ConnectedClient | str) -> Entry:
        """Do again what a person, or a program by its name, undid."""
        self.need_writable()
        done = self.document.redo(self._own(by))
        self._time_travelled(by, _("Redone: {label}").format(label=done.label), done.selection)
        return done

    def _time_travelled(self, by: ConnectedClient | str, message: str, selection: tuple[str, ...]) -> None:
        person = None if isinstance(by, str) else by
        if person is not None:
            person.selection = selection or person.selection
        for client in self.clients.values():
            client.to_say = (message, False)
        self.save_and_show(person)


Textures = Mapping[str, UInt8[np.ndarray, "_ _ 3"]]
"""Pictures by their file names."""


def refit(before: Scene, after: Scene, textures: Textures) -> tuple[Scene, Textures]:
    """The edited scene and its new pictures.

    Those of resized planes are cut and continued, not stretched; those of finishes are made."""
    if after.architecture is before.architecture:
        return after, {}
    # OpenCV; opening a project does without it
    from diorama_core.appearance.surface_finish import with_finish_pictures
    from diorama_core.architecture.texture.refit import refit_textures

    after, made = refit_textures(before, after, textures)
    after, finishes = with_finish_pictures(after, {**textures, **made})
    return after, {**made, **finishes}
