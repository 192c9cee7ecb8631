"""Kinds of a scene's objects against the true ones."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.evaluation.metrics.scene import Matched, kind_share
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Pose, Scene, SceneObject


def test_kinds_of_what_is_absent_are_wrong() -> None:
    library = built_in_library()

    def a(kind: str) -> SceneObject:
        shape = library.in_category(kind)[0]
        return SceneObject(kind, kind, kind, shape.id, shape.size_m, Pose.upright(np.zeros(3)))

    matched = Matched(Scene(), (a("chair"), a("desk"), a("desk")), (a("chair"), a("chair"), None))
    assert kind_share(matched, library) == pytest.approx(1 / 3)
