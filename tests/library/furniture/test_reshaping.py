"""Forms changed as a whole: another girth along the height, left and right changed."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from diorama_core.errors import LibraryError
from diorama_core.library import furniture
from diorama_core.library.furniture.articulation import articulation
from diorama_core.library.furniture.cutting import cut
from diorama_core.library.furniture.measures import can_be_turned, is_turned, made_by_id, made_id, made_to_measure
from diorama_core.library.furniture.model import built, mesh_of
from diorama_core.library.furniture.reshaping import GIRTH, KNOTS, MIRRORED
from diorama_core.library.furniture.solids import cylinder
from diorama_core.library.record import ROUND
from tests.library.furniture.test_joints import posed

DESIGNS = {d.id: d for d in furniture.designs()}
VASE = DESIGNS["vase-cylinder-glass"]
WAIST = tuple(int(v) for v in np.rint(100 - 50 * np.sin(np.linspace(0, np.pi, KNOTS))))


def test_a_cylinder_with_a_waist_is_half_as_wide_in_its_middle() -> None:
    made = made_to_measure(VASE, np.array(VASE.size_m), {GIRTH: WAIST})
    mesh = mesh_of(built(made))
    assert mesh.is_watertight
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx(VASE.size_m, abs=1e-6)
    middle = mesh.vertices[np.abs(mesh.vertices[:, 2]) < 0.01 * VASE.size_m[2]]
    assert np.hypot(*middle[:, :2].T).max() == pytest.approx(0.25 * VASE.size_m[0], rel=0.02)


def test_an_id_tells_the_girth_and_the_shape_stays_round() -> None:
    made = made_to_measure(VASE, np.array(VASE.size_m), {GIRTH: WAIST})
    assert is_turned(made.id)
    assert not is_turned(VASE.id)
    assert made_by_id(made.id, VASE) == made
    assert made.symmetry == ROUND


@pytest.mark.parametrize("girth", [(100,) * (KNOTS - 1), (5,) * KNOTS, (500,) * KNOTS])
def test_a_girth_that_cannot_be_is_refused(girth: tuple) -> None:
    with pytest.raises(LibraryError, match="girth"):
        made_id(VASE.id, np.array(VASE.size_m), {GIRTH: girth})
    with pytest.raises(LibraryError, match="girth"):
        made_by_id(f"{VASE.id}+made-140x140x280;girth=1,2,x", VASE)


def test_only_bodies_of_revolution_have_a_girth() -> None:
    dresser = DESIGNS["dresser-white-four"]
    assert can_be_turned(VASE.id)
    assert not can_be_turned(dresser.id)
    with pytest.raises(LibraryError, match="girth"):
        made_to_measure(dresser, np.array(dresser.size_m), {GIRTH: WAIST})


@pytest.mark.parametrize("height", [0.1, 0.33, 1.0])
def test_a_solid_that_is_cut_is_the_same_solid(height: float) -> None:
    whole = cylinder(0.3, 1.0)
    split = cut(whole, height)
    z = split.vertices[:, 2][split.faces]
    assert not ((z.min(axis=1) < height - 1e-5) & (z.max(axis=1) > height + 1e-5)).any()

    def volume(solid) -> float:
        a, b, c = (solid.vertices[solid.faces[:, k]] for k in range(3))
        return float((a * np.cross(b, c)).sum() / 6)

    assert volume(split) == pytest.approx(volume(whole), rel=1e-9)


def test_a_mirror_image_is_the_form_seen_in_a_mirror() -> None:
    desk = DESIGNS["desk-office-grey"]
    made = made_to_measure(desk, np.array(desk.size_m), {MIRRORED: True})
    assert made.id.endswith(";mirrored=yes")
    assert made_by_id(made.id, desk) == made
    own, image = mesh_of(built(desk)), mesh_of(built(made))
    assert image.volume == pytest.approx(own.volume)
    assert image.volume > 0, "its faces look outward"
    flipped = np.asarray(own.vertices) * (1.0, -1.0, 1.0)
    assert cKDTree(image.vertices).query(flipped)[0].max() < 1e-6
    assert cKDTree(image.vertices).query(own.vertices)[0].max() > 0.05


def test_what_looks_the_same_from_all_around_has_no_mirror_image() -> None:
    with pytest.raises(LibraryError, match="mirrored"):
        made_to_measure(VASE, np.array(VASE.size_m), {MIRRORED: True})
    with pytest.raises(LibraryError, match="mirrored"):
        made_by_id("desk-office-grey+made-750x1500x740;mirrored=no", DESIGNS["desk-office-grey"])


def test_doors_and_drawers_of_a_mirror_image_open_as_they_did() -> None:
    wardrobe = next(d for d in furniture.designs() if d.category == "wardrobe" and articulation(d.id) is not None)
    made = made_id(wardrobe.id, np.array(wardrobe.size_m), {MIRRORED: True})
    own, image = articulation(wardrobe.id), articulation(made)
    assert own is not None
    assert image is not None
    flip = np.diag([1.0, -1.0, 1.0, 1.0])
    for a, b in zip(own.joints, image.joints, strict=True):
        assert (a.kind, a.lower, a.upper) == (b.kind, b.lower, b.upper)
        np.testing.assert_allclose(posed(b, 1.0), flip @ posed(a, 1.0) @ flip, atol=1e-6)
