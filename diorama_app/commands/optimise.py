"""Runs of a layout recipe in the background: live preview, pause, cancel, one undo step, comparison."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from diorama_app.commands.glide import pose_between
from diorama_app.session.client import Client
from diorama_app.session.layout_run import Costs, LayoutRun, Samples
from diorama_app.session.problem_checker import problems
from diorama_app.session.session import EditorSession
from diorama_app.strings import _
from diorama_core.artefacts import LayoutReport
from diorama_core.editing.collisions import Collisions
from diorama_core.editing.hand_placed import ids_to_keep
from diorama_core.errors import EditRefused
from diorama_core.layout.report import layout_figures
from diorama_core.layout.settings import AS_IT_IS, Weights
from diorama_core.layout.what_got_worse import Problems, find_excessive_resizes, new_problems, with_believed_sizes
from diorama_core.progress import Progress
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Pose, Scene

PREVIEW_EVERY_S = 0.05
"""A browser receives at most twenty frames a second."""

CURVES_EVERY_S = 0.5
"""The curves of a running optimiser: drawn with every picture they would be a third of what the page has to do."""

GLIDE_S = 0.9
"""Duration of the animation of a layout that was computed at once."""

GLIDE_BELOW = 10
"""A run with fewer frames than this is animated afterwards."""

PAUSE_POLL_S = 0.05

PUBLISHED = ("paper", "all-in-one")
"""Recipes that do as they were published, sizes included."""


def optimise(
    session: EditorSession,
    recipe_name: str,
    only: tuple[str, ...] = (),
    weights: Weights = AS_IT_IS,
    *,
    by: Client | None = None,
    author: str = "",
    by_hand_too: bool = False,
) -> LayoutRun:
    """Optimise the layout of everything unlocked, or of `only` these and the objects on them; one undo step.

    Args:
        session: where.
        recipe_name: how; sizes stay within `MAX_RESIZE` of what they were unless it is a published recipe.
        only: ids that are free to move, whoever placed them; when empty, all but what people placed.
        weights: of the recipe's costs.
        by: the browser that asks.
        author: who asks where no browser does: the name of another program.
        by_hand_too: whether what people placed is free to move as well.

    Raises:
        EditRefused: nothing is free to move.
    """
    start = session.scene
    if not start.objects:
        raise EditRefused("there is nothing to arrange; insert furniture first")
    left = frozenset[str]() if only or by_hand_too else ids_to_keep(start)
    free = frozenset(only) or frozenset(o.id for o in start.objects if o.id not in left)
    if not free:
        raise EditRefused(
            "everything here was placed by people and stays; select what may move, then optimise the selection"
        )
    run = LayoutRun(
        recipe_name, time.monotonic(), start, only, left=sum(o.by_hand and o.id in left for o in start.objects)
    )

    def work(progress: Progress) -> None:
        from diorama_core.layout.recipes import RoomByRoom, recipe

        frames = _Frames(session, run, progress)
        try:
            everything = len(free) == len(start.objects)
            stage = RoomByRoom(recipe(recipe_name, session.library, None if everything else free, weights=weights))
            final, report = stage.optimise(start, progress, frames.take)
            if recipe_name not in PUBLISHED:
                final = with_believed_sizes(start, final)
        except BaseException:
            session.ui_thread.post(session.refresh)  # cancelled or failed: everything goes back to the document
            raise
        session.ui_thread.post(lambda: run.read(frames.samples))
        run.worse = _worse(session, start, final)
        if frames.shown < GLIDE_BELOW:
            _glide(session, start, final, progress)
        asker = None if by is None else by.id
        session.post(asker, lambda: _arrange(session, final, report, run, by=by, author=author))

    session.jobs.start("optimise", _("Arranging the layout"), work)
    session.layout_run = run
    return run


class _Frames:
    """Scenes and costs of a run while it goes on: all costs are collected, a scene is shown from time to time."""

    def __init__(self, session: EditorSession, run: LayoutRun, progress: Progress) -> None:
        self.samples: Samples = []
        self.shown = 0
        """Number of scenes."""
        self._session, self._run, self._progress = session, run, progress
        self._last_shown = 0.0

    def take(self, scene: Scene, costs: Costs) -> None:
        """Receive a step of the optimiser; while the run is paused, this waits."""
        now = time.monotonic()
        self.samples.append((now - self._run.started_at, tuple(costs)))
        if now - self._last_shown >= PREVIEW_EVERY_S:
            self._last_shown, self.shown = now, self.shown + 1
            show = partial(_show_step, self._session, scene, self._run, self.samples)
            self._session.ui_thread.post(show, key="preview")
        while not self._run.going.wait(PAUSE_POLL_S):
            self._progress.check()


def _worse(session: EditorSession, start: Scene, final: Scene) -> Problems:
    """What is wrong with objects now and was not before, by id."""
    collisions = Collisions(session.library)
    found = new_problems(problems(start, session.library, collisions), problems(final, session.library, collisions))
    resized = find_excessive_resizes(start, final)
    return {i: (*found.get(i, ()), *resized.get(i, ())) for i in (*found, *(i for i in resized if i not in found))}


def pause(session: EditorSession, paused: bool) -> None:
    """Pause or resume the running optimisation."""
    run = session.layout_run
    if run is not None:
        if paused:
            run.going.clear()
        else:
            run.going.set()
        session.refresh_panels()


def show_before(session: EditorSession, before: bool) -> None:
    """Preview the layout before or after the last optimisation; the document does not change."""
    run = session.layout_run
    if run is None or run.final is None:
        raise EditRefused("there is no optimised layout yet; run the optimiser first")
    run.showing_before = before
    poses = {o.id: o.pose for o in session.scene.objects}
    if before:
        poses |= {o.id: o.pose for o in run.start.objects if o.id in poses}
    session.viewport.preview(poses)
    session.refresh_panels()


def put_back(client: Client) -> None:
    """Revert the last optimisation; a further undo step when other edits followed it."""
    session, run = client.session, client.session.layout_run
    if run is None or run.final is None:
        raise EditRefused("there is no optimised layout yet; run the optimiser first")
    run.showing_before = False
    if session.scene is run.final and session.is_of(client, session.document.history.current):
        session.undo(client)
    else:
        there = {o.id: o.pose for o in run.start.objects if session.scene.has_object(o.id)}
        session.edit(_("revert the layout"), lambda s: edits.place(s, there), by=client)
    session.layout_run = None
    session.refresh_panels()


def put_back_worse(client: Client) -> None:
    """Objects that float, collide or left the room since the last optimisation go back to where they were."""
    session, run = client.session, client.session.layout_run
    if run is None or not run.worse:
        raise EditRefused("nothing got worse")
    there = {}
    for object_id in run.worse:
        for one in (object_id, *descendants(run.start, object_id)):
            if session.scene.has_object(one) and run.start.has_object(one):
                there[one] = run.start.object(one).pose
    session.edit(_("put back what got worse"), lambda s: edits.place(s, there), by=client)
    run.worse = {}
    if run.report is not None:
        run.report = replace(run.report, after=layout_figures(run.start, session.scene, session.library))
    session.refresh_panels()


def _glide(session: EditorSession, start: Scene, final: Scene, progress: Progress) -> None:
    """Animate a recipe that finds its solution at once."""
    frames = int(GLIDE_S / PREVIEW_EVERY_S)
    for frame in range(1, frames + 1):
        share = 0.5 - 0.5 * np.cos(np.pi * frame / frames)
        between = {o.id: pose_between(start.object(o.id).pose, o.pose, float(share)) for o in final.objects}
        session.ui_thread.post(partial(session.viewport.preview, between), key="preview")
        time.sleep(PREVIEW_EVERY_S)
        progress.report(1.0, "Settling")


def _show_step(session: EditorSession, scene: Scene, run: LayoutRun, samples: Samples) -> None:
    session.viewport.preview(final_poses(session.scene, run.start, scene))
    now = time.monotonic()
    if now - run.drawn_at < CURVES_EVERY_S:
        return
    run.drawn_at = now
    run.read(samples)
    for client in session.clients.values():
        if client.curves is not None:
            client.curves.refresh()


def _arrange(
    session: EditorSession, final: Scene, report: LayoutReport, run: LayoutRun, *, by: Client | None, author: str
) -> None:
    current = session.scene
    if current is run.start:
        scene = edits.set_metrics(final, report.after)
    else:
        scene = edits.set_metrics(edits.place(current, final_poses(current, run.start, final)), report.after)
    run.report, run.final = report, scene
    label = _("arrange the layout") if run.recipe in PUBLISHED else _("tidy up")
    session.commit(label, scene, by=by, author=author)


def final_poses(current: Scene, start: Scene, final: Scene) -> Mapping[str, Pose]:
    """The final poses of objects that nobody has edited since the start; locked ones stay where they are."""
    return {
        o.id: o.pose
        for o in final.objects
        if current.has_object(o.id)
        and start.has_object(o.id)
        and current.object(o.id) == start.object(o.id)
        and not current.object(o.id).locked
    }
