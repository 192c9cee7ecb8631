"""The right to change the open project, which one program at a time has."""

from __future__ import annotations

from diorama_app.strings import _
from diorama_core.errors import EditRefused, ProjectError
from diorama_core.project.lock import ProjectLock, ProjectLockedError
from diorama_core.project.storage import Project


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
