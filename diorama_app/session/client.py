"""One connected browser: its selection, preferences and panels.

The document is shared; the selection belongs to one client and is shown to the others in that client's colour.
Has no state that must survive a reload.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import viser
from jaxtyping import Float

from diorama_app.session.connected_client import Panel
from diorama_app.session.preferences import Preferences, remember
from diorama_app.session.session import EditorSession
from diorama_app.strings import _
from diorama_app.viewport.client_view import ClientView, NoticeKind
from diorama_app.viewport.decorations import Decorations
from diorama_core.artefacts import FurtherPhoto, Inputs, LabelledBox, Photo
from diorama_core.errors import DioramaError, EditRefused
from diorama_core.scene.types import Camera, Scene, SceneObject

if TYPE_CHECKING:
    from diorama_core.editing.walking import WalkableFloor  # shapely; the page opens without it

log = logging.getLogger(__name__)

COLOURS = ((38, 150, 96), (160, 80, 200), (20, 130, 190), (200, 60, 110), (150, 120, 20), (90, 100, 120))
"""Colours of other clients' selections; one's own is orange."""


SPHERE_VIEW_PX = 600
"""Height of the pictures that are made of a 360 degree photo, one for each turn of the head."""


@dataclass(frozen=True)
class Placing:
    """The next click in the view puts a shape there."""

    shape_id: str


@dataclass(frozen=True)
class Measuring:
    """The next clicks in the view are the ends of a known length."""

    points: tuple[tuple[float, float, float], ...] = ()


@dataclass(frozen=True)
class Playing:
    """Clicks in the view push objects, while gravity acts on all of them."""

    push: Callable[[str, Float[np.ndarray, 3]], None]
    """Pushes an object along a direction of the world."""
    end: Callable[[], None]


Doing = Placing | Measuring | Playing | None
"""What the next click means; None: it selects."""


class Client:
    """Implements `ConnectedClient`. Used from the UI thread only, except where a method says otherwise."""

    def __init__(self, session: EditorSession, viser_client: viser.ClientHandle, number: int) -> None:
        self.session = session
        self.viser_client = viser_client
        self.id: int = viser_client.client_id
        self.name: str = _("User {number}").format(number=number)
        self.colour: tuple[int, int, int] = COLOURS[(number - 1) % len(COLOURS)]
        self.view: ClientView = ClientView(viser_client)
        self.marks = Decorations(viser_client)
        self.selection: tuple[str, ...] = ()
        self.surface: str | None = None
        """Id of the plane that is chosen to be finished; while objects are selected, none is."""
        self.rooms: frozenset[str] = frozenset()
        """Ids of the rooms of a home that are shown; none: all."""
        self.preferences = Preferences()
        self.plan = False
        """Whether the plan is shown in place of the 3D view."""
        self.doing: Doing = None
        self.handles: Panel | None = None
        """What one takes hold of in the 3D view; drawn ahead of the panels."""
        self.panels: list[Panel] = []
        self.failing: dict[str, str] = {}
        """Panels whose last redraw failed, and why."""
        self.job_panel: Panel | None = None
        self.curves: Panel | None = None
        """What is redrawn while a layout is optimised."""
        self.trial_camera: Camera | None = None
        """The photo's camera as it is being set by hand; seen as a grid on its floor."""
        self.dialog: Callable[[], None] | None = None
        """Closes the dialog that is open over the page, if one is."""
        self.toast: Callable[[str, bool], None] = lambda message, undo: None
        """Shows a line at the foot of the view, with a button that undoes when asked."""
        self.offer: Callable[[str, str, Callable[[], None]], None] = lambda message, label, do: None
        """Shows a line that stays, with a button that does something."""
        self._sphere_shown: tuple[Photo, Camera, Photo] | None = None
        """The 360 degree photo of which a view was made last, with the camera of that view and its picture."""
        self.has_left = False
        self.to_say: tuple[str, bool] | None = None
        """What is shown there with the next redraw."""
        self.open_start: Callable[[], None] = lambda: None
        """Lays the start page over the page."""
        self.open_projects: Callable[[], None] = lambda: None
        """Lays the grid of all projects over the page."""
        self.start_tour: Callable[[], None] = lambda: None
        """Shows a newcomer around."""
        self.start_walk: Callable[[WalkableFloor], None] = lambda walk: None
        """Begins a walk in the first person, which the page goes on with by itself."""
        self.open_tab: Callable[[str], None] = lambda name: None
        """Brings a tab of the panels to the front."""
        self.go_to: Callable[[str], None] = lambda name: None
        self.photo_name: str | None = None
        """The further photo that is marked and looked through; None for the scene's own."""
        self.selected_box: int | None = None
        """The box that is selected on the photo."""
        self.open_board: Callable[[], None] = lambda: None
        """Shows the photo with its boxes, to draw on."""
        self.proposals: Callable[[], tuple[LabelledBox, ...]] = lambda: ()
        """Likely objects of the scene's own photo that nobody marked, built or turned down yet."""
        self.dismiss: Callable[[LabelledBox], None] = lambda proposal: None
        """Turns one of them down."""

    # -- photos -----------------------------------------------------------------------------------------------

    @property
    def further_photo(self) -> FurtherPhoto | None:
        """The further photo that is chosen; None where it is the scene's own."""
        return next((p for p in self.session.further_photos if p.name == self.photo_name), None)

    @property
    def inputs(self) -> Inputs | None:
        """The chosen photo with everything that is said of it; None without one."""
        further = self.further_photo
        return self.session.inputs if further is None else further.inputs

    @property
    def viewpoint(self) -> tuple[Camera | None, Photo | None]:
        """The chosen photo and its camera in the scene, where they are known."""
        further = self.further_photo
        if further is None:
            return self.session.scene.camera, self.session.photo
        if further.T_world_sphere is not None:
            return self._sphere_view(further, further.T_world_sphere)
        return further.camera, further.inputs.photo

    def _sphere_view(self, sphere: FurtherPhoto, T_world_sphere: Float[np.ndarray, "4 4"]) -> tuple[Camera, Photo]:
        """What a 360 degree photo shows where this browser's view looks now."""
        from diorama_core.geometry.sphere import perspective  # OpenCV; a scene without such a photo opens without it

        photo, look = sphere.inputs.photo, self.view.camera
        camera, known = look.to_picture_camera(round(SPHERE_VIEW_PX * look.aspect), SPHERE_VIEW_PX), self._sphere_shown
        if known is None or known[0] is not photo or known[1] != camera:
            R_sphere_camera = T_world_sphere[:3, :3].T @ camera.T_world_camera[:3, :3]
            rgb = perspective(photo.rgb, R_sphere_camera, camera.intrinsics)
            known = self._sphere_shown = (photo, camera, Photo(rgb, photo.name, (photo.width, photo.height)))
        return known[1:]

    def close_dialog(self) -> None:
        """Close what is open over the page."""
        if self.dialog is not None:
            self.dialog()

    def annotate(self, label: str, inputs: Inputs) -> None:
        """Change what is said of the chosen photo, as one undo step."""
        further = self.further_photo
        if further is None:
            self.session.commit(label, self.session.scene, inputs=inputs, by=self)
            return
        now = tuple(replace(p, inputs=inputs) if p is further else p for p in self.session.further_photos)
        self.session.commit(label, self.session.scene, further=now, by=self)

    def forget_choices(self) -> None:
        """Choose nothing: ids and places in lists mean something else in another project."""
        self.selection, self.surface, self.rooms, self.doing = (), None, frozenset(), None
        self.photo_name = self.selected_box = None
        self.view.canvas.close()

    def choose_photo(self, name: str | None) -> None:
        """Mark and look through another photo."""
        if name != self.photo_name:
            self.photo_name, self.selected_box = name, None
            self.view.canvas.close()

    # -- selection --------------------------------------------------------------------------------------------

    @property
    def last_selected(self) -> SceneObject | None:
        """The object selected last, or None."""
        return self.session.scene.object(self.selection[-1]) if self.selection else None

    def need_selected(self) -> str:
        """The object selected last; refuses with advice when there is none."""
        if not self.selection:
            raise EditRefused("nothing is selected; click an object first")
        return self.selection[-1]

    def need_selection(self) -> tuple[str, ...]:
        """Everything selected; refuses with advice when there is nothing."""
        self.need_selected()
        return self.selection

    def select(self, ids: Iterable[str]) -> None:
        """Select exactly these objects, in this order."""
        self._choose(ids, None)

    def select_surface(self, plane_id: str | None) -> None:
        """Choose a wall, the floor or the ceiling in place of objects."""
        self._choose((), plane_id)

    def _choose(self, ids: Iterable[str], plane_id: str | None) -> None:
        self.selection = tuple(i for i in dict.fromkeys(ids) if self.session.scene.has_object(i))
        self.surface = plane_id if plane_id is not None and self.session.scene.has_plane(plane_id) else None
        if len(self.session.clients) == 1:  # where several work, undo must not select what another one had selected
            self.session.document.note_selection(self.selection)
        self.session.refresh_panels(self)

    def toggle(self, object_id: str) -> None:
        """Add an object to the selection, or take it out."""
        rest = tuple(i for i in self.selection if i != object_id)
        self.select(rest if object_id in self.selection else (*rest, object_id))

    def drop_missing(self) -> None:
        """Deselect objects that no longer exist."""
        self.selection = tuple(i for i in self.selection if self.session.scene.has_object(i))
        if self.surface is not None and not self.session.scene.has_plane(self.surface):
            self.surface = None
        if self.photo_name is not None and self.further_photo is None:
            self.choose_photo(None)

    # -- page -------------------------------------------------------------------------------------------------

    def change_preferences(self, **changes: Any) -> None:
        """Change the preferences."""
        self.preferences = replace(self.preferences, **changes)
        remember(self.viser_client, self.preferences)
        self.refresh()

    def take_preferences(self, preferences: Preferences) -> None:
        """Restore the preferences stored in this browser."""
        self.preferences = preferences
        self.view.set_dark(preferences.dark)
        self.refresh()

    def refresh(self) -> None:
        """Update this browser's marks, handles and panels to the document.

        What is in the 3D view leaves at once: a hand goes there next, and the panels take several times as long.
        """
        with self.viser_client.atomic():  # one parcel: every one of them would wake the thread that sends
            self._draw("marks", self.show_marks)
            if self.handles is not None:
                self._draw("handles", self.handles.refresh)
        self.viser_client.flush()
        with self.viser_client.atomic():
            if self.to_say is not None:
                (message, undo), self.to_say = self.to_say, None
                self._draw("toast", lambda: self.toast(message, undo))
            for panel in self.panels:
                self._draw(type(panel).__name__, panel.refresh)

    def _draw(self, name: str, draw: Callable[[], None]) -> None:
        """Draw one part of the page; one that fails says so in a line, once, and the others go on."""
        try:
            draw()
        except Exception as error:  # whatever one panel does wrong, the others are drawn
            log.log(logging.DEBUG if name in self.failing else logging.ERROR, "panel %s", name, exc_info=True)
            if name not in self.failing:
                self.failing[name] = str(error) if isinstance(error, DioramaError) else type(error).__name__
                said = _("the panel {name} could not be drawn ({reason}); your work is saved")
                self.notice(said.format(name=name, reason=_(self.failing[name])), "bad")
        else:
            self.failing.pop(name, None)

    def room(self) -> Scene:
        """The room that this person looks at, of those that are shown; the scene where it is one room."""
        scene = self.session.scene
        if not scene.rooms:
            return scene
        from diorama_core.geometry.rooms import room_around  # shapely; a room opens without it

        return room_around(scene, self.view.camera.target_point, self.rooms)

    def show_marks(self, scene: Scene | None = None) -> None:
        """Outlines, name tags and the others' cursors; around a preview where one is given."""
        session, shown = self.session, scene or self.session.scene
        if self.rooms:
            from diorama_core.geometry.rooms import part_of_home  # shapely; a room opens without it

            shown = part_of_home(shown, self.rooms)
        others = [(g.name, g.colour, g.selection) for g in session.clients.values() if g is not self]
        # Over the photo, marks would seem to be the photo's.
        warned = self.preferences.badges and self.view.photo.opacity < 0.5
        badges = session.badges if warned else {}
        self.marks.show(
            shown,
            session.viewport.node_name,
            self.selection,
            others,
            badges,
            names=self.preferences.names,
            unsure=warned,
        )

    def notice(self, message: str, kind: NoticeKind = "info") -> None:
        """Show a message to the user."""
        if kind == "bad":
            self.view.notice(message, kind)
        else:
            self.toast(message, False)

    def post(self, task: Callable[[], object], *, key: str | None = None) -> None:
        """Do `task` on the UI thread; the user is notified when it fails. May be called from any thread."""
        self.session.post(self.id, task, key=None if key is None else f"{self.id} {key}")
