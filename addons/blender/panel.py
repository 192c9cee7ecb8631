"""The panel in the 3D view's sidebar, and what its buttons do."""

from __future__ import annotations

from typing import Any, ClassVar
from urllib.parse import urlsplit

import bpy
from bpy.props import EnumProperty, StringProperty
from mathutils import Matrix

from . import room, transforms
from .client import Client, RefusedError, local_editor

_projects: list[tuple[str, str, str]] = []
"""What the list offers; Blender needs the strings to stay alive."""
_NONE = [("NONE", "No rooms yet", "Press Find Rooms")]
_PROPERTIES = {
    "diorama_address": StringProperty(name="Address", description="Empty: the editor of this machine"),
    "diorama_token": StringProperty(
        name="Token", description="The page's, after ?token=", subtype="PASSWORD", options={"SKIP_SAVE"}
    ),
    "diorama_project": EnumProperty(name="Room", items=lambda _, __: _projects or _NONE),
}
"""Of the window manager: Blender does not save them with a file, so that nobody sends the token along."""


def _client(context: Any) -> Client:
    manager = context.window_manager
    if not manager.diorama_address:
        return local_editor()
    host = urlsplit(manager.diorama_address).hostname
    if host not in ("127.0.0.1", "localhost", "::1") and not bpy.app.online_access:
        raise RefusedError(f"{host} is another machine: allow online access in Blender's preferences, under System")
    return Client(manager.diorama_address, manager.diorama_token)


class _Step(bpy.types.Operator):
    """An operator whose errors are one line; `work` of each does it and gives what was done."""

    bl_options: ClassVar[set[str]] = {"REGISTER"}

    def execute(self, context: Any) -> set[str]:
        """Do it, and tell what was done."""
        try:
            self.report({"INFO"}, self.work(context))
        except (RefusedError, transforms.UnsendableError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class ListRooms(_Step):
    """Ask the editor for its rooms."""

    bl_idname, bl_label = "diorama.list_rooms", "Find Rooms"

    def work(self, context: Any) -> str:
        """Fill the list."""
        chosen = context.window_manager.diorama_project
        rows = _client(context).projects()
        _projects[:] = [(r["project"], r["title"] + (" (open)" if r["open"] else ""), r["folder"]) for r in rows]
        if rows:  # Blender keeps the place in the list, not the name
            names = [r["project"] for r in rows]
            context.window_manager.diorama_project = chosen if chosen in names else names[0]
        return f"{len(rows)} rooms"


class OpenRoom(_Step):
    """Bring the room into this scene, in place of the one that is there."""

    bl_idname, bl_label = "diorama.open_room", "Open"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def work(self, context: Any) -> str:
        """Import the room that is chosen."""
        if not _projects:
            raise RefusedError("no room is chosen: press Find Rooms")
        return _shown(context, _client(context), context.window_manager.diorama_project)


class SendChanges(_Step):
    """Send what was moved, turned, scaled or deleted since, as one step that the editor can undo."""

    bl_idname, bl_label = "diorama.send_changes", "Send Changes"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def work(self, context: Any) -> str:
        """Send the edits, and take over where the editor has put things."""
        opened = _need_room(context)
        made = transforms.changes(room.opened_objects(context.scene), room.world_matrices(context.scene))
        if not made.edits:
            return "; ".join(["nothing has changed", *made.notes])
        client, project = _client(context), opened["project"]
        answer = client.edit(project, opened["version"], made.edits)
        entries = {e["id"]: e for e in client.scene(project)["objects"] if not e["hidden"]}
        here = room.objects_by_id(context.scene)
        room.put({o: Matrix(transforms.matrix_of_entry(entries[i])) for i, o in here.items() if i in entries})
        room.note(context.scene, project, answer["version"], [entries[i] for i in here if i in entries])
        return "; ".join([*made.notes, *answer["notes"], *answer["lines"]])  # Blender cuts long lines at the end


class ReloadRoom(_Step):
    """Take over what others have changed; what you changed and have not sent stays."""

    bl_idname, bl_label = "diorama.reload_room", "Reload"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def work(self, context: Any) -> str:
        """Import the room again, and do again what was not sent."""
        opened, scene = _need_room(context), context.scene
        before, now = room.opened_objects(scene), room.world_matrices(scene)
        moved, gone = transforms.moved_ids(before, now), [o.id for o in before if o.id not in now]
        done = _shown(context, _client(context), opened["project"])
        here = room.objects_by_id(scene)
        room.remove(here[i] for i in gone if i in here)
        still = room.objects_by_id(scene)
        worlds = {i: Matrix(m) for i, m in room.world_matrices(scene).items()}
        worlds |= {i: Matrix(now[i]) for i in moved if i in still}
        room.put({o: worlds[i] for i, o in still.items()})
        unsent = [i for i in (*moved, *gone) if i in here]
        return done + (f"; not sent yet: {', '.join(unsent)}" if unsent else "")


def _need_room(context: Any) -> dict[str, Any]:
    opened = room.about(context.scene)
    if opened is None:
        raise RefusedError("no room is open in this scene: choose one and press Open")
    return opened


def _shown(context: Any, client: Client, project: str) -> str:
    version, glb = client.room(project)
    room.show(context.scene, project, version, glb)
    return f"{project}: {len(room.opened_objects(context.scene))} objects"


class RoomPanel(bpy.types.Panel):
    """The sidebar's tab."""

    bl_idname, bl_label, bl_category = "VIEW3D_PT_diorama", "Diorama", "Diorama"
    bl_space_type, bl_region_type = "VIEW_3D", "UI"

    def draw(self, context: Any) -> None:
        """Address, rooms, and the buttons for the open room."""
        layout, manager = self.layout, context.window_manager
        layout.prop(manager, "diorama_address")
        layout.prop(manager, "diorama_token")
        layout.operator(ListRooms.bl_idname, icon="FILE_REFRESH")
        layout.prop(manager, "diorama_project")
        layout.operator(OpenRoom.bl_idname, icon="IMPORT")
        opened = room.about(context.scene)
        if opened is not None:
            box = layout.box()
            box.label(text=f"{opened['project']}, version {opened['version']}", icon="HOME")
            box.operator(SendChanges.bl_idname, icon="EXPORT")
            box.operator(ReloadRoom.bl_idname, icon="FILE_REFRESH")


_CLASSES = (ListRooms, OpenRoom, SendChanges, ReloadRoom, RoomPanel)


def register() -> None:
    """Declare properties, operators and panel."""
    for name, value in _PROPERTIES.items():
        setattr(bpy.types.WindowManager, name, value)
    for made in _CLASSES:
        bpy.utils.register_class(made)


def unregister() -> None:
    """Take them back."""
    for made in reversed(_CLASSES):
        bpy.utils.unregister_class(made)
    for name in _PROPERTIES:
        delattr(bpy.types.WindowManager, name)
