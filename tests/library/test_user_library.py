"""What people brought along is theirs: found by id, and chosen by builds only where they asked for it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import trimesh

from diorama_core.errors import LibraryError
from diorama_core.library.ingest.shaping import pack_shape
from diorama_core.library.record import Shape
from diorama_core.library.store import StoredLibrary
from diorama_core.library.user_library import (
    OwnModels,
    ProjectShapes,
    UserLibrary,
    offer_shapes,
    read_own_models,
    write_own_models,
)
from tests.app.small_room import PlainLibrary


def test_names_folders_and_deletions_are_kept(tmp_path: Path) -> None:
    path = tmp_path / "own.json"
    assert read_own_models(path) == OwnModels()
    models = OwnModels().rename("lamp", "  Grandma's\nlamp ").file("lamp", "Heirlooms").without("vase").without("lamp")
    write_own_models(path, models)
    assert read_own_models(path) == models
    assert models.names == {"lamp": "Grandma's lamp"}
    assert models.restore("lamp").deleted == ("vase",)
    assert models.rename("lamp", " ").names == {}


def test_a_corrected_model_takes_name_and_folder_of_the_one_before() -> None:
    models = OwnModels().rename("lamp", "Lamp").file("lamp", "Old").supersede("lamp", "lamp~2")
    assert models.names["lamp~2"] == "Lamp"
    assert models.folders["lamp~2"] == "Old"
    assert models.deleted == ("lamp",)


def test_a_damaged_document_says_which_file(tmp_path: Path) -> None:
    path = tmp_path / "own.json"
    path.write_text('{"names": 3}')
    with pytest.raises(LibraryError, match=r"own\.json cannot be read .*delete it"):
        read_own_models(path)


@pytest.fixture
def shared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> UserLibrary:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path / "libraries"))
    made = UserLibrary(PlainLibrary())
    made.own().add(_chair("my-chair"))
    return made


def _chair(shape_id: str) -> object:
    return pack_shape(
        Shape(shape_id, "chair", "a chair", (1.0, 1.0, 1.0)), [trimesh.creation.box((0.5, 0.5, 0.9))], None, "", ()
    )


def _ids(library) -> set[str]:
    return {s.id for s in library.in_category("chair")}


def test_builds_choose_no_uploads_unless_asked(shared: UserLibrary) -> None:
    offered = offer_shapes(shared)
    assert "my-chair" in _ids(shared)
    assert "my-chair" not in _ids(offered)
    assert "my-chair" not in {s.id for s in offered.shapes()}
    assert offered.shape("my-chair").category == "chair", "scenes that hold it are read as before"
    shared.keep_order(replace(shared.own_models, in_builds=True))
    assert "my-chair" in _ids(offer_shapes(shared))
    shared.keep_order(shared.own_models.without("my-chair"))
    assert "my-chair" not in _ids(offer_shapes(shared))


def test_the_shapes_of_an_imported_scene_are_of_their_project_alone(shared: UserLibrary, tmp_path: Path) -> None:
    StoredLibrary(tmp_path / "a" / "shapes", create=True).add(_chair("scanned-chair"))
    of_project = ProjectShapes(shared)
    of_project.show(tmp_path / "a" / "shapes")
    assert "scanned-chair" in _ids(of_project)
    assert _ids(offer_shapes(of_project)) == {"chair_a", "chair_b", "chair_c"}
    of_project.show(tmp_path / "b" / "shapes")
    assert "scanned-chair" not in _ids(of_project)


def test_a_library_to_which_nothing_is_added_is_offered_whole() -> None:
    library = PlainLibrary()
    assert offer_shapes(library) is library
