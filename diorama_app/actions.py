"""The commands of the editor: what each does, in one table that feeds keys, buttons, palette and help."""

from __future__ import annotations

from collections.abc import Callable

from diorama_app import arranging, editing, swapping
from diorama_app.clipboard import copied, pasted
from diorama_app.commands import Command, CommandTable
from diorama_app.guest import Guest
from diorama_app.measuring import start_measuring, stop_measuring
from diorama_app.networks import find_furniture
from diorama_app.photo_outlines import PhotoOutlines
from diorama_app.placing import seated
from diorama_app.room import Room
from diorama_app.views import Views
from diorama_core.errors import EditRefused
from diorama_core.scene.types import Scene

TURN_DEG = 15.0
Do = Callable[[Guest], None]


def build_commands(
    room: Room, views: Views, outlines: PhotoOutlines, cancel: Callable[[Guest], bool], show_help: Do
) -> CommandTable:
    """Every command of the editor.

    Args:
        room: what they act on.
        views: where cameras go.
        outlines: what the photo shows of the things found in it.
        cancel: stops what a person's hand is doing, and says whether it did.
        show_help: opens the list of commands.
    """

    def escape(guest: Guest) -> None:
        if guest.dialog is not None:
            guest.dialog()
            return
        stop_measuring(guest)
        if cancel(guest):
            return
        if guest.view.drawing:
            views.room_view(guest)
        else:
            guest.select(())

    def save(guest: Guest) -> None:
        if room.project is None:
            raise EditRefused("there is no project open to save")
        room.saver.save_soon(room.project, room.scene)
        room.saver.flush()
        guest.notice(f"Saved in {room.project.name}.", "good")

    rows = (
        *_history(room),
        *_selection(room),
        *_objects(room),
        *_several(room),
        *_views(views),
        *_overlays(views, outlines),
        *_ways(),
        Command("save", "Save", save, "S", "cmd/ctrl", "Save now (every change is saved anyway)"),
        Command("measure", "Measure", start_measuring, "M", None, "Measure between two clicks; rescale by it"),
        Command("find_furniture", "Find furniture", find_furniture, None, None, "Box the photo's furniture by network"),
        Command("help", "What you can do", show_help, "?", "shift", "Every command with its key"),
        Command("escape", "Clear selection", escape, "escape", None, "Stop what is under way, or select nothing"),
    )
    return CommandTable(rows)


def _history(room: Room) -> tuple[Command, ...]:
    return (
        Command("undo", "Undo", lambda g: room.undo(g), "Z", "cmd/ctrl", "Take back the last change"),
        Command("redo", "Redo", lambda g: room.redo(g), "Z", "cmd/ctrl+shift", "Do it again"),
    )


def _selection(room: Room) -> tuple[Command, ...]:
    def everything(guest: Guest) -> None:
        guest.select(o.id for o in room.scene.objects if not o.hidden)

    def invert(guest: Guest) -> None:
        guest.select(o.id for o in room.scene.objects if not o.hidden and o.id not in guest.selection)

    def same(guest: Guest) -> None:
        item = room.scene.object(guest.need_selected())
        guest.select((*(o.id for o in room.scene.objects if o.shape_id == item.shape_id and o.id != item.id), item.id))

    def wrong(guest: Guest) -> None:
        if not room.badges:
            raise EditRefused("nothing collides, floats or is outside the room")
        guest.select(room.badges)

    return (
        Command("select_all", "Select all", everything, "A", "cmd/ctrl", "Select everything that is shown"),
        Command("select_invert", "Invert selection", invert, "I", "cmd/ctrl", "Select what is not selected"),
        Command("select_same", "Select alike", same, None, None, "Select everything of the same shape"),
        Command("select_bad", "Select what is wrong", wrong, None, None, "What collides, floats or is outside"),
    )


def _objects(room: Room) -> tuple[Command, ...]:
    def copy(guest: Guest) -> None:
        room.clip = copied(room.scene, guest.need_selection())
        guest.notice(f"Copied {editing.names_of(room.scene, guest.selection)}.")

    def cut(guest: Guest) -> None:
        copy(guest)
        editing.delete_selected(guest)

    def paste(guest: Guest) -> None:
        if room.clip is None:
            raise EditRefused("nothing was copied yet; select something and press Ctrl+C")
        scene, heads = pasted(room.scene, room.clip)
        room.commit(f"paste {editing.names_of(scene, heads)}", scene, by=guest, selection=heads)

    def lock(guest: Guest) -> None:
        chosen = guest.need_selection()
        editing.set_locked(guest, chosen, not room.scene.object(chosen[-1]).locked)

    def hide(guest: Guest) -> None:
        chosen = guest.need_selection()
        editing.set_hidden(guest, chosen, not room.scene.object(chosen[-1]).hidden)

    def drop(guest: Guest) -> None:
        chosen = guest.need_selection()

        def down(scene: Scene) -> Scene:
            for object_id in chosen:
                scene = seated(scene, room.library, object_id)
            return scene

        room.edit(f"put down {editing.names_of(room.scene, chosen)}", down, by=guest)

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


def _several(room: Room) -> tuple[Command, ...]:
    def align(label: str, side: str, anchor: arranging.Anchor) -> Do:
        def run(guest: Guest) -> None:
            chosen = guest.need_selection()
            axis, flipped = guest.view.screen_axis(side)
            end = {"low": "high", "high": "low"}.get(anchor, anchor) if flipped else anchor
            room.edit(
                f"align {label}",
                lambda s: arranging.align(s, chosen, axis, end),  # type: ignore[arg-type]
                by=guest,
            )

        return run

    def distribute(guest: Guest) -> None:
        chosen = guest.need_selection()
        axis = arranging.widest_axis(room.scene, chosen)
        room.edit("distribute evenly", lambda s: arranging.distribute(s, chosen, axis), by=guest)

    def mirror(guest: Guest) -> None:
        chosen = guest.need_selection()
        axis, _ = guest.view.screen_axis("right")
        names = editing.names_of(room.scene, chosen)
        room.edit(f"mirror {names}", lambda s: arranging.mirror(s, chosen, axis), by=guest)

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
    def masks(guest: Guest) -> None:
        wanted = not guest.settings.masks
        if wanted:
            outlines.find(guest)
            views.overlay(guest, 1.0)
        guest.change_settings(masks=wanted)

    def planes(guest: Guest) -> None:
        guest.change_settings(planes=not guest.settings.planes)

    return (
        Command("masks", "Outlines", masks, "O", None, "What was found in the photo, outlined over it"),
        Command("planes", "Planes", planes, "Y", None, "Edges and names of floor, walls and ceiling"),
    )


def _ways() -> tuple[Command, ...]:
    def switch(name: str) -> Do:
        return lambda g: g.change_settings(**{name: not getattr(g.settings, name)})

    def gizmo(mode: str) -> Do:
        return lambda g: g.change_settings(gizmo=mode)

    def theme(guest: Guest) -> None:
        guest.change_settings(dark=not guest.settings.dark)
        guest.view.set_dark(guest.settings.dark)

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
