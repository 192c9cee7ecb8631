"""Arrange: run a layout recipe and watch it settle, with a curve of every cost and a report."""

from __future__ import annotations

import numpy as np
import viser

from diorama_app import work
from diorama_app.page import LiveHtml, text
from diorama_app.panels.fields import on_press, show_if
from diorama_app.room import Room
from diorama_app.work import LayoutRun

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
    """Recipe, start, curves, report."""

    def __init__(self, gui: viser.GuiApi, room: Room) -> None:
        self._room = room
        self._gui = gui
        gui.add_markdown("Objects settle on their supports, out of each other and into the room. Locked ones stay.")
        self._recipe = gui.add_dropdown("Recipe", list(RECIPES), hint="How the layout is found")
        self._start = gui.add_button("Optimise layout", hint="One undo step; Cancel puts everything back")
        on_press(self._start, self._started)
        self._folder = gui.add_folder(None)
        self._plot: viser.GuiUplotHandle | None = None
        self._names: tuple[str, ...] = ()
        self._run: LayoutRun | None = None
        self._report = LiveHtml(gui)

    def refresh(self) -> None:
        """Allow starting when nothing runs; show the last report."""
        busy = self._room.jobs.status is not None or not self._room.scene.objects
        if self._start.disabled != busy:
            self._start.disabled = busy
        self._report.show("" if self._run is None else _report(self._run))

    def _started(self, client_id: int) -> None:
        name = RECIPES[self._recipe.value]

        def start() -> None:
            self._run = work.optimise(self._room, name, self._show)

        self._room.post(client_id, start)

    def _show(self, run: LayoutRun) -> None:
        self._run = run
        self._draw(run)
        self.refresh()

    def _draw(self, run: LayoutRun) -> None:
        if len(run.times_s) < 2:
            return
        names = tuple(list(run.costs)[: len(COLOURS)])
        step = max(1, len(run.times_s) // CURVE_POINTS)
        data = tuple(np.asarray(v, dtype=np.float64)[::step] for v in (run.times_s, *(run.costs[n] for n in names)))
        if self._plot is None or names != self._names:
            self._add_plot(names, data)
        else:
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
