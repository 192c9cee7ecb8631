"""Arrange: run a layout recipe and watch it settle, with a curve of every cost and a report."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import viser

from diorama_app.commands.arrangements import Arrangements, switch_arrangement
from diorama_app.commands.optimise import optimise, put_back, put_back_worse, show_before
from diorama_app.panels.fields import QUIET_COLOUR, enable, on_change, on_press, show_if, show_value
from diorama_app.session.client import Client
from diorama_app.session.layout_run import LayoutRun
from diorama_app.strings import N_, _, plural
from diorama_app.web.html import Action, LiveHtml, button, library_text, text
from diorama_core.layout.settings import RecipeName, Weights, cost_names
from diorama_core.layout.what_got_worse import describe_worse, resizes_in_words
from diorama_core.scene.types import Scene

RECIPES: dict[str, RecipeName] = {
    N_("Tidy up"): "feasible",
    N_("As in the paper"): "paper",
    N_("All in one"): "all-in-one",
}
ABOUT: dict[RecipeName, str] = {
    "feasible": N_("Moves objects as little as possible until nothing overlaps, floats or stands outside the room."),
    "paper": N_("Minimises the published costs in turn; objects may move and change size more."),
    "all-in-one": N_("Minimises all published costs at once; sizes may change strongly."),
}
COLOURS = ("#2f6fd6", "#d6542f", "#269660", "#a050c8", "#c89614", "#149696", "#7a5a3a", "#808080")
CURVE_POINTS = 240
ABOUT_ARRANGEMENTS = N_(
    "1 gives every object its best shape, 2 the second-best, and so on. Locked objects stay. "
    "Select objects to change only those."
)
STAYED = (
    "{count} object that people placed stayed in place.",
    "{count} objects that people placed stayed in place.",
)
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


class Optimiser:
    """Recipe, what may move, start, curves, report, whole-scene alternatives."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._gui = gui
        self._recipe = gui.add_dropdown(_("Recipe"), list(map(_, RECIPES)), hint=_("How the layout is optimised"))
        on_change(
            self._recipe, lambda v: client.post(lambda: client.change_preferences(recipe=_recipe(v)), key="recipe")
        )
        self._about = LiveHtml(gui)
        self._weights: dict[str, viser.GuiSliderHandle[float]] = {}
        with gui.add_folder(_("Weights"), expand_by_default=False):
            for name, (label, hint) in WEIGHTS.items():
                hint = _("{hint}; 1 is the default").format(hint=_(hint))
                self._weights[name] = gui.add_slider(_(label), 0.0, 3.0, 0.1, 1.0, hint=hint)
                on_change(self._weights[name], lambda _: client.post(self.refresh, key="weights"))
            self._even = gui.add_button(_("Reset weights"), color=QUIET_COLOUR, hint=_("Set all weights to 1"))
        on_press(self._even, lambda: client.post(self._reset))
        self._start = gui.add_button(_("Optimise layout"), hint=_("One undo step; Cancel restores the layout"))
        self._start_some = gui.add_button(
            _("Optimise selection"), color=QUIET_COLOUR, hint=_("Move only the selection and what stands on it")
        )
        on_press(self._start, lambda: self._begin(some=False))
        on_press(self._start_some, lambda: self._begin(some=True))
        self._result = LiveHtml(gui, self._act)
        self._folder = gui.add_folder(None)
        self._plot: viser.GuiUplotHandle | None = None
        self._plots: dict[tuple[str, ...], viser.GuiUplotHandle] = {}
        self._names: tuple[str, ...] = ()
        self._report = LiveHtml(gui)
        self._arrangements = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Allow starting when nothing runs; show the curves and the last report."""
        session, run = self._client.session, self._client.session.layout_run
        idle = session.jobs.status is None and bool(session.scene.objects)
        recipe = self._client.preferences.recipe
        show_value(self._recipe, next(_(label) for label, name in RECIPES.items() if name == recipe))
        self._about.show(f'<p class="dim">{text(_(ABOUT[recipe]))} {text(_("Locked objects stay."))}</p>')
        used = cost_names(recipe)
        for name, slider in self._weights.items():
            show_if(name in used, slider)
        enable(self._even, any(slider.value != 1.0 for slider in self._weights.values()))
        enable(self._start, idle)
        enable(self._start_some, idle and bool(self._client.selection))
        self._draw(run)
        labels = {o.id: o.label for o in session.scene.objects}
        ended = run is not None and run.final is not None
        report = "" if run is None or not ended else _worse(run, labels) + _report(run, session.scene)
        self._result.show(_choice(run) + report if run is not None and ended else "")
        self._report.show("" if run is None else report_html(run))
        self._arrangements.show(self._others() if idle else "")

    def _begin(self, *, some: bool) -> None:
        client = self._client
        name = client.preferences.recipe

        def start() -> None:
            weights = Weights(**{cost: self._weights[cost].value for cost in cost_names(name)})
            optimise(client.session, name, client.need_selection() if some else (), weights, by=client)

        client.post(start)

    def _tidy(self, *, by_hand_too: bool = False) -> None:
        optimise(self._client.session, "feasible", by=self._client, by_hand_too=by_hand_too)

    def _others(self) -> str:
        arrangements, chosen = Arrangements(self._client.session.scene), self._client.selection
        count = arrangements.count
        if count < 2:
            return ""
        every = _("Give every unlocked object its alternative {number}")
        chosen_ones = _("Give the selected objects their alternative {number}")
        whole = "".join(
            button(str(k + 1), "arrangement", k, title=every.format(number=k + 1), on=on)
            for k, on in enumerate(arrangements.is_taken(k) for k in range(count))
        )
        some = "".join(
            button(str(k + 1), "mix", k, title=chosen_ones.format(number=k + 1), on=on)
            for k, on in enumerate(arrangements.is_taken(k, chosen) for k in range(count))
        )
        mixed = f'<p class="dim">{text(_("Selection only:"))}</p><div class="bar tight">{some}</div>' if chosen else ""
        return (
            f'<h4>{text(_("Arrangements"))}</h4><p class="dim">{text(_(ABOUT_ARRANGEMENTS))}</p>'
            f'<div class="bar tight">{whole}</div>{mixed}'
        )

    def _reset(self) -> None:
        for slider in self._weights.values():
            show_value(slider, 1.0)
        self.refresh()

    def _act(self, action: Action) -> None:
        client, session = self._client, self._client.session
        if action.do == "before":
            client.post(lambda: show_before(session, True))
        elif action.do == "after":
            client.post(lambda: show_before(session, False))
        elif action.do == "back worse":
            client.post(lambda: put_back_worse(client))
        elif action.do == "tidy":
            client.post(self._tidy)
        elif action.do == "tidy all":
            client.post(lambda: self._tidy(by_hand_too=True))
        elif action.do == "back":
            client.post(lambda: put_back(client))
        elif action.do == "keep":
            client.post(self._keep)
        elif action.do == "arrangement" and action.arg.isdigit():
            client.post(lambda: switch_arrangement(client, int(action.arg)))
        elif action.do == "mix" and action.arg.isdigit():
            client.post(lambda: switch_arrangement(client, int(action.arg), client.need_selection()))

    def _keep(self) -> None:
        session = self._client.session
        if session.layout_run is not None and session.layout_run.showing_before:
            show_before(session, False)
        session.layout_run = None
        session.refresh_panels()

    def _draw(self, run: LayoutRun | None) -> None:
        if run is None or len(run.times_s) < 2:
            if self._plot is not None:
                show_if(False, self._plot)
            return
        names = tuple(list(run.costs)[: len(COLOURS)])
        step = max(1, len(run.times_s) // CURVE_POINTS)
        # From the first cost on: what the recipe loads before is no part of its curves.
        times_s = np.asarray(run.times_s, dtype=np.float64) - run.times_s[0]
        costs = (np.asarray(run.costs[n], dtype=np.float64) for n in names)
        data = tuple(values[::step] for values in (times_s, *costs))
        if self._plot is None or names != self._names:
            self._add_plot(names, data)
        elif len(data[0]) != len(self._plot.data[0]) or data[0][-1] != self._plot.data[0][-1]:
            self._plot.data = data
        assert self._plot is not None
        show_if(True, self._plot)

    def _add_plot(self, names: tuple[str, ...], data: tuple[np.ndarray, ...]) -> None:
        if self._plot is not None:
            show_if(False, self._plot)
        self._names = names
        if names in self._plots:  # a removed one would still be sent what came before its end
            self._plot = self._plots[names]
            self._plot.data = data
            return
        series = [viser.uplot.Series(label=_("Seconds"))]
        for name, colour in zip(names, COLOURS, strict=False):
            series.append(viser.uplot.Series(label=_(COSTS.get(name, name)), stroke=colour, width=2))
        with self._folder:
            self._plot = self._gui.add_uplot(
                data,
                tuple(series),
                title=_("Costs"),
                height=170,
                scales={"x": viser.uplot.Scale(time=False, auto=True)},
            )
        self._plots[names] = self._plot


def _recipe(label: str) -> RecipeName:
    return next(name for english, name in RECIPES.items() if _(english) == label)


def _choice(run: LayoutRun) -> str:
    return (
        '<div class="bar tight">'
        + button(_("Before"), "before", on=run.showing_before, title=_("Show the layout before the run"))
        + button(_("After"), "after", on=not run.showing_before, title=_("Show the layout after the run"))
        + button(_("Keep"), "keep", title=_("Keep the result and close the comparison"))
        + button(_("Revert"), "back", title=_("Undo the optimisation"))
        + "</div>"
    )


def _worse(run: LayoutRun, labels: Mapping[str, str]) -> str:
    """What the recipe made worse, and what can be done about it."""
    lines = () if run.report is None else describe_worse(run.report, run.worse, labels)
    if not lines:
        return ""
    back = button(_("Put back what got worse"), "back worse", title=_("One undo step")) if run.worse else ""
    tidy = (
        button(_("Tidy up"), "tidy", title=_("Move objects onto their supports and apart"))
        if run.recipe != "feasible"
        else ""
    )
    bar = f'<div class="bar tight" style="margin:6px 0 0 0">{back}{tidy}</div>' if back or tidy else ""
    body = "".join(f"<p>{library_text(line)}</p>" for line in lines)
    body = f"<b>{text(_('What got worse'))}</b>{body}"
    return f'<div class="card warn" role="status" style="margin-bottom:6px">{body}{bar}</div>'


def _report(run: LayoutRun, scene: Scene) -> str:
    """Which sizes changed, and what stayed because people placed it."""
    lines = list(resizes_in_words(run.start, scene))
    if run.left:
        lines.append(plural(*STAYED, run.left))
    bar = button(_("Tidy up all"), "tidy all", title=_("Also move objects that people placed")) if run.left else ""
    bar = f'<div class="bar tight" style="margin:6px 0 0 0">{bar}</div>' if bar else ""
    body = "".join(f"<p>{library_text(line)}</p>" for line in lines)
    return f'<div class="card" role="status" style="margin-bottom:6px">{body}{bar}</div>' if lines else ""


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
    words = "".join(f"<p>{text(line)}</p>" for line in _summary_sentences(report.before, report.after))
    tables = f"<table>{figures}</table>" + (f"<h4>{text(_('Costs'))}</h4><table>{costs}</table>" if costs else "")
    title = _("Before → after ({seconds:.1f} s)").format(seconds=report.seconds)
    figures = f"<details><summary class='dim'>{text(title)}</summary>{tables}</details>"
    return f"<h4>{text(_('Result'))}</h4>{words}{why}{figures}"


def _summary_sentences(before: Mapping[str, float], after: Mapping[str, float]) -> Iterator[str]:
    """Sentences about overlaps, supports, and how far objects moved."""
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
