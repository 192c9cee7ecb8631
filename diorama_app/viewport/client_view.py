"""One browser's view: its camera, the photo in the room, the canvas to annotate it, notices. Survives no reload."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Literal

import numpy as np
import viser
from jaxtyping import Float, Int

from diorama_app.strings import _
from diorama_app.viewport.annotation_canvas import AnnotationCanvas
from diorama_app.viewport.camera import ViewCamera
from diorama_app.viewport.decorations import SELECTED_COLOUR, Colour
from diorama_app.viewport.photo_overlay import PhotoOverlay
from diorama_app.web.html import run_once
from diorama_core.scene.types import Plane

PLANE_COLOURS = {"floor": (190, 120, 30), "wall": (30, 110, 220), "ceiling": (120, 80, 190)}
PLANE_LIFT_M = 0.01
TAPE_COLOUR = (200, 60, 110)
COLLIDER_COLOUR = (20, 150, 110)
BRAND_COLOUR = (47, 111, 214)

Vector = Float[np.ndarray, "3"]
NoticeKind = Literal["info", "good", "bad"]


class ClientView:
    """What differs between browsers. Used from the UI thread only."""

    def __init__(self, viser_client: viser.ClientHandle) -> None:
        self._viser_client = viser_client
        self.photo = PhotoOverlay(viser_client)
        self.camera = ViewCamera(viser_client, on_move=self.photo.camera_moved)
        self.canvas = AnnotationCanvas(viser_client.gui)
        self._nodes: dict[str, list[viser.SceneNodeHandle]] = {}
        """What is drawn in this browser alone, by what it shows."""
        self._distances = viser_client.gui.add_html("")
        self._distances_told = "[]"

    def notice(self, message: str, kind: NoticeKind = "info") -> None:
        """A short notice at the edge of the view; what went wrong stays longer."""
        seconds = 9.0 if kind == "bad" else 4.0
        title = {"info": "Diorama", "good": _("Done"), "bad": _("Could not do that")}[kind]
        colour = {"info": (47, 111, 214), "good": (38, 150, 96), "bad": (210, 62, 50)}[kind]
        self._viser_client.add_notification(title, _(message), color=colour, auto_close_seconds=seconds)

    def download(self, name: str, content: bytes) -> None:
        """Hand a file to the person."""
        self._viser_client.send_file_download(name, content, save_immediately=True)

    def set_dark(self, dark: bool) -> None:
        """Dark or light panels."""
        set_theme(self._viser_client.gui, dark=dark)

    def show_measure(self, points: Sequence[tuple[float, float, float]], words: str) -> None:
        """A tape between measured points; none without points."""
        tape, scene = self._begin("tape"), self._viser_client.scene
        for index, point in enumerate(points):
            tape.append(scene.add_icosphere(f"/tape/{index}", radius=0.025, color=TAPE_COLOUR, position=point))
        if len(points) == 2:
            ends = np.array(points)
            tape += [
                scene.add_line_segments(
                    "/tape/line", points=ends[None], colors=TAPE_COLOUR, thickness=4.0, thickness_units="screen"
                ),
                scene.add_label("/tape/length", words, position=ends.mean(axis=0), anchor="bottom-center"),
            ]

    def show_distances(self, distances: Sequence[tuple[Vector, Vector, str]]) -> None:
        """Lines between two points each, with words at their middle; none without.

        The page draws them over the view (`static/distances.js`): beside an object in the hand the picture stays.
        """
        rows = [[*(np.round(np.asarray(end, float), 4).tolist() for end in ends), words] for *ends, words in distances]
        told = json.dumps(rows, separators=(",", ":"))
        if told != self._distances_told:
            self._distances_told = told
            self._distances.content = run_once(f"window.__dioDistances.told({told})")

    def show_surface(self, plane: Plane | None) -> None:
        """The outline of the surface that is chosen; none without."""
        nodes = self._begin("surface")
        if plane is not None:
            nodes.append(self._add_edges("/surface", plane, SELECTED_COLOUR, 4.0))

    def show_colliders(self, vertices: Float[np.ndarray, "n 3"] | None, faces: Int[np.ndarray, "m 3"]) -> None:
        """The edges of convex bodies, in the world; none without."""
        nodes = self._begin("colliders")
        if vertices is not None:
            mesh = self._viser_client.scene.add_mesh_simple(
                "/colliders",
                vertices=vertices,
                faces=faces,
                color=COLLIDER_COLOUR,
                wireframe=True,
                cast_shadow=False,
                receive_shadow=False,
            )
            nodes.append(mesh)

    def show_planes(self, planes: Sequence[tuple[str, Plane]]) -> None:
        """The edges of planes, each with its name; none without planes."""
        nodes, scene = self._begin("planes"), self._viser_client.scene
        for number, (name, plane) in enumerate(planes):
            nodes += [
                self._add_edges(f"/planes/{number}/edges", plane, PLANE_COLOURS[plane.role], 3.0),
                scene.add_label(f"/planes/{number}/name", name, position=plane.centre + PLANE_LIFT_M * plane.normal),
            ]

    def _begin(self, what: str) -> list[viser.SceneNodeHandle]:
        """An empty list for the nodes of something that is shown; those of what was shown before are gone."""
        for node in self._nodes.get(what, ()):
            node.remove()
        self._nodes[what] = []
        return self._nodes[what]

    def _add_edges(self, name: str, plane: Plane, colour: Colour, thickness_px: float) -> viser.SceneNodeHandle:
        ends = plane.polygon + PLANE_LIFT_M * plane.normal
        edges = np.stack([ends, np.roll(ends, -1, axis=0)], axis=1)
        return self._viser_client.scene.add_line_segments(
            name, points=edges, colors=colour, thickness=thickness_px, thickness_units="screen"
        )


def set_theme(gui: viser.GuiApi, *, dark: bool) -> None:
    """Style the panels."""
    gui.configure_theme(
        control_layout="floating", show_logo=False, show_share_button=False, brand_color=BRAND_COLOUR, dark_mode=dark
    )
