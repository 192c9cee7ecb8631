"""What a layout run did: in sentences, and in figures for those who want them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from diorama_app.session.layout_run import LayoutRun
from diorama_app.web.html import text
from diorama_core.io.text import number_of

SHARES = frozenset({"orientation", "placement", "structure", "in_support"})
FIGURES = {
    "orientation": "Upright on their support",
    "placement": "Touching their support",
    "structure": "Upright and touching",
    "in_support": "Inside their support",
    "part_overlap_m": "Deepest overlap",
    "part_overlap_mean_m": "Mean overlap",
    "overlapping_pairs": "Overlapping pairs",
    "moved_m": "Moved, mean",
    "moved_most_m": "Moved, maximum",
    "box_overlap_m": "Overlap of boxes, mean",
}
WEIGHTS = {
    "outline": ("As in the photo", "Objects stay where the photo shows them"),
    "distance": ("Distance", "Objects keep their distance from the camera"),
    "align": ("Upright", "Objects stand upright on their support"),
    "heading": ("Facing", "Objects keep the direction they face in the photo"),
    "place": ("Touching", "Objects touch their support"),
    "neighbours": ("Neighbours", "Objects near each other keep their arrangement"),
    "volume": ("Within support", "Objects stay within the bounds of their support"),
    "collision": ("Separation", "Objects do not overlap"),
}
"""Label and hint of the weight of each cost."""
COSTS = {
    **{name: label for name, (label, _) in WEIGHTS.items()},
    "overlap_m": "Overlap (m)",
    "moved_m": "Moved (m)",
    "e_align": "Upright",
    "e_sem": "Facing",
    "e_place": "Touching",
    "e_rel": "Neighbours",
    "e_vol": "Within support",
    "e_col": "Separation",
}
"""Labels of the costs in curves and tables."""
MIN_COST = 1e-6


def report_html(run: LayoutRun) -> str:
    """The result of a run in sentences, with all figures folded below; empty while there is none."""
    report = run.report
    if report is None:
        return ""
    names = [n for n in dict.fromkeys([*report.before, *report.after]) if n in report.after]
    figures = "".join(_row(n, report.before.get(n), report.after[n]) for n in names if n in FIGURES)
    costs = "".join(_row(n, report.before.get(n), report.after[n]) for n in names if n not in FIGURES)
    reasons = "".join(f"<p>{text(reason)}</p>" for reason in report.reasons)
    why = f'<div class="card warn" style="margin-top:6px">{reasons}</div>' if reasons else ""
    words = "".join(f"<p>{line}</p>" for line in _in_sentences(report.before, report.after))
    tables = f"<table>{figures}</table>" + (f"<h4>Costs</h4><table>{costs}</table>" if costs else "")
    title = f"Before → after ({report.seconds:.1f} s)"
    return f"<h4>Result</h4>{words}{why}<details><summary class='dim'>{title}</summary>{tables}</details>"


def _in_sentences(before: Mapping[str, float], after: Mapping[str, float]) -> Iterator[str]:
    """What a person wants to know first: overlaps, supports, and how far things moved."""
    if "overlapping_pairs" in after and "overlapping_pairs" in before:
        was, now = round(before["overlapping_pairs"]), round(after["overlapping_pairs"])
        yield f"{number_of(now, 'pair')} of objects overlap; {was} did before." if now or was else "No objects overlap."
    if "structure" in after:
        yield f"{100 * after['structure']:.0f} % of the objects stand upright and touch their support."
    if "moved_m" in after and "moved_most_m" in after:
        mean, most = (_figure(name, after[name]) for name in ("moved_m", "moved_most_m"))
        yield f"Objects moved {mean} on average, {most} at most."


def _row(name: str, before: float | None, after: float) -> str:
    label = FIGURES.get(name) or COSTS.get(name, name.removesuffix("_m").replace("_", " "))
    first = "–" if before is None else _figure(name, before)
    return f"<tr><td>{text(label)}</td><td>{first} → {_figure(name, after)}</td></tr>"


def _figure(name: str, value: float) -> str:
    if name in SHARES:
        return f"{100 * value:.0f}%"
    if name.endswith("_m"):
        return f"{100 * value:.1f} cm"
    return f"{value:.3g}" if abs(value) >= MIN_COST else "0"
