"""The commands of the editor: what each does, in one table that feeds keys, buttons, palette and help."""

from __future__ import annotations

from collections.abc import Callable

from diorama_app.commands import edit as editing
from diorama_app.commands import swap as swapping
from diorama_app.commands.camera_presets import Views
from diorama_app.commands.measure import start_measuring, stop_measuring
from diorama_app.commands.registry import Command, CommandTable
from diorama_app.reconstruction.networks import find_furniture
from diorama_app.reconstruction.photo_outlines import PhotoOutlines
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.editing import aligning as arranging
from diorama_core.editing.clipboard import copied, pasted
from diorama_core.editing.placing import seated
from diorama_core.errors import EditRefused
from diorama_core.scene.types import Scene

TURN_DEG = 15.0
Do = Callable[[Client], None]


def build_commands(
    session: EditorSession,
    views: Views,
    outlines: PhotoOutlines,
    cancel: Callable[[Client], bool],
    show_help: Do,
    show_picture: Do,
) -> CommandTable:
    """Every command of the editor.

    Args:
        room: what they act on.
        views: where cameras go.
        outlines: what the photo shows of the things found in it.
        cancel: stops what a person's hand is doing, and says whether it did.
        show_help: opens the list of commands.
        show_picture: opens the choices for a picture.
    """

    def escape(client: Client) -> None:
        if client.dialog is not None:
            client.dialog()
            return
        stop_measuring(client)
        if cancel(client):
            return
        if client.view.drawing:
            views.room_view(client)
        else:
            client.select(())

    def save(client: Client) -> None:
        if session.project is None:
            raise EditRefused("there is no project open to save")
        session.need_writable()
        session.autosave.save_soon(session.project, session.scene)
        session.autosave.flush()
        if session.autosave.trouble:
            return  # it says so itself
        client.notice(f"Saved in {session.project.name}.", "good")

    rows = (
        *_history(session),
        *_selection(session),
        *_objects(session),
        *_several(session),
        *_views(views),
        *_overlays(views, outlines),
        *_ways(),
        Command("save", "Save", save, "S", "cmd/ctrl", "Save now (every change is saved anyway)"),
        Command("measure", "Measure", start_measuring, "M", None, "Measure between two clicks; rescale by it"),
        Command("picture", "Picture", show_picture, "I", None, "Draw a picture or a film of the scene to download"),
        Command("find_furniture", "Find furniture", find_furniture, None, None, "Box the photo's furniture by network"),
        Command("help", "What you can do", show_help, "?", "shift", "Every command with its key"),
        Command("escape", "Clear selection", escape, "escape", None, "Stop what is under way, or select nothing"),
    )
    return CommandTable(rows)


def _history(session: EditorSession) -> tuple[Command, ...]:
    return (
        Command("undo", "Undo", lambda g: session.undo(g), "Z", "cmd/ctrl", "Take back the last change"),
        Command("redo", "Redo", lambda g: session.redo(g), "Z", "cmd/ctrl+shift", "Do it again"),
    )


def _selection(session: EditorSession) -> tuple[Command, ...]:
    def everything(client: Client) -> None:
        client.select(o.id for o in session.scene.objects if not o.hidden)

    def invert(client: Client) -> None:
        client.select(o.id for o in session.scene.objects if not o.hidden and o.id not in client.selection)

    def same(client: Client) -> None:
        item = session.scene.object(client.need_selected())
        client.select(
            (*(o.id for o in session.scene.objects if o.shape_id == item.shape_id and o.id != item.id), item.id)
        )

    def wrong(client: Client) -> None:
        if not session.badges:
            raise EditRefused("nothing collides, floats or is outside the room")
        client.select(session.badges)

    return (
        Command("select_all", "Select all", everything, "A", "cmd/ctrl", "Select everything that is shown"),
        Command("select_invert", "Invert selection", invert, "I", "cmd/ctrl", "Select what is not selected"),
        Command("select_same", "Select alike", same, None, None, "Select everything of the same shape"),
        Command("select_bad", "Select what is wrong", wrong, None, None, "What collides, floats or is outside"),
    )


def _objects(session: EditorSession) -> tuple[Command, ...]:
    def copy(client: Client) -> None:
        session.clip = copied(session.scene, client.need_selection())
        client.notice(f"Copied {editing.names_of(session.scene, client.selection)}.")

    def cut(client: Client) -> None:
        copy(client)
        editing.delete_selected(client)

    def paste(client: Client) -> None:
        if session.clip is None:
            raise EditRefused("nothing was copied yet; select something and press Ctrl+C")
        scene, heads = pasted(session.scene, session.clip)
        session.commit(f"paste {editing.names_of(scene, heads)}", scene, by=client, selection=heads)

    def lock(client: Client) -> None:
        chosen = client.need_selection()
        editing.set_locked(client, chosen, not session.scene.object(chosen[-1]).locked)

    def hide(client: Client) -> None:
        chosen = client.need_selection()
        editing.set_hidden(client, chosen, not session.scene.object(chosen[-1]).hidden)

    def drop(client: Client) -> None:
        chosen = client.need_selection()

        def down(scene: Scene) -> Scene:
            for object_id in chosen:
                scene = seated(scene, session.library, object_id)
            return scene

        session.edit(f"put down {editing.names_of(session.scene, chosen)}", down, by=client)

    return (
        Command("duplicate", "Duplicate", editing.duplicate_selected, "D", "cmd/ctrl", "Copy beside"),
        Command("copy", "Copy", copy, "C", "cmd/ctrl", "Copy with what stands on it; paste in any project"),
        Command("cut", "Cut", cut, "X", "cmd/ctrl", "Copy and delete"),
        Command("paste", "Paste", paste, "V", "cmd/ctrl", "Put down what was copied"),
        Command("delete", "Delete", editing.delete_selected, "delete", None, "Delete the selection"),
        Command("hide", "Hide or show", hide, "H", None, "Hide the selection"),
        Command("show_all", "Show everything", editing.show_all, "H", "shift", "Show all that is hidden"),
        Command("lock", "Lock or unlock", lock, "L", None, "Keep the selection as it is"),
        Command("drop", "Drop to support", drop, "G", None, "Put it down on what holds it up"),
        Command("turn_left", "Turn left", lambda g: editing.turn_selected(g, TURN_DEG), "J", None, "15° left"),
        Command("turn_right", "Turn right", lambda g: editing.turn_selected(g, -TURN_DEG), "K", None, "15° right"),
        Command("next_shape", "Next alternative", lambda g: swapping.next_alternative(g, 1), "X", None, "Swap on"),
        Command("previous_shape", "Previous alternative", lambda g: swapping.next_alternative(g, -1), "X", "shift"),
    )


def _several(session: EditorSession) -> tuple[Command, ...]:
    def align(label: str, side: str, anchor: arranging.Anchor) -> Do:
        def run(client: Client) -> None:
            chosen = client.need_selection()
            axis, flipped = client.view.screen_axis(side)
            end = {"low": "high", "high": "low"}.get(anchor, anchor) if flipped else anchor
            session.edit(
                f"align {label}",
                lambda s: arranging.align(s, chosen, axis, end),  # type: ignore[arg-type]
                by=client,
            )

        return run

    def distribute(client: Client) -> None:
        chosen = client.need_selection()
        axis = arranging.widest_axis(session.scene, chosen)
        session.edit("distribute evenly", lambda s: arranging.distribute(s, chosen, axis), by=client)

    def mirror(client: Client) -> None:
        chosen = client.need_selection()
        axis, _ = client.view.screen_axis("right")
        names = editing.names_of(session.scene, chosen)
        session.edit(f"mirror {names}", lambda s: arranging.mirror(s, chosen, axis), by=client)

    return (
        Command("align_left", "Align left", align("left", "right", "low"), None, None, "Left ends in line"),
        Command("align_centre", "Align middles", align("middles", "right", "middle"), None, None, "Side to side"),
        Command("align_right", "Align right", align("right", "right", "high"), None, None, "Right ends in line"),
        Command("align_back", "Align far", align("far ends", "away", "high"), None, None, "Far ends in line"),
        Command("align_depth", "Align in depth", align("in depth", "away", "middle"), None, None, "Near to far"),
        Command("align_front", "Align near", align("near ends", "away", "low"), None, None, "Near ends in line"),
        Command("distribute", "Distribute evenly", distribute, None, None, "Equal gaps between three or more"),
        Command("mirror", "Mirror", mirror, "M", "shift", "Swap left and right of the arrangement"),
    )


def _views(views: Views) -> tuple[Command, ...]:
    return (
        Command("view_room", "Room view", views.room_view, "R", None, "See the whole room"),
        Command("view_photo", "Photo view", views.photo, "P", None, "Look through the photo's camera"),
        Command("view_top", "Top view", lambda g: views.along(g, (0.0, -1e-3, 1.0)), "T", None, "From above"),
        Command("view_front", "Front view", lambda g: views.along(g, (0.0, -1.0, 0.0)), "4", None, "From the front"),
        Command("view_left", "Left view", lambda g: views.along(g, (-1.0, 0.0, 0.0)), "5", None, "From the left"),
        Command("view_right", "Right view", lambda g: views.along(g, (1.0, 0.0, 0.0)), "6", None, "From the right"),
        Command("focus", "Focus", views.focus, "F", None, "Look at the selection"),
    )


def _overlays(views: Views, outlines: PhotoOutlines) -> tuple[Command, ...]:
    def masks(client: Client) -> None:
        wanted = not client.preferences.masks
        if wanted:
            outlines.find(client)
            views.overlay(client, 1.0)
        client.change_preferences(masks=wanted)

    def planes(client: Client) -> None:
        client.change_preferences(planes=not client.preferences.planes)

    return (
        Command("masks", "Outlines", masks, "O", None, "What was found in the photo, outlined over it"),
        Command("planes", "Planes", planes, "Y", None, "Edges and names of floor, walls and ceiling"),
    )


def _ways() -> tuple[Command, ...]:
    def switch(name: str) -> Do:
        return lambda g: g.change_preferences(**{name: not getattr(g.preferences, name)})

    def gizmo(mode: str) -> Do:
        return lambda g: g.change_preferences(gizmo=mode)

    def theme(client: Client) -> None:
        client.change_preferences(dark=not client.preferences.dark)
        client.view.set_dark(client.preferences.dark)

    return (
        Command("gizmo_floor", "Move", gizmo("floor"), "1", None, "Handles that move on the floor"),
        Command("gizmo_free", "Free", gizmo("free"), "2", None, "Handles that move and turn any way"),
        Command("gizmo_size", "Size", gizmo("size"), "3", None, "Handles that stretch; the corner keeps proportions"),
        Command("snap", "Snap", switch("snap"), "N", None, "Keep to 5 cm, 15° and walls; Alt inverts it in a drag"),
        Command("slide", "No bumps", switch("slide"), "C", None, "Drags do not go through things"),
        Command("names", "Names", switch("names"), "B", None, "Names on everything"),
        Command(
            "badges",
            "Warnings",
            switch("badges"),
            None,
            None,
            "⚠ collides, floats or is outside; ? is unsure",
        ),
        Command("theme", "Dark or light", theme, None, None, "Colours of the panels"),
    )
