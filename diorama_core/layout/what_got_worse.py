"""What a layout recipe made worse, in words: recipes stay as they were published, but people are told."""

from __future__ import annotations

from collections.abc import Mapping

from diorama_core.artefacts import LayoutReport, PhotoDisagreement

Problems = Mapping[str, tuple[str, ...]]
"""By object id, what is wrong with it, in a word each."""

FAR_M = 0.3
"""A layout whose objects moved so far on average is hardly that of the photo."""
MIN_M = 0.005


def new_problems(before: Problems, after: Problems) -> dict[str, tuple[str, ...]]:
    """Problems that objects have now and did not have before."""
    fresh = {i: tuple(w for w in words if w not in before.get(i, ())) for i, words in after.items()}
    return {i: words for i, words in fresh.items() if words}


def in_words(report: LayoutReport, worse: Problems, labels: Mapping[str, str]) -> tuple[str, ...]:
    """One sentence for everything that got worse; empty where nothing did.

    Args:
        report: figures before and after.
        worse: problems that are new, by object id.
        labels: what objects are called.
    """
    lines = []
    for word in sorted({w for words in worse.values() for w in words}):
        names = [labels.get(i, i) for i, words in worse.items() if word in words]
        lines.append(f"{_verb(word, len(names))}: {', '.join(names)}.")
    before, after = report.before, report.after
    pairs, more = before.get("overlapping_pairs"), after.get("overlapping_pairs")
    if pairs is not None and more is not None and more > pairs:
        lines.append(f"Overlapping pairs went from {pairs:.0f} to {more:.0f}.")
    deep, deeper = before.get("part_overlap_m"), after.get("part_overlap_m")
    if deep is not None and deeper is not None and deeper > deep + MIN_M:
        lines.append(f"The deepest overlap went from {100 * deep:.0f} cm to {100 * deeper:.0f} cm.")
    moved = after.get("moved_m", 0.0)
    if moved > FAR_M:
        lines.append(f"Objects moved by {100 * moved:.0f} cm on average; the photo shows them elsewhere.")
    return tuple(lines)


def disagreement_in_words(found: PhotoDisagreement) -> str:
    """One sentence for an object that agrees less with the photo than before."""
    return (
        f"agrees less with the photo: {found.label} moved {100 * found.moved_m:.0f} cm; its outline still covers "
        f"{100 * found.outline_shared:.0f} % of where it was seen"
    )


def _verb(word: str, count: int) -> str:
    singular = {"floats": "1 object floats", "collides": "1 object collides", "outside": "1 object left the room"}
    plural = {"floats": "objects float", "collides": "objects collide", "outside": "objects left the room"}
    return singular.get(word, f"1 object {word}") if count == 1 else f"{count} {plural.get(word, f'objects: {word}')}"
