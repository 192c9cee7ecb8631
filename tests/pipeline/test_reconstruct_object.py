"""One object looked at again uses the stages that the scene was built with."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.models.store import ModelStore
from diorama_core.pipeline.presets import stages_for
from diorama_core.pipeline.reconstruct_object import reconstruct_object
from diorama_core.pipeline.run import build_scene
from diorama_core.synthesis.layout_rooms import box_library
from tests.models import tiny_networks, tiny_sams
from tests.models.test_depth import HEIGHT, WIDTH, _Moge
from tests.pipeline.test_presets import BOX, install


@pytest.mark.parametrize("networks", [False, True], ids=["embedded", "networks"])
def test_a_box_is_looked_at_with_what_built_the_scene(
    networks: bool, tmp_path: Path, rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DIORAMA_MODELS", str(tmp_path / "models"))
    monkeypatch.delenv("DIORAMA_LMM_BASE_URL", raising=False)
    if networks:
        store = ModelStore.default()
        moge = (torch.zeros(1, 3, HEIGHT, WIDTH), torch.tensor(1800))
        names = ["points", "normal", "mask", "metric_scale"]
        graph = tiny_networks.export(_Moge(), moge, tmp_path / "m.onnx", ["image", "num_tokens"], names)
        install(store, "moge-2-vits", [graph])
        install(store, "slimsam", tiny_sams.slimsam(tmp_path)[1:])
    rgb = rng.integers(100, 140, (HEIGHT, WIDTH, 3)).astype(np.uint8)
    rgb[48:82, 44:88] = (200, 60, 40)
    box = LabelledBox(BOX, "chair", "chair")
    inputs, library, cache = Inputs(Photo(rgb, "room.png", (WIDTH, HEIGHT)), (box,)), box_library(), tmp_path / "stages"
    built = build_scene(inputs, library, stages=stages_for("auto", inputs, library), cache=cache)
    saved = {path.name for path in cache.rglob("*.zip")}
    assert any(name.startswith("depth_prediction") for name in saved) == networks
    found = reconstruct_object(built.scene, inputs, library, box, "chair_again", cache=cache)
    assert found.item.id == "chair_again"
    assert found.item.category == "chair"
    assert {path.name for path in cache.rglob("*.zip")} == saved, "the photo's own stages are not run again"
    first = built.observed.objects[0].pose.position
    assert np.linalg.norm(found.item.pose.position - first) < 0.25 * max(1.0, float(np.linalg.norm(first)))
