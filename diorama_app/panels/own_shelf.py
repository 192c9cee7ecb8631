"""A person's own models in the catalogue: in folders, under their own names, deleted and restored."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.web.html import Action, button, switch, text
from diorama_core.library.own_models import OwnModels
from diorama_core.library.record import Shape
from diorama_core.library.user_library import UserLibrary


class OwnShelf:
    """What is drawn of the models, and what is done to them."""

    def __init__(self, client: Client) -> None:
        self._client = client

    @property
    def models(self) -> OwnModels:
        """What their owner says of them."""
        library = self._client.session.library
        return library.own_models if isinstance(library, UserLibrary) else OwnModels()

    def in_folders(self, shapes: Iterable[Shape], tile: Callable[[Shape], str]) -> str:
        """Tiles under the names of their folders; those in no folder come first.

        Args:
            shapes: what is shown.
            tile: draws one.
        """
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
            library.keep_order(models.named(shape_id, words))
        elif action.do == "model-folder" and library.has_own(shape_id):
            library.keep_order(models.filed(shape_id, words))
        elif action.do == "model-restore" and library.has_own(action.arg):
            library.keep_order(models.restored(action.arg))
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
            library.keep_order(library.own_models.restored(shape_id))
            client.refresh()

        client.offer(_("{name} is deleted.").format(name=name), _("Undo"), again)

    def _is_there(self, shape_id: str) -> bool:
        library = self._client.session.library
        return isinstance(library, UserLibrary) and library.has_own(shape_id)
