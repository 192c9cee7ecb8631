"""Corrections of the photo's camera: field of view, tilt, roll, height above the floor."""

from __future__ import annotations

import numpy as np
import viser

from diorama_app.commands.camera_presets import Views
from diorama_app.panels.fields import read_number
from diorama_app.reconstruction.camera_correction import (
    camera_height_m,
    check_angles,
    check_fov,
    rebuild_as_found,
    rebuild_with_camera,
    set_camera_height,
    trial_camera,
)
from diorama_app.session.client import Client
from diorama_app.session.units import format_length, parse_length
from diorama_app.strings import N_, _
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.geometry.rotations import CameraAttitude
from diorama_core.scene.types import Camera

FIELDS = {
    "fov": (N_("Field of view (°)"), N_("From the left to the right edge of the photo")),
    "tilt": (N_("Tilt down (°)"), N_("Angle of the camera below the horizon; sets where the floor is")),
    "roll": (N_("Roll (°)"), N_("Angle by which the camera leans to the right")),
}


class PhotoCameraPanel:
    """A folded list below the photo."""

    def __init__(self, gui: viser.GuiApi, client: Client, views: Views) -> None:
        self._client = client
        self._views = views
        self._html = LiveHtml(gui, lambda action: client.post(lambda: self._do(action)))
        self._typed: dict[str, float] = {}
        self._of: Camera | None = None
        self._figures: dict[str, float] = {}
        """Figures of that camera."""
        self._used = False
        """Whether one of its fields was changed: the list stays open from then on, whatever is drawn anew."""

    def refresh(self) -> None:
        """Draw the camera's figures; typed ones wait for the button."""
        session = self._client.session
        camera = session.scene.camera
        if camera is None or session.inputs is None or self._client.further_photo is not None:
            self._html.show("")
            return
        if self._of != camera:
            self._of, self._figures, self._typed = camera, figures(camera), {}
            self._client.trial_camera = None
        values = {**self._figures, **self._typed}
        shown_as = {name: f"{round(value, 1) + 0.0:.1f}" for name, value in values.items()}  # no minus before a zero
        rows = "".join(_row(_(label), name, shown_as[name], _(hint)) for name, (label, hint) in FIELDS.items())
        shown = format_length(camera_height_m(session.scene) or 0.0, self._client.preferences.unit)
        rows += _row(_("Camera height"), "height", shown, _("The whole scene is rescaled to it"))
        again = button(
            _("Rebuild with this camera"),
            "build",
            title=_("Recompute poses, shapes and layout; outlines stay. One undo step"),
            disabled=not self._typed or session.jobs.status is not None,
        )
        back = button(_("Cancel"), "back", title=_("Reset")) if self._typed else ""
        inputs = session.document.inputs
        if inputs is not None and inputs.camera_attitude is not None and not self._typed:
            back = button(
                _("Estimate tilt"),
                "find",
                title=_("Discard the tilt and roll set by hand, and rebuild"),
                disabled=session.jobs.status is not None,
            )
        explained = f'<p class="dim">{text(_("The grid should lie on the floor of the photo."))}</p>'
        explained = explained if self._typed else ""
        self._html.show(
            f'<details {"open" if self._used else ""}><summary class="dim">{text(_("Camera and floor"))}</summary>'
            f'{explained}<table>{rows}</table><div class="bar tight">{again}{back}</div></details>'
        )

    def _do(self, action: Action) -> None:
        client = self._client
        if action.do == "height":
            self._used = True
            set_camera_height(client, parse_length(action.pair[1], client.preferences.unit))
        elif action.do in FIELDS:
            degrees = read_number(action.pair[1], N_("“{words}” is not an angle; write for example 62.5"))
            self._try({**self._typed, action.do: degrees})
        elif action.do == "back":
            self._typed, client.trial_camera = {}, None
            client.refresh()
        elif action.do == "find":
            rebuild_as_found(client)
        elif action.do == "build" and self._of is not None:
            self._build(self._of)

    def _try(self, typed: dict[str, float]) -> None:
        """Show what was typed as a grid on the floor, over the photo."""
        if self._of is None:
            return
        values = {**self._figures, **typed}
        check_fov(values["fov"])
        camera_attitude = check_angles(values["tilt"], values["roll"])
        self._typed, self._used = typed, True
        self._client.trial_camera = trial_camera(self._of, values["fov"], camera_attitude)
        self._views.overlay(self._client, 1.0)
        self._client.refresh()

    def _build(self, camera: Camera) -> None:
        typed, known = self._typed, self._figures
        camera_attitude: CameraAttitude | None = None
        if "tilt" in typed or "roll" in typed:
            camera_attitude = check_angles(typed.get("tilt", known["tilt"]), typed.get("roll", known["roll"]))
        rebuild_with_camera(self._client, typed.get("fov"), camera_attitude)


def figures(camera: Camera) -> dict[str, float]:
    """Field of view, tilt and roll in degrees."""
    camera_attitude = CameraAttitude.of(camera.T_world_camera[:3, :3])
    angles = (camera.intrinsics.horizontal_fov_rad, camera_attitude.pitch_rad, camera_attitude.roll_rad)
    # Adding zero takes the sign off a rounded minus nothing.
    return dict(zip(FIELDS, (round(float(np.degrees(a)), 6) + 0.0 for a in angles), strict=True))


def _row(name: str, do: str, value: str, hint: str) -> str:
    return (
        f'<tr><td>{text(name)}</td><td><input data-change="{do}" value="{text(value)}" aria-label="{text(name)}" '
        f'title="{text(hint)}" style="width:90px"></td></tr>'
    )
