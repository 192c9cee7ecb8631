"""What people do to walls, floor and ceiling: choose one by a click, and finish it."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_app.commands.edit import supporter_name
from diorama_app.session.client import Client
from diorama_app.strings import _, plural
from diorama_core.errors import EditRefused
from diorama_core.geometry.casting import cast_planes
from diorama_core.scene.room_edits import set_surface_finish
from diorama_core.scene.types import Scene, SurfaceFinish


def surface_under(scene: Scene, origin: Float[np.ndarray, 3], direction: Float[np.ndarray, 3]) -> str | None:
    """Id of the nearest plane on a ray that faces the eye; the others are seen through."""
    facing = tuple(p for p in scene.architecture.planes if float(p.normal @ direction) < 0)
    if not facing:
        return None
    which = int(cast_planes(origin, direction[None], facing)[1][0])
    return facing[which].id if which >= 0 else None


def chosen_surfaces(client: Client, *, all_walls: bool) -> tuple[str, ...]:
    """The surface that is chosen, or with `all_walls` every wall when it is one.

    Raises:
        EditRefused: none is chosen.
    """
    scene, chosen = client.session.scene, client.surface
    if chosen is None or not scene.has_plane(chosen):
        raise EditRefused("no surface is chosen; click a wall, the floor or the ceiling")
    if all_walls and scene.plane(chosen).role == "wall":
        return tuple(p.id for p in scene.architecture.by_role("wall"))
    return (chosen,)


def finish_surfaces(client: Client, finish: SurfaceFinish | None, *, all_walls: bool, merge: str = "") -> None:
    """Finish the chosen surface, or let it look as before with None; one undo step.

    Args:
        client: the browser that asked.
        finish: None for none.
        all_walls: whether every wall gets it.
        merge: steps with the same key become one.
    """
    session = client.session
    chosen = chosen_surfaces(client, all_walls=all_walls)
    names = (
        supporter_name(session.scene, chosen[0])
        if len(chosen) == 1
        else plural("{count} wall", "{count} walls", len(chosen))
    )
    label = _("remove the finish of {names}") if finish is None else _("{pattern} on {names}")
    label = label.format(names=names, pattern="" if finish is None else _(finish.pattern))
    session.edit(
        label,
        lambda scene: set_surface_finish(scene, chosen, finish),
        by=client,
        merge_key=f"finish {' '.join(chosen)} {merge}" if merge else None,
    )
