"""Projects in their folder, outlines by clicks, a shelf that grows, the room's own lengths."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh

from diorama_app.commands.arrangements import Arrangements
from diorama_app.commands.import_model import import_model
from diorama_app.commands.measure import point_under
from diorama_app.projects import manage as project_care
from diorama_app.session.client import Client
from diorama_app.session.layout_run import LayoutRun
from diorama_core.editing.outline import MaskDraft
from diorama_core.errors import EditRefused, ProjectError
from diorama_core.library.user_library import OWN, UserLibrary
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.small_room import PlainLibrary, furnished_scene, make_project


def test_projects_are_renamed_copied_binned_and_brought_back(tmp_path: Path) -> None:
    project = make_project(tmp_path / "demo")
    project_care.rename_project(project, "  My   room ")
    assert project_care.name_of(project.folder) == "My room"
    with pytest.raises(ProjectError, match="needs a name"):
        project_care.rename_project(project, " ")
    copy = project_care.duplicate_project(project.folder, tmp_path)
    assert copy.load_scene() == project.load_scene()
    assert copy.name == "My room 2"
    assert set(project_care.recent_projects(tmp_path)) == {project.folder, copy.folder}
    place = project_care.to_bin(copy.folder, tmp_path)
    assert copy.folder not in project_care.recent_projects(tmp_path)
    assert project_care.projects_in_bin(tmp_path) == (place,)
    assert project_care.out_of_bin(place, tmp_path) == copy.folder
    assert project_care.projects_in_bin(tmp_path) == ()
    place = project_care.to_bin(copy.folder, tmp_path)
    make_project(copy.folder)
    with pytest.raises(ProjectError, match="exists again"):
        project_care.out_of_bin(place, tmp_path)


def test_earlier_versions_come_back_by_name_only(tmp_path: Path) -> None:
    project = make_project(tmp_path / "demo")
    first = project.load_scene()
    project.save_scene(edits.rename(first, "chair_1", "throne"))
    ((name, _),) = project_care.earlier_versions(project)
    assert project_care.earlier_scene(project, name) == first
    with pytest.raises(ProjectError, match="no longer exists"):
        project_care.earlier_scene(project, "../scene.json")


def test_clicks_add_to_an_outline_and_take_away_from_it() -> None:
    rgb = np.full((120, 160, 3), 210, dtype=np.uint8)
    rgb[40:90, 30:70] = (40, 80, 160)
    rgb[40:90, 90:130] = (160, 60, 40)
    blue = np.zeros((120, 160), dtype=bool)
    blue[40:90, 30:70] = True
    outline = MaskDraft(rgb, (28.0, 38.0, 132.0, 92.0), blue)
    both = outline.click(110.0, 65.0, part=True)
    assert both.mask[65, 110]
    assert both.mask[65, 50]
    assert both.mask[45:85, 95:125].mean() > 0.9
    less = both.click(110.0, 65.0, part=False)
    assert not less.mask[65, 110]
    x1, y1, x2, y2 = outline.bounds
    assert (x1, y1, x2, y2) == (30.0, 40.0, 70.0, 90.0)


def test_a_shelf_grows_with_ones_own_models(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path))
    user_library = UserLibrary(PlainLibrary())
    known = user_library.shapes()
    assert user_library.shape("chair_a") in known
    user_library.own()
    assert {s.id for s in user_library.shapes()} == {s.id for s in known}
    assert (tmp_path / OWN).is_dir()
    assert isinstance(user_library.parts("table_a"), trimesh.Scene)


def test_a_library_that_cannot_grow_says_so() -> None:
    client = Client.__new__(Client)
    client.session = SimpleNamespace(library=PlainLibrary())
    with pytest.raises(EditRefused, match="models cannot be added"):
        import_model(client, "x.glb", b"")


def test_arrangements_leave_what_is_locked() -> None:
    scene = edits.set_locked(furnished_scene(), "chair_1", True)
    assert Arrangements(scene).count == 3
    other = Arrangements(scene).take(1)
    assert other.object("chair_1") == scene.object("chair_1")
    assert other.object("chair_2").shape_id != scene.object("chair_2").shape_id
    assert Arrangements(other).take(0).object("chair_2").shape_id == scene.object("chair_2").shape_id
    assert Arrangements(Scene()).count == 0


def test_in_another_arrangement_sets_stay_sets() -> None:
    scene = furnished_scene()
    one, other = scene.object("chair_1"), scene.object("chair_2")
    reordered = (one.candidates[0], *one.candidates[:0:-1])  # the same best shape, the others the other way round
    scene = replace(
        scene, objects=tuple(replace(o, candidates=reordered) if o.id == other.id else o for o in scene.objects)
    )
    for rank in range(Arrangements(scene).count):
        taken = Arrangements(scene).take(rank)
        assert taken.object("chair_1").shape_id == taken.object("chair_2").shape_id
        assert Arrangements(taken).is_taken(rank)
    mixed = Arrangements(scene).take(1, only={"chair_1"})
    assert mixed.object("chair_2") == scene.object("chair_2")
    assert mixed.object("chair_1").shape_id != one.shape_id


def test_costs_that_begin_late_or_end_early_keep_their_level() -> None:
    run = LayoutRun("paper", 0.0, Scene())
    run.read([(0.1, (("a", 3.0),)), (0.2, (("a", 2.0), ("b", 5.0))), (0.3, (("b", 4.0),))])
    assert run.costs == {"a": [3.0, 2.0, 2.0], "b": [5.0, 5.0, 4.0]}
    assert not run.is_paused


def test_a_ray_meets_the_nearest_object_and_passes_walls_from_behind() -> None:
    scene = furnished_scene()
    table = scene.object("table_1").pose.position
    above = point_under(scene, np.array([-0.4, 2.2, 2.4]), np.array([0.0, 0.0, -1.0]))
    assert above is not None
    assert above[2] == pytest.approx(0.74)
    outside = point_under(scene, np.array([1.9, -5.0, 0.1]), np.array([0.0, 1.0, 0.0]))
    assert outside is not None
    assert outside[1] == pytest.approx(3.4), "the near wall is seen from behind"
    assert point_under(scene, table + np.array([0, 0, 9.0]), np.array([0.0, 0.0, 1.0])) is None
