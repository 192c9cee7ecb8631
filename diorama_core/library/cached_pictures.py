"""Shapes with materials whose pictures are painted once and then lie on disk: painting is most of making a shape."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Iterable
from dataclasses import replace
from functools import cache, lru_cache
from pathlib import Path

import trimesh
from PIL import Image

from diorama_core.io.derived import derived
from diorama_core.library.furniture.geometry_key import code_key
from diorama_core.library.furniture.materials import Material, picture_bytes
from diorama_core.library.furniture.model import scene_of
from diorama_core.library.furniture.roles import with_roles
from diorama_core.library.furniture.solids import Solid

PAINTED_AT_ONCE = "plain"
"""Pictures of this kind are of one colour: nothing is gained by caching them."""
_ENDS = (b"\xff\xd9", b"IEND\xaeB`\x82")
"""Last bytes of whole JPEG and PNG files."""


def scene_with_pictures(solids: Iterable[tuple[Material, Solid]], folder: Path) -> trimesh.Scene:
    """`scene_of` with roles, the materials' pictures from their files in a folder.

    Args:
        solids: One for each material.
        folder: Where pictures are cached; without access to it they are painted each time.
    """
    solids = list(solids)
    unpainted = [(replace(material, kind=PAINTED_AT_ONCE), solid) for material, solid in solids]
    scene = with_roles(scene_of(unpainted), [material for material, _ in solids])
    for mesh, (material, _) in zip(scene.geometry.values(), solids, strict=True):
        if material.kind != PAINTED_AT_ONCE:
            picture = Image.open(io.BytesIO(cached_picture(material, folder)), formats=("JPEG", "PNG"))
            picture.load()  # as in `with_roles`
            mesh.visual.material.baseColorTexture = picture
    return scene


@lru_cache(maxsize=512)
def cached_picture(material: Material, folder: Path) -> bytes:
    """`picture_bytes` from its file, which is renewed with the material and the code that paints."""
    name = hashlib.sha256(f"{_code()} {material.name} {material.kind} {material.colour}".encode()).hexdigest()[:32]
    return derived(folder / f"{name}.jpg", lambda: picture_bytes(material), _whole)


@cache
def _code() -> str:
    return code_key(picture_bytes)


def _whole(data: bytes) -> bytes:
    if not data.endswith(_ENDS):
        raise ValueError("the picture is cut off")
    return data
