"""What a network that learnt from photos tells of the kinds of things in boxes."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import UnavailableError
from diorama_core.io import assets
from diorama_core.models.efficientnet import CLASSES, FEATURES
from diorama_core.models.kind_evidence import (
    KindReadings,
    own_evidence,
    read_class_table,
    unit_features,
    with_evidence,
)
from diorama_core.models.recogniser import Recogniser, own_recogniser

own_weights_there = pytest.mark.skipif(not assets.has_own_recogniser(), reason="the recogniser's weights were left out")


def test_the_table_calls_every_class_by_one_name() -> None:
    text = (assets.FOLDER / assets.CLASS_TABLE).read_text()
    names: dict[str, set[str]] = {}
    for number, name in re.findall(r"(\d+) ([^,]+?) \d+(?:,|\n|$)", text):
        names.setdefault(number, set()).add(name)
    assert len(names) > 250
    assert all(len(of_one) == 1 and int(number) < CLASSES for number, of_one in names.items())


def test_a_table_line_that_names_no_kind_is_one_line(tmp_path: Path) -> None:
    path = tmp_path / "table.txt"
    path.write_text("chair: 559 folding chair 3, 765 rocking chair 1\nchiar: 1 goldfish 2\n")
    with pytest.raises(UnavailableError, match=r"table.txt, line 2: not 'kind: NUMBER class SHARE"):
        read_class_table(path, ("chair", "sofa"))
    path.write_text("chair: 559 folding chair 3, 765 rocking chair 1\n")
    shares = read_class_table(path, ("chair", "sofa"))
    assert shares[0, 559] == 0.75
    assert shares[1] == pytest.approx(1 / CLASSES)  # of a kind without a line nothing is known


def test_classes_and_features_add_up() -> None:
    classes = np.full((2, CLASSES), 1e-4)
    classes[0, 10] = classes[1, 20] = 1.0
    direction = np.zeros((FEATURES, 1))
    direction[3] = 1.0
    readings = KindReadings(classes, np.zeros(FEATURES), direction, np.array([[0.0, 2.0]]))
    logits, features = np.zeros((1, CLASSES)), np.ones((1, FEATURES)) * 1e-6
    logits[0, 10] = 12.0
    plain = readings.log_likelihoods(logits, features)
    features[0, 3] = 1.0
    turned = readings.log_likelihoods(logits, features)
    assert plain[0, 0] > plain[0, 1] + 1
    assert turned[0, 1] - plain[0, 1] == pytest.approx(2.0, abs=0.1)
    assert unit_features(features * 9) == pytest.approx(unit_features(features))


def test_evidence_that_says_nothing_changes_nothing_much() -> None:
    kinds = np.array([[0.7, 0.2, 0.1]])
    assert with_evidence(kinds, np.full((1, 3), -4.0)) == pytest.approx(kinds, abs=0.01)


@own_weights_there
def test_boxes_are_named_with_evidence_and_cached_apart(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    own, alone = own_recogniser(), Recogniser.of(assets.FOLDER)
    assert own.evidence is not None
    assert own.evidence.weights in repr(own)
    rgb = np.random.default_rng(0).integers(0, 255, (90, 120, 3)).astype(np.uint8)
    boxes = np.array([[5.0, 5.0, 60.0, 80.0], [50.0, 20.0, 110.0, 60.0]])
    named = own.look(rgb, boxes)
    assert named.kinds.sum(axis=1) == pytest.approx(1.0)
    assert not np.allclose(named.kinds, alone.look(rgb, boxes).kinds)
    assert own.look(rgb, boxes[:0]).kinds.shape == (0, len(own.categories))


@own_weights_there
def test_without_its_layer_the_namer_goes_on_alone_and_says_so(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(assets, "KIND_LAYER", "no-such-layer.npz")
    assert own_evidence.__wrapped__(own_recogniser().categories) is None
    assert "no-such-layer.npz: is missing or of another namer; restore it" in caplog.text
