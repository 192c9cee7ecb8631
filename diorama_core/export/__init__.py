"""Scenes as files other programs open: one module per format over one shared gathering.

gathering.py    the scene reduced once: nodes, shared meshes and materials, camera, lights
formats.py      the table of formats; `export_scene` writes any of them
files.py        files and packages, whole or not at all
"""

from diorama_core.export.formats import FORMATS, Format, Writer, export_scene, format_named

__all__ = ["FORMATS", "Format", "Writer", "export_scene", "format_named"]
