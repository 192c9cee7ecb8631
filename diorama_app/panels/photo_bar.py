"""The bar under the photo: how far marking is, and the buttons that build from it."""

from __future__ import annotations

from diorama_app.reconstruction.build_job import builds_unasked, ready_to_build
from diorama_app.reconstruction.photo_joining import awaits_photo
from diorama_app.session.client import Client
from diorama_app.web.html import button
from diorama_core.artefacts import Inputs
from diorama_core.io.text import number_of
from diorama_core.perception.inputs.boxes.standing import is_upside_down


def photo_bar(client: Client, inputs: Inputs, proposals: int) -> str:
    """What can be done with the chosen photo now, in one row where there is room.

    Args:
        client: whose photo it is.
        inputs: the photo with its boxes.
        proposals: how many proposals lie on it.
    """
    scene, further, busy = client.session.scene, client.further_photo, client.session.jobs.status is not None
    if builds_unasked(client.session):
        mine = button("Mark it myself", "by hand", title="Stop building, and draw boxes around the furniture yourself")
        return f'<div class="bar"><span class="lead">Building what was found in the photo.</span>{mine}</div>'
    pieces = []
    if proposals:
        pieces.append(f'<span class="lead">{number_of(proposals, "proposal")}</span>')
        pieces.append(button("Accept all", "accept all", title="Accept all proposals as boxes; one undo step"))
    if not client.view.canvas.is_open:
        pieces.append(button(marking_label(inputs), "board", title="Show the photo and mark furniture on it"))
    if further is None and scene.objects and client.selected_box is not None:
        hint = "Reconstruct only the selected box; everything else stays"
        pieces.append(button("Add selected box to the scene", "add box", title=hint, disabled=busy))
    if further is None and proposals and not ready_to_build(inputs):
        hint = "Build with the surest proposals; what the build is not sure of is asked afterwards"
        pieces.append(button("Build at once", "build at once", title=hint, disabled=busy))
    elif further is None:
        pieces.append(build_button(inputs, busy=busy))
    if further is not None or awaits_photo(scene):
        hint = "Find where this photo was taken, match its objects with those of the scene and insert the others"
        pieces.append(button("Add to the scene", "join", title=hint, disabled=busy))
    doubt = upside_down_note() if further is None and is_upside_down(inputs.boxes, inputs.photo.height) else ""
    doubt += straightened_note() if further is None and _may_be_bent_back(client, inputs) else ""
    return f'{doubt}<div class="bar">{"".join(pieces)}</div>'


def upside_down_note() -> str:
    """What is said of a photo whose things lie as in one that was turned by 180 degrees, and the button to turn it."""
    turn = button("Turn photo", "turn", title="Turn the photo by 180 degrees, with its boxes, depth and masks")
    return f'<div class="bar"><span class="lead">The photo seems to be upside down.</span>{turn}</div>'


def straightened_note() -> str:
    """What is said of a photo that was straightened by its own lines, and the button that undoes it."""
    back = button("Undo straightening", "bend", title="Use the photo as it is in its file")
    said = "The lens bent straight lines, so the photo was straightened."
    return f'<div class="bar"><span class="lead">{said}</span>{back}</div>'


def _may_be_bent_back(client: Client, inputs: Inputs) -> bool:
    project = client.session.project
    return bool(inputs.photo.straightened) and project is not None and project.has_upload("photo")


def no_scene_card(client: Client) -> str:
    """What can be done where the view is empty, since the photo was put away before a scene was built."""
    inputs, session = client.session.inputs, client.session
    if inputs is None or not session.unfinished or client.view.canvas.is_open or session.jobs.status is not None:
        return ""
    marked = f"{number_of(len(inputs.boxes), 'object')} marked" if inputs.boxes else "nothing is marked yet"
    buttons = button(marking_label(inputs), "board") + build_button(inputs, busy=False)
    return f'<div class="card"><p>There is no scene yet: {marked}.</p><div class="bar">{buttons}</div></div>'


def marking_label(inputs: Inputs) -> str:
    """Words of the button that shows the photo to be marked."""
    return "Continue marking" if inputs.boxes else "Mark furniture"


def build_button(inputs: Inputs, *, busy: bool) -> str:
    """The button that builds the scene, with the number of boxes."""
    count = f" ({len(inputs.boxes)})" if inputs.boxes else ""
    hint = "Build a scene from the photo and its boxes"
    return button(f"Build scene{count}", "build", title=hint, disabled=busy or not ready_to_build(inputs))
