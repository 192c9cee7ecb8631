"""A person's own models: in the catalogue in folders, under their own names, deleted and restored, and corrections of
what was guessed about an uploaded one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import viser

from diorama_app.commands.import_model import FIXES, correct_model, is_own_model
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.web.html import Action, LiveHtml, button, switch, text
from diorama_core.library.record import Shape
from diorama_core.library.user_library import OwnModels, UserLibrary


class OwnShelf:
    """What is drawn of the models, and what is done to them."""

    def __init__(self, client: Client) -> None:
        self._client = client

    @property
    def models(self) -> OwnModels:
        """What their owner says of them."""
        library = self._client.session.library
        return library.own_models if isinstance(library, UserLibrary) else OwnModels()

    def folder_tiles(self, shapes: Iterable[Shape], tile: Callable[[Shape], str]) -> str:
        """Tiles under the names of their folders; those in no folder come first."""
        models, folders = self.models, dict[str, list[Shape]]()
        for shape in shapes:
            folders.setdefault(models.folders.get(shape.id, ""), []).append(shape)
        return "".join(
            (f"<h4>{text(name)}</h4>" if name else "")
            + f'<div class="grid two">{"".join(tile(shape) for shape in folders[name])}</div>'
            for name in sorted(folders, key=str.casefold)
        )

    def head(self) -> str:
        """What concerns all models."""
        models = self.models
        deleted = [i for i in models.deleted if self._is_there(i)]
        hint = _("Builds and rooms from a description may choose your models")
        drawn = switch(_("Use in new rooms"), hint, "in builds", on=models.in_builds)
        if deleted:
            label = _("Restore the last deleted model ({count})").format(count=len(deleted))
            again = button(label, "model-restore", deleted[-1])
            drawn += f'<div class="bar tight">{again}</div>'
        return drawn

    def fields(self, shape: Shape) -> str:
        """The name and the folder of a model, to be typed, and its deletion."""
        models, key = self.models, text(shape.id)
        name, folder = models.names.get(shape.id, shape.caption), models.folders.get(shape.id, "")
        hint = _("Delete {name}; scenes that use it keep it").format(name=name)
        gone = button(_("Delete"), "model-delete", shape.id, title=hint)
        its_name, its_folder = (text(m.format(name=name)) for m in (_("Name of {name}"), _("Folder of {name}")))
        return (
            f'<input data-change="model-name" data-arg="{key}" value="{text(name)}" aria-label="{its_name}">'
            f'<input data-change="model-folder" data-arg="{key}" value="{text(folder)}" '
            f'placeholder="{text(_("Folder"))}" aria-label="{its_folder}">'
            f'<div class="bar tight" style="margin:4px 0 0 0">{gone}</div>'
        )

    def do(self, action: Action) -> bool:
        """Do what was clicked or typed; False where it is not about own models."""
        library, models = self._client.session.library, self.models
        if not isinstance(library, UserLibrary):
            return False
        shape_id, words = action.pair
        if action.do == "switch" and action.arg == "in builds":
            library.keep_order(OwnModels(models.names, models.folders, models.deleted, not models.in_builds))
        elif action.do == "model-name" and library.has_own(shape_id):
            library.keep_order(models.rename(shape_id, words))
        elif action.do == "model-folder" and library.has_own(shape_id):
            library.keep_order(models.file(shape_id, words))
        elif action.do == "model-restore" and library.has_own(action.arg):
            library.keep_order(models.restore(action.arg))
        elif action.do == "model-delete" and library.has_own(action.arg):
            self._delete(library, models, action.arg)
        else:
            return False
        return True

    def _delete(self, library: UserLibrary, models: OwnModels, shape_id: str) -> None:
        client = self._client
        library.keep_order(models.without(shape_id))
        name = models.names.get(shape_id) or library.shape(shape_id).caption

        def again() -> None:
            library.keep_order(library.own_models.restore(shape_id))
            client.refresh()

        client.offer(_("{name} is deleted.").format(name=name), _("Undo"), again)

    def _is_there(self, shape_id: str) -> bool:
        library = self._client.session.library
        return isinstance(library, UserLibrary) and library.has_own(shape_id)


class OwnModel:
    """Shown for objects with an uploaded shape."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw what was guessed about the selected object's model, and ways to correct it."""
        item = self._client.last_selected
        if item is None or not is_own_model(self._client.session, item.shape_id):
            self._html.show("")
            return
        shape = self._client.session.library.shape(item.shape_id)
        fixes = "".join(button(_(fix.name), "fix", name, title=_(fix.hint)) for name, fix in FIXES.items())
        self._html.show(
            f'<h4>{text(_("Your model"))}</h4><div class="dim">{text(_guess(shape))}</div>'
            f'<div class="bar tight">{fixes}</div>'
            '<div style="display:flex;gap:4px;margin-bottom:4px">'
            f'<input data-change="is" aria-label="{text(_("What the model is"))}" value="{text(_(shape.category))}" '
            f'title="{text(_("Type what the model is and press Enter"))}"></div>'
        )

    def _act(self, action: Action) -> None:
        client = self._client
        if action.do == "fix" and action.arg in FIXES:
            client.post(lambda: correct_model(client, client.need_selected(), FIXES[action.arg]))
        elif action.do == "is":
            client.post(lambda: correct_model(client, client.need_selected(), category=action.pair[1]))


def _guess(shape: Shape) -> str:
    """The guesses as a sentence."""
    if shape.guess is None:
        return _("Guessed: {category}.").format(category=_(shape.category))
    sure = round(100 * min(shape.guess.up.confidence, shape.guess.front.confidence))
    unit = shape.guess.unit.value
    return _("Guessed: {category}; one unit is {unit} m; {sure} % sure which side is up. Correct it here.").format(
        category=_(shape.category), unit=unit, sure=sure
    )
