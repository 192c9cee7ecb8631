"""Play with a scene: gravity acts, clicks push, and what came of it is one undo step."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from queue import SimpleQueue
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from diorama_app.commands.optimise import final_poses
from diorama_app.session.client import Client, Playing
from diorama_app.strings import _
from diorama_core.editing.support_changes import reattach
from diorama_core.errors import EditRefused
from diorama_core.geometry.rotations import rotation_vector
from diorama_core.progress import Progress
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene

if TYPE_CHECKING:
    from diorama_core.export.stability import Playground  # the exports; the page opens without them

SHOWN_EVERY_S = 1 / 15
LONGEST_S = 120.0
"""Length of a game that nobody ends."""
STAYED_M, STAYED_RAD = 0.003, 0.01
"""Movements below these are none."""
LAG_S = 0.2
"""A slow machine plays slower rather than by leaps: so much at once at most."""


@dataclass
class Game:
    """What goes on between the page and the thread that simulates."""

    start: Scene
    pushes: SimpleQueue[tuple[str, Float[np.ndarray, 3]]] = field(default_factory=SimpleQueue)
    ended: threading.Event = field(default_factory=threading.Event)


def play(client: Client) -> None:
    """Let gravity act until it is called again; then what moved is one undo step. Cancelling the job changes nothing.

    Raises:
        EditRefused: there is nothing to play with, or another job runs.
    """
    session, doing = client.session, client.doing
    if isinstance(doing, Playing):
        doing.end()
        return
    if not session.scene.objects:
        raise EditRefused("there is nothing to play with; insert furniture first")
    game = Game(session.scene)

    def work(progress: Progress) -> None:
        from diorama_core.export.gathering import gather
        from diorama_core.export.stability import Playground

        try:
            gathered = gather(game.start, session.library, progress=progress.part(0.0, 0.3))
            progress.report(0.4, "preparing colliders")
            playground = Playground(gathered)
            _run(playground, game, progress, lambda: _show(client, playground))
            final = edits.place(game.start, playground.poses())
        except BaseException:
            session.ui_thread.post(session.refresh)  # everything goes back to the document
            raise
        finally:
            client.post(lambda: _stop(client))
        client.post(lambda: _keep(client, game.start, final))

    session.jobs.start("play", _("Playing"), work)
    client.doing = Playing(lambda object_id, direction: game.pushes.put((object_id, direction)), game.ended.set)
    client.refresh()


def _run(playground: Playground, game: Game, progress: Progress, show: Callable[[], None]) -> None:
    then = time.monotonic()
    while not game.ended.wait(SHOWN_EVERY_S) and playground.seconds < LONGEST_S:
        progress.check()
        while not game.pushes.empty():
            playground.push(*game.pushes.get())
        now = time.monotonic()
        playground.step(min(now - then, LAG_S))
        then = now
        progress.report(0.5, "click an object to push it; Play again keeps what moved")
        show()


def _show(client: Client, playground: Playground) -> None:
    poses = playground.poses()
    client.session.ui_thread.post(lambda: client.session.viewport.preview(poses), key="preview")


def _stop(client: Client) -> None:
    if isinstance(client.doing, Playing):
        client.doing = None
        client.refresh()


def _is_still(before: Pose, after: Pose) -> bool:
    """Whether an object is where it was, but for how a simulation settles."""
    turn = rotation_vector(after.R_world_object @ before.R_world_object.T)
    return float(np.linalg.norm(after.position - before.position)) < STAYED_M and (
        float(np.linalg.norm(turn)) < STAYED_RAD
    )


def _keep(client: Client, start: Scene, final: Scene) -> None:
    session = client.session
    poses = final_poses(session.scene, start, final)
    moved = {i: p for i, p in poses.items() if not _is_still(start.object(i).pose, p)}
    if not moved:
        client.notice(_("Nothing moved."), "good")
        session.refresh()
        return
    played = edits.place(session.scene, moved)
    session.commit("play", reattach(session.scene, played), by=client)
