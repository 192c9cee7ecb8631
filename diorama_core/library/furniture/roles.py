"""What the built-in materials are in a person's words, for materials from photos (`library.slots`)."""

from __future__ import annotations

from collections.abc import Iterable

import trimesh

from diorama_core.library.furniture.materials import Material
from diorama_core.library.slots import ROLE, TILE_M, Role

METAL = 0.2
"""Materials of at least this metalness are metals."""
ROLE_OF_KIND: dict[str, Role] = {
    "wood": "wood", "wicker": "wicker", "leather": "leather", "brushed": "metal", "leaf": "leaf",
    **dict.fromkeys(("weave", "velvet", "boucle", "plaid", "knit", "terry", "shag", "herringbone", "check"), "fabric"),
    **dict.fromkeys(("persian", "kilim", "stripes", "diamonds", "medallion"), "fabric"),
    **dict.fromkeys(("clay", "marble", "speckle", "brick", "tiles"), "stone"),
    **dict.fromkeys(("paper", "pages", "cork"), "paper"),
    **dict.fromkeys(("dial", "roman dial", "digits"), "dial"),
    "screen": "screen", "mirror": "mirror", "sky": "pane",
    **dict.fromkeys(("hills", "abstract", "botanic", "waves", "arches", "sun", "field", "ridges", "blocks"), "picture"),
    **dict.fromkeys(("strokes", "skyline", "vessels", "fern", "portrait", "map"), "picture"),
}  # fmt: skip
"""By kind; plain ones are told apart by their opacity and metalness."""


def role(material: Material) -> Role:
    """The role of a built-in material."""
    if material.kind in ("plain", "mesh"):
        return "glass" if material.alpha < 1 else "metal" if material.metallic >= METAL else "paint"
    return ROLE_OF_KIND[material.kind]


def with_roles(scene: trimesh.Scene, materials: Iterable[Material]) -> trimesh.Scene:
    """The scene of a design with roles noted on its meshes, one material for each in their order.

    Pictures are decoded: shapes are shared between threads, which must not decode one at the same time.
    """
    for mesh, material in zip(scene.geometry.values(), materials, strict=True):
        mesh.metadata |= {ROLE: role(material), TILE_M: material.tile_m}
        mesh.visual.material.baseColorTexture.load()
    return scene
