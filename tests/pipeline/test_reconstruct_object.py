"""One object looked at again uses the stages that the scene was built with."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.models.store import ModelStore
from diorama_core.pipeline.presets import stages_for
from diorama_core.pipeline.reconstruct_object import reconstruct_object
from diorama_core.pipeline.run import build_scene
from diorama_core.synthesis.layout_rooms import box_library
from tests.pipeline.test_presets import BOX, graphs, install, photo

__all__ = ["graphs", "photo"]  # fixtures


def test_a_box_is_looked_at_with_what_built_the_scene(
    photo: Photo, graphs: dict[str, list[Path]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without networks: `test_plan.py`."""
    monkeypatch.setenv("DIORAMA_MODELS", str(tmp_path / "models"))
    monkeypatch.delenv("DIORAMA_LMM_BASE_URL", raising=False)
    for network_id in ("moge-2-vits", "slimsam"):
        install(ModelStore.default(), network_id, graphs[network_id])
    box = LabelledBox(BOX, "chair", "chair")
    inputs, library, cache = Inputs(photo, (box,)), box_library(), tmp_path / "stages"
    stages = stages_for("auto", inputs, library)
    built = build_scene(inputs, library, stages=stages, cache=cache, plane_pictures=False)
    saved = {path.name for path in cache.rglob("*.zip")}
    assert any(name.startswith("depth_prediction") for name in saved)
    found = reconstruct_object(built.scene, inputs, library, box, "chair_again", cache=cache)
    assert found.item.id == "chair_again"
    assert found.item.category == "chair"
    assert {path.name for path in cache.rglob("*.zip")} == saved, "the photo's own stages are not run again"
    first = built.observed.objects[0].pose.position
    assert np.linalg.norm(found.item.pose.position - first) < 0.25 * max(1.0, float(np.linalg.norm(first)))
