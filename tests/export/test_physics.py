from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.export.physics import (
    MAX_PRIOR_RATIO,
    MIN_MASS_KG,
    OTHER,
    SUBSTANCES,
    enclosed_m3,
    friction_of,
    material_mass_kg,
    plausible_mass_kg,
    substance_of,
)
from diorama_core.library.record import Shape
from diorama_core.render.appearance import Material
from tests.export.surfaces import ball, quad

BALL_M3 = 4 / 3 * np.pi * 0.1**3


@pytest.mark.parametrize(
    ("name", "kind"),
    [("Walnut veneer", "wood"), ("brushed STEEL", "steel"), ("leather 2", "leather"), ("mattress", "foam")],
)
def test_materials_are_known_by_their_names(name: str, kind: str) -> None:
    assert substance_of(Material(name, (1, 1, 1))).name == kind


def test_unnamed_materials_are_judged_by_their_looks() -> None:
    assert substance_of(Material("x", (1, 1, 1), alpha=0.4)).name == "glass"
    assert substance_of(Material("x", (1, 1, 1), metallic=1.0)).name == "steel"
    assert substance_of(Material("x", (1, 1, 1))) is OTHER


def test_only_closed_surfaces_enclose_a_volume() -> None:
    assert enclosed_m3(ball()) == pytest.approx(BALL_M3, rel=0.02)
    body = ball()
    assert enclosed_m3(replace(body, faces=body.faces[1:])) == 0.0
    assert enclosed_m3(replace(body, faces=body.faces[:, ::-1])) == 0.0
    assert enclosed_m3(quad()) == 0.0


def test_solid_things_weigh_their_volume_and_hollow_ones_their_walls() -> None:
    foam = ball(Material("foam", (1, 1, 1)))
    steel = ball(Material("steel", (1, 1, 1)))
    one = np.ones(3)
    assert material_mass_kg((foam,), one) == pytest.approx(40 * BALL_M3, rel=0.02)
    walls = 7800 * 4 * np.pi * 0.01 * 0.0012
    assert material_mass_kg((steel,), one) == pytest.approx(walls, rel=0.02)
    assert material_mass_kg((foam,), 2 * one) == pytest.approx(8 * 40 * BALL_M3, rel=0.02)
    assert material_mass_kg((foam, foam), one) == pytest.approx(2 * 40 * BALL_M3, rel=0.02)
    sheet = quad(Material("linen", (1, 1, 1)))
    assert material_mass_kg((sheet,), one) == pytest.approx(60 * 4 * 0.003)
    assert material_mass_kg((), one) == MIN_MASS_KG


def test_masses_stay_near_what_is_usual() -> None:
    known = Shape("s", "chair", "", (1, 1, 1), mass_kg=6.0)
    assert plausible_mass_kg(7.0, np.ones(3), known) == 7.0
    assert plausible_mass_kg(500.0, np.ones(3), known) == 6.0 * MAX_PRIOR_RATIO
    assert plausible_mass_kg(0.1, np.array([2.0, 1, 1]), known) == 12.0 / MAX_PRIOR_RATIO
    assert plausible_mass_kg(500.0, np.ones(3), replace(known, mass_kg=1.0)) == 500.0


def test_the_largest_material_slides() -> None:
    rubber, steel = ball(Material("rubber", (1, 1, 1)), 0.05), ball(Material("steel", (1, 1, 1)), 0.2)
    friction = {s.name: s.friction for s in SUBSTANCES}
    assert friction_of((rubber, steel)) == friction["steel"]
    assert friction_of((rubber,)) == friction["rubber"]
    assert friction_of(()) == OTHER.friction
