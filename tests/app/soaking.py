"""Random edits by a person who never tires."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from diorama_app import arranging, editing, swapping
from diorama_app.clipboard import copied, pasted
from diorama_app.inserting import insert_shape
from diorama_app.room import Room
from diorama_app.viser_adapter import Visitors, create_server, last_message_arrived, stop_server
from diorama_core.errors import DioramaError
from diorama_core.project.storage import Project
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.scene.support import check_scene
from tests.app.people import join
from tests.app.small_room import SIZES, PlainLibrary, make_project

MOST_OBJECTS = 60


class Soak:
    """A room, a guest, and a generator of edits."""

    def __init__(self, folder: Path, seed: int) -> None:
        self.server = create_server(host="127.0.0.1", port=0, label="soak", visitors=Visitors("127.0.0.1"))
        self.room = Room(self.server, PlainLibrary(), folder / "projects")
        self.room.open_project(make_project(folder / "projects" / "demo"))
        self.guest = join(self.room)
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

        self.room.desk.post(all_of_them)
        self.room.desk.wait(3600.0)
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
        check_scene(self.room.scene)
        assert scene_from_json(scene_to_json(self.room.scene)) == self.room.scene

    def saved(self) -> bool:
        self.room.saver.flush()
        assert isinstance(self.room.project, Project)
        return self.room.project.load_scene() == self.room.scene

    def memory_mb(self) -> float:
        import gc

        self.room.checker.wait()
        gc.collect()
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return pages * 4096 / 1e6

    def kept_messages(self) -> int:
        return last_message_arrived(self.server)

    def close(self) -> None:
        self.room.close()
        stop_server(self.server)

    # -- edits ------------------------------------------------------------------------------------------------

    def _choose(self) -> None:
        ids = [o.id for o in self.room.scene.objects]
        count = min(len(ids), int(self.rng.integers(1, 4)))
        self.guest.select(self.rng.choice(ids, count, replace=False).tolist() if ids else ())

    def _move(self) -> None:
        item = self.room.scene.object(self.guest.need_selected())
        base = editing.base_position(item) + np.append(self.rng.normal(0, 0.4, 2), 0.0)
        editing.set_base_position(self.guest, item.id, base)

    def _turn(self) -> None:
        editing.turn_selected(self.guest, float(self.rng.uniform(-90, 90)))

    def _resize(self) -> None:
        item = self.room.scene.object(self.guest.need_selected())
        size = np.asarray(item.shape_size_m) * self.rng.uniform(0.7, 1.4, 3)
        editing.set_size(self.guest, item.id, size)

    def _swap(self) -> None:
        self.guest.settings = type(self.guest.settings)(
            size_mode=swapping.SIZE_MODES[self.rng.integers(4)], keep_colour=bool(self.rng.integers(2))
        )
        swapping.swap(self.guest, self.guest.need_selected(), str(self.rng.choice(list(SIZES))))

    def _insert(self) -> None:
        if len(self.room.scene.objects) < MOST_OBJECTS:
            insert_shape(self.guest, str(self.rng.choice(list(SIZES))))

    def _delete(self) -> None:
        if len(self.room.scene.objects) > 6:
            editing.delete_selected(self.guest)

    def _paste(self) -> None:
        if len(self.room.scene.objects) < MOST_OBJECTS:
            scene, heads = pasted(self.room.scene, copied(self.room.scene, self.guest.selection))
            self.room.commit("paste", scene, by=self.guest, selection=heads)

    def _attach(self) -> None:
        scene = self.room.scene
        parents = [p.id for p in scene.architecture.planes] + [o.id for o in scene.objects]
        editing.attach(self.guest, self.guest.need_selected(), str(self.rng.choice(parents)))

    def _lock(self) -> None:
        editing.set_locked(self.guest, self.guest.selection, bool(self.rng.integers(5) == 0))

    def _hide(self) -> None:
        editing.set_hidden(self.guest, self.guest.selection, bool(self.rng.integers(4) == 0))

    def _rename(self) -> None:
        editing.rename(self.guest, self.guest.need_selected(), f"thing {self.rng.integers(1000)} <i>")

    def _paint(self) -> None:
        colour = None if self.rng.integers(3) == 0 else tuple(float(c) for c in self.rng.uniform(0, 1, 3).round(1))
        editing.set_colour(self.guest, self.guest.selection, colour)  # type: ignore[arg-type]

    def _align(self) -> None:
        chosen = self.guest.need_selection()
        axis = np.eye(3)[self.rng.integers(2)]
        self.room.edit("align", lambda s: arranging.align(s, chosen, axis, "middle"), by=self.guest)

    def _undo(self) -> None:
        self.room.undo(self.guest)

    def _redo(self) -> None:
        self.room.redo(self.guest)
