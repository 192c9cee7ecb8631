from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.walls.ceilings import ceiling_height, find_ceilings
from tests.architecture.known_rooms import known_room
from tests.architecture.walls.measured_room import surface_of
from tests.synthetic_rooms import box_room, look, shoot


def upward(pitch_deg: float = -15.0, top: float = 2.6, noise: float = 0.0):
    return surface_of(shoot(look(0, pitch_deg, 1.5, 75, (320, 240)), box_room(-2.0, 2.0, 4.0, top), noise=noise))


@pytest.mark.parametrize(("top", "noise"), [(2.3, 0.0), (2.6, 0.01), (3.4, 0.0)])
def test_a_level_ceiling_is_found_at_its_height(top: float, noise: float) -> None:
    surface = upward(top=top, noise=noise)
    (piece,) = find_ceilings(surface)
    assert piece.is_flat
    assert -piece.offset == pytest.approx(top, abs=0.03)
    assert ceiling_height(surface) == pytest.approx(top, abs=0.03)


def test_none_in_view_is_none() -> None:
    surface = upward(25.0)
    assert find_ceilings(surface) == ()
    assert ceiling_height(surface) is None


def test_points_that_are_explained_otherwise_do_not_count() -> None:
    surface = upward()
    assert ceiling_height(surface, without=surface.points[:, 2] > 2.5) is None


@pytest.mark.parametrize("kind", ["sloped", "gable"])
def test_slopes_are_found_as_they_are(kind: str) -> None:
    planes, camera = known_room(kind, 1)
    true = [p for p in planes if p.id.startswith("ceiling") and abs(p.normal[2]) < 0.99]
    slopes = [c for c in find_ceilings(surface_of(shoot(camera, planes))) if not c.is_flat]
    assert slopes
    for piece in slopes:
        best = max(true, key=lambda p: p.normal @ piece.normal)
        assert np.rad2deg(np.arccos(min(best.normal @ piece.normal, 1.0))) < 4.0
        assert piece.offset == pytest.approx(best.offset, abs=0.08)
    assert [s.area_m2 for s in slopes] == sorted((s.area_m2 for s in slopes), reverse=True)
