"""The commands of the editor: what each does, in one table that feeds keys, buttons, palette and help."""

from __future__ import annotations

from collections.abc import Callable

from diorama_app.commands import edit as editing
from diorama_app.commands import swap as swapping
from diorama_app.commands.camera_presets import Views
from diorama_app.commands.measure import start_measuring, stop_measuring
from diorama_app.commands.play import play
from diorama_app.commands.registry import Command, CommandTable
from diorama_app.reconstruction.networks import find_furniture
from diorama_app.reconstruction.photo_outlines import PhotoOutlines
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.strings import _
from diorama_core.editing import aligning as arranging
from diorama_core.editing.clipboard import clip_of, free_offset, paste_at, paste_clip
from diorama_core.editing.placing import seat
from diorama_core.errors import EditRefused
from diorama_core.scene.room_edits import floor_height
from diorama_core.scene.types import Scene

TURN_DEG = 15.0
OPPOSITE: dict[arranging.Anchor, arranging.Anchor] = {"low": "high", "middle": "middle", "high": "low"}
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
        session: what they act on.
        views: where cameras go.
        outlines: what the photo shows of the objects found in it.
        cancel: cancels the current gesture; returns whether there was one.
        show_help: opens the list of commands.
        show_picture: opens the choices for a picture.
    """
    rows = (
        *_history(session),
        *_selection(session),
        *_objects(session),
        *_several(session),
        *_views(views),
        *_overlays(views, outlines),
        *_ways(),
        *_general(session, show_help, show_picture),
        _escape(views, cancel),
    )
    return CommandTable(rows)


def _escape(views: Views, cancel: Callable[[Client], bool]) -> Command:
    def escape(client: Client) -> None:
        if client.dialog is not None:
            client.dialog()
            return
        stop_measuring(client)
        if cancel(client):
            return
        if client.view.canvas.is_open and client.selected_box is not None:
            client.selected_box = None
            client.refresh()
        elif client.view.canvas.is_open:
            views.room_view(client)
        else:
            client.select(())

    return Command(
        "escape", "Clear selection", escape, "escape", None, "Cancel the current action, or clear the selection"
    )


def _general(session: EditorSession, show_help: Do, show_picture: Do) -> tuple[Command, ...]:
    def save(client: Client) -> None:
        project = session.need_project()
        session.autosave.save_soon(project, session.scene)
        session.autosave.flush()
        if session.autosave.trouble:
            return  # it says so itself
        client.notice(_("Saved in {name}.").format(name=project.name), "good")

    return (
        Command("save", "Save", save, "S", "cmd/ctrl", "Save now; every change is saved automatically, too"),
        Command(
            "measure",
            "Measure",
            start_measuring,
            "M",
            None,
            "Measure between two clicked points, which snap to corners; type the true length to rescale",
        ),
        Command("picture", "Picture", show_picture, "I", None, "Draw a picture or a film of the scene to download"),
        Command(
            "find_furniture",
            "Detect furniture",
            find_furniture,
            hint="Detect the furniture in the photo with a network",
        ),
        Command(
            "start_page", "Start page", lambda g: g.open_start(), None, None, "A photo, a description, an empty room"
        ),
        Command(
            "projects", "All projects", lambda g: g.open_projects(), None, None, "Search, rename, duplicate, delete"
        ),
        Command("tour", "Show me around", lambda g: g.start_tour(), hint="A tour of the page in six steps"),
        Command("help", "Help", show_help, "?", "shift", "Every command with its key"),
    )


def _history(session: EditorSession) -> tuple[Command, ...]:
    return (
        Command("undo", "Undo", lambda g: session.undo(g), "Z", "cmd/ctrl", "Undo the last change"),
        Command("redo", "Redo", lambda g: session.redo(g), "Z", "cmd/ctrl+shift", "Redo the last undone change"),
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
        Command("select_all", "Select all", everything, "A", "cmd/ctrl", "Select all visible objects"),
        Command(
            "select_invert", "Invert selection", invert, "I", "cmd/ctrl", "Select all objects that are not selected"
        ),
        Command("select_same", "Select same shape", same, hint="Select all objects with the same shape"),
        Command("select_bad", "Select problems", wrong, hint="Objects that collide, float or are outside"),
    )


def _objects(session: EditorSession) -> tuple[Command, ...]:
    def copy(client: Client) -> None:
        session.shared.clip = clip_of(session.scene, client.need_selection())
        client.notice(_("Copied {names}.").format(names=editing.names_of(session.scene, client.selection)))

    def cut(client: Client) -> None:
        copy(client)
        editing.delete_selected(client)

    def paste(client: Client) -> None:
        if session.shared.clip is None:
            raise EditRefused("nothing was copied yet; select something and press Ctrl+C")
        clip, here = session.shared.clip, session.scene
        original = all(here.has_object(o.id) and here.object(o.id) == o for o in clip.objects)
        scene, heads = (
            paste_clip(here, clip, free_offset(here, clip))
            if original
            else paste_at(here, clip, client.view.camera.point_on_level(floor_height(client.room())))
        )
        label = _("paste {names}").format(names=editing.names_of(scene, heads))
        session.commit(label, scene, by=client, selection=heads)

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
                scene = seat(scene, session.library, object_id)
            return scene

        label = _("drop {names}").format(names=editing.names_of(session.scene, chosen))
        session.edit(label, down, by=client, by_hand=True)

    return (
        Command("duplicate", "Duplicate", editing.duplicate_selected, "D", "cmd/ctrl", "Duplicate next to it"),
        Command("copy", "Copy", copy, "C", "cmd/ctrl", "Copy with everything on it; paste into any project"),
        Command("cut", "Cut", cut, "X", "cmd/ctrl", "Copy and delete"),
        Command("paste", "Paste", paste, "V", "cmd/ctrl", "Paste the copied objects"),
        Command("delete", "Delete", editing.delete_selected, "delete", None, "Delete the selection"),
        Command("hide", "Hide or show", hide, "H", None, "Hide or show the selection"),
        Command("show_all", "Show everything", editing.show_all, "H", "shift", "Show all hidden objects"),
        Command("lock", "Lock or unlock", lock, "L", None, "Protect the selection from changes"),
        Command("drop", "Drop to support", drop, "G", None, "Lower the selection onto its support"),
        Command("turn_left", "Rotate left", lambda g: editing.turn_selected(g, TURN_DEG), "J", None, "15° left"),
        Command("turn_right", "Rotate right", lambda g: editing.turn_selected(g, -TURN_DEG), "K", None, "15° right"),
        Command("next_shape", "Next alternative", lambda g: swapping.next_alternative(g, 1), "X", None, "Swap shape"),
        Command("previous_shape", "Previous alternative", lambda g: swapping.next_alternative(g, -1), "X", "shift"),
    )


def _several(session: EditorSession) -> tuple[Command, ...]:
    def align(side: str, anchor: arranging.Anchor) -> Do:
        def run(client: Client) -> None:
            chosen = client.need_selection()
            axis, flipped = client.view.camera.screen_axis(side)
            end = OPPOSITE[anchor] if flipped else anchor
            label = _("align {names}").format(names=editing.names_of(session.scene, chosen))
            session.edit(label, lambda s: arranging.align(s, chosen, axis, end), by=client, by_hand=True)

        return run

    def distribute(client: Client) -> None:
        chosen = client.need_selection()
        axis = arranging.widest_axis(session.scene, chosen)
        session.edit(_("distribute evenly"), lambda s: arranging.distribute(s, chosen, axis), by=client, by_hand=True)

    def mirror(client: Client) -> None:
        chosen = client.need_selection()
        axis = client.view.camera.screen_axis("right")[0]
        label = _("mirror {names}").format(names=editing.names_of(session.scene, chosen))
        session.edit(label, lambda s: arranging.mirror(s, chosen, axis, session.library), by=client, by_hand=True)

    return (
        Command("align_left", "Align left", align("right", "low"), hint="Align left edges"),
        Command("align_centre", "Align centres", align("right", "middle"), hint="Align centres"),
        Command("align_right", "Align right", align("right", "high"), hint="Align right edges"),
        Command("align_back", "Align far", align("away", "high"), hint="Align far edges"),
        Command("align_depth", "Align in depth", align("away", "middle"), hint="Align centres in depth"),
        Command("align_front", "Align near", align("away", "low"), hint="Align near edges"),
        Command("distribute", "Distribute evenly", distribute, hint="Equal gaps between three or more objects"),
        Command("mirror", "Mirror", mirror, "M", "shift", "Mirror the selection left to right"),
    )


def _views(views: Views) -> tuple[Command, ...]:
    return (
        Command("view_room", "Room view", views.room_view, "R", None, "Show the whole room"),
        Command("view_photo", "Photo view", views.photo, "P", None, "View from the photo's camera"),
        Command("view_top", "Top view", lambda g: views.look(g, (0.0, -1e-3, 1.0)), "T", None, "From above"),
        Command("view_plan", "Plan", views.plan, "7", None, "The plan: drag walls and corners, type lengths"),
        Command("view_front", "Front view", lambda g: views.look(g, (0.0, -1.0, 0.0)), "4", None, "From the front"),
        Command("view_left", "Left view", lambda g: views.look(g, (-1.0, 0.0, 0.0)), "5", None, "From the left"),
        Command("view_right", "Right view", lambda g: views.look(g, (1.0, 0.0, 0.0)), "6", None, "From the right"),
        Command("walk", "Walk", views.walk, "W", None, "Walk through the room: W A S D, drag to look around"),
        Command(
            "play",
            "Play",
            play,
            hint="Switch on gravity; clicks push objects. Play again keeps the result as one undo step",
        ),
        Command("focus", "Focus", views.focus, "F", None, "Centre the view on the selection"),
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
        Command("masks", "Outlines", masks, "O", None, "Outline the detected objects over the photo"),
        Command("planes", "Planes", planes, "Y", None, "Show edges and names of the floor, walls and ceiling"),
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
        Command("gizmo_floor", "Move", gizmo("floor"), "1", None, "Handles to move on the floor"),
        Command("gizmo_free", "Free", gizmo("free"), "2", None, "Handles to move and rotate freely"),
        Command("gizmo_size", "Size", gizmo("size"), "3", None, "Handles to resize; the corner keeps proportions"),
        Command("snap", "Snap", switch("snap"), "N", None, "Snap to 5 cm, 15° and walls; hold Alt to invert"),
        Command("slide", "No overlaps", switch("slide"), "C", None, "Dragged objects stop at other objects"),
        Command("names", "Names", switch("names"), "B", None, "Show the name of every object"),
        Command(
            "badges", "Warnings", switch("badges"), hint="⚠ collides, floats or is outside the room; ? is uncertain"
        ),
        Command("theme", "Dark or light", theme, hint="Switch between dark and light panels"),
    )
