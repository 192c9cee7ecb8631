"""What a network that learnt from photos (EfficientNet-Lite0) tells of the kind of thing in a box.

Two readings of one crop, added as log-likelihoods. Its 1,000 classes, which have no ceiling lamps or night stands: a
table says which classes it takes each of our kinds for. Its features: a small linear layer that learnt, on annotated
photos, what the namer of our own and that table get wrong (`training.kind_evidence`; `assets/models/README.md`).
"""

from __future__ import annotations

import hashlib
import logging
import re
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float, Float32, UInt8
from scipy.special import softmax

from diorama_core.errors import UnavailableError
from diorama_core.io import assets
from diorama_core.io.derived import read_arrays
from diorama_core.models.efficientnet import CLASSES, FEATURES, SIDE_PX, lite0_graph
from diorama_core.models.images import IMAGENET_MEAN, IMAGENET_STD, box_crop, normalise
from diorama_core.models.runtime import SHARED_SESSIONS, SessionPool
from diorama_core.scene.values import ArrayValue

log = logging.getLogger(__name__)

MARGIN, SQUEEZE = 0.06, 0.5
"""Around the box, and how far a long box is stretched to fill the square: a compromise between detail and shape."""
_ELSEWHERE = 0.1
"""Share of a kind's pictures whose class the table does not foresee, spread over all classes."""
TABLE_TRUST = 0.875
"""Power of what the table says, beside the namer's own probabilities (`retrieval.seen_kinds` takes both to another)."""
OWN_FLOOR = 0.001
"""Added to the namer's probabilities: it learnt from rendered rooms and rules out what it should not."""
_BATCH = 8
_ENTRY = re.compile(r"(\d+) (.+) (\d+)")


@dataclass(frozen=True, eq=False)
class KindReadings(ArrayValue):
    """What turns the network's outputs into likelihoods of kinds."""

    classes: Float[np.ndarray, "k c"]
    """How often the network takes a picture of each kind for each class."""
    mean: Float[np.ndarray, "f"]
    basis: Float[np.ndarray, "f d"]
    """Mean and principal directions of features in photos of rooms, as `unit_features` makes them."""
    weights: Float[np.ndarray, "d k"]
    """Log-likelihood of each kind along each direction."""

    def log_likelihoods(
        self, logits: Float[np.ndarray, "n c"], features: Float[np.ndarray, "n f"]
    ) -> Float[np.ndarray, "n k"]:
        """Log-likelihood of every kind, up to a constant in each row."""
        return (
            table_likelihoods(self.classes, logits) + (unit_features(features) - self.mean) @ self.basis @ self.weights
        )


@dataclass(frozen=True)
class KindEvidence:
    """Input: an upright RGB picture and boxes in it. Output: log-likelihoods of the kinds of `assets.CARD`."""

    graph: Path = field(repr=False)
    readings: KindReadings = field(repr=False, compare=False)
    weights: str
    """Identity of the readings, for cache keys."""
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    def log_likelihoods(
        self, rgb: UInt8[np.ndarray, "h w 3"], boxes: Float[np.ndarray, "n 4"]
    ) -> Float[np.ndarray, "n k"]:
        """What is in every box, up to a constant in each row."""
        return self.readings.log_likelihoods(*self.look(rgb, boxes))

    def look(
        self, rgb: UInt8[np.ndarray, "h w 3"], boxes: Float[np.ndarray, "n 4"]
    ) -> tuple[Float[np.ndarray, "n c"], Float[np.ndarray, "n f"]]:
        """The network's logits of ImageNet's classes and its features, for every box."""
        logits, features = [np.zeros((0, CLASSES))], [np.zeros((0, FEATURES))]
        for start in range(0, len(boxes), _BATCH):
            crops = _crops(rgb, boxes[start : start + _BATCH])
            shapes = {"features": (len(crops), FEATURES), "logits": (len(crops), CLASSES)}
            outputs = self.pool.get(self.graph).run({"crops": crops}, shapes)
            logits.append(outputs["logits"].astype(np.float64))
            features.append(outputs["features"].astype(np.float64))
        return np.concatenate(logits), np.concatenate(features)


def with_evidence(kinds: Float[np.ndarray, "n k"], evidence: Float[np.ndarray, "n k"]) -> Float[np.ndarray, "n k"]:
    """Probabilities of the namer joined with log-likelihoods of independent evidence."""
    return softmax(np.log(kinds + OWN_FLOOR) + evidence, axis=1)


def table_likelihoods(classes: Float[np.ndarray, "k c"], logits: Float[np.ndarray, "n c"]) -> Float[np.ndarray, "n k"]:
    """Log-likelihood of every kind, by the classes that the network takes a picture for."""
    return TABLE_TRUST * np.log(softmax(logits, axis=1) @ ((1 - _ELSEWHERE) * classes + _ELSEWHERE / CLASSES).T)


def unit_features(features: Float[np.ndarray, "n f"]) -> Float[np.ndarray, "n f"]:
    """Roots of the features, which are positive and skewed, at unit length: how bright a picture is says nothing."""
    roots = np.sqrt(np.maximum(features, 0.0))
    return roots / np.maximum(np.linalg.norm(roots, axis=1, keepdims=True), 1e-9)


@cache
def own_evidence(kinds: tuple[str, ...]) -> KindEvidence | None:
    """The evidence for kinds in this order; None, with one line in the log, where a part of it is missing."""
    try:
        readings = _readings(kinds)
        identity = hashlib.sha256(b"".join(a.tobytes() for a in (readings.classes, readings.basis, readings.weights)))
        return KindEvidence(lite0_graph(), readings, identity.hexdigest()[:8])
    except UnavailableError as error:
        log.warning("boxes are named less well: %s", error)
        return None


def _readings(kinds: tuple[str, ...]) -> KindReadings:
    table, path = (assets.FOLDER / name for name in (assets.CLASS_TABLE, assets.KIND_LAYER))
    layer = read_arrays(path, "kinds", "mean", "basis", "weights")
    if layer is None or tuple(map(str, layer[0])) != kinds:
        raise UnavailableError(f"{path}: is missing or of another namer; restore it from the repository")
    mean, basis, weights = (np.asarray(a, np.float64) for a in layer[1:])
    return KindReadings(read_class_table(table, kinds), mean, basis, weights)


def read_class_table(path: Path, kinds: tuple[str, ...]) -> Float[np.ndarray, "k c"]:
    """Shares of ImageNet's classes for every kind, from lines `kind: NUMBER class SHARE, ...`.

    Raises:
        UnavailableError: when the file cannot be read, or a line is not laid out so or names no kind.
    """
    table = np.zeros((len(kinds), CLASSES))
    row = {kind: k for k, kind in enumerate(kinds)}
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise UnavailableError(f"{path}: is missing; restore it from the repository") from error
    for number, line in enumerate(lines, 1):
        kind, _, entries = line.partition(": ")
        parsed = [_ENTRY.fullmatch(entry) for entry in entries.split(", ")]
        if kind not in row or not all(parsed):
            raise UnavailableError(f"{path}, line {number}: not 'kind: NUMBER class SHARE, ...'")
        for entry in filter(None, parsed):
            table[row[kind], int(entry[1])] = float(entry[3])
    table[~table.any(axis=1)] = 1.0
    return table / table.sum(axis=1, keepdims=True)


def _crops(rgb: UInt8[np.ndarray, "h w 3"], boxes: Float[np.ndarray, "n 4"]) -> Float32[np.ndarray, "n 3 s s"]:
    crops = (box_crop(rgb, box, MARGIN, SIDE_PX, SQUEEZE) for box in boxes)
    return np.concatenate([normalise(crop, IMAGENET_MEAN, IMAGENET_STD) for crop in crops])
