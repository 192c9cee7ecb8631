"""What a layout run did: in sentences, and in figures for those who want them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from diorama_app.session.layout_run import LayoutRun
from diorama_app.strings import N_, _, plural
from diorama_app.web.html import library_text, text

SHARES = frozenset({"orientation", "placement", "structure", "in_support"})
FIGURES = {
    "orientation": N_("Upright on their support"),
    "placement": N_("Touching their support"),
    "structure": N_("Upright and touching"),
    "in_support": N_("Inside their support"),
    "part_overlap_m": N_("Deepest overlap"),
    "part_overlap_mean_m": N_("Mean overlap"),
    "overlapping_pairs": N_("Overlapping pairs"),
    "moved_m": N_("Moved, mean"),
    "moved_most_m": N_("Moved, maximum"),
    "box_overlap_m": N_("Overlap of boxes, mean"),
}
WEIGHTS = {
    "outline": (N_("As in the photo"), N_("Objects stay where the photo shows them")),
    "distance": (N_("Distance"), N_("Objects keep their distance from the camera")),
    "align": (N_("Upright"), N_("Objects stand upright on their support")),
    "heading": (N_("Facing"), N_("Objects keep the direction they face in the photo")),
    "place": (N_("Touching"), N_("Objects touch their support")),
    "neighbours": (N_("Neighbours"), N_("Objects near each other keep their arrangement")),
    "volume": (N_("Within support"), N_("Objects stay within the bounds of their support")),
    "collision": (N_("Separation"), N_("Objects do not overlap")),
}
"""Label and hint of the weight of each cost."""
COSTS = {
    **{name: label for name, (label, _) in WEIGHTS.items()},
    "overlap_m": N_("Overlap (m)"),
    "moved_m": N_("Moved (m)"),
    "e_align": N_("Upright"),
    "e_sem": N_("Facing"),
    "e_place": N_("Touching"),
    "e_rel": N_("Neighbours"),
    "e_vol": N_("Within support"),
    "e_col": N_("Separation"),
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
    reasons = "".join(f"<p>{library_text(reason)}</p>" for reason in report.reasons)
    why = f'<div class="card warn" style="margin-top:6px">{reasons}</div>' if reasons else ""
    words = "".join(f"<p>{text(line)}</p>" for line in _in_sentences(report.before, report.after))
    tables = f"<table>{figures}</table>" + (f"<h4>{text(_('Costs'))}</h4><table>{costs}</table>" if costs else "")
    title = _("Before → after ({seconds:.1f} s)").format(seconds=report.seconds)
    figures = f"<details><summary class='dim'>{text(title)}</summary>{tables}</details>"
    return f"<h4>{text(_('Result'))}</h4>{words}{why}{figures}"


def _in_sentences(before: Mapping[str, float], after: Mapping[str, float]) -> Iterator[str]:
    """What a person wants to know first: overlaps, supports, and how far things moved."""
    if "overlapping_pairs" in after and "overlapping_pairs" in before:
        was, now = round(before["overlapping_pairs"]), round(after["overlapping_pairs"])
        pairs = plural("{count} pair of objects overlaps", "{count} pairs of objects overlap", now)
        yield _("{pairs}; {was} before.").format(pairs=pairs, was=was) if now or was else _("No objects overlap.")
    if "structure" in after:
        percent = round(100 * after["structure"])
        yield _("{percent} % of the objects stand upright and touch their support.").format(percent=percent)
    if "moved_m" in after and "moved_most_m" in after:
        mean, most = (_figure(name, after[name]) for name in ("moved_m", "moved_most_m"))
        yield _("Objects moved {mean} on average, {most} at most.").format(mean=mean, most=most)


def _row(name: str, before: float | None, after: float) -> str:
    label = FIGURES.get(name) or COSTS.get(name, name.removesuffix("_m").replace("_", " "))
    first = "–" if before is None else _figure(name, before)
    return f"<tr><td>{text(_(label))}</td><td>{first} → {_figure(name, after)}</td></tr>"


def _figure(name: str, value: float) -> str:
    if name in SHARES:
        return f"{100 * value:.0f}%"
    if name.endswith("_m"):
        return f"{100 * value:.1f} cm"
    return f"{value:.3g}" if abs(value) >= MIN_COST else "0"
