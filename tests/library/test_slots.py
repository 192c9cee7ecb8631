from __future__ import annotations

import numpy as np
import pytest
import trimesh
from trimesh.visual.material import PBRMaterial

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.slots import match, rectangle_of, slots_of
from diorama_core.scene.types import PhotoMaterial


def box(size: tuple[float, float, float], name: str, **values: object) -> trimesh.Trimesh:
    mesh = trimesh.creation.box(size)
    mesh.visual = trimesh.visual.TextureVisuals(material=PBRMaterial(name=name, **values))
    return mesh


def material(slot: str, *, main: bool = False) -> PhotoMaterial:
    return PhotoMaterial(slot, (0.5, 0.5, 0.5), main=main)


def test_slots_are_named_by_role_and_rank() -> None:
    parts = trimesh.Scene(
        {
            "foot": box((0.1, 0.1, 0.1), "dark oak"),
            "frame": box((0.5, 0.5, 0.5), "walnut"),
            "seat": box((1, 1, 1), "grey cloth"),
            "knob": box((0.05, 0.05, 0.05), "x", metallicFactor=1.0),
        }
    )
    slots = slots_of(parts)
    assert [s.name for s in slots] == ["fabric", "wood", "wood 2", "metal"]
    assert [s.main for s in slots] == [True, False, False, False]


def test_every_built_in_shape_has_slots_of_known_roles() -> None:
    for shape_id, roles in (
        ("picture-hills-oak", {"wood", "paint", "picture"}),
        ("television-feet", {"paint", "screen"}),
    ):
        assert {s.role for s in slots_of(built_in_library().parts(shape_id))} == roles


def test_materials_go_to_their_slot_main_to_main_and_role_to_role() -> None:
    parts = trimesh.Scene({"seat": box((1, 1, 1), "brown leather"), "legs": box((0.5, 0.5, 0.5), "steel")})
    found = match(slots_of(parts), [material("fabric", main=True), material("wood"), material("metal 2")])
    assert {slot: m.main for slot, m in found.items()} == {"leather": True}
    found = match(slots_of(parts), [material("fabric", main=True), material("metal")])
    assert set(found) == {"leather", "metal"}


def test_a_picture_lies_on_the_front_of_its_slot() -> None:
    parts = trimesh.Scene({"art": box((0.02, 0.8, 0.6), "painting")})
    rectangle = rectangle_of(parts, slots_of(parts)[0], "front")
    top_left, top_right, _, bottom_left = rectangle.corners
    np.testing.assert_allclose(top_left, [0.01, -0.4, 0.3])
    np.testing.assert_allclose(top_right, [0.01, 0.4, 0.3])
    np.testing.assert_allclose(bottom_left, [0.01, -0.4, -0.3])
    np.testing.assert_allclose(rectangle.uv(np.array([top_left, bottom_left])), [[0, 1], [0, 0]], atol=1e-12)


def test_a_leaning_picture_is_measured_in_its_own_plane() -> None:
    lean = np.radians(20)
    art = box((0.02, 0.8, 0.6), "painting")
    art.apply_transform(trimesh.transformations.rotation_matrix(-lean, [0, 1, 0]))
    rectangle = rectangle_of(trimesh.Scene({"art": art}), slots_of(trimesh.Scene({"art": art}))[0], "front")
    assert np.linalg.norm(rectangle.up) == pytest.approx(0.6, abs=1e-6)
    assert np.linalg.norm(rectangle.across) == pytest.approx(0.8, abs=1e-6)


def test_a_rug_is_seen_from_above_its_far_side_on_top() -> None:
    parts = trimesh.Scene({"pile": box((2.0, 1.4, 0.02), "carpet")})
    top_left = rectangle_of(parts, slots_of(parts)[0], "top").corners[0]
    np.testing.assert_allclose(top_left, [-1.0, -0.7, 0.01])
