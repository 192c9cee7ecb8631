"""Arrange: run a layout recipe and watch it settle, with a curve of every cost and a report."""

from __future__ import annotations

import numpy as np
import viser

from diorama_app.arrangements import arrangement_count, switch_arrangement
from diorama_app.guest import Guest
from diorama_app.layout_run import LayoutRun
from diorama_app.optimising import optimise, put_back, show_before
from diorama_app.page import Action, LiveHtml, button, text
from diorama_app.panels.fields import enable, on_press, show_if

RECIPES = {"Tidy up (feasible)": "feasible", "As in the paper": "paper", "All in one": "all-in-one"}
COLOURS = ("#2f6fd6", "#d6542f", "#269660", "#a050c8", "#c89614", "#149696", "#7a5a3a", "#808080")
CURVE_POINTS = 240
SHARES = frozenset({"orientation", "placement", "structure", "in_support"})
FIGURES = {
    "orientation": "Upright on their support",
    "placement": "Touching their support",
    "structure": "Both",
    "in_support": "Inside their support",
    "part_overlap_m": "Deepest overlap",
    "part_overlap_mean_m": "Mean overlap",
    "overlapping_pairs": "Overlapping pairs",
    "moved_m": "Moved, mean",
    "moved_most_m": "Moved, most",
}


class Optimiser:
    """Recipe, what may move, start, curves, report, whole-scene alternatives."""

    def __init__(self, gui: viser.GuiApi, guest: Guest) -> None:
        self._guest = guest
        self._gui = gui
        gui.add_markdown("Objects settle on their supports, out of each other and into the room. Locked ones stay.")
        self._recipe = gui.add_dropdown("Recipe", list(RECIPES), hint="How the layout is found")
        self._start = gui.add_button("Optimise layout", hint="One undo step; Cancel puts everything back")
        self._start_some = gui.add_button(
            "Optimise selection", color="gray", hint="Only what is selected (and what stands on it) moves"
        )
        on_press(self._start, lambda: self._started(some=False))
        on_press(self._start_some, lambda: self._started(some=True))
        self._result = LiveHtml(gui, self._act)
        self._folder = gui.add_folder(None)
        self._plot: viser.GuiUplotHandle | None = None
        self._names: tuple[str, ...] = ()
        self._report = LiveHtml(gui)
        self._arrangements = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Allow starting when nothing runs; show the curves and the last report."""
        room, run = self._guest.room, self._guest.room.layout_run
        idle = room.jobs.status is None and bool(room.scene.objects)
        enable(self._start, idle)
        enable(self._start_some, idle and bool(self._guest.selection))
        self._draw(run)
        self._result.show(_choice(run) if run is not None and run.final is not None else "")
        self._report.show("" if run is None else _report(run))
        self._arrangements.show(self._others() if idle else "")

    def _started(self, *, some: bool) -> None:
        name, guest = RECIPES[self._recipe.value], self._guest

        def start() -> None:
            optimise(guest, name, guest.need_selection() if some else ())

        guest.post(start)

    def _others(self) -> str:
        count = arrangement_count(self._guest.room.scene)
        if count < 2:
            return ""
        buttons = "".join(
            button(str(k + 1), "arrangement", k, title="Every unlocked object in its next best alternative")
            for k in range(count)
        )
        return (
            '<h4>Arrangements</h4><p class="dim">The whole room in its best, second best… shapes. Lock what you like, '
            f'switch, and lock more.</p><div class="bar tight">{buttons}</div>'
        )

    def _act(self, action: Action) -> None:
        guest, room = self._guest, self._guest.room
        if action.do == "before":
            guest.post(lambda: show_before(room, True))
        elif action.do == "after":
            guest.post(lambda: show_before(room, False))
        elif action.do == "back":
            guest.post(lambda: put_back(guest))
        elif action.do == "keep":
            guest.post(self._keep)
        elif action.do == "arrangement" and action.arg.isdigit():
            guest.post(lambda: switch_arrangement(guest, int(action.arg)))

    def _keep(self) -> None:
        room = self._guest.room
        if room.layout_run is not None and room.layout_run.showing_before:
            show_before(room, False)
        room.layout_run = None
        room.refresh_panels()

    def _draw(self, run: LayoutRun | None) -> None:
        if run is None or len(run.times_s) < 2:
            if self._plot is not None:
                show_if(False, self._plot)
            return
        names = tuple(list(run.costs)[: len(COLOURS)])
        step = max(1, len(run.times_s) // CURVE_POINTS)
        data = tuple(np.asarray(v, dtype=np.float64)[::step] for v in (run.times_s, *(run.costs[n] for n in names)))
        if self._plot is None or names != self._names:
            self._add_plot(names, data)
        elif len(data[0]) != len(self._plot.data[0]) or data[0][-1] != self._plot.data[0][-1]:
            self._plot.data = data
        assert self._plot is not None
        show_if(True, self._plot)

    def _add_plot(self, names: tuple[str, ...], data: tuple[np.ndarray, ...]) -> None:
        if self._plot is not None:
            self._plot.remove()
        series = [viser.uplot.Series(label="s")]
        for name, colour in zip(names, COLOURS, strict=False):
            series.append(viser.uplot.Series(label=name, stroke=colour, width=2))
        with self._folder:
            self._plot = self._gui.add_uplot(
                data, tuple(series), title="Costs", height=170, scales={"x": viser.uplot.Scale(time=False, auto=True)}
            )
        self._names = names


def _choice(run: LayoutRun) -> str:
    return (
        '<div class="bar tight">'
        + button("Before", "before", on=run.showing_before, title="Show where everything was")
        + button("After", "after", on=not run.showing_before, title="Show where it is now")
        + button("Keep", "keep", title="Put this comparison away")
        + button("Put back", "back", title="Take the optimisation back")
        + "</div>"
    )


def _report(run: LayoutRun) -> str:
    report = run.report
    if report is None:
        return ""
    names = [n for n in dict.fromkeys([*report.before, *report.after]) if n in report.after]
    rows = "".join(_row(name, report.before.get(name), report.after[name]) for name in names)
    reasons = "".join(f"<p>{text(reason)}</p>" for reason in report.reasons)
    why = f'<div class="card warn" style="margin-top:6px">{reasons}</div>' if reasons else ""
    return f"<h4>Before → after ({report.seconds:.1f} s)</h4><table>{rows}</table>{why}"


def _row(name: str, before: float | None, after: float) -> str:
    label = FIGURES.get(name, name.removesuffix("_m").replace("_", " "))
    first = "–" if before is None else _figure(name, before)
    return f"<tr><td>{text(label)}</td><td>{first} → {_figure(name, after)}</td></tr>"


def _figure(name: str, value: float) -> str:
    if name in SHARES:
        return f"{100 * value:.0f}%"
    return f"{100 * value:.1f} cm" if name.endswith("_m") else f"{value:.3g}"
