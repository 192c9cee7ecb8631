"""What the picture of a thing says about its form: which top and base, arms, back, how many doors and drawers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.geometry.shape_appearance import ShapeAppearance
from diorama_core.library.form import MEASURED, VALUES, form_of, value_indices
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.slots import slots_of
from diorama_core.retrieval.feature_cache import cached_features, has_features
from diorama_core.retrieval.settings import SETTINGS, UsualFormSettings

FORM_FEATURES = "form-3"
"""Cache key; to be changed with what `library.form` measures."""


def shape_form(
    library: ShapeLibrary, shape: Shape, appearance: ShapeAppearance, folder: Path | None = None
) -> Mapping[str, str | int]:
    """The form of a shape at its own size (`library.form.form_of`), values beyond those of `VALUES` left out.

    It is kept on disk, since doors and drawers are counted on a shape that is built for this alone.

    Args:
        library: where it is.
        shape: whose.
        appearance: its triangles.
        folder: cache folder of features; `features` in Diorama's cache folder by default.
    """

    def measure() -> Float[np.ndarray, "1 n"]:
        mesh = trimesh.Trimesh(appearance.vertices, appearance.faces, process=False)
        slots = slots_of(library.parts(shape.id))
        form = form_of(shape.id, shape.category, mesh, np.asarray(shape.size_m), slots)
        return value_indices(form)[None].astype(float)

    indices = cached_features(FORM_FEATURES, shape, measure, folder)[0].astype(int).tolist()
    return {name: VALUES[name][k] for name, k in zip(MEASURED, indices, strict=True) if 0 <= k < len(VALUES[name])}


def has_form(shape: Shape, folder: Path | None = None) -> bool:
    """Whether the form of a shape is on disk."""
    return has_features(FORM_FEATURES, shape, folder)


def form_likelihood_factor(
    form: Mapping[str, str | int], seen_form: Sequence[float], settings: UsualFormSettings = SETTINGS.forms
) -> float:
    """What a shape's score is multiplied by: above 1 for forms that are likelier than what was to be expected.

    Attributes that the shape does not have say nothing; `seen_form` is as `SeenKinds.form`, the factor 1 without any.

    Args:
        form: of the shape; attributes that it does not have say nothing.
        seen_form: probability of every value of every attribute (`SeenKinds.form`); without any, the factor is 1.
        settings: numbers to work with.
    """
    if not len(seen_form):
        return 1.0
    ends = np.cumsum([len(VALUES[name]) for name in MEASURED])[:-1]
    total = 0.0
    for values, index in zip(np.split(np.asarray(seen_form), ends), value_indices(form), strict=True):
        if index >= 0:
            p = (values + settings.seen_floor) / (values + settings.seen_floor).sum()
            total += float(np.log(p[index]) - p @ np.log(p))
    return float(np.exp(settings.seen * total))
