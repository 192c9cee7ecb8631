"""LLMDet, converted from a copy as `transformers` reads it: the same boxes, whatever the words."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch
import transformers
from tokenizers import Tokenizer, models, pre_tokenizers

from diorama_core.models.grounding import TOKENS, GroundingDino
from diorama_core.models.manifest import network
from diorama_core.models.runtime import NetworkError, SessionPool
from diorama_core.models.store import ModelStore
from diorama_core.pipeline import network_stages
from scripts import convert_llmdet

WORDS = {"[CLS]": 101, "[SEP]": 102, ".": 1012, "chair": 5, "table": 6, "coffee": 7, "lamp": 8, "sofa": 9, "[UNK]": 1}
SIDE = 224


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A tiny network with random weights, as its authors publish the large one."""
    torch.manual_seed(0)
    swin = {
        "model_type": "swin",
        "image_size": SIDE,
        "embed_dim": 12,
        "depths": [1, 1, 1, 1],
        "num_heads": [1, 2, 3, 4],
    }
    small = {"hidden_size": 16, "num_hidden_layers": 1, "num_attention_heads": 2, "intermediate_size": 16}
    config = transformers.MMGroundingDinoConfig(
        backbone_config={**swin, "window_size": 7, "out_features": ["stage2", "stage3", "stage4"]},
        text_config={"model_type": "bert", **small, "vocab_size": 1100, "max_position_embeddings": TOKENS},
        d_model=32,
        encoder_layers=1,
        decoder_layers=2,
        encoder_attention_heads=2,
        decoder_attention_heads=2,
        encoder_ffn_dim=16,
        decoder_ffn_dim=16,
        num_queries=20,
        max_text_len=TOKENS,
    )
    model = transformers.MMGroundingDinoForObjectDetection(config).eval()
    for parameter in model.parameters():
        if parameter.dim() > 1:
            torch.nn.init.normal_(parameter, std=0.2)
    folder = tmp_path_factory.mktemp("llmdet")
    model.save_pretrained(folder)
    tokenizer = Tokenizer(models.WordLevel(WORDS, unk_token="[UNK]"))
    tokenizer.pre_tokenizer = pre_tokenizers.Whitespace()
    tokenizer.save(str(folder / "tokenizer.json"))
    return folder


@pytest.fixture(scope="module")
def facade(copy: Path, tmp_path_factory: pytest.TempPathFactory) -> GroundingDino:
    script, target = convert_llmdet, tmp_path_factory.mktemp("graph") / "model.onnx"
    before = torch.linspace
    script.write_network(script.read_model(copy), target, SIDE)
    assert torch.linspace is before, "what was replaced for the export is back"
    return GroundingDino(target, copy / "tokenizer.json", pool=SessionPool())


def test_it_finds_the_same_boxes_for_words_that_it_was_not_traced_with(
    copy: Path, facade: GroundingDino, rng: np.random.Generator
) -> None:
    model = transformers.MMGroundingDinoForObjectDetection.from_pretrained(copy).eval()
    rgb = rng.integers(0, 255, (60, 80, 3)).astype(np.uint8)
    phrases = ["chair", "lamp", "sofa"]
    pixels, shown = facade.pixels(rgb, SIDE)
    assert shown.sum() == SIDE * SIDE * 60 // 80
    ids = torch.tensor([[101, 5, 1012, 8, 1012, 9, 1012, 102]])
    with torch.no_grad():
        out = model(
            pixel_values=torch.from_numpy(pixels),
            pixel_mask=torch.from_numpy(shown),
            input_ids=ids,
            attention_mask=torch.ones_like(ids),
            token_type_ids=torch.zeros_like(ids),
        )
    likely = out.logits[0].sigmoid()[:, [1, 3, 5]].numpy()
    threshold = float(np.median(likely.max(axis=1)))
    keep = np.flatnonzero(likely.max(axis=1) > threshold)
    order = keep[np.argsort(-likely.max(axis=1)[keep], kind="stable")]
    found = facade.detect(rgb, phrases, threshold)
    assert len(found) == len(order) > 0
    np.testing.assert_allclose(found.scores, likely.max(axis=1)[order], atol=1e-4)
    assert found.labels.tolist() == likely.argmax(axis=1)[order].tolist()
    centre, half = out.pred_boxes[0].numpy()[order, :2], out.pred_boxes[0].numpy()[order, 2:] / 2
    corners = np.concatenate([centre - half, centre + half], axis=1) * [80, 60, 80, 60]
    np.testing.assert_allclose(found.boxes, np.clip(corners, 0, [80, 60, 80, 60]), atol=0.01)


def test_many_phrases_are_asked_in_several_runs(facade: GroundingDino, rng: np.random.Generator) -> None:
    phrases = ["coffee table", "lamp"] * 60
    prompts = facade.prompts(phrases)
    assert len(prompts) == 2
    assert all(len(p.ids) <= TOKENS and p.ids[0] == 101 and p.ids[-2:] == (1012, 102) for p in prompts)
    assert [k for p in prompts for k in p.phrases] == list(range(120))
    for prompt in prompts:
        for index, span in zip(prompt.phrases, prompt.spans, strict=True):
            assert prompt.ids[span] == ((7, 6) if index % 2 == 0 else (8,))
    rgb = rng.integers(0, 255, (60, 80, 3)).astype(np.uint8)
    found = facade.detect(rgb, phrases, 0.0)
    assert len(found) == 2 * 20, "the queries of both runs"
    assert (np.diff(found.scores) <= 0).all()
    assert not len(facade.detect(rgb, (), 0.0))


def test_another_tokenizer_is_one_clear_line(facade: GroundingDino, tmp_path: Path) -> None:
    Tokenizer(models.WordLevel({"a": 0}, unk_token="a")).save(str(tmp_path / "tokenizer.json"))
    with pytest.raises(NetworkError, match="convert it again"):
        GroundingDino(facade.graph, tmp_path / "tokenizer.json", pool=SessionPool()).prompts(["chair"])


def test_a_copy_becomes_a_network_of_the_store(copy: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script = convert_llmdet
    monkeypatch.setattr(
        script, "write_network", lambda model, target: (target.parent.mkdir(parents=True), target.touch())
    )
    script.main([str(copy), "-o", str(tmp_path / "made")])
    store = ModelStore(tmp_path / "store")
    assert store.add_folder(tmp_path / "made") == ("llmdet-tiny",)
    stage = network_stages.detector(store, network("llmdet-tiny"))
    assert "GroundingDino" in repr(stage)
    assert "template='{}'" in repr(stage)


@pytest.mark.parametrize("damage", ["absent", "no weights"])
def test_a_copy_that_cannot_be_used_is_one_clear_line(copy: Path, tmp_path: Path, damage: str) -> None:
    folder = tmp_path / "copy"
    folder.mkdir()
    if damage == "no weights":
        for name in ("config.json", "tokenizer.json"):
            (folder / name).write_bytes((copy / name).read_bytes())
        (folder / "model.safetensors").write_bytes(b"no weights")
    with pytest.raises(SystemExit) as caught:
        convert_llmdet.main([str(folder), "-o", str(tmp_path / "made")])
    assert "\n" not in str(caught.value)
    assert str(folder) in str(caught.value)
