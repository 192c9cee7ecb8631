"""Annotated photos: a made one is built and measured, what is missing or broken is said and the rest goes on."""

from __future__ import annotations

import json
import logging
from pathlib import Path

import pytest
from PIL import Image

from diorama_app.cli import main
from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.photo_annotations import read_annotations
from diorama_core.evaluation.benchmarks.photos import PhotoSource, plan
from diorama_core.evaluation.reports import tables
from tests.evaluation.truth import view_of_room

SIZE = (240, 180)
ANNOTATIONS = Path(__file__).parents[2] / "photo_annotations.json"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A rendered bathroom with three annotations, one photo of another size, and one that is not there."""
    view = view_of_room(16, "bathroom", SIZE)
    folder = tmp_path_factory.mktemp("photos")
    for name in ("made", "other"):
        Image.fromarray(view.inputs.photo.rgb).save(folder / f"{name}.png")
    categories = [(box.box, box.category) for _, box in view.inputs.instance_boxes][:3]
    objects = [
        {"bbox": box, "class": name, "kind": name, "on": "floor", "colour": [200, 200, 200]} for box, name in categories
    ]
    k = view.scene.camera.intrinsics
    (folder / "photos.json").write_text(json.dumps([{"id": "made", "K": [k.fx, k.fy, k.cx, k.cy]}]))
    document = {
        "made": {"size": SIZE, "objects": objects},
        "other": {"size": (10, 10), "objects": objects[:1]},
        "absent": {"size": SIZE, "objects": objects[:1]},
    }
    path = folder / "annotations.json"
    path.write_text(json.dumps(document))
    return path, folder, len(objects)


def test_photos_are_measured_and_failures_do_not_stop_the_others(made, capsys, caplog, tmp_path, monkeypatch):
    """Once perturbed, in folds and with a sheet, then again from the JSON."""
    monkeypatch.setattr(tables, "GROUP_DRAWS", 20)
    path, folder, count = made
    words = ["bench", "photos", str(path), "--photos", str(folder), "--json", str(tmp_path / "out.json")]
    words += ["--perturbed", "dropped", "--folds", "2", "--sheet", str(tmp_path / "sheet.jpg")]
    with caplog.at_level(logging.ERROR):
        assert main(words) == 0
    shown = capsys.readouterr()
    document = json.loads((tmp_path / "out.json").read_text())
    assert document["missing"] == ["absent"]
    assert "not in the folder: absent" in shown.out
    assert [line.split(" failed")[0] for line in shown.err.splitlines() if "failed: " in line] == [
        "diorama: other",
        "diorama: other, dropped",
    ]
    of = {(photo["photo"], photo["perturbation"]): photo for photo in document["photos"]}
    built, failed = of["made", ""], of["other", ""]
    assert [len(of["made", change]["objects"]) for change in ("", "dropped")] == [count, count - 1]
    assert built["failure"] == ""
    assert any(annotated["kind_first"] for annotated in built["objects"])
    assert all(annotated["iou"] == 0.0 for annotated in failed["objects"])
    assert "annotations are of a picture of 10 x 10 pixels" in failed["failure"]
    titles = [table["title"] for table in document["tables"]]
    assert titles[1:] == ["Fronts by kind", "Form", "Folds of photos", "Perturbed photos", "What perturbations change"]
    with Image.open(tmp_path / "sheet.jpg") as sheet:
        assert sheet.width > 2000
    assert main(words) == 0
    again = {(p["photo"], p["perturbation"]): p for p in json.loads((tmp_path / "out.json").read_text())["photos"]}
    assert again["made", "dropped"]["seconds"] == of["made", "dropped"]["seconds"]  # not built anew
    capsys.readouterr()


def test_every_fold_may_have_settings_of_its_own(made):
    path, folder, _ = made
    sources = [PhotoSource(path, folder)]
    planned = plan(sources, folds=2, settings=[{"layout.rounds": 1.0}, {"layout.rounds": 2.0}])
    assert planned.folds == {"made": 0, "other": 1}
    assert [task.settings for task in planned.tasks] == [{"layout.rounds": 1.0}, {"layout.rounds": 2.0}]
    with pytest.raises(InputError, match="3 files of settings for 2 folds"):
        plan(sources, folds=2, settings=[{}, {}, {}])


def test_ids_of_several_files_must_differ(made):
    path, folder, _ = made
    with pytest.raises(InputError, match="made is in an earlier file too"):
        plan([PhotoSource(path, folder)] * 2)


def test_a_folder_without_any_of_them_is_an_error(made, tmp_path):
    with pytest.raises(InputError, match="none of the 3 annotated photos"):
        plan([PhotoSource(made[0], tmp_path)])


@pytest.mark.parametrize(
    ("objects", "said"),
    [
        ([{"bbox": [0, 0, 9, 9], "class": "cup", "kind": "cup", "on": 4}], "on 4, but there are 1 objects"),
        ([{"bbox": [0, 0, 9], "class": "cup", "kind": "cup"}], "objects, 0, bbox"),
        ([{"bbox": [0, 0, 9, 9], "class": "wall", "kind": "object"}], "part of the room"),
    ],
)
def test_broken_annotations_are_said_in_one_line(objects, said, tmp_path):
    path = tmp_path / "a.json"
    path.write_text(json.dumps({"p": {"size": [9, 9], "objects": objects}}))
    with pytest.raises(InputError, match=said):
        read_annotations(path)


def test_the_projects_own_annotations_can_be_read_and_name_known_kinds():
    photos = read_annotations(ANNOTATIONS)
    assert len(photos) == 21
    objects = [annotated for photo in photos.values() for annotated in photo.objects]
    assert all(annotated.bbox[0] < annotated.bbox[2] and annotated.bbox[1] < annotated.bbox[3] for annotated in objects)
    assert {"chair", "table"} <= {annotated.word for annotated in objects if annotated.loose}
