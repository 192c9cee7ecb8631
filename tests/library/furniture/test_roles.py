from __future__ import annotations

from diorama_core.library import furniture
from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.prints import PRINTS
from diorama_core.library.furniture.roles import ROLE_OF_KIND, role
from diorama_core.library.furniture.textures import PAINTERS


def test_every_kind_of_material_has_a_role() -> None:
    assert set(PAINTERS) | set(PRINTS) == set(ROLE_OF_KIND) | {"plain", "mesh"}


def test_plain_materials_are_told_apart() -> None:
    assert [role(x) for x in (m.WHITE, m.CHROME, m.GLASS)] == ["paint", "metal", "glass"]
    assert [role(x) for x in (m.OAK, m.LINEN, m.TAN_LEATHER, m.SCREEN)] == ["wood", "fabric", "leather", "screen"]


def test_materials_of_designs_have_roles() -> None:
    some = furniture.designs()[::60]
    assert all(role(p.material) for d in some for p in d.build(d.size_m))
