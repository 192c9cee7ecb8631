"""The correspondence solvers on rendered rooms with exact truth."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from diorama_core.artefacts import PosedCandidates, RankedShapes
from diorama_core.pose.correspondence.crops import crop_object, template_view
from diorama_core.pose.correspondence.features import GeometricFeatures
from diorama_core.pose.correspondence.solvers import KINDS, CorrespondencePose
from diorama_core.progress import Progress
from diorama_core.render.templates import TemplateGrid, render_templates
from tests.pose.rooms import LIBRARY, Room, camera_at, standing, yaw_error_deg

GRID = TemplateGrid(elevations_deg=(15.0, 30.0), azimuths=18, size_px=160)


@cache
def solver(kind: str) -> CorrespondencePose:
    return CorrespondencePose(LIBRARY, kind, grid=GRID)  # a parameter of the tests


def posed(room: Room, kind: str) -> tuple[PosedCandidates, ...]:
    return solver(kind).pose(room.inputs, room.objects, room.geometry, room.depth(True), room.ranked(), Progress())


def chairs() -> list[Room]:
    return [
        Room(camera_at(), (standing("chair", x, 2.6, yaw),), (0,)) for x, yaw in ((0, -60), (0.5, -100), (-0.5, 200))
    ]


@pytest.mark.parametrize("kind", KINDS)
def test_chairs_are_turned_and_placed(kind: str) -> None:
    errors, distances = [], []
    for room in chairs():
        best = posed(room, kind)[0].candidates[0]
        true = room.placed[0].pose
        errors.append(yaw_error_deg(best.pose, true, 1))
        distances.append(float(np.linalg.norm(best.pose.position - true.position)))
        assert best.pose.scale.min() == best.pose.scale.max()
    assert np.median(errors) < 21.0
    assert np.median(distances) < 0.35


def test_the_picture_of_a_view_finds_that_view() -> None:
    templates = render_templates(LIBRARY.mesh("chair"), GRID)
    view = template_view(templates)
    features = GeometricFeatures().encode(view)
    assert features.shape[:2] == (len(GRID), 256)
    same = np.einsum("pd,vpd->v", features[7], features)
    assert int(same.argmax()) == 7
    lengths = np.linalg.norm(features, axis=2)
    assert ((np.abs(lengths - 1) < 1e-4) | (lengths == 0)).all()


def test_the_crop_looks_straight_at_the_object() -> None:
    room = chairs()[1]
    item, depth = room.objects[0], room.depth(True)
    crop = crop_object(
        room.inputs.photo.rgb, item.mask, item.box, depth.depth_m, depth.normals_world, room.camera, GRID
    )
    rows, columns = np.nonzero(crop.view.mask[0])
    assert abs(0.5 * (rows.min() + rows.max()) - GRID.size_px / 2) < 8
    assert abs(0.5 * (columns.min() + columns.max()) - GRID.size_px / 2) < 8
    assert np.allclose(crop.R_camera_crop @ crop.R_camera_crop.T, np.eye(3), atol=1e-9)
    known = crop.points_camera[np.isfinite(crop.points_camera).all(axis=1)]
    local = (known - room.camera.to_camera(room.placed[0].pose.position)).astype(float)
    assert np.linalg.norm(local, axis=1).max() < 0.9


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("kind_of_mask", ["empty", "one pixel", "everything"])
def test_useless_masks_are_survived(kind: str, kind_of_mask: str) -> None:
    room = chairs()[0]
    mask = np.full_like(room.objects[0].mask, kind_of_mask == "everything")
    mask[100, 200] |= kind_of_mask == "one pixel"
    objects = tuple(replace(o, mask=mask) for o in room.objects)
    found = solver(kind).pose(room.inputs, objects, room.geometry, room.depth(True), room.ranked(), Progress())
    for item in found:
        for candidate in item.candidates:
            assert np.isfinite(candidate.pose.matrix).all()
            assert 0.0 <= candidate.score <= 1.0


def test_degenerate_shapes_are_survived() -> None:
    room = chairs()[0]
    ranked = (RankedShapes("o0", (("triangle", 1.0), ("round table", 0.5))),)
    for kind in KINDS:
        found = solver(kind).pose(room.inputs, room.objects, room.geometry, room.depth(True), ranked, Progress())
        assert all(np.isfinite(c.pose.matrix).all() for f in found for c in f.candidates)


def test_the_same_input_gives_the_same_poses() -> None:
    room = chairs()[2]
    first, second = posed(room, "correspondence"), posed(room, "correspondence")
    assert all(
        np.array_equal(a.pose.matrix, b.pose.matrix)
        for a, b in zip(first[0].candidates, second[0].candidates, strict=True)
    )
