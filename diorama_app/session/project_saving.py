"""What of the open project is on disk, and the right to change it there, which one program at a time has."""

from __future__ import annotations

import contextlib
from collections.abc import Callable

from diorama_app.session.autosave import Autosave
from diorama_app.session.document import Document
from diorama_app.strings import _
from diorama_app.viewport.client_view import NoticeKind
from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.errors import EditRefused, ProjectError
from diorama_core.library.library_names import BUILT_IN
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.user_library import OWN, UserLibrary
from diorama_core.project.lock import ProjectLock, ProjectLockedError
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene


class ProjectAccess:
    """The lock of the project that is open; without it the project is only looked at."""

    def __init__(self) -> None:
        self._lock: ProjectLock | None = None
        self.read_only = ""
        """Why the open project is read-only; empty when it is writable."""
        self.unwritable = ""
        """Why changes cannot be saved although they may be made; empty when they can."""

    def take(self, project: Project) -> bool:
        """Let go of the project that was open, and have this one to oneself if possible.

        Returns:
            Whether the lock is taken now and was not before.
        """
        if self._lock is not None:
            if self._lock.folder == project.folder:
                return False
            self.release()
        self.read_only = self.unwritable = ""
        try:
            self._lock = ProjectLock(project.folder, "the editor")
        except ProjectLockedError as error:
            self.read_only = _("nothing can be changed here: {reason}").format(reason=_(str(error)))
        except (ProjectError, OSError) as error:
            self.unwritable = _("changes will not be saved: {reason}").format(reason=_(str(error)))
        return self._lock is not None

    def need_writable(self) -> None:
        """Raise `EditRefused` when the open project cannot be changed here."""
        if self.read_only:
            raise EditRefused(self.read_only)

    def release(self) -> None:
        """Let go of the project."""
        if self._lock is not None:
            self._lock.release()
        self._lock = None


class ProjectSaving:
    """The folder of the open project follows its document."""

    def __init__(self, say: Callable[[str, NoticeKind], None], on_version: Callable[[], None]) -> None:
        """Save nothing yet; both are told from another thread: what could not be saved or has been, and of versions."""
        self.autosave = Autosave(
            on_error=lambda line: say(line, "bad"), on_saved=lambda line: say(line, "good"), on_version=on_version
        )
        self.access = ProjectAccess()
        self._inputs: Inputs | None = None
        """Corrections of the photo as they are in the folder."""
        self._further: tuple[FurtherPhoto, ...] = ()

    def take(self, project: Project) -> None:
        """Write what is unsaved of the project that was open, and have this one to oneself if possible."""
        self.autosave.flush()
        if self.access.take(project):
            with contextlib.suppress(OSError):  # leftovers that cannot be removed disturb nobody
                self.autosave.recovery.clean_up(project)

    def is_saved(self, document: Document) -> None:
        """What a document says of its photos is in the folder."""
        self._inputs, self._further = document.inputs, document.further_photos

    def inputs_are_saved(self, inputs: Inputs | None) -> None:
        """These corrections of the photo are in the folder; None where what is there is not known."""
        self._inputs = inputs

    def save_soon(self, project: Project, document: Document, library: ShapeLibrary) -> None:
        """Write within a second what of a document differs from the folder; its shapes are in the library."""
        scene, inputs, further = document.scene, document.inputs, document.further_photos
        begun = bool(scene.objects or scene.architecture.planes) or project.has_scene
        _note_library(project, scene, library)
        self.autosave.save_soon(
            project,
            scene if begun else None,
            None if inputs is self._inputs else inputs,
            None if further is self._further else further,
        )
        self.is_saved(document)

    def close(self) -> None:
        """Write what is unsaved, and let go of the project."""
        self.autosave.stop()
        self.access.release()


def _note_library(project: Project, scene: Scene, library: ShapeLibrary) -> None:
    """Commands that open this project must find the models of people's own that stand in it."""
    if not isinstance(library, UserLibrary) or OWN in project.shared_library_name.split("+"):
        return
    if not {s.id for s in library.uploads()}.isdisjoint(o.shape_id for o in scene.objects):
        project.update_info(library=f"{project.info().get('library', BUILT_IN)}+{OWN}")
