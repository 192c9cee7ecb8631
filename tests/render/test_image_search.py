from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.geometry.palettes import Palette
from diorama_core.library.catalogue import built_in_library, default_cache_dir
from diorama_core.library.ingest.sink import Ingested
from diorama_core.library.store import StoredLibrary, create_library
from diorama_core.pipeline.prepare import prepare_library
from diorama_core.render import image_search
from diorama_core.render.crops import ShapeCrop, foreground, read_crop
from diorama_core.render.image_search import SEARCH_GRID, ImageSearch
from diorama_core.render.template_cache import TemplateCache
from diorama_core.render.view_features import WIDTH, colour_feature, view_feature
from diorama_core.render.views import StudioView, render_shape
from diorama_core.retrieval.appearance_similarity import EMBEDDED_FEATURES
from diorama_core.workers import LocalWorkers
from tests.few_shapes import stored_copy

CHOSEN = (
    "chair-slat-oak",
    "chair-panel-birch",
    "sofa-chesterfield",
    "bookshelf-oak-four",
    "floor-lamp-arc",
    "table-round-oak",
)


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> StoredLibrary:
    """A stored library with a few of the built-in shapes."""
    built_in = built_in_library()
    known = {s.id for s in built_in.shapes()}
    store = create_library("chosen")
    for shape_id in [c for c in CHOSEN if c in known]:
        store.add(stored_copy(built_in, shape_id, shape_id))
    assert len(store) >= 5
    return store


def picture_of(library: StoredLibrary, shape_id: str, yaw_deg: float) -> ShapeCrop:
    view = StudioView(np.radians(yaw_deg), np.radians(17.0))
    rgba = render_shape(library, shape_id, (120, 120), view)
    return ShapeCrop(np.ascontiguousarray(rgba[..., :3]), rgba[..., 3] > 200)


def test_a_picture_finds_its_shape(library: StoredLibrary) -> None:
    search = ImageSearch(library)
    for shape in library.shapes():
        for yaw in (-35.0, 25.0):
            found = search.find(picture_of(library, shape.id, yaw), k=2)
            assert found.shapes[0].category == shape.category
            assert found.scores[0] >= found.scores[1]


def test_words_keep_the_search_within_a_kind(library: StoredLibrary) -> None:
    sofa = picture_of(library, "sofa-chesterfield", 20.0)
    found = ImageSearch(library).find(sofa, "chairs", k=5)
    assert [s.category for s in found.shapes[:2]] == ["chair", "chair"]
    assert ImageSearch(library).find(sofa, "qwxzzk", k=1).shapes[0].category == "sofa"
    assert "not known" in ImageSearch(library).find(sofa, "qwxzzk", k=1).note


def test_features_are_made_once(library: StoredLibrary, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    search = ImageSearch(library, tmp_path / "views")
    first = search.prepare(library.shapes()[:2])
    assert len(first) == 2
    assert first.values.shape == (2, len(SEARCH_GRID), WIDTH)
    monkeypatch.setattr(image_search, "shape_features", None)  # calling it would fail
    assert len(search.prepare(library.shapes()[:2])) == 2


def test_preparing_a_stored_library_on_processes(library: StoredLibrary, tmp_path: Path) -> None:
    mixed = StoredLibrary(tmp_path / "mixed", create=True)
    good, bad = library.shapes()[0], replace(library.shapes()[1], content_hash="of no model")
    mixed.add(Ingested(good, library.glb(good.id), None, "good"))
    mixed.add(Ingested(bad, b"no model", None, "bad"))
    prepared = prepare_library(f"{mixed.folder}/", views=True, templates=True, pool=LocalWorkers(1))
    assert prepared.count == 2
    assert [shape_id for shape_id, _ in prepared.failures] == [bad.id]
    assert "damaged" in prepared.failures[0][1]
    assert TemplateCache().has(good)
    assert len(ImageSearch(mixed).prepare([good])) == 1
    retained = default_cache_dir() / "features" / EMBEDDED_FEATURES / f"{good.content_hash}.npy"
    assert retained.exists()  # what retrieval compares


def test_features_agree_with_themselves_and_not_with_others() -> None:
    gray = np.tile(np.linspace(40, 220, 60), (80, 1)).astype(np.uint8)
    wide, tall = np.zeros((80, 60), bool), np.zeros((80, 60), bool)
    wide[30:45, 5:55], tall[5:75, 20:35] = True, True
    red = colour_feature(Palette(np.array([[50.0, 60.0, 40.0]]), np.ones(1)))
    blue = colour_feature(Palette(np.array([[35.0, 20.0, -55.0]]), np.ones(1)))
    feature = view_feature(gray, wide, red)
    assert feature is not None
    assert feature @ feature == pytest.approx(1.0, abs=1e-5)
    other = view_feature(gray, tall, red)
    assert other is not None
    assert feature @ other < 0.7
    recoloured = view_feature(gray, wide, blue)
    assert recoloured is not None
    assert feature @ recoloured < 0.95
    shifted = view_feature(np.roll(gray, 3, axis=1), np.roll(wide, 20, axis=0), red)
    assert shifted is not None
    assert feature @ shifted > 0.9, "where in the picture it is does not matter"
    assert view_feature(gray, np.zeros((80, 60), bool), red) is None


def test_crops_from_files(tmp_path: Path, library: StoredLibrary) -> None:
    rgba = render_shape(library, "sofa-chesterfield", (160, 160), StudioView(0.4, 0.3))
    Image.fromarray(rgba).save(tmp_path / "cut.png")
    cut = read_crop(tmp_path / "cut.png")
    assert 0.1 < cut.mask.mean() < 0.6
    assert cut.note == ""
    on_paper = Image.new("RGB", (160, 160), (235, 233, 228))
    on_paper.paste(Image.fromarray(rgba[..., :3]), mask=Image.fromarray(((rgba[..., 3] > 200) * 255).astype(np.uint8)))
    on_paper.save(tmp_path / "paper.png")
    paper = read_crop(tmp_path / "paper.png")
    assert (paper.mask & cut.mask).sum() / (paper.mask | cut.mask).sum() > 0.8
    Image.new("RGB", (50, 40), (10, 20, 30)).save(tmp_path / "plain.jpg")
    assert read_crop(tmp_path / "plain.jpg").mask.all()
    assert "cut-out" in read_crop(tmp_path / "plain.jpg").note
    assert foreground(np.zeros((2, 2, 3), np.uint8)).all()


def test_files_that_are_no_pictures_are_refused(tmp_path: Path) -> None:
    (tmp_path / "x.png").write_bytes(b"not a picture")
    with pytest.raises(InputError, match="cannot be read as a picture"):
        read_crop(tmp_path / "x.png")
    with pytest.raises(InputError, match="cannot be read"):
        read_crop(tmp_path / "absent.png")
    Image.new("RGBA", (30, 30), (0, 0, 0, 0)).save(tmp_path / "clear.png")
    with pytest.raises(InputError, match="transparent"):
        read_crop(tmp_path / "clear.png")
    Image.new("1", (9000, 9000)).save(tmp_path / "vast.png")
    with pytest.raises(InputError, match="give a crop"):
        read_crop(tmp_path / "vast.png")
