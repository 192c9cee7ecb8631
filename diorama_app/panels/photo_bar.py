"""The bar under the photo, with how far marking is and buttons that build from it, and the card of an empty view."""

from __future__ import annotations

import viser

from diorama_app.reconstruction.build_job import build, builds_unasked, ready_to_build
from diorama_app.reconstruction.photo_joining import awaits_photo
from diorama_app.session.client import Client
from diorama_app.strings import _, plural
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.artefacts import Inputs
from diorama_core.perception.inputs.boxes.agreement import is_upside_down


def photo_bar(client: Client, inputs: Inputs, proposals: int) -> str:
    """What can be done now with the chosen photo, on which so many proposals lie, in one row where there is room."""
    scene, further, busy = client.session.scene, client.further_photo, client.session.jobs.status is not None
    if builds_unasked(client.session):
        hint = _("Stop building, and draw boxes around the furniture yourself")
        return _note(_("Building what was found in the photo."), button(_("Mark it myself"), "by hand", title=hint))
    pieces = []
    if proposals:
        pieces.append(f'<span class="lead">{text(plural("{count} proposal", "{count} proposals", proposals))}</span>')
        pieces.append(button(_("Accept all"), "accept all", title=_("Accept all proposals as boxes; one undo step")))
    if not client.view.canvas.is_open:
        pieces.append(button(marking_label(inputs), "board", title=_("Show the photo and mark furniture on it")))
    if further is None and scene.objects and client.selected_box is not None:
        hint = _("Reconstruct only the selected box; everything else stays")
        pieces.append(button(_("Add selected box to the scene"), "add box", title=hint, disabled=busy))
    if further is None and proposals and not ready_to_build(inputs):
        hint = _("Build with the surest proposals; you are asked about uncertain results afterwards")
        pieces.append(button(_("Build at once"), "build at once", title=hint, disabled=busy))
    elif further is None:
        pieces.append(build_button(inputs, busy=busy))
    if further is not None and further.inputs.photo.equirectangular:
        count, hint = (
            len(inputs.boxes),
            _("Build the room again from the boxes in this 360 degree photo; one undo step"),
        )
        label = _("Build the whole room") + (f" ({count})" if count else "")
        pieces.append(button(label, "build sphere", title=hint, disabled=busy or not count))
    elif further is not None or awaits_photo(scene):
        hint = _("Find where this photo was taken, match its objects with those of the scene and insert the others")
        pieces.append(button(_("Add to the scene"), "join", title=hint, disabled=busy))
    doubt = upside_down_note() if further is None and is_upside_down(inputs.boxes, inputs.photo.height) else ""
    doubt += straightening_note() if further is None and _may_be_bent_back(client, inputs) else ""
    return f'{doubt}<div class="bar">{"".join(pieces)}</div>'


def upside_down_note() -> str:
    """What is said of a photo whose things lie as in one that was turned by 180 degrees, and the button to turn it."""
    turn = button(_("Turn photo"), "turn", title=_("Turn the photo by 180 degrees, with its boxes, depth and masks"))
    return _note(_("The photo seems to be upside down."), turn)


def straightening_note() -> str:
    """What is said of a photo that was straightened by its own lines, and the button that undoes it."""
    back = button(_("Undo straightening"), "bend", title=_("Use the photo as it is in its file"))
    return _note(_("The photo was straightened because its lens bends straight lines."), back)


def _note(message: str, its_button: str) -> str:
    return f'<div class="bar"><span class="lead">{text(message)}</span>{its_button}</div>'


def _may_be_bent_back(client: Client, inputs: Inputs) -> bool:
    project = client.session.project
    return bool(inputs.photo.straightened) and project is not None and project.has_upload("photo")


class NoSceneCard:
    """What can be done where the view is empty, since the photo was put away before a scene was built.

    It belongs to no tab: a page draws what belongs to one only once that tab was in front.
    """

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, self._act, floating="dio-no-scene")

    def refresh(self) -> None:
        """Show it where there is a photo and no scene, and nothing else fills the view."""
        client, session = self._client, self._client.session
        inputs = client.session.inputs
        if inputs is None or not session.is_unbuilt or client.view.canvas.is_open or session.jobs.status is not None:
            self._html.show("")
            return
        count = len(inputs.boxes)
        marked = plural(
            "There is no scene yet: {count} object is marked.",
            "There is no scene yet: {count} objects are marked.",
            count,
        )
        message = marked if count else _("There is no scene yet: nothing is marked.")
        buttons = button(marking_label(inputs), "board") + build_button(inputs, busy=False)
        self._html.show(f'<div class="card"><p>{text(message)}</p><div class="bar">{buttons}</div></div>')

    def _act(self, action: Action) -> None:
        client = self._client
        client.post(client.open_board if action.do == "board" else lambda: build(client.session))


def marking_label(inputs: Inputs) -> str:
    """Words of the button that shows the photo to be marked."""
    return _("Continue marking") if inputs.boxes else _("Mark furniture")


def build_button(inputs: Inputs, *, busy: bool) -> str:
    """The button that builds the scene, with the number of boxes."""
    count = f" ({len(inputs.boxes)})" if inputs.boxes else ""
    ready = ready_to_build(inputs)
    hint = _("Build a scene from the photo and its boxes")
    return button(_("Build scene") + count, "build", title=hint, disabled=busy or not ready)
