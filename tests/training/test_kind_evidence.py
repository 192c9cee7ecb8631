"""The layer from features of photos to kinds."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from diorama_core.models.efficientnet import CLASSES, FEATURES
from diorama_core.models.kind_evidence import OWN_FLOOR
from diorama_core.training.kind_evidence import AnnotatedLooks, fit, scores, write_layer

KINDS = ("bed", "chair", "desk", "sofa")


def photos(count: int, seed: int = 0) -> list[AnnotatedLooks]:
    """Boxes whose features tell the kind, and of which the namer and the classes know nothing."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        kinds = rng.integers(0, len(KINDS), 5)
        features = rng.uniform(0.0, 0.2, (5, FEATURES))
        for row, kind in zip(features, kinds, strict=True):
            row[100 * kind : 100 * kind + 100] += 1.0
        boxes = np.array([[20.0 * k, 0.0, 20.0 * k + 10, 10.0] for k in range(5)])
        own = np.full((5, len(KINDS)), 1 / len(KINDS))
        found.append(AnnotatedLooks(own, np.zeros((5, CLASSES)), features, kinds, boxes))
    return found


def test_what_features_tell_is_learnt_for_photos_held_back(tmp_path: Path) -> None:
    table = tmp_path / "table.txt"
    table.write_text("bed: 564 four-poster 1\n")
    looks = photos(12)
    own, _, layer = scores(looks, KINDS, table)
    assert own.first < 0.6
    assert layer.first > 0.9
    assert layer.log_loss < own.log_loss
    readings = fit(looks, KINDS, table)
    other = photos(1, seed=9)[0]
    seen = np.log(other.own + OWN_FLOOR) + readings.log_likelihoods(other.logits, other.features)
    assert (seen.argmax(axis=1) == other.kinds).all()
    write_layer(readings, KINDS, tmp_path / "layer.npz")
    with np.load(tmp_path / "layer.npz") as saved:
        assert tuple(saved["kinds"]) == KINDS
        assert saved["basis"].dtype == np.float16
