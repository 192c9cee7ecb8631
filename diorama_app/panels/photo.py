"""The photo panel: upload the photo and its inputs, draw and name boxes, build the scene."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import viser

from diorama_app.commands.registry import CommandTable
from diorama_app.panels.fields import GO_COLOUR, UploadField, enable, on_change, on_press, show_if, show_value
from diorama_app.panels.messages import ask_depth
from diorama_app.panels.photo_bar import photo_bar
from diorama_app.panels.photo_boxes import PhotoBoxes, box_list
from diorama_app.projects.begin import begin_project, keep_given
from diorama_app.projects.pictures import encode_picture, jpeg_uri
from diorama_app.projects.reading_again import upload_again, with_depth
from diorama_app.projects.uploads import Upload
from diorama_app.reconstruction import build_job as work
from diorama_app.reconstruction.dropped_photos import check_all_round
from diorama_app.reconstruction.networks import (
    NO_DETECTOR,
    PROPOSALS_ONLY,
    SMALLEST,
    can_find_furniture,
    can_propose_boxes,
    detect_with_networks,
    missing_networks,
)
from diorama_app.reconstruction.object_correction import add_from_photo
from diorama_app.reconstruction.photo_joining import join_photo
from diorama_app.reconstruction.text_to_scene import describe_room, how_pictures_come
from diorama_app.session.client import Client
from diorama_app.strings import N_, _
from diorama_app.viewport.annotation_canvas import Deleted, Selected
from diorama_app.viewport.mesh_assets import reduce
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.artefacts import Inputs
from diorama_core.errors import InputError, SphericalPhotoError
from diorama_core.io.text import sentences
from diorama_core.models.manifest import networks_of
from diorama_core.models.store import ModelStore
from diorama_core.perception.inputs import ReadInputs
from diorama_core.perception.inputs.depth.scale import AmbiguousDepthError, DepthAnswer
from diorama_core.perception.inputs.sorting import Sort
from diorama_core.perception.inputs.source import Source
from diorama_core.project.storage import Project

SLOW_BYTES = 2_000_000
"""A file of more is announced while it is read."""

KINDS: dict[Sort, str] = {
    "photo": N_("Photo"),
    "boxes": N_("Boxes"),
    "depth": N_("Depth"),
    "masks": N_("Masks"),
    "confidence": N_("Confidence"),
}
INVITATION = N_(
    "Drop it here or upload it. Then draw a box around each piece of furniture, and build a scene that you can edit."
)


class PhotoPanel:
    """Uploads, the drawing of boxes, their list, and "Build scene"."""

    def __init__(self, gui: viser.GuiApi, client: Client, commands: CommandTable) -> None:
        self._client, self._session = client, client.session
        self._boxes = PhotoBoxes(client, self.refresh)
        self._seen_for: Project | None = None
        """The project of which it is known whether its photo is built unasked."""
        self._picture_of: object = None
        self._picture = ""
        self._invitation = LiveHtml(gui, self._act)
        self._bar = LiveHtml(gui, self._act)
        self._naming = LiveHtml(gui, self._act)
        self._list = LiveHtml(gui, self._act)
        client.open_board = self._boxes.open
        client.proposals, client.dismiss = self._boxes.proposals, self._boxes.dismiss
        self._more = gui.add_folder(_("More"), expand_by_default=False)
        with self._more:
            self._find = gui.add_button(_("Detect furniture"), hint=commands["find_furniture"].tooltip)
            on_press(self._find, lambda: client.post(lambda: commands["find_furniture"].run(client)))
            self._no_detector = LiveHtml(gui, self._act)
            hint = _("Build a photo without boxes as soon as it is uploaded, from what is found in it")
            self._at_once = gui.add_checkbox(_("Build uploads at once"), client.preferences.build_at_once, hint=hint)
            on_change(self._at_once, lambda on: client.post(lambda: client.change_preferences(build_at_once=bool(on))))
            self._files = gui.add_folder(None)
            with self._files:
                self._upload(gui, "boxes", _("Add boxes"), ".json,.xml,.txt,.csv")
                self._upload(gui, "depth", _("Add depth"), "*/*")
                self._upload(gui, "masks", _("Add masks"), "image/png,.npy,.npz,.zip,.json,.tif,.tiff")
                hint = _("fx,fy,cx,cy in pixels of the photo; estimated when empty")
                self._camera = gui.add_text(_("Camera"), "", hint=hint)
                on_change(self._camera, self._camera_given)
        self._upload(gui, "photo", _("Upload a photo"), "image/*")
        hint = _("For example: a bedroom with a double bed and two lamps")
        self._words = gui.add_text(_("Describe a room"), "", hint=hint)
        hint = _("Create a new project from this description")
        self._describe = gui.add_button(_("Create room"), color=GO_COLOUR, hint=hint)
        on_change(self._words, lambda words: client.post(self.refresh, key="words"))
        on_press(self._describe, lambda: client.post(lambda: describe_room(client, self._words.value)))
        self._drawn_by = LiveHtml(gui)

    def take(self, name: str, content: bytes) -> None:
        """Begin a project with a file that a person chose as its photo, whatever else it may look like."""
        self.begin(Upload(content, name))

    def begin(self, upload: Upload) -> None:
        """Read a photo with what was given for it: they are a project from the moment when they are read."""
        client = self._client

        def finish(read: ReadInputs) -> None:
            project = begin_project(self._session.projects_dir, upload.name, read, upload.photo)
            keep_given(project, upload)
            given, whole = read.inputs, read.inputs.photo.equirectangular
            if client.preferences.build_at_once and (whole or not (given.boxes or given.instances is not None)):
                project.update_info(**{work.AWAITED: True})
            self._session.visit(client, project, sentences(read.warnings[:3]))

        def ask(unknown: AmbiguousDepthError | SphericalPhotoError) -> None:
            if not isinstance(unknown, SphericalPhotoError):
                ask_depth(client, unknown, lambda answer: self.begin(upload.answer(answer)))
                return
            check_all_round(upload)
            self.begin(replace(upload, sphere=True))

        self._session.reader.read(upload, client, finish, ask)
        self._announce(upload.name, upload.photo)

    def add(self, new: Mapping[Sort, Source]) -> None:
        """Read the open photo together with further files of it, and keep what comes of it."""
        self._read_again(_("add {kinds}").format(kinds=", ".join(_(KINDS[kind]).lower() for kind in new)), new)
        for source in new.values():
            self._announce(source.name, source.data)

    def _announce(self, name: str, content: bytes) -> None:
        if len(content) > SLOW_BYTES:
            self._client.notice(_("Reading {name}…").format(name=name))

    def refresh(self) -> None:
        """Draw what is known of the photo."""
        client, inputs, idle = self._client, self._client.inputs, self._session.jobs.status is None
        further = client.further_photo
        if inputs is None or client.selected_box is None or client.selected_box >= len(inputs.boxes):
            client.selected_box = None
        self._invitation.show(self._introduction(inputs))
        show_if(inputs is not None, self._more)
        show_if(further is None, self._files)
        show_if(further is None, self._words, self._describe)
        self._drawn_by.show(f'<p class="dim">{text(_(how_pictures_come()))}</p>' if self._words.value.strip() else "")
        enable(self._describe, idle and bool(self._words.value.strip()))
        finds, about = self._session.glances.get("detection", _detection)
        enable(self._find, idle and finds)
        show_value(self._at_once, client.preferences.build_at_once)
        self._no_detector.show(about if inputs is not None else "")
        proposed = 0 if inputs is None else self._boxes.proposal_count(inputs)
        if inputs is not None and idle and (proposed or inputs.photo.equirectangular):
            self._build_if_awaited(inputs)
        self._bar.show("" if inputs is None else photo_bar(client, inputs, proposed))
        self._naming.show("" if inputs is None else self._boxes.name_field(inputs))
        self._list.show("" if inputs is None else box_list(inputs, client.selected_box))
        if inputs is not None:
            self._boxes.show(inputs)

    # -- uploads ----------------------------------------------------------------------------------------------

    def _upload(self, gui: viser.GuiApi, kind: Sort, label: str, mime_type: str) -> str:
        def take(name: str, content: bytes) -> None:
            if kind == "photo":
                self.begin(Upload(content, name))
            else:
                self.add({kind: Source(content, name)})

        return UploadField(gui, self._client, label, take, mime_type=mime_type).uuid

    def _read_again(
        self,
        label: str,
        new: Mapping[Sort, Source],
        answer: DepthAnswer | None = None,
        *,
        turn: bool = False,
        bend: bool = False,
    ) -> None:
        """Read the photo with its other files, turned by 180 degrees or left bent where asked, and keep what comes."""
        session, client, before = self._session, self._client, self._session.inputs
        if before is None or session.project is None:
            raise InputError("upload the photo first, then its boxes, depth or masks")
        new = with_depth(new, session.project)
        camera = _intrinsics(self._camera.value)
        upload = upload_again(session.project, before, new, answer, camera, turn=turn, bend=bend)
        project = session.project
        work.stop_unasked(session)

        def finish(read: ReadInputs) -> None:
            if session.inputs is not before:
                raise InputError("the photo or its boxes changed meanwhile; upload the file again")
            keep_given(project, replace(upload, depth=upload.depth if "depth" in new else None, masks=new.get("masks")))
            attitude = None if turn or bend else before.camera_attitude
            inputs = replace(read.inputs, camera_attitude=attitude, camera_height_m=before.camera_height_m)
            session.commit(label, session.scene, inputs=inputs, by=client)
            if read.warnings:  # in place of the step's name, now or when the page is drawn next
                client.to_say = sentences(read.warnings[:3]), True
                client.refresh()

        def ask(unknown: AmbiguousDepthError | SphericalPhotoError) -> None:
            if isinstance(unknown, SphericalPhotoError):
                raise unknown
            ask_depth(client, unknown, lambda chosen: self._read_again(label, new, chosen, turn=turn, bend=bend))

        session.reader.read(upload, client, finish, ask)

    def _camera_given(self, value: str) -> None:
        def read() -> None:
            if self._session.inputs is not None and (not value.strip() or value.count(",") == 3):
                self._read_again(_("set the camera"), {})

        self._client.post(read, key="camera")

    def _add_selected(self) -> None:
        inputs, index = self._session.inputs, self._client.selected_box
        if inputs is None or index is None:
            raise InputError("select a box in the list first, or draw one around the missing object")
        box = inputs.boxes[index]
        add_from_photo(self._client, box.box, box.label)

    def _act(self, action: Action) -> None:
        client, boxes = self._client, self._boxes
        acts: dict[str, Callable[[], None]] = {
            "download": lambda: detect_with_networks(client),
            "accept all": boxes.accept_all,
            "board": boxes.open,
            "add box": self._add_selected,
            "turn": lambda: self._read_again(_("turn the photo"), {}, turn=True),
            "bend": lambda: self._read_again(_("undo straightening"), {}, bend=True),
            "build": lambda: work.build(client.session),
            "build at once": self._build_found,
            "by hand": self._mark_by_hand,
            "join": lambda: join_photo(client),
            "build sphere": self._build_whole_room,
            "named": lambda: boxes.name(action.pair[1]),
            "name": lambda: boxes.name(action.arg),
        }

        def do() -> None:
            if action.do in acts:
                acts[action.do]()
            elif action.arg.isdigit() and action.do == "drop":
                boxes.handle(Deleted(int(action.arg)))
            elif action.arg.isdigit() and action.do == "mark":
                index = int(action.arg)
                boxes.handle(Selected(None if client.selected_box == index else index))

        client.post(do)

    def _build_found(self) -> None:
        """Build with what was found, of which nobody looked at anything."""
        inputs = self._session.inputs
        if inputs is not None:
            work.build_found(self._session, self._boxes.sure(inputs))

    def _build_whole_room(self) -> None:
        """Build from the 360 degree photo that is chosen."""
        further = self._client.further_photo
        if further is not None:
            work.build_whole_room(self._session, further.inputs)

    def _build_if_awaited(self, inputs: Inputs) -> None:
        """Build what was found in a photo that was just uploaded; where nothing is sure, a person marks it."""
        session, project = self._session, self._session.project
        if project is None or project == self._seen_for or not session.is_unbuilt:
            return
        self._seen_for = project
        whole = inputs.photo.equirectangular  # its views are searched by the build
        if work.is_awaited(project) and (whole or (not inputs.boxes and self._boxes.sure(inputs))):
            self._build_found()

    def _mark_by_hand(self) -> None:
        work.stop_unasked(self._session)
        self._client.refresh()

    # -- words ------------------------------------------------------------------------------------------------

    def _introduction(self, inputs: Inputs | None) -> str:
        if inputs is None:
            title, more = text(_("Start with a photo of a room.")), text(_(INVITATION))
            return f'<div class="drop"><b>{title}</b><br><span class="dim">{more}</span></div>'
        extras = [_(name) for name, there in _extras(inputs).items() if there]
        extra = (
            f'<br><span class="dim">{text(_("with {kinds}").format(kinds=", ".join(extras)))}</span>' if extras else ""
        )
        about = text(inputs.photo.name) + extra
        if self._client.view.canvas.is_open:
            return f"<p>{about}</p>"  # the photo itself is on the board
        if self._picture_of is not inputs.photo:
            jpeg = encode_picture(reduce(inputs.photo.rgb, 480), "JPEG", quality=80)
            self._picture_of, self._picture = inputs.photo, jpeg_uri(jpeg)
        return (
            f'<img class="photo" alt="{text(_("The photo"))}" src="{self._picture}"'
            f' title="{text(_("Drop another photo here to start another project"))}">'
            f'<p style="margin-top:6px">{about}</p>'
        )


def _detection() -> tuple[bool, str]:
    """Whether anything detects furniture now, and what would do it better, with its size and licences."""
    finds = can_propose_boxes()
    missing = missing_networks(ModelStore.default(), networks_of(SMALLEST))
    if can_find_furniture() or not missing:
        return finds, ""
    size = f"{sum(n.size_bytes for n in missing) / 1e6:.0f} MB"
    licences = ", ".join(sorted({n.licence for n in missing}))
    label = _("Download {size} and detect").format(size=size)
    fetch = button(label, "download", title=_("Accept their licences: {licences}").format(licences=licences))
    return finds, (
        f'<p class="dim">{text(_(PROPOSALS_ONLY if finds else NO_DETECTOR))}</p>{fetch}'
        f'<p class="dim">{text(_("Licences: {licences}.").format(licences=licences))}</p>'
    )


def _extras(inputs: Inputs) -> dict[str, bool]:
    return {
        N_("depth"): inputs.depth_m is not None,
        N_("masks"): inputs.instances is not None,
        N_("camera"): inputs.intrinsics is not None,
    }


def _intrinsics(given: str) -> tuple[float, float, float, float] | None:
    if not given.strip():
        return None
    try:
        fx, fy, cx, cy = (float(part) for part in given.split(","))
    except ValueError as error:
        message = _("the camera “{words}” is not four numbers; give fx,fy,cx,cy in pixels").format(words=given[:40])
        raise InputError(message) from error
    return fx, fy, cx, cy
