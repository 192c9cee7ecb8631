"""The profile of bodies of revolution from their outlines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.geometry.observed import observe
from diorama_core.library.catalogue import built_in_library
from diorama_core.pose.mask_observations import Evidence
from diorama_core.pose.turned_profile import fit_profile, is_revolution, profile_m
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.types import Pose
from tests.pose.rooms import camera_at

LIBRARY = built_in_library()
CAMERA = camera_at()
LARGE = 2.0
"""Vases as large as furniture, so that the picture shows enough of them."""


def seen(true_id: str, hidden_left: bool = False) -> tuple[Evidence, Pose]:
    """A large vase in the picture, its left half behind something if asked."""
    size = LARGE * np.array(LIBRARY.shape(true_id).size_m)
    pose = Pose(np.eye(3), np.array([0.0, 3.4, size[2] / 2]), np.full(3, LARGE))
    mask = MeshCaster([(LIBRARY.mesh(true_id), pose.matrix)]).buffers(CAMERA).instance == 0
    rows, columns = np.nonzero(mask)
    box = (float(columns.min()), float(rows.min()), float(columns.max() + 1), float(rows.max() + 1))
    before = np.zeros_like(mask)
    if hidden_left:
        before[:, : int((box[0] + box[2]) / 2)] = True
    window = observe(CAMERA, box, mask & ~before, 1.0, (before,), 56)
    return Evidence(CAMERA, window, None), pose


def as_large(shape_id: str, pose: Pose, true_id: str) -> Pose:
    """A shape in the place of another, filling its box."""
    return replace(pose, scale=LARGE * np.array(LIBRARY.shape(true_id).size_m) / LIBRARY.shape(shape_id).size_m)


@pytest.mark.parametrize("hidden_left", [False, True])
def test_a_cylinder_becomes_the_round_vase_that_is_seen(hidden_left: bool) -> None:
    true_id, found_id = "vase-moon-stone", "vase-cylinder-glass"
    evidence, pose = seen(true_id, hidden_left)
    found = fit_profile(LIBRARY, found_id, [evidence], [as_large(found_id, pose, true_id)], 0.4)
    assert found is not None
    assert found.error < 0.1
    shares = np.linspace(-0.4, 0.4, 9)
    true_m = LARGE * profile_m(LIBRARY.mesh(true_id), shares * LIBRARY.shape(true_id).size_m[2])
    made_m = profile_m(LIBRARY.mesh(found.shape_id), shares * found.size_m[2])
    assert made_m == pytest.approx(true_m, rel=0.12)


def test_what_agrees_as_well_as_it_is_keeps_its_profile() -> None:
    evidence, pose = seen("vase-moon-stone")
    assert fit_profile(LIBRARY, "vase-moon-stone", [evidence], [pose], 0.01) is None


def test_what_is_no_body_of_revolution_is_not_turned() -> None:
    evidence, pose = seen("vase-moon-stone")
    assert fit_profile(LIBRARY, "plant-olive", [evidence], [pose], 0.9) is None
    assert fit_profile(LIBRARY, "dresser-white-four", [evidence], [pose], 0.9) is None


@pytest.mark.parametrize(
    ("shape_id", "is_one"), [("vase-moon-stone", True), ("lamp-urn-blue", True), ("plant-olive", False)]
)
def test_sections_tell_bodies_of_revolution(shape_id: str, is_one: bool) -> None:
    assert is_revolution(LIBRARY.mesh(shape_id)) is is_one
