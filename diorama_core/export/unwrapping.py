"""A second set of texture coordinates in which no two triangles overlap, for light that an engine bakes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from diorama_core.errors import UnavailableError
from diorama_core.render.appearance import Surface


def unwrap(surfaces: Sequence[Surface]) -> Iterator[Surface]:
    """The surfaces of one mesh with `light_uv`, all in one square from 0 to 1; vertices are split at seams.

    Raises:
        UnavailableError: xatlas is not installed.
    """
    try:
        import xatlas
    except ImportError as missing:
        raise UnavailableError("coordinates for baked light need xatlas: pip install 'diorama[game]'") from missing
    starts = np.cumsum([0, *(len(s.vertices) for s in surfaces)])
    faces = np.concatenate([s.faces + start for s, start in zip(surfaces, starts, strict=False)])
    positions = np.concatenate([s.vertices for s in surfaces])
    original, split, uv = xatlas.parametrize(positions, faces.astype(np.uint32))
    rows = np.split(split.astype(np.int64), np.cumsum([len(s.faces) for s in surfaces])[:-1])
    for surface, start, triangles in zip(surfaces, starts, rows, strict=False):
        used, corners = np.unique(triangles, return_inverse=True)
        vertices = original[used].astype(np.int64) - start
        yield replace(
            surface,
            vertices=surface.vertices[vertices],
            normals=surface.normals[vertices],
            faces=corners.reshape(-1, 3).astype(np.int32),
            uv=None if surface.uv is None else surface.uv[vertices],
            colours=None if surface.colours is None else surface.colours[vertices],
            light_uv=uv[used],
        )
