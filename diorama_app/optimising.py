"""Run a layout recipe beside the desk: live preview, pause, cancel, one undo step; before and after to compare."""

from __future__ import annotations

import time
from collections.abc import Mapping
from functools import partial

import numpy as np
import viser.transforms as vtf

from diorama_app.guest import Guest
from diorama_app.layout_run import Costs, LayoutRun, Samples
from diorama_app.room import Room
from diorama_core.artefacts import LayoutReport
from diorama_core.errors import EditRefused
from diorama_core.layout.weights import AS_IT_IS, Weights
from diorama_core.progress import Progress
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene

PREVIEW_EVERY_S = 0.05
"""Twenty pictures a second are what reaches a browser."""

GLIDE_S = 0.9
"""How long a layout that was found at once takes to settle before people's eyes."""

GLIDE_BELOW = 10
"""A run with fewer pictures than this is too abrupt to be followed."""

PAUSE_LOOK_S = 0.05


def optimise(guest: Guest, recipe_name: str, only: tuple[str, ...] = (), weights: Weights = AS_IT_IS) -> LayoutRun:
    """Optimise the layout of everything unlocked, or of `only` these and what they hold up; one undo step."""
    room = guest.room
    start = room.scene
    if not start.objects:
        raise EditRefused("there is nothing to arrange; insert furniture first")
    run = LayoutRun(recipe_name, time.monotonic(), start, only)

    def work(progress: Progress) -> None:
        from diorama_core.layout.recipes import recipe

        shown, pictures = 0.0, 0
        samples: Samples = []

        def preview(scene: Scene, costs: Costs) -> None:
            nonlocal shown, pictures
            now = time.monotonic()
            samples.append((now - run.started_at, tuple(costs)))
            if now - shown >= PREVIEW_EVERY_S:
                shown, pictures = now, pictures + 1
                room.desk.post(lambda: _show_step(room, scene, run, samples), key="preview")
            while not run.going.wait(PAUSE_LOOK_S):
                progress.check()

        try:
            stage = recipe(recipe_name, room.library, frozenset(only) if only else None, weights=weights)
            final, report = stage.optimise(start, progress, preview)
        except BaseException:
            room.desk.post(room.refresh)  # cancelled or failed: everything goes back to the document
            raise
        room.desk.post(lambda: run.read(samples))
        if pictures < GLIDE_BELOW:
            _glide(room, start, final, progress)
        guest.post(lambda: _arranged(guest, final, report, run))

    room.jobs.start("optimise", "Arranging the layout", work)
    room.layout_run = run
    return run


def pause(room: Room, paused: bool) -> None:
    """Let the running optimisation wait, or go on."""
    run = room.layout_run
    if run is not None:
        if paused:
            run.going.clear()
        else:
            run.going.set()
        room.refresh_panels()


def show_before(room: Room, before: bool) -> None:
    """Show where everything was before the last optimisation, or where it is now; the document stays."""
    run = room.layout_run
    if run is None or run.final is None:
        raise EditRefused("no layout was optimised yet")
    run.showing_before = before
    poses = {o.id: o.pose for o in room.scene.objects}
    if before:
        poses |= {o.id: o.pose for o in run.start.objects if o.id in poses}
    room.preview(poses)
    room.refresh_panels()


def put_back(guest: Guest) -> None:
    """Take the last optimisation back, with one more undo step when something else was done since."""
    room, run = guest.room, guest.room.layout_run
    if run is None or run.final is None:
        raise EditRefused("no layout was optimised yet")
    run.showing_before = False
    if room.scene is run.final:
        room.undo(guest)
    else:
        there = {o.id: o.pose for o in run.start.objects if room.scene.has_object(o.id)}
        room.edit("put the layout back", lambda s: edits.place(s, there), by=guest)
    room.layout_run = None
    room.refresh_panels()


def _glide(room: Room, start: Scene, final: Scene, progress: Progress) -> None:
    """A recipe that finds its answer at once is still watched on its way there."""
    frames = int(GLIDE_S / PREVIEW_EVERY_S)
    for frame in range(1, frames + 1):
        share = 0.5 - 0.5 * np.cos(np.pi * frame / frames)
        between = {o.id: _between(start.object(o.id).pose, o.pose, float(share)) for o in final.objects}
        room.desk.post(partial(room.preview, between), key="preview")
        time.sleep(PREVIEW_EVERY_S)
        progress.report(1.0, "Settling")


def _between(a: Pose, b: Pose, share: float) -> Pose:
    turn = vtf.SO3.from_matrix(b.R_world_object @ a.R_world_object.T)
    R = vtf.SO3.exp(share * turn.log()).as_matrix() @ a.R_world_object
    u, _, vt = np.linalg.svd(R)
    return Pose(u @ vt, a.position + share * (b.position - a.position), a.scale + share * (b.scale - a.scale))


def _show_step(room: Room, scene: Scene, run: LayoutRun, samples: Samples) -> None:
    room.preview(untouched(room.scene, run.start, scene))
    run.read(samples)
    for guest in room.guests.values():
        if guest.curves is not None:
            guest.curves.refresh()


def _arranged(guest: Guest, final: Scene, report: LayoutReport, run: LayoutRun) -> None:
    room = guest.room
    current = room.scene
    if current is run.start:
        scene = edits.set_metrics(final, report.after)
    else:
        scene = edits.set_metrics(edits.place(current, untouched(current, run.start, final)), report.after)
    run.report, run.final = report, scene
    room.commit("arrange the layout", scene, by=guest)


def untouched(current: Scene, start: Scene, final: Scene) -> Mapping[str, Pose]:
    """The final poses of objects that nobody has edited since the start; locked ones stay where they are."""
    return {
        o.id: o.pose
        for o in final.objects
        if current.has_object(o.id)
        and start.has_object(o.id)
        and current.object(o.id) == start.object(o.id)
        and not current.object(o.id).locked
    }
