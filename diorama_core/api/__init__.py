"""The public interface: photos and descriptions become scenes, which are optimised, drawn, saved and exported.

Each function imports what it needs when it is called: loading a project costs nothing of what building one does.
`diorama_core.__all__` lists what of this package is public.
"""

from diorama_core.api.building import build, build_from_text
from diorama_core.api.reconstruction import Reconstruction, load, open_library, save
from diorama_core.api.results import export, optimise, render
from diorama_core.layout.settings import RecipeName as Recipe

__all__ = [
    "Recipe",
    "Reconstruction",
    "build",
    "build_from_text",
    "export",
    "load",
    "open_library",
    "optimise",
    "render",
    "save",
]
