from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.catalogue import BuiltInLibrary, built_in_library
from diorama_core.library.opening import OpenedShapes, can_open, open_parts


@pytest.fixture(scope="module")
def library() -> BuiltInLibrary:
    return built_in_library()


@pytest.fixture(scope="module")
def door(library: BuiltInLibrary) -> str:
    return next(s.id for s in library.in_category("door") if can_open(library, s.id))


def test_doors_open_and_sofas_do_not(library: BuiltInLibrary, door: str) -> None:
    sofa = library.in_category("sofa")[0].id
    assert not can_open(library, sofa)
    assert open_parts(library, sofa, 0.5) is library.parts(sofa)
    assert open_parts(library, door, 0.0) is library.parts(door)


def test_a_leaf_swings_about_its_hinge_and_the_frame_stays(library: BuiltInLibrary, door: str) -> None:
    closed, opened = library.parts(door).bounds, open_parts(library, door, 1.0).bounds
    assert np.ptp(opened, axis=0)[0] > np.ptp(closed, axis=0)[0] + 0.4, "the leaf stands in the room"
    np.testing.assert_allclose(np.ptp(opened, axis=0)[2], np.ptp(closed, axis=0)[2], atol=0.01)
    half = open_parts(library, door, 0.5).bounds
    assert np.ptp(closed, axis=0)[0] < np.ptp(half, axis=0)[0] < np.ptp(opened, axis=0)[0]
    assert OpenedShapes(library, 0.5).parts(door) is open_parts(library, door, 0.5), "made once"


def test_what_turns_keeps_its_form_in_a_stretched_shape(library: BuiltInLibrary, door: str) -> None:
    """Its area in the scaled shape is the same however far it stands open."""
    scale = (1.0, 1.6, 0.8)

    def area(share: float) -> float:
        mesh = open_parts(library, door, share, scale).to_geometry().copy()
        mesh.vertices = np.asarray(mesh.vertices) * scale
        return float(mesh.area)

    assert area(0.4) == pytest.approx(area(1.0), rel=1e-6)
