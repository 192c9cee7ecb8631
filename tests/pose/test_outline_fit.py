"""Poses a little off that are fitted to a rendered outline."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from diorama_core.artefacts import DepthMap
from diorama_core.geometry.observed import observe
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.pose.mask_observations import Evidence
from diorama_core.pose.outline_fit import COARSE, FINE, fit_pose
from diorama_core.pose.surface import measure_surface
from diorama_core.provenance import DepthSource
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.types import Pose, yaw_rotation
from tests.pose.rooms import LIBRARY, camera_at

CAMERA = camera_at()
SIZE = np.array(LIBRARY.shape("table").size_m)
TRUE = Pose.upright((0.2, 3.2, SIZE[2] / 2), np.deg2rad(-60.0))
CASTER = ShapeCaster(LIBRARY.mesh("table"))


def evidence(measured: bool, trust: float = 1.0, cells: int = 56) -> Evidence:
    seen = MeshCaster([(LIBRARY.mesh("table"), TRUE.matrix)]).buffers(CAMERA)
    mask = seen.instance == 0
    rows, columns = np.nonzero(mask)
    box = (float(columns.min()), float(rows.min()), float(columns.max() + 1), float(rows.max() + 1))
    window = observe(CAMERA, box, mask, trust, (), cells)
    depth = DepthMap(seen.depth_m, seen.normals_world, DepthSource.MEASURED if measured else DepthSource.RENDERED)
    return Evidence(CAMERA, window, measure_surface(depth, window, mask, 0.0))


def error_of(of: Evidence, pose: Pose) -> float:
    batch = PoseBatch(pose.R_world_object[None], pose.position[None], np.asarray(pose.scale)[None])
    return float(of.errors(CASTER, batch)[0])


def off() -> Pose:
    """Turned, moved aside and too long, its base where it was."""
    R = TRUE.R_world_object @ yaw_rotation(0.05)
    return Pose(R, TRUE.position + np.array([0.05, 0.0, 0.0]), np.array([1.0, 1.08, 1.0]))


@pytest.mark.parametrize("measured", [False, True])
def test_a_pose_a_little_off_comes_nearer(measured: bool) -> None:
    of = evidence(measured)
    found = fit_pose(of, CASTER, off(), SIZE, resize=True)
    assert error_of(of, found) < 0.5 * error_of(of, off())
    assert found.position[2] - 0.5 * SIZE[2] * found.scale[2] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("measured", [False, True])
def test_a_second_fit_to_finer_outlines_comes_nearer_still(measured: bool) -> None:
    fine = evidence(measured, cells=84)
    coarse = fit_pose(evidence(measured), CASTER, off(), SIZE, resize=True, near=COARSE)
    found = fit_pose(fine, CASTER, coarse, SIZE, resize=True, near=FINE)
    assert error_of(fine, found) < 0.9 * error_of(fine, coarse)


def test_one_of_a_set_keeps_its_size() -> None:
    found = fit_pose(evidence(True), CASTER, off(), SIZE, resize=False)
    assert found.scale == pytest.approx(off().scale)


def test_the_best_pose_and_doubtful_masks_move_nothing() -> None:
    best = fit_pose(evidence(True), CASTER, TRUE, SIZE, resize=True)
    assert np.abs(best.position - TRUE.position).max() < 0.02
    doubtful = evidence(False, trust=0.3)
    assert fit_pose(doubtful, CASTER, off(), SIZE, resize=True) == off()


@pytest.mark.parametrize("cut", [{"border_share": 0.5}, {"hidden_share": 0.95}])
def test_what_is_cut_or_hidden_keeps_its_size(cut: dict[str, float]) -> None:
    whole = evidence(False)
    partly = replace(whole, seen=replace(whole.seen, **cut))
    assert fit_pose(whole, CASTER, off(), SIZE, resize=True).scale[1] < 1.05
    found = fit_pose(partly, CASTER, off(), SIZE, resize=True)
    assert found.scale == pytest.approx(off().scale, rel=0.02)


def test_what_is_round_from_above_stays_round() -> None:
    size, drum = np.array([0.8, 0.8, 0.7]), trimesh.creation.cylinder(0.4, 0.7, sections=48)
    true = Pose.upright((0.2, 3.2, 0.35), 0.0)
    seen = MeshCaster([(drum, true.matrix)]).buffers(CAMERA)
    mask = seen.instance == 0
    rows, columns = np.nonzero(mask)
    box = (float(columns.min()), float(rows.min()), float(columns.max() + 1), float(rows.max() + 1))
    of = Evidence(CAMERA, observe(CAMERA, box, mask, 1.0, (), 56), None)
    small = Pose(true.R_world_object, true.position, np.array([0.85, 0.85, 1.0]))
    found = fit_pose(of, ShapeCaster(drum), small, size, resize=True)
    assert found.scale[0] == pytest.approx(found.scale[1])
    assert found.scale[0] == pytest.approx(1.0, abs=0.06)
