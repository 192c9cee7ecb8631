from __future__ import annotations

import dataclasses
import hashlib
import io
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import trimesh

from diorama_core.errors import LibraryError
from diorama_core.io.glb import read_glb
from diorama_core.library import catalogue, furniture
from diorama_core.library.catalogue import (
    BuiltInLibrary,
    built_in_library,
    cached_picture,
    default_cache_dir,
    scene_with_pictures,
)
from diorama_core.library.furniture import designs, materials
from diorama_core.library.furniture.materials import picture_bytes
from diorama_core.library.furniture.model import Design, built, scene_of
from diorama_core.library.furniture.roles import with_roles
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import CATEGORIES

SAMPLE = tuple(d.id for d in designs()[::9])
FREQUENT = {
    "chair": 8, "sofa": 6, "table": 8, "bed": 5, "bookshelf": 5, "cabinet": 5, "dresser": 5, "night stand": 5,
    "lamp": 5, "pillow": 4, "books": 4, "door": 4, "picture": 4,
}  # fmt: skip
DESIGN = next(d for d in furniture.designs() if d.id == "bed-channel-green")


@pytest.fixture(scope="module")
def library() -> BuiltInLibrary:
    return built_in_library()


def in_category(category: str) -> list[Design]:
    return [d for d in designs() if d.category == category]


def test_is_a_shape_library(library: BuiltInLibrary) -> None:
    used: ShapeLibrary = library
    assert len(used.shapes()) >= 300


def test_every_category_has_its_shapes(library: BuiltInLibrary) -> None:
    count = Counter(s.category for s in library.shapes())
    assert [c.name for c in CATEGORIES if count[c.name] < FREQUENT.get(c.name, 3)] == []
    assert all(len(library.in_category(name)) == n for name, n in count.items())


def test_records_are_sound(library: BuiltInLibrary) -> None:
    shapes = library.shapes()
    known = {c.name for c in CATEGORIES}
    assert all(s.category in known and s.caption and s.style and s.mass_kg > 0 for s in shapes)
    assert max(Counter(s.content_hash for s in shapes).values()) == 1
    assert max(Counter(s.caption for s in shapes).values()) == 1


def test_sizes_agree_with_the_size_priors() -> None:
    """The middling shape lies within two deviations of some mode in every direction."""
    for category in CATEGORIES:
        middling = np.median([np.log(d.size_m) for d in in_category(category.name)], axis=0)
        off = [np.abs((middling - p.log_median_xyz) / p.log_sigma_xyz).max() for p in category.priors]
        assert min(off) < 2.0, category.name


@pytest.mark.parametrize("shape_id", SAMPLE)
def test_geometry_is_canonical(library: BuiltInLibrary, shape_id: str) -> None:
    shape, mesh = library.shape(shape_id), library.mesh(shape_id)
    assert np.allclose(mesh.extents, shape.size_m, atol=1e-6)
    assert np.allclose(mesh.bounds.mean(axis=0), 0.0, atol=1e-6)
    assert np.allclose(library.parts(shape_id).bounds, mesh.bounds, atol=1e-5)
    assert 12 <= len(mesh.faces) <= 30_000


@pytest.mark.parametrize("design", designs()[::10], ids=lambda d: d.id)
def test_builders_fill_the_size_they_are_given(design: Design) -> None:
    """The last stretch to the exact size stays small, so that nothing is visibly squashed."""
    points = np.concatenate([p.solid.vertices for p in design.build(design.size_m)])
    assert np.isfinite(points).all()
    stretch = np.asarray(design.size_m) / np.ptp(points, axis=0)
    assert (stretch > 0.6).all()
    assert (stretch < 1.7).all()


def test_triangle_budget(library: BuiltInLibrary) -> None:
    counts = [len(library.mesh(shape_id).faces) for shape_id in SAMPLE]
    assert np.median(counts) < 4_000
    assert max(counts) < 30_000


@pytest.mark.parametrize("shape_id", SAMPLE[::4])
def test_glb_opens_with_textures_and_normals(library: BuiltInLibrary, shape_id: str) -> None:
    data = library.glb(shape_id)
    scene = trimesh.load(io.BytesIO(data), file_type="glb")
    assert np.allclose(scene.bounds, library.mesh(shape_id).bounds, atol=1e-4)
    document, _ = read_glb(data)
    assert "extensionsRequired" not in document
    assert all("NORMAL" in p["attributes"] for mesh in document["meshes"] for p in mesh["primitives"])
    assert all("baseColorTexture" in m["pbrMetallicRoughness"] for m in document["materials"])


def test_same_keys_and_bytes_in_another_process(library: BuiltInLibrary, tmp_path: Path) -> None:
    code = (
        "import sys, hashlib; from pathlib import Path; from diorama_core.library.catalogue import built_in_library;"
        "library = built_in_library(Path(sys.argv[1]));"
        "print(hashlib.sha256(library.glb('plant-fiddle')).hexdigest(), *(s.content_hash for s in library.shapes()))"
    )
    out = subprocess.run([sys.executable, "-OO", "-c", code, str(tmp_path)], capture_output=True, text=True, check=True)
    here = hashlib.sha256(library.glb("plant-fiddle")).hexdigest()
    assert out.stdout.split() == [here, *(s.content_hash for s in library.shapes())]


@pytest.mark.unchecked
def test_listing_is_instant_and_warm_glb_is_quick(tmp_path: Path) -> None:
    start = time.process_time()
    assert built_in_library(tmp_path).shapes()
    assert time.process_time() - start < 1.0
    built_in_library(tmp_path).glb("chair-slat-oak")
    again = built_in_library(tmp_path)
    start = time.process_time()
    again.glb("chair-slat-oak")
    assert time.process_time() - start < 0.05


def test_broken_cache_folder_only_costs_time(tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    assert len(built_in_library(blocked).glb("stool-farm-pine")) > 1000


def test_threads_share_one_build(tmp_path: Path) -> None:
    library = built_in_library(tmp_path)
    seen: list[int] = []
    workers = [threading.Thread(target=lambda: seen.append(id(library.mesh("bench-hairpin")))) for _ in range(6)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(set(seen)) == 1
    assert len(seen) == 6


def test_unknown_shape_is_a_library_error(library: BuiltInLibrary) -> None:
    for ask in (library.shape, library.mesh, library.parts, library.glb):
        with pytest.raises(LibraryError, match="no shape is called 'nope'"):
            ask("nope")


def test_cache_folder_follows_the_environment(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("DIORAMA_CACHE", str(tmp_path / "elsewhere"))
    assert default_cache_dir() == tmp_path / "elsewhere"


def above_floor(library: BuiltInLibrary, shape_id: str) -> list[float]:
    shape = library.shape(shape_id)
    return [s.height_m + shape.size_m[2] / 2 for s in shape.surfaces]


@pytest.mark.parametrize(
    "shape_id", ["table-oak-classic", "table-round-tulip", "desk-standing", "side-table-tripod-oak"]
)
def test_a_table_has_its_top(library: BuiltInLibrary, shape_id: str) -> None:
    (height,) = above_floor(library, shape_id)
    assert height == pytest.approx(library.shape(shape_id).size_m[2], abs=0.005)


@pytest.mark.parametrize(
    "shape_id", ["chair-slat-oak", "chair-padded-grey", "chair-folding-pine", "armchair-lounge-oak"]
)
def test_a_chair_has_its_seat(library: BuiltInLibrary, shape_id: str) -> None:
    assert any(0.40 < z < 0.50 for z in above_floor(library, shape_id))


def test_a_sofa_has_its_seat_and_a_bed_its_mattress(library: BuiltInLibrary) -> None:
    for sofa in library.in_category("sofa"):
        assert any(0.36 < z < 0.5 for z in above_floor(library, sofa.id)), sofa.id
    assert any(0.5 < z < 0.68 for z in above_floor(library, "bed-panel-oak"))


def test_a_bookcase_has_its_shelves_and_a_closed_cabinet_no_reachable_inside(library: BuiltInLibrary) -> None:
    shape = library.shape("bookshelf-oak-four")
    inside = [s for s in shape.surfaces if s.interior]
    assert len(inside) == 4
    assert all(0.3 < s.clearance_m < 0.4 for s in inside)
    assert sum(not s.interior for s in shape.surfaces) == 1
    assert all(not s.interior for s in library.shape("dresser-white-four").surfaces)


def test_surfaces_survive_the_cache(tmp_path: Path) -> None:
    first = built_in_library(tmp_path).shape("tv-stand-oak-open")
    assert built_in_library(tmp_path).shape("tv-stand-oak-open") == first


def test_records_know_other_names_and_the_faces_that_touch(library: BuiltInLibrary) -> None:
    by_category = {s.category: s for s in library.shapes()}
    assert "settee" in by_category["sofa"].synonyms or "couch" in by_category["sofa"].synonyms
    assert by_category["clock"].contact_faces[0] == "back"
    assert by_category["ceiling lamp"].contact_faces == ("top",)
    assert by_category["table"].contact_faces == ("bottom",)


def test_a_shape_is_the_same_with_cached_pictures(tmp_path: Path) -> None:
    solids = built(DESIGN)
    painted = with_roles(scene_of(solids), [material for material, _ in solids])
    for _ in range(2):
        cached_picture.cache_clear()
        kept = scene_with_pictures(solids, tmp_path)
        assert list(kept.geometry) == list(painted.geometry)
        for mesh, other in zip(kept.geometry.values(), painted.geometry.values(), strict=True):
            assert np.array_equal(mesh.vertices, other.vertices)
            assert mesh.metadata == other.metadata
            ours, theirs = mesh.visual.material, other.visual.material
            assert np.array_equal(np.asarray(ours.baseColorTexture), np.asarray(theirs.baseColorTexture))
            assert (ours.name, ours.roughnessFactor) == (theirs.name, theirs.roughnessFactor)


def test_a_picture_is_painted_once_and_again_when_cut_off(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    painted: list[str] = []

    def paint(material: materials.Material) -> bytes:
        painted.append(material.name)
        return picture_bytes(material)

    monkeypatch.setattr(catalogue, "picture_bytes", paint)
    monkeypatch.setattr(catalogue, "_code", lambda: "as it is")
    for _ in range(2):
        cached_picture.cache_clear()
        assert cached_picture(materials.OAK, tmp_path) == picture_bytes(materials.OAK)
    assert painted == [materials.OAK.name]
    (path,) = tmp_path.iterdir()
    path.write_bytes(path.read_bytes()[:-20])
    cached_picture.cache_clear()
    assert cached_picture(materials.OAK, tmp_path) == picture_bytes(materials.OAK)
    assert len(painted) == 2
    # Another colour and another code are other pictures.
    cached_picture(dataclasses.replace(materials.OAK, colour="#808080"), tmp_path)
    monkeypatch.setattr(catalogue, "_code", lambda: "as it will be")
    cached_picture.cache_clear()
    cached_picture(materials.OAK, tmp_path)
    assert len(painted) == 4
    assert len(list(tmp_path.iterdir())) == 3
