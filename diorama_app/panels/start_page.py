"""The start page: a photo, a description, an empty room, a file or an earlier project, or an example.

It lies over the page when the program was started without a project, in every tab of the browser until it was used, and
whenever it is asked for. `static/start_page.js` asks for it, `static/tour.js` shows newcomers around afterwards.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import viser

from diorama_app.panels.fields import PageScript, add_hidden_upload
from diorama_app.panels.projects import folder_in_list, visit_listed
from diorama_app.projects.manage import address_of, name_of, recent_projects
from diorama_app.projects.pictures import jpeg_uri
from diorama_app.reconstruction.opening_job import open_file
from diorama_app.reconstruction.starting_rooms import LIVING_ROOM, open_example, start_empty_room
from diorama_app.reconstruction.text_to_scene import describe_room
from diorama_app.session.client import Client
from diorama_app.session.units import format_length, parse_length
from diorama_app.strings import N_, _
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.errors import InputError
from diorama_core.io.assets import asset
from diorama_core.project.storage import Project

PICTURES = asset("start")
EXAMPLES = {LIVING_ROOM: N_("Living room"), "bedroom": N_("Bedroom"), "study": N_("Study"), "kitchen": N_("Kitchen")}
USUAL_ROOM_M = (4.0, 5.0, 2.5)
LENGTHS = {
    N_("Width"): N_("Width of the room"),
    N_("Depth"): N_("Depth of the room"),
    N_("Height"): N_("Height of the room"),
}
RECENT = 4

ABOUT_PHOTO = N_("Drop one here, or choose a file. You mark the furniture; Diorama builds the room.")


class StartPage:
    """Drawn while it is open."""

    def __init__(self, gui: viser.GuiApi, client: Client, take_photo: Callable[[str, bytes], None]) -> None:
        """Put the start page behind a hidden button that the page presses by itself."""
        self._client = client
        self._open = False
        self._words = ""
        self._lengths_m = USUAL_ROOM_M
        self._refused: dict[str, str] = {}
        """What was typed as a length and is none, by field: it stays there to be corrected, and no room is made."""
        self._opened_over: Project | None = None
        self._photo_field = add_hidden_upload(gui, client, _("Start with a photo"), take_photo)
        self._file_field = add_hidden_upload(gui, client, _("Start with a file"), self._take_file)
        self._opener = LiveHtml(gui, self._act)
        self._tour = PageScript(gui)
        self._html = LiveHtml(gui, self._act, floating="dio-start")
        client.open_start = self.open
        client.start_tour = self.start_tour

    def refresh(self) -> None:
        """Draw it while it is open, and what lets the page open it. It closes when another project is opened.

        So what cannot be read leaves it where it is, for another try.
        """
        session = self._client.session
        if self._open and session.project is not self._opened_over:
            self._open, self._client.dialog = False, None
        by_itself = "data-auto" if session.greets else ""
        self._opener.show(f'<button type="button" id="dio-start-open" {by_itself} data-do="begin" hidden></button>')
        self._html.show(self._page() if self._open else "")

    def open(self) -> None:
        """Show it over the page; Esc closes it."""
        self._client.close_dialog()
        self._open, self._opened_over = True, self._client.session.project
        self._client.dialog = self.close
        self.refresh()

    def close(self) -> None:
        """Back to the room behind it."""
        self._open = False
        self._client.dialog = None
        self.refresh()

    def start_tour(self) -> None:
        """Show the page's parts one by one."""
        self._tour.run("window.__dioTour();", again=True)

    def _take_file(self, name: str, content: bytes) -> None:
        open_file(self._client, name, content)
        self.close()

    def _act(self, action: Action) -> None:
        self._client.post(lambda: self._do(action))

    def _do(self, action: Action) -> None:
        client = self._client
        if action.do == "begin":
            if self._open:  # the page does not have it, or it would not ask
                self._html.show(self._page(), again=True)
            else:
                self.open()
        elif action.do == "close":
            self.close()
        elif action.do == "tour":
            self.close()
            self.start_tour()
        elif action.do == "words":
            self._words = action.pair[1]
        elif action.do == "length":
            self._enter(*action.pair)
        elif action.do == "describe":
            describe_room(client, self._words)
            self.close()
        elif action.do == "empty":
            for words in self._refused.values():
                parse_length(words, client.preferences.unit)  # which says again what is wrong
            start_empty_room(client, *self._lengths_m)
            self.close()
        elif action.do == "example" and action.arg in EXAMPLES:
            self.close()
            open_example(client, action.arg)
        elif action.do == "projects":
            client.open_projects()
        elif action.do == "project":
            folder_in_list(client.session, action.arg)  # refused while the page is still open
            self.close()
            visit_listed(client, action.arg)

    def _enter(self, which: str, words: str) -> None:
        if which not in LENGTHS:
            return
        try:
            length = parse_length(words, self._client.preferences.unit)
        except InputError:
            self._refused[which] = words
            self._html.show(self._page(), again=True)
            raise
        width, depth, height = (
            length if name == which else old for name, old in zip(LENGTHS, self._lengths_m, strict=True)
        )
        self._lengths_m = (width, depth, height)
        if self._refused.pop(which, None) is not None:
            self._html.show(self._page(), again=True)

    def _page(self) -> str:
        unit = self._client.preferences.unit
        invalid = ' aria-invalid="true"'
        fields = "".join(
            f'<label>{text(_(name))}<input data-change="length" data-arg="{name}" '
            f'value="{text(self._refused.get(name) or format_length(length, unit))}" aria-label="{text(_(whole))}"'
            f"{invalid if name in self._refused else ''}></label>"
            for (name, whole), length in zip(LENGTHS.items(), self._lengths_m, strict=True)
        )
        photo, file = self._photo_field, self._file_field
        examples = "".join(
            f'<button type="button" class="tile" data-do="example" data-arg="{kind}">'
            f'<img alt="" src="{_picture(kind)}"><b>{text(_(name))}</b></button>'
            for kind, name in EXAMPLES.items()
        )
        earlier = self._client.session.glances.get("start", self._earlier)
        return (
            f'<div class="page" role="dialog" aria-modal="true" aria-label="{text(_("Start"))}"><header>'
            f"<h1>Diorama</h1><p>{text(_('One photo of a room becomes a 3D scene you can edit.'))}</p>"
            + button("✕", "close", title=_("Close"))
            + '</header><div class="ways">'
            f'<section class="first drop"><h2>{text(_("A photo"))}</h2><p>{text(_(ABOUT_PHOTO))}</p>'
            f'<label class="choose main" for="file_upload_{photo}" tabindex="0">{text(_("Choose a photo"))}</label>'
            "</section>"
            f"<section><h2>{text(_('A description'))}</h2><p>{text(_('Describe the room in a sentence.'))}</p>"
            f'<textarea data-change="words" rows="3" aria-label="{text(_("Description of the room"))}" '
            f'placeholder="{text(_("a bedroom with a double bed and two lamps"))}">{text(self._words)}</textarea>'
            + button(_("Create room"), "describe")
            + f"</section><section><h2>{text(_('An empty room'))}</h2>"
            f"<p>{text(_('Type the size of the room, then add furniture.'))}</p>"
            f'<div class="fields">{fields}</div>' + button(_("Create empty room"), "empty") + "</section>"
            f"<section><h2>{text(_('Continue'))}</h2>{earlier}"
            f'<label class="choose" for="file_upload_{file}" tabindex="0">{text(_("Open a file"))}</label>'
            f'<p class="dim">{text(_("GLB, USD, USDZ or Sweet Home 3D"))}</p></section></div>'
            f'<h2>{text(_("Or try an example"))}</h2><div class="examples">{examples}</div>'
            f"<footer>{button(_('Show me around'), 'tour', title=_('A tour of the page in six steps'))}</footer></div>"
        )

    def _earlier(self) -> str:
        folders = recent_projects(self._client.session.projects_dir)[:RECENT]
        rows = "".join(
            button(text(name_of(f)), "project", address_of(f), title=_("Open this project")) for f in folders
        )
        more = button(_("All projects"), "projects", title=_("Search, rename, duplicate, delete"))
        none = f'<p class="dim">{text(_("No projects yet."))}</p>'
        return f'<div class="earlier">{rows}{more}</div>' if rows else none


@cache
def _picture(kind: str) -> str:
    """A small picture of an example, as it lies beside the program."""
    return jpeg_uri((PICTURES / f"{kind}.jpg").read_bytes())
