"""Each data set's own layout, in small folders that the tests make."""

from __future__ import annotations

import gzip
import json
from collections.abc import Callable
from pathlib import Path

import pytest
import trimesh

from diorama_core.errors import InputError
from diorama_core.library import datasets
from diorama_core.library.datasets import as_sources, dataset_named, read_json, recognise
from diorama_core.library.ingest.given import Given
from diorama_core.library.ingest.models import read_model
from diorama_core.library.ingest.shaping import ModelSource
from tests.library.ingest.models import chair, table, y_up


def put(path: Path, mesh: trimesh.Trimesh) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(mesh.export(file_type=path.suffix[1:]) if path.suffix == ".glb" else b"")
    if path.suffix != ".glb":
        mesh.export(path)


def pack(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(gzip.compress(text.encode()))


def objaverse(root: Path) -> None:
    put(root / "glbs" / "000-001" / "aa11.glb", y_up(chair()))
    put(root / "glbs" / "000-002" / "bb22.glb", y_up(table()))
    put(root / "glbs" / "000-002" / "cc33.glb", y_up(table()))  # not in LVIS
    pack(root / "lvis-annotations.json.gz", json.dumps({"armchair": ["aa11", "zz99"], "flugelhorn": ["bb22"]}))
    pack(root / "metadata" / "000-001.json.gz", json.dumps({"aa11": {"name": "My old chair", "license": "by"}}))


def shapenet(root: Path) -> None:
    put(root / "03001627" / "aa11" / "models" / "model_normalized.obj", y_up(chair()))
    put(root / "04379243" / "bb22" / "models" / "model_normalized.obj", y_up(table()))
    (root / "taxonomy.json").write_text(json.dumps([{"synsetId": "03001627", "name": "chair,seat"}]))


def hssd(root: Path) -> None:
    put(root / "objects" / "a" / "aa11.glb", y_up(chair()))
    put(root / "objects" / "b" / "bb22.glb", y_up(table()))
    put(root / "objects" / "b" / "bb22_part_1.glb", y_up(table()))
    put(root / "objects" / "b" / "bb22.collider.glb", y_up(table()))
    for name, config in (("a/aa11", {"up": [0, 1, 0], "front": [0, 0, -1]}), ("b/bb22", {"render_asset": "bb22.glb"})):
        (root / "objects" / f"{name}.object_config.json").write_text(json.dumps(config))
    (root / "metadata").mkdir()
    (root / "metadata" / "objects.csv").write_text(
        "id,name,main_category,up\naa11,Nice chair,chair,\nbb22,Desk,desk,\n"
    )


def future(root: Path) -> None:
    put(root / "aa11" / "raw_model.obj", y_up(chair()))
    put(root / "aa11" / "normalized_model.obj", y_up(chair()))
    put(root / "bb22" / "raw_model.obj", y_up(table()))
    rows = [
        {"model_id": "aa11", "super-category": "Chair", "category": "Lounge Chair / Cafe Chair", "style": "Modern"},
        {"model_id": "bb22", "super-category": "Table", "category": "Dining Table", "material": "Wood"},
    ]
    (root / "model_info.json").write_text(json.dumps(rows))


def abo(root: Path) -> None:
    put(root / "3dmodels" / "original" / "1" / "aa11.glb", y_up(chair()))
    put(root / "3dmodels" / "original" / "2" / "bb22.glb", y_up(table()))
    rows = [
        {"3dmodel_id": "aa11", "product_type": [{"value": "CHAIR"}],
         "item_name": [{"language_tag": "de_DE", "value": "Stuhl"}, {"language_tag": "en_US", "value": "Oak chair"}]},
        {"3dmodel_id": "bb22", "product_type": [{"value": "DESK"}], "item_name": []},
        {"item_id": "no model"},
    ]  # fmt: skip
    pack(root / "listings" / "metadata" / "listings_0.json.gz", "\n".join(json.dumps(r) for r in rows) + "\n")


MAKERS: dict[str, Callable[[Path], None]] = {
    "objaverse-lvis": objaverse,
    "shapenetcore": shapenet,
    "hssd": hssd,
    "3d-future": future,
    "abo": abo,
}
EXPECTED = {
    "objaverse-lvis": [("aa11", "armchair", "+y", None, None), ("bb22", "object", "+y", None, None)],
    "shapenetcore": [("03001627-aa11", "chair", "+y", "-z", None), ("04379243-bb22", "table", "+y", "-z", None)],
    "hssd": [("aa11", "chair", "+y", "-z", 1.0), ("bb22", "desk", "+y", None, 1.0)],
    "3d-future": [("aa11", "armchair", "+y", "+z", 1.0), ("bb22", "table", "+y", "+z", 1.0)],
    "abo": [("aa11", "chair", "+y", "+z", 1.0), ("bb22", "desk", "+y", "+z", 1.0)],
}


def made(name: str, root: Path) -> tuple[ModelSource, ...]:
    MAKERS[name](root)
    return as_sources(dataset_named(name), root, Given())


@pytest.mark.parametrize("name", MAKERS)
def test_a_copy_is_recognised_and_read_with_what_the_set_says_of_its_models(name: str, tmp_path: Path) -> None:
    found = made(name, tmp_path)
    facts = [(s.id, s.given.category, s.given.up, s.given.front, s.given.unit_m) for s in found]
    assert facts == EXPECTED[name]
    assert all(s.given.source == name and s.given.licence and s.given.reason == name for s in found)
    dataset = recognise(tmp_path)
    assert dataset is not None
    assert dataset.name == name
    assert all(len(read_model(s.path, s.root).scene.geometry) for s in found)
    flagged = as_sources(dataset, tmp_path, Given(up="+z", front="+x", category="stool"))
    assert {(s.given.up, s.given.front, s.given.category) for s in flagged} == {("+z", "+x", "stool")}, "flags go first"


@pytest.mark.parametrize("name", MAKERS)
def test_an_empty_folder_says_what_is_missing(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=f"no model of {name}"):
        as_sources(dataset_named(name), tmp_path, Given())


def test_captions_and_words_are_retained(tmp_path: Path) -> None:
    assert [s.given.caption for s in made("objaverse-lvis", tmp_path / "o")] == ["My old chair", "flugelhorn"]
    assert made("objaverse-lvis", tmp_path / "o")[1].given.synonyms == ("flugelhorn",)
    future = [s.given.caption for s in made("3d-future", tmp_path / "f")]
    assert future == ["lounge chair, modern", "dining table, wood"]
    assert [s.given.caption for s in made("abo", tmp_path / "a")] == ["Oak chair", "desk"]


def test_anyones_folder_is_no_data_set(tmp_path: Path) -> None:
    put(tmp_path / "chairs" / "a.glb", chair())
    assert recognise(tmp_path) is None


def test_broken_metadata_names_the_file(tmp_path: Path) -> None:
    future(tmp_path)
    (tmp_path / "model_info.json").write_text("[{")
    with pytest.raises(InputError, match=r"model_info\.json is not valid JSON"):
        as_sources(dataset_named("3d-future"), tmp_path, Given())


def test_packed_metadata_is_capped_before_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(datasets, "MAX_METADATA_BYTES", 100_000)
    path = tmp_path / "lvis-annotations.json.gz"
    path.write_bytes(gzip.compress(b'["a"]'))
    assert read_json(path) == ["a"]
    path.write_bytes(gzip.compress(b" " * 50_000_000))
    with pytest.raises(InputError, match=r"unpack to more than 0\.1 MB.*; download it again"):
        read_json(path)
    path.write_bytes(gzip.compress(b'["a"]')[:-9])
    with pytest.raises(InputError, match="cannot be read"):
        read_json(path)
    (tmp_path / "deep.json").write_text("[" * 10_000)
    with pytest.raises(InputError, match="nested"):
        read_json(tmp_path / "deep.json")


def test_an_unknown_data_set_lists_the_known(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="objaverse-lvis, shapenetcore"):
        dataset_named("modelnet")
