from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.export.sharing import (
    Labels,
    SharedAppearance,
    slug_of,
    unique_name,
    with_unit_normals,
    without_slivers,
)
from diorama_core.render.appearance import Material
from tests.export.surfaces import quad


def test_equal_materials_and_pictures_become_one() -> None:
    first, second = (np.full((4, 4, 3), 9, np.uint8) for _ in range(2))
    shared = SharedAppearance(None)
    (a,), (b,) = (shared.surfaces([quad(Material("oak", texture=p))]) for p in (first, second))
    assert a.material is b.material
    (other,) = shared.surfaces([quad(Material("oak", (0.1, 0.1, 0.1)))])
    assert [m.name for m in shared.materials] == ["oak", "oak 2"]
    assert other.material is shared.materials[1]


def test_slivers_go_and_lost_normals_come_from_a_face() -> None:
    surface = quad()
    with_sliver = replace(surface, faces=np.vstack([surface.faces, [[0, 1, 1]]]).astype(np.int32))
    np.testing.assert_array_equal(without_slivers(with_sliver).faces, surface.faces)
    lost = replace(surface, normals=surface.normals * np.array([[0], [2], [1], [1]], np.float32))
    np.testing.assert_allclose(with_unit_normals(lost).normals, surface.normals, atol=1e-6)


def test_slugs_are_identifiers() -> None:
    assert slug_of("night stand (2)") == "night_stand_2"
    assert slug_of("3 chairs").isidentifier()
    assert slug_of("—").isidentifier()


def test_names_differ_even_where_case_is_ignored() -> None:
    taken: set[str] = set()
    assert [unique_name(n, taken) for n in ("Lamp", "lamp", "LAMP")] == ["Lamp", "lamp 2", "LAMP 3"]
    labels = Labels()
    assert [labels.slug("a b"), labels.slug("a-b"), labels.key("a b")] == ["a_b", "a_b_2", "a_b"]
    assert labels.name("") == "object"
