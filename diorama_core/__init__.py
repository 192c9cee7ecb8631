"""Diorama: one photo of a room becomes an editable 3D scene.

Example::

    import diorama_core as diorama

    room = diorama.build("room.jpg", boxes="boxes.json")
    room = diorama.optimise(room)
    room.save("my-room")
    diorama.export(room, "my-room.glb")

The names in `__all__` are the public interface; `docs/python.md` introduces them. Every other module can be imported
but may change. A name is imported when it is first used, so that importing the package takes milliseconds.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from diorama_core.api import (
        Reconstruction,
        build,
        build_from_text,
        export,
        load,
        open_library,
        optimise,
        render,
        save,
    )
    from diorama_core.pipeline.stages import Stages
    from diorama_core.scene.types import Scene

__all__ = [
    "Reconstruction",
    "Scene",
    "Stages",
    "build",
    "build_from_text",
    "export",
    "load",
    "open_library",
    "optimise",
    "render",
    "save",
]

_PLACES = {"Scene": "diorama_core.scene.types", "Stages": "diorama_core.pipeline.stages"}
"""Modules of the public names that are not in `diorama_core.api`."""

# Importing a subpackage binds it here under its own name, once. Two share their names with functions of the public
# interface: bound and unbound now, they cannot replace the functions later.
for _name in ("export", "render"):
    import_module(f"diorama_core.{_name}")
    del globals()[_name]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_PLACES.get(name, "diorama_core.api")), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
