"""Folders of models become libraries: in parallel, resumed, with every failure told at the end."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from PIL import Image

from diorama_core.errors import Cancelled, InputError
from diorama_core.io.derived import write_arrays
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.ingest import adding
from diorama_core.library.ingest import known_shapes as known_module
from diorama_core.library.ingest.adding import Added, add_models
from diorama_core.library.ingest.correct import correct
from diorama_core.library.ingest.finding import model_files, read_table, sources
from diorama_core.library.ingest.given import Given
from diorama_core.library.ingest.known_shapes import KnownShapes
from diorama_core.library.ingest.limits import Limits
from diorama_core.library.ingest.relief import SIDE
from diorama_core.library.ingest.shaping import ModelSource
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.store import StoredLibrary
from diorama_core.progress import CancelToken, Progress, ProgressEvent
from diorama_core.workers import FinishedItem, Workers, workers
from tests.library.ingest.models import chair, document, known_shapes, table, write_glb, y_up


@dataclass(frozen=True)
class Here:
    """All work in this process, so that tests need no pool."""

    count: int = 1

    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[FinishedItem[Any, Any]]:
        for item in items:
            try:
                yield FinishedItem(item, function(item))
            except Exception as error:
                yield FinishedItem(item, None, error)


@pytest.fixture(autouse=True)
def _few_known_shapes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Comparing with two shapes instead of all built-in ones."""
    known = known_shapes(("chair", chair()), ("table", table()))
    monkeypatch.setattr(adding, "load_known_shapes", lambda **_: known)
    adding._cached_shapes.cache_clear()
    monkeypatch.setattr(adding, "_limit_memory", lambda most: None)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A chair as GLB and STL, a table as OBJ in a folder, one broken file and one format that is not read."""
    root = tmp_path / "models"
    (root / "tables").mkdir(parents=True)
    (root / "chair.glb").write_bytes(trimesh.Scene(y_up(chair())).export(file_type="glb"))
    trimesh.Trimesh(chair().vertices * 1000, chair().faces).export(root / "chair.stl")
    y_up(table()).export(root / "tables" / "a1.obj")
    (root / "broken.glb").write_bytes(b"glTF")
    (root / "sofa.blend").write_bytes(b"BLENDER")
    (root / ".hidden.glb").write_bytes(b"")
    return root


def added(folder: Path, library: StoredLibrary, given: Given | None = None, **options: object) -> Added:
    paths, skipped = model_files(folder)
    found = sources(folder, paths, given or Given(), options.pop("table", {}))
    return add_models(found, library, options.pop("pool", Here()), skipped=skipped, **options)


@pytest.fixture
def library(tmp_path: Path) -> StoredLibrary:
    return StoredLibrary(tmp_path / "library", create=True)


def test_a_folder_becomes_a_library(folder: Path, library: StoredLibrary) -> None:
    report = added(folder, library)
    assert report.added == ("chair", "chair-stl", "tables-a1")
    assert [t.path.name for t in report.failed] == ["broken.glb"]
    assert "within its header" in report.failed[0].reason
    assert [t.path.name for t in report.skipped] == ["sofa.blend"]
    used: ShapeLibrary = library
    assert {s.id: s.category for s in used.shapes()} == {"chair": "chair", "chair-stl": "chair", "tables-a1": "table"}
    for shape_id in ("chair", "chair-stl"):
        shape = used.shape(shape_id)
        assert np.allclose(shape.size_m, chair().extents, atol=1e-3)
        assert any(abs(s.height_m + shape.size_m[2] / 2 - 0.48) < 0.01 for s in shape.surfaces)
        assert shape.guess is not None
        assert np.allclose(used.mesh(shape_id).bounds.mean(axis=0), 0, atol=1e-6)
        back = used.mesh(shape_id).vertices[used.mesh(shape_id).vertices[:, 2] > 0.2]
        assert back[:, 0].mean() < 0  # the front is +X
    assert used.shape("tables-a1").symmetry == 2


def test_a_second_run_reads_only_what_changed(folder: Path, library: StoredLibrary) -> None:
    added(folder, library)
    again = added(folder, library)
    assert (again.added, again.retained) == ((), 3)
    os.utime(folder / "chair.glb", (1, 1))
    assert added(folder, library).added == ("chair",)
    assert added(folder, library, Given(unit_m=0.5)).retained == 0


def test_the_same_files_give_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    made = []
    for name in ("one", "two"):
        library = StoredLibrary(tmp_path / name, create=True)
        added(folder, library)
        made.append([(s, library.glb(s.id)) for s in library.shapes()])
    assert made[0] == made[1]


def test_a_stopped_run_goes_on_where_it_stopped(folder: Path, library: StoredLibrary) -> None:
    token = CancelToken()
    progress = Progress(on_event=lambda event: token.cancel() if "2 of" in event.message else None, token=token)
    with pytest.raises(Cancelled):
        added(folder, library, progress=progress)
    before = len(library.shapes())
    assert 0 < before < 3
    report = added(folder, library)
    assert (report.retained, len(report.added)) == (before, 3 - before)


def test_flags_and_table(folder: Path, library: StoredLibrary, tmp_path: Path) -> None:
    facts = tmp_path / "facts.csv"
    facts.write_text("file,up,front,unit,category,caption\ntables/a1.obj,+y,+x,0.5,desk,my desk\nchair.glb,,,,,\n")
    report = added(folder, library, Given(licence="mine"), table=read_table(facts))
    assert "tables-a1" in report.added
    desk = library.shape("tables-a1")
    assert (desk.category, desk.caption, desk.licence) == ("desk", "my desk", "mine")
    assert desk.guess is not None
    assert (desk.guess.front.value, desk.guess.front.reason) == ("+x", "facts.csv")
    assert max(desk.size_m) == pytest.approx(0.7, abs=0.01)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name,up\na,+y\n", "must name the columns"),
        ("file,up\na.glb,north\n", "line 2.*choose one of"),
        ("file,unit\na.glb,wide\n", "line 2"),
        ("file,category\na.glb,flugelhorn\n", "line 2.*flugelhorn"),
    ],
    ids=["columns", "axis", "unit", "category"],
)
def test_a_table_that_makes_no_sense_names_the_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "facts.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_table(path)


def test_a_table_that_is_no_table_is_one_short_line(tmp_path: Path) -> None:
    path = tmp_path / "facts.csv"
    path.write_text(f"file,category\na.glb,{'x' * 5000}\n")
    with pytest.raises(InputError, match="is not known") as caught:
        read_table(path)
    assert len(str(caught.value)) < 600
    os.mkfifo(tmp_path / "pipe.csv")  # opened without care, it would wait for a writer for ever
    with pytest.raises(InputError, match="is not a file"):
        read_table(tmp_path / "pipe.csv")


def test_no_folder_is_an_input_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is no folder"):
        model_files(tmp_path / "nowhere")


@pytest.mark.unchecked
def test_a_file_that_takes_too_long_is_given_up(folder: Path, library: StoredLibrary) -> None:
    report = added(folder, library, limits=Limits(seconds=1e-3))
    assert report.added == ()
    assert any("took longer" in t.reason for t in report.failed)


def test_textures_survive_the_way_into_a_library(tmp_path: Path, library: StoredLibrary) -> None:
    folder = tmp_path / "models"
    folder.mkdir()
    Image.new("RGB", (16, 16), (200, 30, 30)).save(folder / "red.png")
    made = document(
        images=[{"uri": "red.png"}],
        textures=[{"source": 0}],
        materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    )
    made["meshes"][0]["primitives"][0]["material"] = 0
    write_glb(folder / "picture.glb", made)
    added(folder, library)
    (part,) = library.parts("picture").geometry.values()
    assert part.visual.material.baseColorTexture.getpixel((3, 3))[0] == pytest.approx(200, abs=8)


@pytest.mark.slow
def test_processes_do_the_same(
    folder: Path, library: StoredLibrary, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A real pool; it compares with the built-in shapes, of whose reliefs a cache says nothing."""
    keys = np.array([s.content_hash for s in built_in_library().shapes()])
    reliefs = np.zeros((len(keys), 3, 2, SIDE, SIDE), np.uint8)
    write_arrays(known_module._place(tmp_path / "cache"), {"keys": keys, "reliefs": reliefs})
    monkeypatch.setenv("DIORAMA_CACHE", str(tmp_path / "cache"))
    pool: Workers = workers(count=2)
    assert added(folder, library, pool=pool).added == ("chair", "chair-stl", "tables-a1")


def test_a_wrong_guess_is_put_right(folder: Path, library: StoredLibrary) -> None:
    added(folder, library, Given(up="+z", front="+x", unit_m=1.0))  # wrong for the GLB: it lies on its back
    lying = library.shape("chair")
    assert lying.size_m[2] == pytest.approx(chair().extents[1], abs=1e-3)
    library.add(correct(library, "chair", up="+y", front="+z", category="office chair", source_key="k"))
    shape = library.shape("chair")
    assert np.allclose(shape.size_m, chair().extents, atol=1e-3)
    assert shape.category == "office chair"
    assert shape.guess is not None
    assert (shape.guess.up.value, shape.guess.front.value, shape.guess.up.confidence) == ("+y", "+z", 1.0)
    back = library.mesh("chair").vertices[library.mesh("chair").vertices[:, 2] > 0.2]
    assert back[:, 0].mean() < 0
    assert "k" in library.source_keys()


def test_a_size_is_put_right_and_a_correction_that_makes_no_sense_is_refused(
    folder: Path, library: StoredLibrary
) -> None:
    added(folder, library)
    before = library.shape("chair")
    library.add(correct(library, "chair", scale=0.5))
    after = library.shape("chair")
    assert np.allclose(after.size_m, np.array(before.size_m) / 2)
    assert np.allclose(after.surfaces[0].height_m, before.surfaces[0].height_m / 2, atol=1e-3)
    with pytest.raises(InputError, match="right angles"):
        correct(library, "chair", up="+x", front="-x")
    with pytest.raises(InputError, match="positive factor"):
        correct(library, "chair", scale=0.0)


def test_a_source_is_a_plain_value(folder: Path) -> None:
    paths, _ = model_files(folder)
    made = sources(folder, paths, Given(), {})
    assert all(isinstance(s, ModelSource) for s in made)
    assert len({s.id for s in made}) == len(made)
    assert made == sources(folder, paths, Given(), {})


@pytest.mark.parametrize("steps", [0, 4], ids=["known", "first time"])
def test_progress_only_grows_and_a_first_import_spends_most_of_it_on_learning(
    steps: int, folder: Path, library: StoredLibrary, monkeypatch: pytest.MonkeyPatch
) -> None:
    known = adding.load_known_shapes()

    def learn(on_step: Callable[[float], None] = lambda _: None) -> KnownShapes:
        for number in range(steps):
            on_step((number + 1) / steps)
        return known

    monkeypatch.setattr(adding, "load_known_shapes", learn)
    events: list[ProgressEvent] = []
    added(folder, library, progress=Progress(on_event=events.append))
    shares = [event.fraction for event in events]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert [e.fraction for e in events if "furniture looks like" in e.message] == pytest.approx(
        [0.2, 0.4, 0.6, 0.8][:steps]
    )
