"""What the picture of a thing says about its form: which top and base, arms, how many doors and drawers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import trimesh

from diorama_core.geometry.shape_appearance import ShapeAppearance
from diorama_core.io.cache import LruCache
from diorama_core.library.form import MEASURED, VALUES, form_of, value_indices
from diorama_core.library.record import Shape

_SAYS = 0.2
"""Power of the probability that multiplies a retrieval score: scores of good and bad shapes differ little."""
_FLOOR = 0.03
"""Added to every probability: the namer learnt from rendered pictures and is too sure of itself on photos."""

_FORM_OF: LruCache[str, Mapping[str, str | int]] = LruCache(4096)


def shape_form(shape: Shape, appearance: ShapeAppearance) -> Mapping[str, str | int]:
    """The form of a shape at its own size (`library.form.form_of`)."""

    def found() -> Mapping[str, str | int]:
        mesh = trimesh.Trimesh(appearance.vertices, appearance.faces, process=False)
        return form_of(shape.id, shape.category, mesh, np.asarray(shape.size_m))

    return _FORM_OF.get(shape.content_hash, found)


def seen_form_factor(form: Mapping[str, str | int], seen_form: Sequence[float]) -> float:
    """What a shape's score is multiplied by: above 1 for forms that are likelier than what was to be expected.

    Args:
        form: of the shape; attributes that it does not have say nothing.
        seen_form: probability of every value of every attribute (`SeenKinds.form`); without any, the factor is 1.
    """
    if not len(seen_form):
        return 1.0
    ends = np.cumsum([len(VALUES[name]) for name in MEASURED])[:-1]
    total = 0.0
    for values, index in zip(np.split(np.asarray(seen_form), ends), value_indices(form), strict=True):
        if index >= 0:
            p = (values + _FLOOR) / (values + _FLOOR).sum()
            total += float(np.log(p[index]) - p @ np.log(p))
    return float(np.exp(_SAYS * total))
