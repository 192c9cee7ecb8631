"""All projects in a grid over the page: searched, sorted, opened, renamed, duplicated, deleted to the bin."""

from __future__ import annotations

import time
from pathlib import Path

import viser

from diorama_app.panels.fields import options_html
from diorama_app.panels.projects import folder_in_list, is_open, visit_listed
from diorama_app.projects import manage
from diorama_app.projects.pictures import project_picture
from diorama_app.session.client import Client
from diorama_app.strings import N_, _
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.errors import EditRefused
from diorama_core.project.lock import ProjectLock
from diorama_core.project.storage import Project

SORTS = {"changed": N_("Last changed first"), "oldest": N_("Oldest first"), "name": N_("By name")}
_FILTER = (
    "const w=this.value.trim().toLowerCase();"
    "this.closest('.page').querySelectorAll('[data-name]').forEach(t=>t.hidden=!t.dataset.name.includes(w))"
)
"""Hides what does not match while somebody types; the server hears of it when the field is left."""


class AllProjects:
    """Drawn while it is open."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._open = False
        self._words, self._sort = "", "changed"
        self._html = LiveHtml(gui, lambda action: client.post(lambda: self._do(action)), floating="dio-projects")
        client.open_projects = self.open

    def refresh(self) -> None:
        """Draw it while it is open."""
        self._html.show(self._client.session.glances.get(self._key(), self._page) if self._open else "")

    def open(self) -> None:
        """Show it over the page; Esc closes it."""
        self._client.close_dialog()
        self._open, self._client.dialog = True, self.close
        self.refresh()

    def close(self) -> None:
        """Back to the page behind it."""
        self._open, self._client.dialog = False, None
        self.refresh()

    def _key(self) -> tuple[str, ...]:
        project = self._client.session.project
        return ("all projects", self._words, self._sort, "" if project is None else project.folder.name)

    def _page(self) -> str:
        folders = manage.recent_projects(self._client.session.projects_dir)
        names = {folder: manage.name_of(folder) for folder in folders}
        if self._sort == "oldest":
            folders.reverse()
        elif self._sort == "name":
            folders.sort(key=lambda folder: names[folder].casefold())
        tiles = "".join(self._tile(folder, names[folder]) for folder in folders)
        options = options_html(((key, _(words)) for key, words in SORTS.items()), self._sort)
        bin_of = "".join(_bin_row(place) for place in manage.projects_in_bin(self._client.session.projects_dir))
        bin_of = f"<details><summary>{text(_('Bin'))}</summary>{bin_of}</details>" if bin_of else ""
        title = text(_("All projects"))
        return (
            f'<div class="page" role="dialog" aria-modal="true" aria-label="{title}"><header><h1>{title}</h1>'
            + button("✕", "close", title=_("Close"))
            + f'</header><div class="search"><input type="search" data-change="search" value="{text(self._words)}" '
            f'placeholder="{text(_("Search"))}" aria-label="{text(_("Search projects"))}" oninput="{_FILTER}">'
            f'<select data-change="sort" aria-label="{text(_("Order"))}">{options}</select></div>'
            f'<div class="grid">{tiles}</div>{bin_of}</div>'
        )

    def _tile(self, folder: Path, name: str) -> str:
        address, session = manage.address_of(folder), self._client.session
        current, written = is_open(session.project, folder), manage.mtime(folder)
        picture = session.thumbnails.picture_html(f"{folder} {written}", lambda: project_picture(folder))
        when = time.strftime("%Y-%m-%d, %H:%M", time.localtime(written))
        hidden = "" if self._words.casefold() in name.casefold() else "hidden"
        label, named = text(_("Open {name}").format(name=name)), text(_("Name of {name}").format(name=name))
        return (
            f'<div class="tile {"on" if current else ""}" data-name="{text(name.lower())}" {hidden}>'
            f'<button type="button" data-do="open" data-arg="{text(address)}" title="{label}" aria-label="{label}">'
            f'{picture}</button><input data-change="rename" data-arg="{text(address)}" value="{text(name)}" '
            f'aria-label="{named}" title="{text(_("Type to rename"))}"><small>{when}</small><div class="bar">'
            + button(_("Duplicate"), "copy", address)
            + button(_("Delete"), "bin", address, title=_("Move it to the bin"), disabled=current)
            + "</div></div>"
        )

    def _do(self, action: Action) -> None:
        session = self._client.session
        if action.do == "close":
            self.close()
            return
        if action.do == "search":
            self._words = action.pair[1].strip()
        elif action.do == "sort" and action.pair[1] in SORTS:
            self._sort = action.pair[1]
        elif action.do == "unbin":
            self._restore(action.arg)
        elif action.do == "rename":
            self._rename(folder_in_list(session, action.pair[0]), action.pair[1])
        elif action.do == "open":
            folder_in_list(session, action.arg)  # refused while the page is still open
            self.close()
            visit_listed(self._client, action.arg)
        elif action.do in ("copy", "bin"):
            self._with_listed(action.do, folder_in_list(session, action.arg))
        session.glances.forget()
        session.refresh_panels()

    def _restore(self, address: str) -> None:
        session = self._client.session
        place = next((p for p in manage.projects_in_bin(session.projects_dir) if manage.address_of(p) == address), None)
        if place is None:
            raise EditRefused("that project no longer exists")
        folder = manage.out_of_bin(place, session.projects_dir)
        self._client.toast(_("{name} is restored.").format(name=manage.name_of(folder)), False)

    def _rename(self, folder: Path, name: str) -> None:
        session = self._client.session
        if is_open(session.project, folder):
            session.need_writable()
        else:
            ProjectLock(folder).release()  # refused while another program has it open
        manage.rename_project(Project.open(folder), name)

    def _with_listed(self, do: str, folder: Path) -> None:
        client, session = self._client, self._client.session
        if do == "copy":
            session.autosave.flush()
            copy = manage.duplicate_project(folder, session.projects_dir)
            client.toast(_("Copied as {name}.").format(name=copy.name), False)
        else:
            if is_open(session.project, folder):
                raise EditRefused("that project is open; open another one first")
            ProjectLock(folder).release()
            name, place = manage.name_of(folder), manage.to_bin(folder, session.projects_dir)
            message = _("{name} is in the bin.").format(name=name)
            client.offer(message, _("Restore"), lambda: self._undelete(manage.address_of(place)))

    def _undelete(self, address: str) -> None:
        self._restore(address)
        self._client.session.glances.forget()
        self._client.session.refresh_panels()


def _bin_row(place: Path) -> str:
    restore = button(_("Restore"), "unbin", manage.address_of(place))
    return f'<div class="row"><span class="name">{text(manage.name_of(place))}</span>{restore}</div>'
