"""Random edits by a person who never tires."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from diorama_app.commands import edit as editing
from diorama_app.commands import swap as swapping
from diorama_app.commands.insert import insert_shape
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.web.viser_adapter import create_server, stop_server
from diorama_app.web.visitors import Visitors
from diorama_core.editing import aligning as arranging
from diorama_core.editing.clipboard import clip_of, paste_clip
from diorama_core.errors import DioramaError
from diorama_core.project.storage import Project
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.scene.support import check_scene
from tests.app.people import join
from tests.app.small_room import SIZES, PlainLibrary, make_project

MAX_OBJECTS = 60


class Soak:
    """An open project, a client, and a generator of edits."""

    def __init__(self, folder: Path, seed: int) -> None:
        self.server = create_server(host="127.0.0.1", port=0, label="soak", visitors=Visitors("127.0.0.1"))
        self.session = EditorSession(self.server, PlainLibrary(), folder / "projects", Client)
        self.session.open_project(make_project(folder / "projects" / "demo"))
        self.client = join(self.session)
        self.rng = np.random.default_rng(seed)
        self.refused = 0
        self.done = 0

    def run(self, count: int) -> None:
        """Do so many edits, on the desk as the editor does."""
        failed: list[BaseException] = []

        def all_of_them() -> None:
            try:
                self._run(count)
            except BaseException as error:
                failed.append(error)

        self.session.ui_thread.post(all_of_them)
        self.session.ui_thread.wait(3600.0)
        if failed:
            raise failed[0]

    def _run(self, count: int) -> None:
        acts: list[Callable[[], None]] = [
            self._move,
            self._move,
            self._turn,
            self._resize,
            self._swap,
            self._insert,
            self._delete,
            self._paste,
            self._attach,
            self._lock,
            self._hide,
            self._rename,
            self._paint,
            self._align,
            self._undo,
            self._redo,
        ]
        for _ in range(count):
            self._choose()
            try:
                acts[self.rng.integers(len(acts))]()
            except DioramaError:
                self.refused += 1
            self.done += 1
            if self.done % 50 == 0:
                self.check()

    def check(self) -> None:
        check_scene(self.session.scene)
        assert scene_from_json(scene_to_json(self.session.scene)) == self.session.scene

    def saved(self) -> bool:
        self.session.autosave.flush()
        assert isinstance(self.session.project, Project)
        return self.session.project.load_scene() == self.session.scene

    def memory_mb(self) -> float:
        import gc

        self.session.checker.wait()
        gc.collect()
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return pages * 4096 / 1e6

    def retained_messages(self) -> int:
        """How many messages the server keeps for late joiners: a measure of leaks."""
        return len(self.server._websock_server._broadcast_buffer.message_from_id)

    def close(self) -> None:
        self.session.close()
        stop_server(self.server)

    # -- edits ------------------------------------------------------------------------------------------------

    def _choose(self) -> None:
        ids = [o.id for o in self.session.scene.objects]
        count = min(len(ids), int(self.rng.integers(1, 4)))
        self.client.select(self.rng.choice(ids, count, replace=False).tolist() if ids else ())

    def _move(self) -> None:
        item = self.session.scene.object(self.client.need_selected())
        base = editing.base_position(item) + np.append(self.rng.normal(0, 0.4, 2), 0.0)
        editing.set_base_position(self.client, item.id, base)

    def _turn(self) -> None:
        editing.turn_selected(self.client, float(self.rng.uniform(-90, 90)))

    def _resize(self) -> None:
        item = self.session.scene.object(self.client.need_selected())
        size = np.asarray(item.shape_size_m) * self.rng.uniform(0.7, 1.4, 3)
        editing.set_size(self.client, item.id, size)

    def _swap(self) -> None:
        self.client.preferences = type(self.client.preferences)(
            size_mode=swapping.SIZE_MODES[self.rng.integers(4)], keep_colour=bool(self.rng.integers(2))
        )
        swapping.swap(self.client, self.client.need_selected(), str(self.rng.choice(list(SIZES))))

    def _insert(self) -> None:
        if len(self.session.scene.objects) < MAX_OBJECTS:
            insert_shape(self.client, str(self.rng.choice(list(SIZES))))

    def _delete(self) -> None:
        if len(self.session.scene.objects) > 6:
            editing.delete_selected(self.client)

    def _paste(self) -> None:
        if len(self.session.scene.objects) < MAX_OBJECTS:
            scene, heads = paste_clip(self.session.scene, clip_of(self.session.scene, self.client.selection))
            self.session.commit("paste", scene, by=self.client, selection=heads)

    def _attach(self) -> None:
        scene = self.session.scene
        parents = [p.id for p in scene.architecture.planes] + [o.id for o in scene.objects]
        editing.attach(self.client, self.client.need_selected(), str(self.rng.choice(parents)))

    def _lock(self) -> None:
        editing.set_locked(self.client, self.client.selection, bool(self.rng.integers(5) == 0))

    def _hide(self) -> None:
        editing.set_hidden(self.client, self.client.selection, bool(self.rng.integers(4) == 0))

    def _rename(self) -> None:
        editing.rename(self.client, self.client.need_selected(), f"thing {self.rng.integers(1000)} <i>")

    def _paint(self) -> None:
        colour = None if self.rng.integers(3) == 0 else tuple(float(c) for c in self.rng.uniform(0, 1, 3).round(1))
        editing.set_colour(self.client, self.client.selection, colour)

    def _align(self) -> None:
        chosen = self.client.need_selection()
        axis = np.eye(3)[self.rng.integers(2)]
        self.session.edit("align", lambda s: arranging.align(s, chosen, axis, "middle"), by=self.client)

    def _undo(self) -> None:
        self.session.undo(self.client)

    def _redo(self) -> None:
        self.session.redo(self.client)
