"""The photo panel: upload the photo and its inputs, draw boxes, build the scene."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import viser
from jaxtyping import UInt8
from PIL import Image

from diorama_app.commands.camera_presets import Views
from diorama_app.commands.registry import CommandTable
from diorama_app.panels.fields import enable, on_change, on_press, show_if, show_label, show_value
from diorama_app.reconstruction import build_job as work
from diorama_app.reconstruction.networks import NO_DETECTOR
from diorama_app.reconstruction.object_correction import add_from_photo
from diorama_app.reconstruction.text_to_scene import describe_room, how_pictures_come
from diorama_app.session.client import Client
from diorama_app.session.draft import Draft, boxes_json, can_find_furniture
from diorama_app.session.reading import Upload
from diorama_app.viewport.mesh_assets import reduced
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_app.web.viser_adapter import component_uuid
from diorama_core.artefacts import Box
from diorama_core.errors import InputError
from diorama_core.library.taxonomy import CATEGORIES
from diorama_core.perception.inputs import ReadInputs

COMMON = ("chair", "table", "sofa", "armchair", "bed", "desk", "coffee table", "lamp", "cabinet", "bookshelf")
SLOW_BYTES = 2_000_000
"""A file of more is announced while it is read."""
UPLOADS = {"photo": "Photo", "depth": "Depth (PNG, NPY)", "boxes": "Boxes (JSON)", "masks": "Masks (PNG)"}


class PhotoPanel:
    """Uploads, the drawing board's controls, the list of boxes, and "Build scene"."""

    def __init__(self, gui: viser.GuiApi, client: Client, views: Views, commands: CommandTable) -> None:
        self._client, self._session, self._views = client, client.session, views
        self._picture_of: object = None
        self._picture = ""
        self._invitation = LiveHtml(gui, self._act)
        self._photo_button = self._upload(gui, "photo", "Upload a photo", "image/*")
        self._words = gui.add_text("Describe a room", "", hint="For example: a bedroom with a double bed and two lamps")
        self._describe = gui.add_button(
            "Create room", color="green", hint="Creates a new project from this description"
        )
        on_change(self._words, lambda _: client.post(self.refresh, key="words"))
        on_press(self._describe, lambda: client.post(lambda: describe_room(client, self._words.value)))
        self._drawn_by = LiveHtml(gui)
        self._more = gui.add_folder("More about this photo", expand_by_default=False)
        with self._more:
            self._upload(gui, "boxes", "Add boxes (JSON)", ".json,application/json")
            self._upload(gui, "depth", "Add depth (PNG or NPY)", "*/*")
            self._upload(gui, "masks", "Add masks (PNG)", "image/png")
            self._camera = gui.add_text("Camera", "", hint="fx,fy,cx,cy in pixels of the photo; empty: estimated")
            on_change(self._camera, self._camera_given)
        self._draw = gui.add_button("Draw boxes", color="blue", hint="Draw a box around each piece of furniture")
        on_press(self._draw, lambda: client.post(self._toggle_board))
        self._find = gui.add_button("Detect furniture", hint=commands["find_furniture"].tooltip)
        on_press(self._find, lambda: client.post(lambda: commands["find_furniture"].run(client)))
        self._no_detector = LiveHtml(gui)
        client.open_board = self._open_board
        names = [*COMMON, *sorted({c.name for c in CATEGORIES} - {*COMMON, "object"})]
        self._label = gui.add_dropdown("Category", names, hint="Category of the selected or the next box")
        self._other = gui.add_text("or type", "", hint="Any other category, instead of one in the list")
        on_change(self._label, lambda value: client.post(lambda: self._labelled(value, listed=True)))
        on_change(self._other, lambda value: client.post(lambda: self._labelled(value, listed=False), key="word"))
        self._list = LiveHtml(gui, self._act)
        self._add = gui.add_button(
            "Add selected box to the scene",
            color="blue",
            hint="Reconstructs only the selected box; everything else stays",
        )
        on_press(self._add, lambda: client.post(self._add_marked))
        self._build = gui.add_button("Build scene", color="green", hint="Builds a scene from the photo and its boxes")
        on_press(self._build, lambda: client.post(lambda: work.build(client)))

    def take(self, name: str, content: bytes) -> None:
        """Take a picture that was dropped somewhere on the page."""
        self._received("photo", name, content)

    @property
    def label(self) -> str:
        """What the next box is called."""
        return self._other.value.strip() or self._label.value

    def refresh(self) -> None:
        """Draw the state of the draft."""
        draft = self._session.draft
        has_photo = draft.photo is not None
        self._invitation.show(self._introduction(draft))
        show_if(has_photo, self._more, self._draw, self._find, self._label, self._other, self._build)
        self._drawn_by.show(f'<p class="dim">{text(how_pictures_come())}</p>' if self._words.value.strip() else "")
        enable(self._describe, self._session.jobs.status is None and bool(self._words.value.strip()))
        finds = can_find_furniture()
        enable(self._find, self._session.jobs.status is None and finds)
        self._no_detector.show(f'<p class="dim">{text(NO_DETECTOR)}</p>' if has_photo and not finds else "")
        self._list.show(_box_list(draft) if has_photo else "")
        show_if(has_photo and draft.from_project and bool(self._session.scene.objects), self._add)
        enable(self._add, self._session.jobs.status is None and draft.highlighted is not None)
        enable(self._build, self._session.jobs.status is None and draft.ready)
        show_label(self._draw, "Done drawing" if self._client.view.canvas.is_open else "Draw boxes")

    # -- uploads ----------------------------------------------------------------------------------------------

    def _upload(self, gui: viser.GuiApi, kind: str, label: str, mime_type: str) -> str:
        handle = gui.add_upload_button(label, mime_type=mime_type)

        async def uploaded(event: viser.GuiEvent[viser.GuiUploadButtonHandle]) -> None:
            file = event.target.value
            self._client.post(lambda: self._received(kind, file.name, file.content))

        handle.on_upload(uploaded)
        return component_uuid(handle)

    def _received(self, kind: str, name: str, content: bytes) -> None:
        draft = self._session.draft
        if kind == "photo":
            files: dict[str, bytes] = {"photo": content}
        elif draft.photo is None:
            raise InputError("upload the photo first, then its boxes, depth or masks")
        else:
            files = {**draft.files, kind: content}

        def take(made: Draft) -> None:
            if kind == "boxes" and made.inputs is not None:
                made = replace(made, boxes=made.inputs.boxes)
            self._taken(kind, name, made)

        self._read(files, Draft(name=name) if kind == "photo" else draft, take)
        if len(content) > SLOW_BYTES:
            self._client.notice(f"Reading {name}…")

    def _taken(self, kind: str, name: str, made: Draft) -> None:
        self._session.draft = made
        for warning in made.warnings[:3]:
            self._client.notice(warning)
        if kind == "photo":
            self._client.open_tab("Photo")
            self._open_board()
        else:
            self._redraw_boards()
            self._client.notice(f"{UPLOADS[kind]}: {name} is loaded.", "good")
        self._session.refresh_panels(self._client)

    def _read(self, files: dict[str, bytes], draft: Draft, take: Callable[[Draft], None]) -> None:
        """Read the files together, in the background; then `take` the draft they make."""
        files = dict(files)
        if "photo" not in files:
            files["photo"] = _png(draft)
        if "boxes" not in files and draft.boxes and draft.photo is not None:
            files["boxes"] = boxes_json(draft.boxes, draft.photo)
        before = self._session.draft.inputs

        def done(read: ReadInputs) -> None:
            if self._session.draft.inputs is not before:
                raise InputError("the photo or its inputs changed meanwhile; upload the file again")
            take(replace(draft, inputs=read.inputs, warnings=read.warnings, files=files, from_project=False))

        upload = Upload(
            files["photo"],
            draft.name,
            depth=files.get("depth"),
            boxes=files.get("boxes"),
            masks=files.get("masks"),
            intrinsics=_intrinsics(self._camera.value),
        )
        self._session.reader.read(upload, self._client.id, self._client.post, done)

    def _camera_given(self, value: str) -> None:
        def read() -> None:
            if self._session.draft.photo is not None and (not value.strip() or value.count(",") == 3):
                self._read(self._session.draft.files, self._session.draft, take)

        def take(made: Draft) -> None:
            self._session.draft = made
            self._session.refresh_panels(self._client)

        self._client.post(read, key="camera")

    # -- the drawing board ------------------------------------------------------------------------------------

    def _toggle_board(self) -> None:
        if self._client.view.canvas.is_open:
            self._views.room_view(self._client)
        else:
            self._open_board()
        self.refresh()

    def _open_board(self) -> None:
        photo = self._session.draft.photo
        if photo is None:
            raise InputError("there is no photo yet; upload one first")
        self._client.view.canvas.open(photo.rgb, lambda box: self._client.post(lambda: self._drawn(box)))
        self._redraw_boards()

    def _drawn(self, box: Box) -> None:
        self._change(self._session.draft.with_box(box, self.label))

    def _labelled(self, word: str, *, listed: bool) -> None:
        if listed and self._other.value:
            show_value(self._other, "")
        draft = self._session.draft
        label = word.strip() or self._label.value
        if draft.highlighted is not None and draft.highlighted < len(draft.boxes):
            self._change(draft.relabelled(draft.highlighted, label))

    def _change(self, draft: Draft) -> None:
        self._session.draft = draft
        self._redraw_boards()
        self._session.refresh_panels()

    def _add_marked(self) -> None:
        draft = self._session.draft
        if draft.highlighted is None or draft.highlighted >= len(draft.boxes):
            raise InputError("select a box in the list first, or draw one around the missing object")
        box = draft.boxes[draft.highlighted]
        add_from_photo(self._client, box.box, box.label)

    def _redraw_boards(self) -> None:
        draft = self._session.draft
        for client in self._session.clients.values():
            client.view.canvas.show_boxes(draft.boxes, draft.highlighted)

    def _act(self, action: Action) -> None:
        def do() -> None:
            draft, index = self._session.draft, int(action.arg)
            if index >= len(draft.boxes):
                return
            if action.do == "drop":
                self._change(draft.without_box(index))
            elif action.do == "mark":
                self._change(replace(draft, highlighted=None if draft.highlighted == index else index))

        if action.arg.isdigit():
            self._client.post(do)

    # -- words ------------------------------------------------------------------------------------------------

    def _introduction(self, draft: Draft) -> str:
        if draft.photo is None:
            return (
                f'<div class="drop" data-file="{self._photo_button}"><b>Start with a photo of a room.</b><br>'
                '<span class="dim">Drop it here or upload it. Then mark the furniture with boxes, and it becomes a '
                "scene you can edit.</span></div>"
            )
        if self._picture_of is not draft.photo:
            self._picture_of, self._picture = draft.photo, _jpeg_uri(draft.photo.rgb)
        state = (
            ("1 box" if len(draft.boxes) == 1 else f"{len(draft.boxes)} boxes")
            if draft.boxes
            else (
                "<b>Build the scene: furniture is detected automatically. Or draw boxes.</b>"
                if can_find_furniture()
                else "<b>Draw a box around each piece of furniture.</b>"
            )
        )
        extras = [n for n, there in _extras(draft).items() if there]
        extra = f" · with {', '.join(extras)}" if extras else ""
        return (
            f'<img class="photo" alt="the photo" src="{self._picture}" data-file="{self._photo_button}" '
            'title="Drop another photo here to start over">'
            f'<p style="margin-top:6px">{text(draft.photo.name)}<br><span class="dim">{state}{extra}</span></p>'
        )


def _extras(draft: Draft) -> dict[str, bool]:
    inputs = draft.inputs
    return {
        "depth": inputs is not None and inputs.depth_m is not None,
        "masks": inputs is not None and inputs.instances is not None,
        "camera": inputs is not None and inputs.intrinsics is not None,
    }


def _box_list(draft: Draft) -> str:
    if not draft.boxes:
        return "<p class='dim'>Press <b>Draw boxes</b>, choose a category, and drag a rectangle in the photo.</p>"
    rows = []
    for index, box in enumerate(draft.boxes):
        on = "on" if index == draft.highlighted else ""
        unknown = ' <span class="dim">as an object</span>' if box.category == "object" else ""
        rows.append(
            f'<div class="row {on}" data-do="mark" data-arg="{index}">'
            f'<span class="name">{text(box.label)}{unknown}</span>'
            + button("✕", "drop", index, title="Delete this box")
            + "</div>"
        )
    return f"<h4>Boxes</h4>{''.join(rows)}"


def _intrinsics(given: str) -> tuple[float, float, float, float] | None:
    if not given.strip():
        return None
    try:
        fx, fy, cx, cy = (float(part) for part in given.split(","))
    except ValueError as error:
        raise InputError(f"the camera '{given[:40]}' is not four numbers; give fx,fy,cx,cy in pixels") from error
    return fx, fy, cx, cy


def _png(draft: Draft) -> bytes:
    if draft.photo is None:
        raise InputError("there is no photo yet; upload one first")
    buffer = io.BytesIO()
    Image.fromarray(draft.photo.rgb).save(buffer, "PNG")
    return buffer.getvalue()


def _jpeg_uri(rgb: UInt8[np.ndarray, "h w 3"]) -> str:
    buffer = io.BytesIO()
    Image.fromarray(reduced(rgb, 480)).save(buffer, "JPEG", quality=80)
    return "data:image/jpeg;base64," + base64.b64encode(buffer.getvalue()).decode()
