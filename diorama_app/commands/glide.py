"""Objects that a step moved glide to their new places, so that one sees what changed."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from diorama_core.geometry.rotations import rotation_from_vector, rotation_vector
from diorama_core.scene.types import Pose, Scene

if TYPE_CHECKING:
    from diorama_app.session.session import EditorSession

STEPS, DURATION_S = 8, 0.4
"""How many places of a way are shown, and how long it takes: an eye follows it, and nobody waits for it."""


def glide(session: EditorSession, before: Scene) -> None:
    """Show the way from an earlier scene to the present one; an edit meanwhile ends it.

    A scene that grew as a whole is shown at once: its walls do not glide.

    Args:
        session: shows the present scene already. Called from its UI thread.
        before: the earlier scene.
    """
    after = session.scene
    if after.architecture is not before.architecture:
        return
    ways = {
        o.id: (before.object(o.id).pose, o.pose)
        for o in after.objects
        if before.has_object(o.id) and before.object(o.id).pose is not o.pose
    }

    def step(number: int) -> None:
        if session.scene is not after:
            return
        if number == STEPS:
            session.viewport.show(after, session.textures)
            return
        share = number / STEPS
        eased = share * share * (3.0 - 2.0 * share)
        session.viewport.preview({name: pose_between(*way, eased) for name, way in ways.items()})
        session.ui_thread.post(partial(step, number + 1), after_s=DURATION_S / STEPS, awaited=False)

    if ways:
        step(0)


def pose_between(start: Pose, end: Pose, share: float) -> Pose:
    """A pose on the way between two, turned about one axis; `share` is 0 at the start and 1 at the end."""
    turn = rotation_vector(end.R_world_object @ start.R_world_object.T)
    return Pose(
        rotation_from_vector(share * turn) @ start.R_world_object,
        start.position + share * (end.position - start.position),
        start.scale * (end.scale / start.scale) ** share,
    )
