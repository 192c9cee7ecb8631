"""Bodies of revolution with another girth along their height."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.errors import LibraryError
from diorama_core.library import furniture
from diorama_core.library.furniture.girth import KNOTS, NAME, cut
from diorama_core.library.furniture.measures import can_be_turned, is_turned, made_by_id, made_id, made_to_measure
from diorama_core.library.furniture.model import built, mesh_of
from diorama_core.library.furniture.solids import cylinder
from diorama_core.library.record import ROUND

DESIGNS = {d.id: d for d in furniture.designs()}
VASE = DESIGNS["vase-cylinder-glass"]
WAIST = tuple(int(v) for v in np.rint(100 - 50 * np.sin(np.linspace(0, np.pi, KNOTS))))


def test_a_cylinder_with_a_waist_is_half_as_wide_in_its_middle() -> None:
    made = made_to_measure(VASE, np.array(VASE.size_m), {NAME: WAIST})
    mesh = mesh_of(built(made))
    assert mesh.is_watertight
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx(VASE.size_m, abs=1e-6)
    middle = mesh.vertices[np.abs(mesh.vertices[:, 2]) < 0.01 * VASE.size_m[2]]
    assert np.hypot(*middle[:, :2].T).max() == pytest.approx(0.25 * VASE.size_m[0], rel=0.02)


def test_an_id_tells_the_girth_and_the_shape_stays_round() -> None:
    made = made_to_measure(VASE, np.array(VASE.size_m), {NAME: WAIST})
    assert is_turned(made.id)
    assert not is_turned(VASE.id)
    assert made_by_id(made.id, VASE) == made
    assert made.symmetry == ROUND


@pytest.mark.parametrize("girth", [(100,) * (KNOTS - 1), (5,) * KNOTS, (500,) * KNOTS])
def test_a_girth_that_cannot_be_is_refused(girth: tuple) -> None:
    with pytest.raises(LibraryError, match="girth"):
        made_id(VASE.id, np.array(VASE.size_m), {NAME: girth})
    with pytest.raises(LibraryError, match="girth"):
        made_by_id(f"{VASE.id}+made-140x140x280;girth=1,2,x", VASE)


def test_only_bodies_of_revolution_have_a_girth() -> None:
    dresser = DESIGNS["dresser-white-four"]
    assert can_be_turned(VASE.id)
    assert not can_be_turned(dresser.id)
    with pytest.raises(LibraryError, match="girth"):
        made_to_measure(dresser, np.array(dresser.size_m), {NAME: WAIST})


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
