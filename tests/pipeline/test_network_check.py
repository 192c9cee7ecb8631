"""Networks on this machine are tried on a known photo: one that works passes, one that does not says why."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

from diorama_app.projects.example import example_inputs
from diorama_core.models.manifest import NETWORKS, network
from diorama_core.models.store import ModelStore
from diorama_core.pipeline import network_check, network_stages
from diorama_core.pipeline.network_check import Measurement, check_networks, delete_failing_networks
from tests.models import small_graphs, tiny_networks
from tests.models.tiny_networks import install


def test_every_role_has_a_trial() -> None:
    assert {n.role for n in NETWORKS} == set(network_check._TRIALS)


@pytest.mark.parametrize(("value", "ok"), [(1.0, True), (0.5, True), (2.01, False), (float("nan"), False)])
def test_a_measurement_is_within_its_range(value: float, ok: bool) -> None:
    measured = Measurement("size", value, (0.5, 2.0))
    assert measured.ok is ok
    assert "expected 0.5 to 2" in str(measured)
    assert "(expected at least 1)" in str(Measurement("objects", value, (1, np.inf)))


def test_the_real_networks_pass(shared: Path, tmp_path: Path) -> None:
    store = ModelStore(tmp_path)
    store.add_folder(shared / "models")
    detector, depth = check_networks(store, example_inputs().inputs)
    assert (detector.network.id, depth.network.id) == ("yolox-nano", "fast-depth")
    assert detector.ok, detector.words
    assert "known objects found" in detector.words
    assert detector.device == "cpu"
    assert depth.ok, depth.words
    assert "median depth" in depth.words


def test_the_large_detector_is_given_the_side_that_its_patches_need(tmp_path: Path) -> None:
    store = ModelStore(tmp_path / "store")
    graph = tiny_networks.migan(tmp_path / "model.onnx")
    for network_id in ("owlv2-large", "owlv2-base"):
        install(store, network_id, [graph, graph])
    sides = {i: repr(network_stages.detector(store, network(i))) for i in ("owlv2-large", "owlv2-base")}
    assert "side=1008" in sides["owlv2-large"]
    assert "side=960" in sides["owlv2-base"]


PICTURE = {"image": ("f", 4)}


def _segmenter(folder: Path, share: float) -> list[Path]:
    """Masks of stripes that fill a share of everything, whatever the box."""
    stripes = np.where(np.arange(256) % 10 < 10 * share, 2.0, -2.0)
    features = {"image_embeddings": np.ones((1, 8, 4, 4)), "interm_embeddings.0": np.ones((1, 4, 4, 8))}
    masks = {"iou_predictions": np.full((1, 1), 0.9), "low_res_masks": np.broadcast_to(stripes, (1, 1, 256, 256))}
    return [
        _answering(folder / "e.onnx", {"input_image": ("f", 3)}, features),
        _answering(folder / "d.onnx", small_graphs.HQ_SAM, masks),
    ]


def _depth(folder: Path, canonical: float) -> list[Path]:
    outputs = {"depth": np.full((1, 1, 504, 504), canonical), "sky": np.zeros((1, 1, 504, 504))}
    return [_answering(folder / "m.onnx", PICTURE, outputs)]


def _foreground(folder: Path, rows: float) -> list[Path]:
    logits = np.full((1, 1, 1024, 1024), -5.0)
    logits[:, :, : int(rows)] = 5.0
    return [_answering(folder / "m.onnx", {"input_image": ("f", 4)}, {"output_image": logits})]


def _inpainter(folder: Path, grey: float) -> list[Path]:
    return [_answering(folder / "m.onnx", {**PICTURE, "mask": ("f", 4)}, {"output": np.full((1, 3, 512, 512), grey)})]


def _features(folder: Path, spread: float) -> list[Path]:
    patches = np.random.default_rng(0).normal(0.0, spread, (1, 257, 8))
    return [_answering(folder / "m.onnx", {"pixel_values": ("f", 4)}, {"last_hidden_state": patches})]


def _pose_scale(folder: Path, scale: float) -> list[Path]:
    turns = {"scale": np.full((3, 1), scale), "inplane": np.tile([1.0, 0.0], (3, 1))}
    maps = {"features": np.ones((1, 4, 16, 16))}
    return [_answering(folder / "f.onnx", PICTURE, maps), _answering(folder / "r.onnx", {"pairs": ("f", 2)}, turns)]


def _answering(path: Path, inputs: Mapping[str, tuple[str, int]], outputs: Mapping[str, np.ndarray]) -> Path:
    return small_graphs.constants(path, inputs, {name: value.astype(np.float32) for name, value in outputs.items()})


@pytest.mark.parametrize(
    ("network_id", "made", "right", "wrong", "measured"),
    [
        ("hq-sam-base", _segmenter, 0.6, 0.0, "share of a box within its mask"),
        ("hq-sam-base", _segmenter, 0.6, 1.0, "share of a box within its mask"),
        ("da3-metric-large", _depth, 2.0, 200.0, "median depth"),
        ("birefnet-lite", _foreground, 300, 1024, "share of foreground"),
        ("lama", _inpainter, 170.0, 0.0, "difference of a filled hole"),
        ("dinov2-small", _features, 1.0, 0.0, "spread of the features"),
        ("gigapose-scale", _pose_scale, 1.0, 10.0, "scale of a crop against itself"),
    ],
)
def test_an_answer_out_of_range_fails_and_says_which(
    network_id: str,
    made: Callable[[Path, float], list[Path]],
    right: float,
    wrong: float,
    measured: str,
    tmp_path: Path,
) -> None:
    for answer in (right, wrong):
        store = ModelStore(tmp_path / str(answer))
        install(store, network_id, made(tmp_path, answer))
        (check,) = check_networks(store, example_inputs().inputs)
        assert check.ok is (answer == right), check.words
        assert measured in check.words
        assert "expected" in check.words


def test_a_network_that_ignores_words_and_pictures_fails(tmp_path: Path) -> None:
    store = ModelStore(tmp_path / "store")
    vector = {"embeds": np.ones((1, 512))}
    text = _answering(tmp_path / "t.onnx", {"input_ids": ("i", 2)}, vector)
    image = _answering(tmp_path / "i.onnx", {"pixel_values": ("f", 4)}, vector)
    install(store, "openclip-b32", [text, tiny_networks.clip_tokenizer(tmp_path / "tokenizer.json"), image])
    (check,) = check_networks(store, example_inputs().inputs)
    assert not check.ok
    assert "right words over wrong ones 0 " in check.words


def test_a_network_of_another_kind_in_its_place_fails_with_one_line(tmp_path: Path) -> None:
    store = ModelStore(tmp_path / "store")
    graph = tiny_networks.migan(tmp_path / "model.onnx")
    depth = network("moge-2-vits")
    install(store, depth.id, [graph])
    (check,) = check_networks(store, example_inputs().inputs)
    assert not check.ok
    assert "\n" not in check.words
    assert np.isfinite(check.seconds)


def test_what_arrives_without_a_checksum_and_does_not_work_is_deleted(tmp_path: Path) -> None:
    """A network of the same role with other graphs, taken for HQ-SAM; and one that answers as it should."""
    store = ModelStore(tmp_path / "store")
    encoder, _ = _segmenter(tmp_path, 0.6)
    plain = {name: kind for name, kind in small_graphs.HQ_SAM.items() if name != "interm_embeddings"}
    masks = {"iou_predictions": np.full((1, 1), 0.9), "low_res_masks": np.full((1, 1, 256, 256), 2.0)}
    install(store, "hq-sam-base", [encoder, _answering(tmp_path / "other.onnx", plain, masks)])
    (check,) = delete_failing_networks(store, ("hq-sam-base",), example_inputs().inputs)
    assert "inputs" in check.words
    assert not store.has(network("hq-sam-base"))
    install(store, "hq-sam-base", _segmenter(tmp_path, 0.6))
    assert delete_failing_networks(store, ("hq-sam-base", "birefnet"), example_inputs().inputs) == ()
    assert store.has(network("hq-sam-base"))
