"""Mass, friction, joints and colliders of the selected object, as simulators get them; folded until they are wanted."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import viser

from diorama_app.commands.edit import supporter_name
from diorama_app.session.client import Client
from diorama_app.session.units import format_length
from diorama_app.strings import _, plural
from diorama_app.web.html import Action, LiveHtml, fold_button, text
from diorama_core.scene.types import Scene, SceneObject

if TYPE_CHECKING:
    from diorama_core.export.bodies import MovingPart, RigidBody


class Physics:
    """A folded table; while it is unfolded, the colliders are drawn in the view."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, self._act)
        self._of: tuple[SceneObject, Scene] | None = None
        self._table = ""

    def refresh(self) -> None:
        """Show the physics of the selected object where the person has unfolded them."""
        item, unfolded = self._client.last_selected, self._client.preferences.physics
        scene = self._client.session.scene
        wanted = (item, scene) if item is not None and unfolded else None
        if self._of is None or wanted is None or self._of[0] is not wanted[0] or self._of[1] is not wanted[1]:
            self._of, self._table = wanted, "" if wanted is None else self._describe(*wanted)
            if wanted is None:
                self._client.view.show_colliders(None, np.zeros((0, 3), dtype=int))
        what = _("mass, friction, joints and colliders, as they are exported to simulators")
        fold = fold_button(_("Physics"), "fold", what, unfolded=unfolded)
        self._html.show("" if item is None else fold + self._table)

    def _describe(self, item: SceneObject, scene: Scene) -> str:
        """The table of one object; draws its colliders."""
        from diorama_core.export.bodies import hull_faces  # manifold3d; opening a project does without it
        from diorama_core.export.colliders import body_of, world_parts

        body = body_of(scene, self._client.session.library, item.id)
        hulls = [hull_faces(part) for part in world_parts(body)]
        starts = np.cumsum([0, *(len(hull[0]) for hull in hulls)])
        vertices, faces = (np.concatenate([hull[k] for hull in hulls]) for k in (0, 1))
        faces = faces + np.repeat(starts[:-1], [len(hull[1]) for hull in hulls])[:, None]
        self._client.view.show_colliders(vertices, faces)
        rows = [
            (_("Mass"), f"{body.mass_kg + sum(m.inertia.mass_kg for m in body.moving):.3g} kg"),
            (_("Friction"), f"{body.friction:g}"),
            (_("Moves"), _freedom(body, scene)),
            *((_(m.limb.name).capitalize(), self._joint(m)) for m in body.moving),
            (_("Colliders"), plural("{count} convex part", "{count} convex parts", len(hulls))),
        ]
        cells = "".join(f"<tr><td>{text(name)}</td><td>{text(value)}</td></tr>" for name, value in rows)
        return f'<table>{cells}</table><p class="dim">{text(_("The colliders are drawn in the view."))}</p>'

    def _joint(self, moving: MovingPart) -> str:
        """What a joint does, and how far."""
        limb = moving.limb
        if limb.kind == "slide":
            length = format_length(limb.upper - limb.lower, self._client.preferences.unit)
            return _("slides {length}").format(length=length)
        return _("turns {degrees:.0f}°").format(degrees=np.degrees(limb.upper - limb.lower))

    def _act(self, action: Action) -> None:
        client = self._client
        if action.do == "fold":
            client.post(lambda: client.change_preferences(physics=not client.preferences.physics))


def _freedom(body: RigidBody, scene: Scene) -> str:
    """Whether a simulator may move an object, or what holds it."""
    if body.free:
        return _("freely")
    if body.node.item.locked:
        return _("no: it is locked")
    edge = body.node.support
    if edge is None:
        return _("no: nothing supports it")
    return _("no: fixed to {supporter}").format(supporter=supporter_name(scene, edge.parent))
