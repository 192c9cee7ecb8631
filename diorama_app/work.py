"""The long jobs: build a scene from a photo, optimise the layout, export. Each runs beside the desk."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import viser.transforms as vtf

from diorama_app.drafts import Draft
from diorama_app.room import Room
from diorama_core.artefacts import LayoutReport
from diorama_core.errors import EditRefused, InputError
from diorama_core.progress import Progress
from diorama_core.project.storage import Project
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene

PREVIEW_EVERY_S = 0.05
"""Twenty pictures a second are what reaches a browser."""

GLIDE_S = 0.9
"""How long a layout that was found at once takes to settle before people's eyes."""

GLIDE_BELOW = 10
"""A run with fewer pictures than this is too abrupt to be followed."""

Costs = Sequence[tuple[str, float]]
Samples = list[tuple[float, tuple[tuple[str, float], ...]]]
"""Seconds since the start, and every cost then; only ever appended to."""


def build(room: Room, client_id: int | None) -> None:
    """Build the draft's scene: in the open project when it came from there, else in a new one."""
    draft = room.draft
    if not draft.ready:
        raise InputError(
            "there is no photo yet; upload one first"
            if draft.photo is None
            else "nothing is marked in the photo yet; draw a box around each piece of furniture first"
        )
    inputs = draft.to_build()

    def work(progress: Progress) -> None:
        from diorama_core.project.build import build_project

        own = draft.from_project and room.project is not None
        project = (
            room.project
            if own
            else Project.create(fresh_folder(room.projects_dir, draft.name), name=Path(draft.name).stem)
        )
        assert project is not None
        room.saver.flush()
        built = build_project(project, inputs, room.library, warnings=draft.warnings, progress=progress)
        room.post(client_id, lambda: _built(room, draft, project, built.scene, own=own))

    room.jobs.start("build", "Building the scene", work)


def _built(room: Room, draft: Draft, project: Project, scene: Scene, *, own: bool) -> None:
    newer = room.draft if room.draft is not draft else None
    if newer is None:
        for view in room.views.values():
            view.close_board()
    if own and project == room.project:
        inputs = project.load_inputs()
        room.textures = project.textures(scene)
        room.read_notes()
        room.draft = Draft(inputs, inputs.boxes if inputs else (), from_project=True, name=project.name)
        room.commit("build the scene", scene, selection=())
        room.show_everyone_the_room()
    else:
        room.open_project(project)
    if newer is not None:
        room.draft = newer  # what somebody handed in meanwhile is not lost
        room.refresh_panels()
    room.notice_all(f"The scene has {len(scene.objects)} objects. Click one to change it.", "good")


def fresh_folder(projects_dir: Path, name: str) -> Path:
    """A folder for a new project, named after the photo; one without a scene yet is taken up again."""
    stem = re.sub(r"[^A-Za-z0-9._-]+", "-", Path(name).stem).strip("-.")[:60] or "room"
    for number in range(1, 10_000):
        folder = projects_dir / (stem if number == 1 else f"{stem}-{number}")
        begun = (folder / "project.json").exists() and not (folder / "scene.json").exists()
        if begun or not folder.exists():
            return folder  # one that was begun is resumed
    raise InputError(f"{projects_dir} holds too many projects called {stem}; rename the photo")


@dataclass
class LayoutRun:
    """The curves and the report of the last optimisation, as the panel shows them."""

    recipe: str
    started_at: float
    times_s: list[float]
    costs: dict[str, list[float]]
    report: LayoutReport | None = None

    def read(self, samples: Samples) -> None:
        """Take up what the optimiser has written since. A cost that begins later or ends earlier keeps its level."""
        for at_s, costs in samples[len(self.times_s) :]:
            self.times_s.append(at_s)
            for name, value in costs:
                self.costs.setdefault(name, [float(value)] * (len(self.times_s) - 1)).append(float(value))
            for values in self.costs.values():
                values.extend([values[-1]] * (len(self.times_s) - len(values)))


def optimise(room: Room, recipe_name: str, on_progress: Callable[[LayoutRun], None]) -> LayoutRun:
    """Optimise the layout with live preview; commits once, as one undo step. `on_progress` is called on the desk."""
    start = room.scene
    if not start.objects:
        raise EditRefused("there is nothing to arrange; insert furniture first")
    run = LayoutRun(recipe_name, time.monotonic(), [], {})

    def work(progress: Progress) -> None:
        from diorama_core.layout.recipes import recipe

        shown, pictures = 0.0, 0
        samples: Samples = []

        def preview(scene: Scene, costs: Costs) -> None:
            nonlocal shown, pictures
            now = time.monotonic()
            samples.append((now - run.started_at, tuple(costs)))
            if now - shown >= PREVIEW_EVERY_S:
                shown, pictures = now, pictures + 1
                room.desk.post(lambda: _show_step(room, start, scene, run, samples, on_progress), key="preview")

        try:
            final, report = recipe(recipe_name, room.library).optimise(start, progress, preview)
        except BaseException:
            room.desk.post(room.refresh)  # cancelled or failed: everything goes back to the document
            raise
        room.desk.post(lambda: run.read(samples))
        if pictures < GLIDE_BELOW:
            _glide(room, start, final, progress)
        room.desk.post(lambda: _arranged(room, start, final, report, run, on_progress))

    room.jobs.start("optimise", "Arranging the layout", work)
    return run


def _glide(room: Room, start: Scene, final: Scene, progress: Progress) -> None:
    """A recipe that finds its answer at once is still watched on its way there."""
    frames = int(GLIDE_S / PREVIEW_EVERY_S)
    for frame in range(1, frames + 1):
        share = 0.5 - 0.5 * np.cos(np.pi * frame / frames)
        between = {o.id: _between(start.object(o.id).pose, o.pose, float(share)) for o in final.objects}
        room.desk.post(partial(room.preview, between), key="preview")
        time.sleep(PREVIEW_EVERY_S)
        progress.report(1.0, "Settling")


def _between(a: Pose, b: Pose, share: float) -> Pose:
    turn = vtf.SO3.from_matrix(b.R_world_object @ a.R_world_object.T)
    R = vtf.SO3.exp(share * turn.log()).as_matrix() @ a.R_world_object
    u, _, vt = np.linalg.svd(R)
    return Pose(u @ vt, a.position + share * (b.position - a.position), a.scale + share * (b.scale - a.scale))


def _show_step(
    room: Room, start: Scene, scene: Scene, run: LayoutRun, samples: Samples, tell: Callable[[LayoutRun], None]
) -> None:
    room.preview(untouched(room.scene, start, scene))
    run.read(samples)
    tell(run)


def _arranged(
    room: Room, start: Scene, final: Scene, report: LayoutReport, run: LayoutRun, tell: Callable[[LayoutRun], None]
) -> None:
    run.report = report
    current = room.scene
    if current is start:
        room.commit("arrange the layout", edits.set_metrics(final, report.after))
    else:
        poses = untouched(current, start, final)
        room.commit("arrange the layout", edits.set_metrics(edits.place(current, poses), report.after))
    tell(run)
    room.notice_all(f"The layout is arranged ({report.seconds:.1f} s). Undo takes it back.", "good")


def untouched(current: Scene, start: Scene, final: Scene) -> Mapping[str, Pose]:
    """The final poses of objects that nobody has edited since the start; locked ones stay where they are."""
    return {
        o.id: o.pose
        for o in final.objects
        if current.has_object(o.id)
        and start.has_object(o.id)
        and current.object(o.id) == start.object(o.id)
        and not current.object(o.id).locked
    }


def export_glb(room: Room, client_id: int) -> None:
    """Write the scene as GLB into the project and hand it to the browser that asked."""
    scene, project, textures = room.scene, room.project, dict(room.textures)
    if not scene.objects and not scene.architecture.planes:
        raise EditRefused("there is nothing to export yet; build or open a scene first")
    visible = replace_hidden(scene)
    name = f"{project.folder.name if project is not None else 'scene'}.glb"

    def work(progress: Progress) -> None:
        from diorama_core.export.gltf import glb_bytes

        progress.report(0.2, "Gathering meshes and materials")
        data = glb_bytes(visible, room.library, textures=textures)
        progress.check()

        def hand_over() -> None:
            view = room.views.get(client_id)
            if view is not None:
                view.download(name, data)
                view.notice(f"{name} ({len(data) / 1e6:.1f} MB) is in your downloads.", "good")

        room.post(client_id, hand_over)

    room.jobs.start("export", "Exporting GLB", work)


def replace_hidden(scene: Scene) -> Scene:
    """The scene without hidden objects; what they hold up stays where it is."""
    gone = {o.id for o in scene.objects if o.hidden}
    return replace(
        scene,
        objects=tuple(o for o in scene.objects if o.id not in gone),
        supports=tuple(s for s in scene.supports if s.child not in gone and s.parent not in gone),
    )
