"""What objects look like to the namer that comes with Diorama."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import DetectedObject, Photo
from diorama_core.library.taxonomy import CATEGORIES
from diorama_core.models.own_weights import has_own_recogniser
from diorama_core.perception.naming import own_naming
from diorama_core.progress import Progress


@pytest.mark.skipif(not has_own_recogniser(), reason="the recogniser's weights were left out")
def test_every_object_gets_probabilities_of_kinds() -> None:
    rgb = np.random.default_rng(0).integers(0, 255, (60, 80, 3)).astype(np.uint8)
    objects = tuple(
        DetectedObject(name, "object", "object", box, np.ones((60, 80), bool), 1, 1.0)
        for name, box in (("a", (0.0, 0.0, 30.0, 40.0)), ("b", (20.0, 10.0, 80.0, 60.0)))
    )
    naming = own_naming()
    assert naming is not None
    found = naming.name(Photo(rgb, "0" * 64, (80, 60)), objects, Progress())
    assert [one.object_id for one in found] == ["a", "b"]
    for one in found:
        assert set(one.kinds) <= {c.name for c in CATEGORIES}
        assert one.probabilities.sum() == pytest.approx(1.0)
    assert naming.name(Photo(rgb, "0" * 64, (80, 60)), (), Progress()) == ()
