from __future__ import annotations

import numpy as np
import pytest
import trimesh

from diorama_core.importing.measured_types import MeasuredBox
from diorama_core.importing.scanned_shapes import ScannedSurface, unit_surface
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import yaw_rotation

LIBRARY = built_in_library()


def scanned(category: str, turn: float = 0.0, number: int = 1) -> MeasuredBox:
    """A shape of the library as a box with points of its surface, seen from above and from the sides."""
    shape = LIBRARY.in_category(category)[number]
    points = np.asarray(trimesh.sample.sample_surface(LIBRARY.mesh(shape.id), 3000, seed=3)[0])
    R, centre = yaw_rotation(turn), np.array([1.0, 2.0, shape.size_m[2] / 2])
    size = np.array(shape.size_m)
    return MeasuredBox("object", {}, R, centre, size, points=points @ R.T + centre)


@pytest.mark.parametrize(("category", "others"), [("chair", ("cabinet", "box")), ("table", ("cabinet", "bed"))])
def test_the_own_kind_is_nearest_to_the_points(category: str, others: tuple[str, ...]) -> None:
    surface = ScannedSurface.of(scanned(category, turn=0.7))
    own = surface.misfit_of_kind(category, LIBRARY)
    assert own is not None
    for other in others:
        misfit = surface.misfit_of_kind(other, LIBRARY)
        assert misfit is not None
        assert own < misfit - 0.01


def test_the_shape_itself_fits_in_its_own_turn() -> None:
    box = scanned("chair")
    misfits = ScannedSurface.of(box).misfits(LIBRARY.in_category("chair")[1], LIBRARY)
    assert int(np.argmin(misfits)) == 0
    assert misfits[0] < 0.04


def test_a_thin_thing_is_not_turned_across_its_box() -> None:
    seen = np.random.default_rng(0).uniform(-0.5, 0.5, (400, 3)) * [0.02, 0.54, 0.86]
    box = MeasuredBox("object", {}, np.eye(3), np.zeros(3), np.array([0.02, 0.54, 0.86]), points=seen)
    _, quarters = ScannedSurface.of(box).fits("picture", LIBRARY)
    assert quarters % 2 == 0
    across = MeasuredBox("object", {}, np.eye(3), np.zeros(3), np.array([0.54, 0.02, 0.86]), points=seen[:, [1, 0, 2]])
    _, quarters = ScannedSurface.of(across).fits("picture", LIBRARY)
    assert quarters % 2 == 1


def test_a_kind_without_shapes_says_nothing() -> None:
    assert ScannedSurface.of(scanned("chair")).misfit_of_kind("unicorn", LIBRARY) is None


def test_a_box_without_points_has_no_surface() -> None:
    with pytest.raises(ValueError, match="no points"):
        ScannedSurface.of(MeasuredBox("object", {}, np.eye(3), np.zeros(3), np.ones(3)))


def test_surfaces_fill_the_unit_box() -> None:
    points = unit_surface(LIBRARY.in_category("table")[0], LIBRARY)
    assert np.abs(points).max() == pytest.approx(0.5, abs=0.02)
