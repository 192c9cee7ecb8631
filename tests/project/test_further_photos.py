from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.pipeline import codec
from diorama_core.project.further_photos import (
    MAX_PHOTOS,
    MAX_POSES,
    load_photos,
    note_placed,
    save_photos,
    still_made,
    still_placed,
)
from diorama_core.project.storage import Project
from diorama_core.scene.edits import move, recolour, rename
from diorama_core.scene.room_edits import move_plane
from diorama_core.scene.types import PhotoMaterial, Scene
from tests.app.small_room import make_project, photo_camera, plain_photo


@pytest.fixture
def project(tmp_path: Path) -> Project:
    return make_project(tmp_path / "demo")


def save_two(project: Project) -> tuple[FurtherPhoto, ...]:
    photos = tuple(FurtherPhoto(n, Inputs(plain_photo())) for n in ("one", "two"))
    save_photos(project, photos)
    return photos


def shifted(scene: Scene, by_m: float) -> Scene:
    """The scene with a chair moved along x."""
    return move(scene, "chair_1", scene.object("chair_1").pose.move((by_m, 0.0, 0.0)))


def test_photos_come_back_as_they_were_saved(project: Project) -> None:
    assert load_photos(project) == ((), ())
    one = FurtherPhoto("one", Inputs(plain_photo()), photo_camera(), (("table_1", (1.0, 2.0, 3.0, 4.0)),))
    two = FurtherPhoto("two", Inputs(plain_photo(320, 240)))
    save_photos(project, (one, two))
    found, damage = load_photos(project)
    assert damage == ()
    assert [p.name for p in found] == ["one", "two"]
    assert found[0].camera == one.camera
    assert found[0].seen == one.seen
    assert np.array_equal(found[1].inputs.photo.rgb, two.inputs.photo.rgb)
    assert (project.folder / "photos" / "one.jpg").exists()


def test_a_photo_that_is_saved_is_not_written_again_and_one_taken_out_is_gone(project: Project) -> None:
    one, two = save_two(project)
    path = project.folder / "photos" / "one.zip"
    before = path.stat().st_mtime_ns
    save_photos(project, (one,), (one, two))
    assert path.stat().st_mtime_ns == before
    assert [p.name for p in load_photos(project)[0]] == ["one"]
    three = FurtherPhoto("three", Inputs(plain_photo()))
    save_photos(project, (one, three), (one,))
    assert path.stat().st_mtime_ns == before
    assert [p.name for p in load_photos(project)[0]] == ["one", "three"], "only those that are saved are left alone"


def test_a_damaged_photo_is_named_and_the_others_are_read(project: Project) -> None:
    save_two(project)
    (project.folder / "photos" / "one.zip").write_bytes(b"nothing")
    found, damage = load_photos(project)
    assert [p.name for p in found] == ["two"]
    assert len(damage) == 1
    assert "one.zip" in damage[0]
    project.update_info(photos=["../../scene", 5])
    assert load_photos(project)[0] == ()


def test_a_photo_that_says_another_name_is_not_read(tmp_path: Path) -> None:
    """Its name becomes that of files: a received project could write outside its folder."""
    project = make_project(tmp_path / "demo")
    save_photos(project, (FurtherPhoto("one", Inputs(plain_photo())),))
    other = codec.dump(FurtherPhoto(str(tmp_path / "elsewhere"), Inputs(plain_photo())))
    (project.folder / "photos" / "one.zip").write_bytes(other)
    found, damage = load_photos(project)
    assert found == ()
    assert "one.zip" in damage[0]
    assert "elsewhere" in damage[0]


@pytest.mark.parametrize("noted", ["[", "[1]", '{"table_1": 5, "wall_1": [7]}', '{"table_1": [[[1], "x", 1]]}'])
def test_where_notes_are_damaged_nothing_was_put_by_the_program_until_it_notes_again(
    project: Project, noted: str
) -> None:
    scene = project.load_scene()
    for name in ("placed.json", "looks.json"):
        (project.stages_folder / name).write_text(noted)
    assert still_placed(project, scene) == still_made(project, scene) == frozenset()
    note_placed(project, scene)
    ids = {o.id for o in scene.objects}
    assert still_made(project, scene) == ids
    assert still_placed(project, scene) == ids | {p.id for p in scene.architecture.planes}


def test_what_a_person_moved_or_locked_is_not_where_it_was_put(project: Project) -> None:
    scene = project.load_scene()
    assert still_placed(project, scene) == frozenset()  # an older project: nothing was noted
    note_placed(project, scene)
    ids = {o.id for o in scene.objects} | {p.id for p in scene.architecture.planes}
    assert still_placed(project, scene) == ids
    moved = shifted(scene, 0.2)
    assert still_placed(project, moved) == ids - {"chair_1"}
    locked = replace(scene, objects=tuple(replace(o, locked=o.id == "table_1") for o in scene.objects))
    assert still_placed(project, locked) == ids - {"table_1"}
    note_placed(project, moved)
    assert still_placed(project, scene) == ids  # after an undo
    wall = scene.architecture.by_role("wall")[0].id
    assert wall not in still_placed(project, move_plane(scene, wall, 0.3))


def test_what_a_person_swapped_painted_or_named_is_not_as_it_was_made(project: Project) -> None:
    scene = project.load_scene()
    assert still_made(project, scene) == frozenset()
    note_placed(project, scene)
    ids = frozenset(o.id for o in scene.objects)
    assert still_made(project, scene) == ids
    assert still_made(project, recolour(scene, "chair_1", (0.9, 0.1, 0.1))) == ids - {"chair_1"}
    assert still_made(project, rename(scene, "chair_1", "throne")) == ids - {"chair_1"}
    moved = shifted(scene, 0.2)
    assert still_made(project, moved) == ids
    locked = replace(scene, objects=tuple(replace(o, locked=o.id == "table_1") for o in scene.objects))
    assert still_made(project, locked) == ids - {"table_1"}
    swapped = tuple(replace(o, shape_id="another") if o.id == "chair_1" else o for o in scene.objects)
    assert still_made(project, replace(scene, objects=swapped)) == ids - {"chair_1"}


@pytest.mark.parametrize(("by_m", "is_placed"), [(5e-5, True), (-5e-5, True), (2e-4, False), (-2e-4, False)])
def test_what_moved_less_than_a_tenth_of_a_millimetre_is_where_it_was_put(
    project: Project, by_m: float, is_placed: bool
) -> None:
    scene = project.load_scene()
    note_placed(project, scene)
    assert ("chair_1" in still_placed(project, shifted(scene, by_m))) == is_placed


def test_the_newest_poses_are_remembered_each_once(project: Project) -> None:
    steps = [shifted(project.load_scene(), 0.1 * i) for i in range(MAX_POSES + 1)]
    for scene in (*steps[:-1], steps[0], steps[-1]):
        note_placed(project, scene)
    known = ["chair_1" in still_placed(project, scene) for scene in steps]
    assert known == [True, False] + [True] * (MAX_POSES - 1)
    assert "chair_1" in still_made(project, steps[1]), "it looks the same everywhere"


def test_the_picture_for_people_is_written_once(project: Project) -> None:
    save_photos(project, (FurtherPhoto("one", Inputs(plain_photo())),))
    picture = project.folder / "photos" / "one.jpg"
    picture.write_bytes(b"cropped by a person")
    save_photos(project, (FurtherPhoto("one", Inputs(plain_photo())),))
    assert picture.read_bytes() == b"cropped by a person"


def test_no_more_photos_are_read_than_a_project_may_have(project: Project) -> None:
    project.update_info(photos=[f"photo {number}" for number in range(MAX_PHOTOS + 1)])
    assert len(load_photos(project)[1]) == MAX_PHOTOS
    project.update_info(photos="one")
    assert load_photos(project) == ((), ())


def test_what_the_photo_shows_of_an_object_is_part_of_its_look(project: Project) -> None:
    scene = project.load_scene()

    def painted(*materials: PhotoMaterial) -> Scene:
        first, *others = scene.objects
        return replace(scene, objects=(replace(first, photo_materials=materials), *others))

    made = painted(PhotoMaterial("wood", (0.5, 0.4, 0.3), "wood"), PhotoMaterial("fabric", (0.1, 0.2, 0.3)))
    note_placed(project, made)
    item = made.objects[0].id
    assert item in still_made(project, made)
    assert item not in still_made(project, scene)
    for slot, colour, texture in (
        ("metal", (0.1, 0.2, 0.3), None),
        ("fabric", (0.9, 0.2, 0.3), None),
        ("fabric", (0.1, 0.2, 0.3), "cloth"),
    ):
        other = painted(made.objects[0].photo_materials[0], PhotoMaterial(slot, colour, texture))
        assert item not in still_made(project, other)
