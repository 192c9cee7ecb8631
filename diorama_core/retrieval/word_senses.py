"""Which kind a loose word means, by where its box is in the picture and how large the thing would be there.

"Lamp" is said of lamps on tables, floors, walls and ceilings, "table" of desks and of coffee tables, and geometry needs
to know which before it can measure anything. Every kind that a word may mean is set at many distances; where its foot
or its top would be, and its size, are compared with what such things usually have. The camera's height is inferred from
all boxes together, on a grid: given the height, boxes are taken to be independent (naive Bayes). What the picture of a
thing looks like joins in where that is known, and then what lies on what, how large it would be there, and the type of
the room (`kinds_together`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import CameraEstimate, DetectedObject
from diorama_core.library.labels import is_named, meanings, names_a_kind
from diorama_core.library.taxonomy import UNKNOWN, Mount, category
from diorama_core.retrieval.box_views import HEIGHTS_M, BoxView, box_likelihood, box_view, lying_likelihoods
from diorama_core.retrieval.kinds_together import Lying, carriers, carries, kinds_together
from diorama_core.retrieval.seen_kinds import as_it_looks
from diorama_core.scene.types import Intrinsics


@dataclass(frozen=True)
class WordSenseSettings:
    """Weights of place and size in the meaning of a word."""

    usual_height_m: float = 1.45
    height_sigma_m: float = 0.3
    """Deviation of the heights of cameras above the floor."""
    measured_sigma_m: float = 0.15
    unsupported: float = 0.15
    inside: float = 0.5
    """How likely a thing lies on another one where no box is below it, and where one is all around it."""
    switch: float = 1.5
    """How many times likelier it must be that a thing is held otherwise than its word says before geometry takes it
    so."""
    majority: float = 0.5
    """How likely another kind that is held alike must be: a wrong one's narrow size would spoil the whole room's
    scale."""
    sure: float = 0.4
    """How likely a kind must be before geometry takes a thing without a name for it."""


SETTINGS = WordSenseSettings()


def with_word_senses(objects: tuple[DetectedObject, ...], camera: CameraEstimate) -> tuple[DetectedObject, ...]:
    """The objects, those whose word is used loosely with the category that it most probably means here.

    Where a thing is held decides first, over all kinds that are held there. Among kinds that are held as the word says
    its own category stays unless another one is likelier than all others together: retrieval compares them later.
    A word that is no kind's name ("stand") means the likeliest.
    """
    best = camera.best
    senses = sense_probabilities(objects, best.intrinsics, best.R_world_camera, camera.height_m)
    return tuple(
        replace(item, category=_choose_kind(item, of_word), meanings=_list_senses(of_word))
        for item, of_word in zip(objects, senses, strict=True)
    )


def _list_senses(senses: Mapping[str, float]) -> tuple[tuple[str, float], ...]:
    """Several senses, likeliest first."""
    return tuple(sorted(senses.items(), key=lambda pair: (-pair[1], pair[0]))) if len(senses) > 1 else ()


def sense_probabilities(
    objects: Sequence[DetectedObject],
    intrinsics: Intrinsics,
    R_world_camera: Float[np.ndarray, "3 3"],
    height_m: float | None = None,
) -> list[Mapping[str, float]]:
    """For every object the kinds its word may mean, with probabilities that the boxes leave them.

    Args:
        objects: of one photo; for one without a name its category is the only one.
        intrinsics: of the photo's camera.
        R_world_camera: how it is held; world +Z is up.
        height_m: of the camera above the floor, where that is known.
    """
    below = carriers([item.box for item in objects])
    views = [
        box_view(item.box, _lying_probability(item, objects, on), intrinsics, R_world_camera)
        for item, on in zip(objects, below, strict=True)
    ]
    senses = [
        as_it_looks(meanings(item.label, item.category), item.looks_like, is_named(item.label)) for item in objects
    ]
    likely = [
        {kind: box_likelihood(view, kind) for kind in of_word} for view, of_word in zip(views, senses, strict=True)
    ]
    usual, sigma = (
        (SETTINGS.usual_height_m, SETTINGS.height_sigma_m)
        if height_m is None
        else (height_m, SETTINGS.measured_sigma_m)
    )
    log_likelihoods = [-0.5 * ((HEIGHTS_M - np.clip(usual, HEIGHTS_M[0], HEIGHTS_M[-1])) / sigma) ** 2]
    for of_word, of_view in zip(senses, likely, strict=True):
        log_likelihoods.append(np.log(sum(share * of_view[kind] for kind, share in of_word.items())))
    # Sorted: the order of the objects must not show in a bit.
    log_height = np.sort(np.stack(log_likelihoods), axis=0).sum(axis=0)
    height = np.exp(log_height - log_height.max())
    height /= height.sum()
    probabilities: list[Mapping[str, float]] = []
    for of_word, of_view in zip(senses, likely, strict=True):
        mixed = sum(share * of_view[kind] for kind, share in of_word.items())  # the others' say on the height
        posterior = {kind: share * float((height * of_view[kind] / mixed).sum()) for kind, share in of_word.items()}
        whole = sum(posterior.values())
        probabilities.append({kind: value / whole for kind, value in posterior.items()})
    return kinds_together(probabilities, below, _as_lying(views, likely, below, height))


def _as_lying(
    views: Sequence[BoxView],
    likely: Sequence[Mapping[str, Float[np.ndarray, "h"]]],
    below: Sequence[int | None],
    height: Float[np.ndarray, "h"],
) -> list[Lying | None]:
    """For every thing with a carrier how many times likelier its box is if it lies there."""
    lying: list[Lying | None] = []
    for view, of_view, on in zip(views, likely, below, strict=True):
        on_kinds = () if on is None else tuple(kind for kind in likely[on] if carries(kind))
        if on is None or not on_kinds:
            lying.append(None)
            continue
        alone = np.array([float(height @ of_kind) for of_kind in of_view.values()])
        likelihoods = lying_likelihoods(view, tuple(of_view), views[on], on_kinds, height)
        lying.append(Lying(tuple(of_view), on_kinds, likelihoods / alone[:, None]))
    return lying


def _choose_kind(item: DetectedObject, senses: Mapping[str, float]) -> str:
    detected_kind, named = item.category, is_named(item.label)
    if detected_kind == UNKNOWN.name or (named and not names_a_kind(item.label)):
        best = max(senses, key=lambda kind: senses[kind])
        return best if named or senses[best] > SETTINGS.sure else detected_kind
    mounts: dict[Mount, float] = {}
    for kind, share in senses.items():
        mount = category(kind).mount
        mounts[mount] = mounts.get(mount, 0.0) + share
    mount = max(mounts, key=mounts.__getitem__)
    if mounts[mount] <= SETTINGS.switch * mounts.get(category(detected_kind).mount, 0.0):
        mount = category(detected_kind).mount
    best = max((kind for kind in senses if category(kind).mount == mount), key=lambda kind: senses[kind])
    return best if mount != category(detected_kind).mount or senses[best] > SETTINGS.majority else detected_kind


def _lying_probability(item: DetectedObject, objects: Sequence[DetectedObject], inside: int | None) -> float:
    if any(_stands_on(other.box, item.box) for other in objects if other is not item):
        return 1.0
    return SETTINGS.unsupported if inside is None else SETTINGS.inside


def _stands_on(below: tuple[float, float, float, float], box: tuple[float, float, float, float]) -> bool:
    """Whether a box's foot is over another one that begins lower than it."""
    x, slack = (box[0] + box[2]) / 2, 0.1 * (box[3] - box[1])
    return below[0] <= x <= below[2] and box[1] < below[1] <= box[3] + slack <= below[3] + slack
