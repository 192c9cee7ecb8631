"""Correspondences by DINOv2's patches and the scale network, with tiny networks of the real ones' signatures."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.models.features import Dinov2
from diorama_core.models.gigapose import PatchTurns
from diorama_core.models.runtime import SessionPool
from diorama_core.pose.correspondence.crops import crop_object, template_view
from diorama_core.pose.correspondence.features import EncodedViews, NetworkFeatures
from diorama_core.pose.correspondence.rigid import from_matches, from_one_match
from diorama_core.pose.correspondence.solvers import CorrespondencePose
from diorama_core.progress import Progress
from diorama_core.render.templates import TemplateGrid, render_templates
from tests.models import tiny_networks
from tests.pose.correspondence.test_solvers import chairs
from tests.pose.rooms import LIBRARY

GRID = TemplateGrid(elevations_deg=(15.0,), azimuths=9, size_px=112)


@pytest.fixture(scope="module")
def features(tmp_path_factory: pytest.TempPathFactory) -> NetworkFeatures:
    _, graph = tiny_networks.dinov2(tmp_path_factory.mktemp("dino") / "model.onnx")
    return NetworkFeatures(Dinov2(graph, "tiny", pool=SessionPool()))


def test_patches_are_the_networks_of_unit_length(features: NetworkFeatures) -> None:
    view = template_view(render_templates(LIBRARY.mesh("chair"), GRID))
    found = features.encode(view)
    assert found.shape == (len(GRID), 256, 24)
    inside = view.patch_cover > 0
    assert np.allclose(np.linalg.norm(found[inside], axis=-1), 1.0, atol=1e-5)
    assert (found[~inside] == 0).all()
    own = features.network.patches(np.repeat(view.gray[3][..., None], 3, axis=-1)).reshape(256, -1)
    at = np.flatnonzero(view.foreground[3])[5]
    assert np.allclose(found[3, at], own[at] / np.linalg.norm(own[at]), atol=1e-4)


def test_features_of_views_are_retained_by_content_and_weights(features: NetworkFeatures, tmp_path: Path) -> None:
    templates = render_templates(LIBRARY.mesh("chair"), GRID)
    view = template_view(templates)
    first = EncodedViews.of(templates, view, features, "abc", tmp_path)
    assert len(list(tmp_path.iterdir())) == 1
    unused = NetworkFeatures(replace(features.network, graph=tmp_path / "not there.onnx"))
    again = EncodedViews.of(templates, view, unused, "abc", tmp_path)
    assert (again.features == EncodedViews.of(templates, view, unused, "abc", tmp_path).features).all()
    inside = view.foreground
    assert np.allclose(again.features[inside], first.features[inside], atol=1e-3)
    next(tmp_path.iterdir()).write_bytes(b"half")
    mended = EncodedViews.of(templates, view, features, "abc", tmp_path)
    assert np.allclose(mended.features[inside], first.features[inside], atol=1e-3)


def test_the_stage_runs_on_network_features(features: NetworkFeatures) -> None:
    room = chairs()[1]
    stage = CorrespondencePose(LIBRARY, features=features, grid=GRID)
    found = stage.pose(room.inputs, room.objects, room.geometry, room.depth(True), room.ranked(), Progress())
    assert found
    assert np.isfinite(found[0].candidates[0].pose.matrix).all()
    assert "tiny" in repr(stage)


@dataclass(frozen=True)
class _Turner:
    """Stands for the scale network: says the same of every pair, and remembers what it was shown."""

    scale: float
    angle_rad: float

    def maps(self, crops):
        assert [c.shape[-1] for c in crops] == [3, 3]
        return np.stack([np.full((4, 16, 16), c.mean(), np.float32) for c in crops])

    def turns(self, template, photo, template_cells, photo_cells):
        assert template_cells.shape == photo_cells.shape == (1, 2)
        return PatchTurns(np.array([self.scale]), np.array([self.angle_rad]))


def test_the_scale_network_says_how_large_and_how_far_turned() -> None:
    room = chairs()[1]
    stage = CorrespondencePose(LIBRARY, grid=GRID)
    item, depth = room.objects[0], room.depth(True)
    crop = crop_object(
        room.inputs.photo.rgb, item.mask, item.box, depth.depth_m, depth.normals_world, room.camera, GRID
    )
    compared = stage.compare(crop, [LIBRARY.shape("chair")])[0]
    view = int(compared.ranked_views[0])
    one, double = (from_one_match(compared, view, _Turner(s, 0.0)) for s in (1.0, 2.0))
    turned = from_one_match(compared, view, _Turner(1.0, 0.5))
    assert double.scale == pytest.approx(2 * one.scale)
    assert np.arccos((np.trace(turned.R.T @ one.R) - 1) / 2) == pytest.approx(0.5)
    # Beside RANSAC it is taken only where more matches agree with it.
    plain = from_matches(compared, compared.ranked_views[:5])
    absurd = from_matches(compared, compared.ranked_views[:5], _Turner(40.0, 2.0))
    assert absurd.scale == pytest.approx(plain.scale)
