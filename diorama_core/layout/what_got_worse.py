"""What a layout recipe made worse, in words: recipes stay as they were published, but people are told."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from diorama_core.artefacts import LayoutReport, PhotoDisagreement
from diorama_core.scene.edits import resize
from diorama_core.scene.support import top_down
from diorama_core.scene.types import Scene, SceneObject

Problems = Mapping[str, tuple[str, ...]]
"""By object id, what is wrong with it, in a word each."""

NAMED_MOVE_M = 0.3
"""A layout whose objects moved so far on average is hardly that of the photo."""
NAMED_OVERLAP_M = 0.005
"""Overlaps are given in whole centimetres."""
MIN_CHANGE_M = 1e-6
"""Sizes that differ by less are the same."""


RESIZED = "was resized"
"""The problem of an object that became much smaller or larger than it was seen."""
MAX_RESIZE = 1.25
"""A recipe may make any side of an object so many times as long or as short: fits to a photo seldom differ by more."""
MIN_TOLD = 0.05
"""Relative changes of size below this are told nobody."""


def resizes(start: Scene, final: Scene) -> dict[str, float]:
    """By object id, the largest factor by which a side of an object became longer or shorter; at least 1."""
    both = [(start.object(o.id).size_m, o) for o in final.objects if start.has_object(o.id)]
    return {o.id: float(np.exp(np.abs(np.log(o.size_m / was)).max())) for was, o in both}


def find_excessive_resizes(start: Scene, final: Scene) -> dict[str, tuple[str, ...]]:
    """The problem of each object whose size left what is believed of it."""
    return {i: (RESIZED,) for i, factor in resizes(start, final).items() if factor > MAX_RESIZE + 1e-6}


def resizes_in_words(start: Scene, final: Scene) -> tuple[str, ...]:
    """One line for each object of another size: from which size to which."""
    return tuple(
        f"resized: {final.object(i).label}, {_size(start.object(i))} to {_size(final.object(i))} cm"
        for i, factor in resizes(start, final).items()
        if factor > 1.0 + MIN_TOLD
    )


def with_believed_sizes(start: Scene, final: Scene) -> Scene:
    """A layout with sizes that stay near those at its start; each object stays on its base.

    What stands on an object rises and sinks with its top.
    """
    for object_id in (i for i in top_down(final) if start.has_object(i)):
        was, now = start.object(object_id).size_m, final.object(object_id).size_m
        believed = was * np.clip(now / was, 1.0 / MAX_RESIZE, MAX_RESIZE)
        if np.abs(believed - now).max() > MIN_CHANGE_M:
            final = resize(final, object_id, believed)
    return final


def _size(item: SceneObject) -> str:
    depth, width, height = 100.0 * item.size_m
    return f"{width:.0f} x {depth:.0f} x {height:.0f}"


def new_problems(before: Problems, after: Problems) -> dict[str, tuple[str, ...]]:
    """Problems that objects have now and did not have before."""
    fresh = {i: tuple(w for w in words if w not in before.get(i, ())) for i, words in after.items()}
    return {i: words for i, words in fresh.items() if words}


def describe_worse(report: LayoutReport, worse: Problems, labels: Mapping[str, str]) -> tuple[str, ...]:
    """One sentence for everything that got worse; empty where nothing did."""
    lines = []
    for word in sorted({w for words in worse.values() for w in words}):
        names = [labels.get(i, i) for i, words in worse.items() if word in words]
        lines.append(f"{_verb(word, len(names))}: {', '.join(names)}.")
    before, after = report.before, report.after
    pairs, more = before.get("overlapping_pairs"), after.get("overlapping_pairs")
    if pairs is not None and more is not None and more > pairs:
        lines.append(f"Overlapping pairs went from {pairs:.0f} to {more:.0f}.")
    deep, deeper = before.get("part_overlap_m"), after.get("part_overlap_m")
    if deep is not None and deeper is not None and deeper > deep + NAMED_OVERLAP_M:
        lines.append(f"The deepest overlap went from {100 * deep:.0f} cm to {100 * deeper:.0f} cm.")
    moved = after.get("moved_m", 0.0)
    if moved > NAMED_MOVE_M:
        lines.append(f"Objects moved by {100 * moved:.0f} cm on average; the photo shows them elsewhere.")
    return tuple(lines)


def disagreement_in_words(disagreement: PhotoDisagreement) -> str:
    """One sentence for an object that agrees less with the photo than before."""
    return (
        f"agrees less with the photo: {disagreement.label}, moved {100 * disagreement.moved_m:.0f} cm; "
        f"the outline still covers {100 * disagreement.outline_shared:.0f} % of where it was seen"
    )


def _verb(word: str, count: int) -> str:
    verbs = {
        "floats": ("floats", "float"),
        "collides": ("collides", "collide"),
        "outside": ("left the room", "left the room"),
        RESIZED: ("was resized", "were resized"),
    }
    one, many = verbs.get(word, (word, None))
    if count == 1:
        return f"1 object {one}"
    return f"{count} objects {many}" if many else f"{count} objects: {word}"
