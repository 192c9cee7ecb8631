"""Every error Diorama raises on purpose.

    DioramaError
    ├── InputError          a file or value the user gave cannot be used
    │   └── SphericalPhotoError  the photo shows all directions
    ├── SceneError          a scene document or an edit of it is not valid
    │   └── EditRefused     the edit would break the scene (a cycle, a locked object)
    ├── LibraryError        a shape is missing, unreadable or malformed
    ├── ProjectError        a project folder cannot be read or written
    ├── ExportError         a scene cannot be written in the asked format
    ├── UnavailableError    an optional dependency, model or system library is missing
    └── Cancelled           the user stopped a long-running job

A message is one line: what was wrong, where, and what to do. It is shown to people as it is, so it is
written once, where the cause is known, and handled once, where the user is (command line or editor).
"""


class DioramaError(Exception):
    """Base of all errors that are the user's to read."""


class InputError(DioramaError):
    """A file or value given by the user cannot be used."""


class SphericalPhotoError(InputError):
    """The photo shows all directions: it is for `build_sphere`, not for what takes a perspective photo."""


class SceneError(DioramaError):
    """A scene document or an edit of it is not valid."""


class EditRefused(SceneError):
    """An edit would break the scene; the scene is unchanged."""


class LibraryError(DioramaError):
    """A shape is missing, unreadable or malformed."""


class ProjectError(DioramaError):
    """A project folder cannot be read or written."""


class ExportError(DioramaError):
    """A scene cannot be written in the asked format."""


class UnavailableError(DioramaError):
    """An optional dependency, model or system library is missing."""


class Cancelled(DioramaError):
    """A long-running job was stopped on request."""
