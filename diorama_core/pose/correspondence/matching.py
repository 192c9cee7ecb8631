"""Which patch of the picture is which patch of a view: nearest neighbours there and back (cyclic distance).

Of the paper (supplement, "Zero-shot object pose estimation") and ZSP: a patch, its nearest neighbour in the view, and
that one's nearest neighbour back in the picture. A match is believed where the way back ends near its start.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float32, Int

from diorama_core.pose.correspondence.crops import PATCHES

MAX_CYCLE = 2.0
"""Maximum distance in patches between start and end of an accepted cycle."""
MIN_SIMILARITY = 0.5
MAX_MATCHES = 50


@dataclass(frozen=True, eq=False)
class Matches:
    """For every view its matches with the picture, best first; `count` of them are meant, the rest is padding."""

    query: Int[np.ndarray, "v k"]
    """Patch of the picture."""
    template: Int[np.ndarray, "v k"]
    """Patch of the view."""
    similarity: Float[np.ndarray, "v k"]
    count: Int[np.ndarray, " v"]

    def select_views(self, views: slice) -> Matches:
        """Matches of some of the views."""
        return Matches(self.query[views], self.template[views], self.similarity[views], self.count[views])

    @property
    def mean_similarity(self) -> Float[np.ndarray, " v"]:
        """Over each view's matches; 0 without any."""
        inside = np.arange(self.similarity.shape[1]) < self.count[:, None]
        return (self.similarity * inside).sum(axis=1) / np.maximum(self.count, 1)


def similarities(
    query: Float32[np.ndarray, "p d"],
    views: Float32[np.ndarray, "v p d"],
    query_inside: Bool[np.ndarray, " p"],
    view_inside: Bool[np.ndarray, "v p"],
) -> Float32[np.ndarray, "v q p"]:
    """Cosine similarity of the picture's foreground patches with every patch of all views; -1 outside their shape.

    One matrix product for all views.

    Args:
        query: unit features of the picture's p patches.
        views: unit features of the patches of v views.
        query_inside: which patches of the picture are foreground, q of them.
        view_inside: which patches of each view show the shape.
    """
    inside = query[query_inside]
    flat = views.reshape(-1, views.shape[-1])
    scores = (inside @ flat.T).reshape(len(inside), *views.shape[:2]).transpose(1, 0, 2)
    return np.where(view_inside[:, None], scores, -1.0)


def cyclic_matches(similarity: Float32[np.ndarray, "v q p"], query_patches: Int[np.ndarray, " q"]) -> Matches:
    """The accepted matches of every view."""
    views, count, _ = similarity.shape
    if count == 0:
        none = np.zeros((views, 0), dtype=int)
        return Matches(none, none, none.astype(float), np.zeros(views, dtype=int))
    forward = similarity.argmax(axis=2)
    best = np.take_along_axis(similarity, forward[..., None], axis=2)[..., 0]
    back = similarity.argmax(axis=1)
    home = query_patches[np.take_along_axis(back, forward, axis=1)]
    start = np.broadcast_to(query_patches, home.shape)
    cycle = np.hypot(home % PATCHES - start % PATCHES, home // PATCHES - start // PATCHES)
    good = (cycle < MAX_CYCLE) & (best >= MIN_SIMILARITY)
    order = np.argsort(np.where(good, -best, np.inf), axis=1, kind="stable")[:, :MAX_MATCHES]
    return Matches(
        query=query_patches[order],
        template=np.take_along_axis(forward, order, axis=1),
        similarity=np.take_along_axis(best, order, axis=1).astype(float),
        count=np.minimum(good.sum(axis=1), min(MAX_MATCHES, count)),
    )


def template_scores(similarity: Float32[np.ndarray, "v q p"]) -> Float[np.ndarray, " v"]:
    """How like the whole picture is to each view: mean of every patch's best similarity, both ways (best match)."""
    if similarity.shape[1] == 0:
        return np.zeros(len(similarity))
    forward = similarity.max(axis=2).mean(axis=1)
    inside = similarity.max(axis=1) > -1
    back = np.where(inside, similarity.max(axis=1), 0.0).sum(axis=1) / np.maximum(inside.sum(axis=1), 1)
    return 0.5 * (forward + back)
