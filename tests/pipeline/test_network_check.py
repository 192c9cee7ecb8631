"""Networks on this machine are tried on a known photo: one that works passes, one that does not says why."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_app.projects.example import example_inputs
from diorama_core.models.manifest import NETWORKS, network
from diorama_core.models.store import ModelStore
from diorama_core.pipeline import network_check, network_stages
from diorama_core.pipeline.network_check import Measurement, check_networks
from tests.models import tiny_networks
from tests.models.tiny_networks import install


def test_every_role_has_a_trial() -> None:
    assert {n.role for n in NETWORKS} == set(network_check._TRIALS)


@pytest.mark.parametrize(("value", "ok"), [(1.0, True), (0.5, True), (2.01, False), (float("nan"), False)])
def test_a_measurement_is_within_its_range(value: float, ok: bool) -> None:
    measured = Measurement("size", value, (0.5, 2.0))
    assert measured.ok is ok
    assert "expected 0.5 to 2" in str(measured)


def test_the_real_detector_passes(shared: Path, tmp_path: Path) -> None:
    store = ModelStore(tmp_path)
    store.add_folder(shared / "models")
    (check,) = check_networks(store, example_inputs().inputs)
    assert check.ok, check.words
    assert check.network.id == "yolox-nano"
    assert check.words.startswith("boxes ")
    assert check.device == "cpu"


def test_the_large_detector_is_given_the_side_that_its_patches_need(tmp_path: Path) -> None:
    store = ModelStore(tmp_path / "store")
    graph = tiny_networks.migan(tmp_path / "model.onnx")
    for network_id in ("owlv2-large", "owlv2-base"):
        install(store, network_id, [graph, graph])
    sides = {i: repr(network_stages.detector(store, network(i))) for i in ("owlv2-large", "owlv2-base")}
    assert "side=1008" in sides["owlv2-large"]
    assert "side=960" in sides["owlv2-base"]


def test_a_network_of_another_kind_in_its_place_fails_with_one_line(tmp_path: Path) -> None:
    store = ModelStore(tmp_path / "store")
    graph = tiny_networks.migan(tmp_path / "model.onnx")
    depth = network("moge-2-vits")
    install(store, depth.id, [graph])
    (check,) = check_networks(store, example_inputs().inputs)
    assert not check.ok
    assert "\n" not in check.words
    assert np.isfinite(check.seconds)
