from __future__ import annotations

import dataclasses
import threading
from pathlib import Path

import numpy as np
import pytest
import trimesh

from diorama_core.errors import LibraryError
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.ingest.sink import Ingested
from diorama_core.library.record import Assumption, Guess, Shape, SupportSurface
from diorama_core.library.store import (
    CombinedLibrary,
    StoredLibrary,
    create_library,
    library_folder,
    list_libraries,
    open_library,
)
from diorama_core.library.store.records import Records


def ingested(name: str, category: str = "box", height: float = 0.5, **changes: object) -> Ingested:
    """A red box of that height, as ingestion would hand it over."""
    box = trimesh.creation.box((0.4, 0.6, height))
    box.visual.face_colors = [200, 30, 30, 255]
    top = SupportSurface(np.array([[0.2, 0.3, 0.25], [-0.2, 0.3, 0.25], [-0.2, -0.3, 0.25]]), np.inf, False)
    sure = Assumption("+z", 0.9, "the file says so")
    record = Shape(
        id=name,
        category=category,
        caption=f"a red {category}",
        size_m=(0.4, 0.6, height),
        source="tests",
        licence="CC0",
        symmetry=2,
        surfaces=(top,),
        mass_kg=3.5,
        content_hash=f"hash-of-{name}-{height}",
        synonyms=("crate", "Kiste"),
        contact_faces=("bottom", "back"),
        triangles=12,
        guess=Guess(sure, sure, sure, sure),
    )
    record = dataclasses.replace(record, **changes)
    glb = trimesh.Scene(box).export(file_type="glb")
    return Ingested(record, glb, b"png", f"key of {name} {height}", ("no normals; computed",))


@pytest.fixture
def library(tmp_path: Path) -> StoredLibrary:
    return StoredLibrary(tmp_path / "mine", create=True)


def test_what_was_added_comes_back_after_reopening(library: StoredLibrary) -> None:
    items = [ingested("b", "box"), ingested("a", "cabinet", 0.9), ingested("c", "box", 0.2)]
    for item in items:
        library.add(item)
    again = StoredLibrary(library.folder)
    assert [s.id for s in again.shapes()] == ["a", "b", "c"]
    assert [s.id for s in again.in_category("box")] == ["b", "c"]
    assert again.in_category("piano") == ()
    for item in items:
        assert again.shape(item.record.id) == item.record
        assert again.glb(item.record.id) == item.glb
        assert again.thumbnail(item.record.id) == b"png"
        assert again.warnings(item.record.id) == ("no normals; computed",)
    assert again.source_keys() == {i.source_key for i in items}


def test_listed_records_lack_only_surfaces_and_guess(library: StoredLibrary) -> None:
    item = ingested("a")
    library.add(item)
    assert library.shapes() == (dataclasses.replace(item.record, surfaces=(), guess=None),)
    library.add(ingested("plain", synonyms=(), contact_faces=()))
    assert library.shapes()[1].synonyms == ()
    assert library.shapes()[1].contact_faces == ()


def test_geometry_and_materials(library: StoredLibrary) -> None:
    library.add(ingested("a"))
    mesh = library.mesh("a")
    assert mesh.extents == pytest.approx([0.4, 0.6, 0.5])
    assert mesh.volume == pytest.approx(0.12)
    assert library.mesh("a") is mesh
    (part,) = library.parts("a").geometry.values()
    assert part.visual.kind is not None


@pytest.mark.parametrize("own", [True, False])
def test_pictures_of_materials_are_decoded_before_threads_share_them(library: StoredLibrary, own: bool) -> None:
    """PIL decodes a picture when it is first used, and two threads that do so at once break it."""
    built_in = built_in_library()
    shape_id = built_in.in_category("armchair")[0].id
    if own:
        item = ingested("woven")
        library.add(dataclasses.replace(item, glb=built_in.glb(shape_id)))
    parts = library.parts("woven") if own else built_in.parts(shape_id)
    pictures = [m.visual.material.baseColorTexture for m in parts.geometry.values()]
    assert any(picture is not None for picture in pictures)
    assert all(getattr(picture, "fp", None) is None for picture in pictures)


def test_the_same_id_is_replaced_and_the_old_model_goes(library: StoredLibrary) -> None:
    library.add(ingested("a", height=0.5))
    library.add(ingested("twin", height=0.5))
    library.add(ingested("a", height=0.8, category="cabinet"))
    assert library.shape("a").size_m[2] == 0.8
    assert library.mesh("a").extents[2] == pytest.approx(0.8)
    assert [s.id for s in library.in_category("box")] == ["twin"]
    assert library.mesh("twin").extents[2] == pytest.approx(0.5), "the twin used the same model"
    library.remove(["twin", "never heard of"])
    assert len(library) == 1
    (model,) = library.folder.rglob("*.glb")
    assert model.stat().st_mode & 0o444 == 0o444, "others may read a shared library"


def test_readers_see_what_another_adds(library: StoredLibrary) -> None:
    reader = StoredLibrary(library.folder)
    assert reader.shapes() == ()
    library.add(ingested("a"))
    first = reader.shapes()
    assert len(first) == 1
    assert reader.shapes() is first, "unchanged, so not read again"


def test_threads_share_a_library(library: StoredLibrary) -> None:
    failures: list[Exception] = []

    def use(number: int) -> None:
        try:
            library.add(ingested(f"shape{number}", height=0.1 + number / 100))
            assert library.mesh(f"shape{number}").extents[2] == pytest.approx(0.1 + number / 100)
            library.shapes()
        except Exception as error:  # handed to the test's own thread
            failures.append(error)

    threads = [threading.Thread(target=use, args=(n,)) for n in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures
    assert len(library) == 8


@pytest.mark.unchecked
def test_a_failed_batch_leaves_nothing(library: StoredLibrary) -> None:
    broken = dataclasses.replace(ingested("b"), source_key=None)
    with pytest.raises(LibraryError, match="NOT NULL"):
        library.add_all([ingested("a"), broken])
    assert len(library) == 0
    library.add(ingested("a"))
    assert len(library) == 1


def test_clear_errors(library: StoredLibrary, tmp_path: Path) -> None:
    with pytest.raises(LibraryError, match="no shape is called 'x' in the library 'mine'"):
        library.shape("x")
    library.add(ingested("a"))
    (model,) = library.folder.rglob("*.glb")
    model.write_bytes(b"glTF but not really")
    with pytest.raises(LibraryError, match="'a' is damaged"):
        library.mesh("a")
    model.unlink()
    with pytest.raises(LibraryError, match=r"cannot be read .*add shape 'a' again"):
        library.glb("a")
    with pytest.raises(LibraryError, match="no shape library"):
        StoredLibrary(tmp_path / "nowhere")
    damaged = tmp_path / "damaged"
    damaged.mkdir()
    (damaged / "library.sqlite").write_bytes(b"not a database at all" * 100)
    with pytest.raises(LibraryError, match="cannot be used"):
        StoredLibrary(damaged)


def test_a_newer_librarys_file_is_not_touched(library: StoredLibrary) -> None:
    records = Records(library.folder / "library.sqlite")
    records._db.execute("PRAGMA user_version = 99")
    with pytest.raises(LibraryError, match="newer Diorama"):
        StoredLibrary(library.folder)


def test_names_and_paths(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path))
    create_library("mine").add(ingested("a"))
    assert list_libraries() == ("mine",)
    assert [s.id for s in open_library("mine").shapes()] == ["a"]
    assert [s.id for s in open_library(f"{tmp_path}/mine").shapes()] == ["a"]
    with pytest.raises(LibraryError, match="no library 'theirs'; available: built-in, mine"):
        open_library("theirs")
    for name in ("", "..", "a b", "built-in", "x" * 80):
        with pytest.raises(LibraryError, match="cannot be called"):
            library_folder(name)


def test_joined_libraries(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path))
    create_library("mine").add_all([ingested("a"), ingested("b"), ingested("chair-slat-oak", "chair")])
    create_library("yours").add_all([ingested("b", height=0.7), ingested("c")])
    stored = open_library("mine+yours")
    assert [s.id for s in stored.shapes()] == ["a", "b", "chair-slat-oak", "c"]
    assert stored.shape("b").size_m[2] == 0.5, "the first one named wins"
    assert open_library("yours+mine").shape("b").size_m[2] == 0.7
    assert [s.id for s in stored.in_category("box")] == ["a", "b", "c"]
    both = open_library("built-in+mine")
    assert isinstance(both, CombinedLibrary)
    assert both.shape("chair-slat-oak").source == "built in"
    assert both.glb("a") == ingested("a").glb
    assert both.thumbnail("a") == b"png"
    assert both.thumbnail("chair-slat-oak") is None
    assert len(both.shapes()) == len(built_in_library().shapes()) + 2
    create_library("mine").add(ingested("later"))
    assert both.shape("later")
    with pytest.raises(LibraryError, match="no shape is called 'nothing'"):
        both.mesh("nothing")
