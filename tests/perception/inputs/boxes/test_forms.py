"""Every form of boxes is recognised by its content, and gives the same boxes."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from diorama_core.artefacts import LabelledBox
from diorama_core.errors import InputError
from diorama_core.perception.inputs.boxes import lines, lists, markup, tools
from diorama_core.perception.inputs.boxes.entry import BoxText
from diorama_core.perception.inputs.boxes.nested import box_of, word_of
from diorama_core.perception.inputs.boxes.reading import BOX_FORMS, parse_box_text, read_boxes
from diorama_core.perception.inputs.source import Source, form_of
from tests.perception.inputs.files import decoded

SIZE = (400, 300)
BOXES = [(20, 30, 120, 230, "chair"), (200, 60, 380, 280, "sofa")]


def sized(x1: float, y1: float, x2: float, y2: float) -> list[float]:
    return [x1, y1, x2 - x1, y2 - y1]


def shares(x1: float, y1: float, x2: float, y2: float) -> list[float]:
    return [(x1 + x2) / 800, (y1 + y2) / 600, (x2 - x1) / 400, (y2 - y1) / 300]


def rows(write):
    return [write(*b) for b in BOXES]


COCO = {
    "images": [{"id": 7, "file_name": "photo.png", "width": 400, "height": 300}],
    "categories": [{"id": 1, "name": "chair"}, {"id": 2, "name": "sofa"}],
    "annotations": [
        {"image_id": 7, "category_id": k + 1, "bbox": sized(*b[:4]), "iscrowd": 0, "area": 1}
        for k, b in enumerate(BOXES)
    ],
}
STUDIO_RESULTS = rows(
    lambda x1, y1, x2, y2, w: {
        "original_width": 400,
        "original_height": 300,
        "type": "rectanglelabels",
        "value": {"x": x1 / 4, "y": y1 / 3, "width": (x2 - x1) / 4, "height": (y2 - y1) / 3, "rectanglelabels": [w]},
    }
)
STUDIO = [{"data": {"image": "photo.png"}, "annotations": [{"result": STUDIO_RESULTS}]}]
VIA = {
    "photo.png1234": {
        "filename": "photo.png",
        "regions": rows(
            lambda x1, y1, x2, y2, w: {
                "shape_attributes": {"name": "rect", "x": x1, "y": y1, "width": x2 - x1, "height": y2 - y1},
                "region_attributes": {"thing": w},
            }
        ),
    }
}
LABELME = {
    "shapes": rows(lambda x1, y1, x2, y2, w: {"label": w, "points": [[x2, y1], [x1, y2]], "shape_type": "rectangle"}),
    "imageWidth": 400,
    "imageHeight": 300,
}
VOC = "<annotation><size><width>400</width><height>300</height></size>{}</annotation>".format(
    "".join(
        rows(
            lambda x1, y1, x2, y2, w: (
                f"<object><name>{w}</name><bndbox><xmin>{x1 + 1}</xmin><ymin>{y1 + 1}</ymin><xmax>{x2}</xmax>"
                f"<ymax>{y2}</ymax></bndbox></object>"
            )
        )
    )
)
CVAT = '<annotations><image name="photo.png" width="400" height="300">{}</image></annotations>'.format(
    "".join(rows(lambda x1, y1, x2, y2, w: f'<box label="{w}" xtl="{x1}" ytl="{y1}" xbr="{x2}" ybr="{y2}"/>'))
)
ROBOFLOW = {
    "predictions": rows(
        lambda x1, y1, x2, y2, w: {
            "x": (x1 + x2) / 2, "y": (y1 + y2) / 2, "width": x2 - x1, "height": y2 - y1, "class": w, "confidence": 0.9,
        }
    ),
    "image": {"width": 400, "height": 300},
}  # fmt: skip
CREATE_ML = {
    "image": "photo.png",
    "annotations": rows(
        lambda x1, y1, x2, y2, w: {
            "label": w,
            "coordinates": {"x": (x1 + x2) / 2, "y": (y1 + y2) / 2, "width": x2 - x1, "height": y2 - y1},
        }
    ),
}
AMAZON = rows(
    lambda x1, y1, x2, y2, _: {
        "BoundingBox": {"Left": x1 / 400, "Top": y1 / 300, "Width": (x2 - x1) / 400, "Height": (y2 - y1) / 300}
    }
)
REKOGNITION = {
    "Labels": [{"Name": "x", "Instances": [{"Name": b[4], **i} for b, i in zip(BOXES, AMAZON, strict=True)]}]
}
BY_KIND = {"Labels": [{"Name": b[4], "Instances": [i]} for b, i in zip(BOXES, AMAZON, strict=True)]}
CORNERS_ONLY = [list(b[:4]) for b in BOXES]
COLUMNS = {"boxes": CORNERS_ONLY, "labels": ["chair", "sofa"], "scores": [0.9, 0.8]}
TABLE = "filename,width,height,class,xmin,ymin,xmax,ymax\n" + "\n".join(
    rows(lambda x1, y1, x2, y2, w: f"photo.png,400,300,{w},{x1},{y1},{x2},{y2}")
)
KITTI = "\n".join(rows(lambda x1, y1, x2, y2, w: f"{w} 0.0 0 0.0 {x1} {y1} {x2} {y2} 0 0 0 0 0 0 0"))

PANOPTIC = {**COCO, "annotations": [{"image_id": 7, "segments_info": COCO["annotations"]}]}
OTHERS = [{"bbox": [1, 1, 9, 9], "class": "bed"}] * 5
NAMED = rows(lambda x1, y1, x2, y2, w: {"bbox": [x1, y1, x2, y2], "class": w})
CORNERS = rows(lambda x1, y1, x2, y2, w: {"topLeft": {"x": x1, "y": y1}, "bottomRight": {"x": x2, "y": y2}, "name": w})
TF_ROWS = {"detection_boxes": rows(lambda a, b, c, d, _: [b / 300, a / 400, d / 300, c / 400]),
           "detection_class_entities": ["chair", "sofa"]}  # fmt: skip
MANIFEST = {
    "bb": {"annotations": rows(lambda a, b, c, d, w: {"left": a, "top": b, "width": c - a, "height": d - b,
                                                      "class_id": len(w) - 4})},
    "bb-metadata": {"class-map": {"1": "chair", "0": "sofa"}},
}  # fmt: skip
LABEL_IDS = [{"type": "bbox", "label_id": k, "bbox": sized(*b[:4])} for k, b in enumerate(BOXES)]
DATUMARO = {
    "categories": {"label": {"labels": [{"name": "chair"}, {"name": "sofa"}]}},
    "items": [{"id": "photo", "annotations": LABEL_IDS, "format": "xywh"}],
}
VIA_TABLE = "filename,region_shape_attributes,region_attributes\n" + "\n".join(
    rows(
        lambda a, b, c, d, w: (
            f'photo.png,"{{""name"":""rect"",""x"":{a},""y"":{b},""width"":{c - a},""height"":{d - b}}}",'
            f'"{{""kind"":""{w}""}}"'
        )
    )
)
FENCED = "The boxes:\n```json\n" + json.dumps(NAMED) + "\n```\n"
DOTA = "imagesource:x\ngsd:0.1\n" + "\n".join(rows(lambda a, b, c, d, w: f"{a} {b} {c} {b} {c} {d} {a} {d} {w} 0"))
RETINANET = "\n".join(rows(lambda a, b, c, d, w: f"images/photo.png,{a},{b},{c},{d},{w}"))

FORMS = [
    ("COCO data set", COCO),
    ("COCO data set", PANOPTIC),
    ("VGG Image Annotator", {"p": {"filename": "a/photo.png", "regions": VIA["photo.png1234"]["regions"]}}),
    ("list of boxes", [{**row, "bbox": str(row["bbox"])} for row in NAMED]),
    ("list of boxes", CORNERS),
    ("list of boxes", FENCED),
    ("list of boxes", [{"image": "a/b.png", **r} for r in OTHERS] + [{"image": "c/photo.png", **r} for r in NAMED]),
    ("columns of boxes", TF_ROWS),
    ("columns of boxes", [{"file": "b.png", "boxes": [[1, 1, 9, 9]], "labels": ["bed"]},
                          {"file": "photo.png", **COLUMNS}]),
    ("object with a list of boxes", BY_KIND),
    ("object with a list of boxes", MANIFEST),
    ("object with a list of boxes", DATUMARO),
    ("object with a list of boxes", [{"name": "b.jpg", "labels": OTHERS}, {"name": "photo.jpg", "labels": NAMED}]),
    ("object with a list of boxes", {"b.png": OTHERS, "photo.png": NAMED}),
    ("object with a list of boxes", {"images": [{"file_name": "b.png", "objects": OTHERS},
                                                {"file_name": "photo.png", "objects": NAMED}]}),
    ("boxes by name", {"chair_1": [20, 30, 120, 230], "sofa_1": [200, 60, 380, 280]}),
    ("boxes by name", {"chair": [[20, 30, 120, 230]], "sofa": [[200, 60, 380, 280]]}),
    ("boxes by name", {k: {"0": v, "1": w} for k, v, w in zip(
        ("xmin", "ymin", "xmax", "ymax", "name"), *BOXES, strict=True)}),
    ("table of boxes", VIA_TABLE),
    ("words and numbers", DOTA),
    ("words and numbers", RETINANET),
    ("LabelMe", LABELME),
    ("Label Studio", STUDIO),
    ("VGG Image Annotator", VIA),
    ("list of boxes", NAMED),
    ("list of boxes", rows(lambda a, b, c, d, w: {"label": w, "box": {"xmin": a, "ymin": b, "xmax": c, "ymax": d}})),
    ("list of boxes", rows(lambda a, b, c, d, w: {"box_2d": [b / 0.3, a / 0.4, d / 0.3, c / 0.4], "label": w})),
    (
        "list of boxes",
        rows(lambda a, b, c, d, w: {"bounding_box": [a / 400, b / 300, (c - a) / 400, (d - b) / 300], "label": w}),
    ),
    ("columns of boxes", COLUMNS),
    ("columns of boxes", {"<OD>": {"bboxes": COLUMNS["boxes"], "labels": COLUMNS["labels"]}}),
    ("object with a list of boxes", ROBOFLOW),
    ("object with a list of boxes", CREATE_ML),
    ("object with a list of boxes", REKOGNITION),
    ("Pascal VOC", VOC),
    ("CVAT", CVAT),
    ("table of boxes", TABLE),
    ("words and numbers", KITTI),
]  # fmt: skip


@pytest.mark.parametrize(
    ("recognises", "name"),
    [(tools.is_labelme, "LabelMe"), (lists.is_columns, "columns of boxes"), (markup.is_voc, "Pascal VOC"),
     (lines.is_words, "words and numbers")],
)  # fmt: skip
def test_a_form_knows_its_own_files(recognises: Callable[[BoxText], bool], name: str) -> None:
    own = [parse_box_text(Source(content(d), "file"), "photo.png", SIZE) for n, d in FORMS if n == name]
    assert own
    assert all(recognises(text) for text in own)


@pytest.mark.parametrize("strange", ["{}", "<a/>", "one line of text", "[[1]]", '[{"a": 1}]', '{"shapes": 1}'])
def test_no_form_knows_strange_files(strange: str) -> None:
    assert form_of(BOX_FORMS, parse_box_text(Source(strange.encode(), "file"), "photo.png", SIZE)) is None


def read(document: object) -> tuple[tuple[LabelledBox, ...], tuple[str, ...]]:
    return read_boxes(Source(content(document), "file"), decoded(*SIZE))


def content(document: object) -> bytes:
    return (document if isinstance(document, str) else json.dumps(document)).encode()


@pytest.mark.parametrize(
    "document",
    [
        [{"image": "a.png", **OTHERS[0]}, {"image": "b.png", **NAMED[0]}],
        {"a.png": OTHERS, "b.png": NAMED},
        {"samples": [{"filepath": "a.png", "objects": OTHERS}, {"filepath": "b.png", "objects": NAMED}]},
        TABLE + "\n" + TABLE.split("\n", 1)[1].replace("photo", "b"),
        RETINANET.replace("photo", "a") + "\n" + RETINANET.replace("photo", "b"),
    ],
)
def test_boxes_of_other_pictures_are_refused(document: object) -> None:
    source = Source(content(document).replace(b"photo.png", b"a.png"), "b")
    with pytest.raises(InputError, match=r"is of 2 pictures, none of them called photo.png"):
        read_boxes(source, decoded(*SIZE))


@pytest.mark.parametrize(
    "name", ["photo_png.rf.0a1b2c3d.png", "C:\\x\\PHOTO.JPG", "12ab34cd-photo.png", "a/photo.webp"]
)
def test_names_of_pictures_as_programs_change_them(name: str) -> None:
    other = {"id": 8, "file_name": "other.png", "width": 10, "height": 10}
    document = {**COCO, "images": [{**COCO["images"][0], "file_name": name}, other]}
    assert len(read(document)[0]) == 2


def test_a_photo_without_boxes_among_others_is_said() -> None:
    document = [{"name": "a.png", "labels": NAMED}, {"name": "photo.png", "labels": []}]
    with pytest.raises(InputError, match="holds no box of the photo"):
        read(document)


def test_utf_16_is_text() -> None:
    assert len(read_boxes(Source(json.dumps(NAMED).encode("utf-16"), "b"), decoded(*SIZE))[0]) == 2


@pytest.mark.parametrize(("name", "document"), FORMS, ids=[f"{k}-{n}" for k, (n, _) in enumerate(FORMS)])
def test_every_form_gives_the_same_boxes(name: str, document: object) -> None:
    form = form_of(BOX_FORMS, parse_box_text(Source(content(document), "file"), "photo.png", SIZE))
    assert form.name == name
    found, _ = read(document)
    assert [b.label for b in found] == ["chair", "sofa"]
    for box, (*expected, _) in zip(found, BOXES, strict=True):
        assert box.box == pytest.approx(expected, abs=1e-6)


def test_yolo_takes_its_names_from_the_file_beside(tmp_path: Path) -> None:
    lines = "\n".join(f"{k} " + " ".join(f"{v:.6f}" for v in shares(*b[:4])) for k, b in enumerate(BOXES))
    path = tmp_path / "labels.txt"
    path.write_text(lines)
    nameless, notes = read_boxes(Source(lines.encode(), path.name, path), decoded(*SIZE))
    assert {b.label for b in nameless} == {"object"}
    assert "classes.txt" in notes[0]
    (tmp_path / "data.yaml").write_text("path: x\nnames:\n  0: chair\n  1: sofa\n")
    found, notes = read_boxes(Source(lines.encode(), path.name, path), decoded(*SIZE))
    assert [b.label for b in found] == ["chair", "sofa"]
    assert notes == ()
    assert found[1].box == pytest.approx(BOXES[1][:4], abs=0.01)


def test_coco_results_are_sized_and_say_where_names_are(tmp_path: Path) -> None:
    results = [{"image_id": 1, "category_id": k + 1, "bbox": sized(*b[:4]), "score": 0.5} for k, b in enumerate(BOXES)]
    path = tmp_path / "results.json"
    path.write_bytes(json.dumps(results).encode())
    source = Source(path.read_bytes(), path.name, path)
    found, notes = read_boxes(source, decoded(*SIZE))
    assert found[0].box == BOXES[0][:4]
    assert "`categories`" in notes[0]
    (tmp_path / "instances.json").write_text(json.dumps(COCO))
    named, _ = read_boxes(source, decoded(*SIZE))
    assert [b.label for b in named] == ["chair", "sofa"]


def test_a_data_set_of_many_pictures_gives_the_photo_s() -> None:
    other = {"id": 8, "file_name": "other.png", "width": 10, "height": 10}
    many = {**COCO, "images": [*COCO["images"], other]}
    found, notes = read(many)
    assert len(found) == 2
    assert "2 pictures" in notes[0]
    with pytest.raises(InputError, match="none of them called"):
        read({**many, "images": [other, other]})


def test_names_under_unusual_keys_are_used_or_named() -> None:
    known = [
        {"bbox": [1, 1, 60, 60], "thing": "chair", "id": "a17"},
        {"bbox": [9, 9, 80, 80], "thing": "sofa", "id": "b2"},
    ]
    found, notes = read(known)
    assert [b.label for b in found] == ["chair", "sofa"]
    assert "'thing'" in notes[0]
    unknown = [{"bbox": [1, 1, 60, 60], "note": "qwxz"}]
    found, notes = read(unknown)
    assert found[0].label == "object"
    assert "'note'" in notes[0]


@pytest.mark.parametrize("document", ["<svg/>", "hello world", {"a": 1}, [1, 2], [{"x": "y"}]])
def test_what_is_no_file_of_boxes_is_refused_with_an_example(document: object) -> None:
    with pytest.raises(InputError, match="boxes are a JSON list"):
        read(document)


def test_one_annotation_in_anybody_s_words() -> None:
    assert word_of({"labelName": "sofa"}) == word_of({"type": "rectangle", "category_name": "sofa"}) == "sofa"
    assert word_of({"category_id": 3}, {3: "lamp"}) == "lamp"
    assert box_of({"boundingBox": {"Left": 1, "Top": 2, "Width": 3, "Height": 4}}, "") == (1, 2, 4, 6)
    assert box_of({"polygon": [[1, 2], [5, 3], [2, 9]]}, "") == (1, 2, 5, 9)
    assert box_of({"cx": 5, "cy": 5, "w": 2, "h": 4}, "") == (4, 3, 6, 7)
    assert box_of({"name": "x"}, "") is None


@pytest.mark.parametrize(
    ("document", "words"),
    [
        ({"boxes": CORNERS_ONLY, "labels": ["chair(0.45)", "sofa 0.87"]}, ["chair", "sofa"]),
        ([{"bbox": CORNERS_ONLY[0], "class": "chair (.5)"}, {"bbox": CORNERS_ONLY[1], "class": "sofa 2"}],
         ["chair", "sofa 2"]),
        ([{"value": 0, "label": "background"}, *({"label": b[4], "box": list(b[:4])} for b in BOXES)],
         ["chair", "sofa"]),
        ({"pred_boxes": CORNERS_ONLY, "pred_classes": [0, 2], "class_names": ["chair", "lamp", "sofa"]},
         ["chair", "sofa"]),
    ],
    ids=["scores behind words", "scores and numbers", "the background is none", "numbers of classes"],
)  # fmt: skip
def test_words_of_boxes(document: object, words: list[str]) -> None:
    assert [b.label for b in read(document)[0]] == words


def test_bounds_of_cvat_s_masks() -> None:
    masks = "".join(
        f'<mask label="{w}" rle="0, 9" left="{x1}" top="{y1}" width="{x2 - x1}" height="{y2 - y1}"/>'
        for x1, y1, x2, y2, w in BOXES
    )
    image = f'<image name="photo.png" width="400" height="300">{masks}</image>'
    assert [(b.box, b.label) for b in read(f"<annotations>{image}</annotations>")[0]] == [
        (tuple(map(float, b[:4])), b[4]) for b in BOXES
    ]
