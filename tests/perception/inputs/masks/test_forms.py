"""Every form of masks gives the same objects."""

from __future__ import annotations

import base64
import io
import itertools
import json
import zipfile
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.artefacts import LabelledBox
from diorama_core.errors import InputError
from diorama_core.perception.inputs.masks.pictures import paint_masks, without_void
from diorama_core.perception.inputs.masks.reading import (
    MASK_FORMS,
    MaskContent,
    read_arrays,
    read_folder_of_masks,
    read_masks,
)
from diorama_core.perception.inputs.masks.segments import decode_runs, whole_numbers
from diorama_core.perception.inputs.source import Folder, Source, form_of, read_folder
from tests.perception.inputs.files import decoded, encoded, npy

HEIGHT, WIDTH = 90, 120
LARGE, SMALL = np.zeros((HEIGHT, WIDTH), bool), np.zeros((HEIGHT, WIDTH), bool)
LARGE[10:80, 10:90] = True
SMALL[30:60, 50:110] = True
IDS = np.where(SMALL, 2, np.where(LARGE, 1, 0)).astype(np.uint8)
RGB = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
RGB[LARGE], RGB[SMALL] = (200, 30, 30), (30, 200, 30)


def found(given: Source | Folder) -> np.ndarray:
    return read_masks(given, (), decoded(WIDTH, HEIGHT))[0]


def picture(image: Image.Image, name: str = "m.png", **options) -> Source:
    return Source(encoded(image, **options), name)


def palette(indices: np.ndarray, colours: list[tuple[int, int, int]]) -> Image.Image:
    image = Image.fromarray(indices.astype(np.uint8), "P")
    image.putpalette([v for c in colours for v in c])
    return image


def outline(mask: np.ndarray) -> np.ndarray:
    import cv2

    return cv2.dilate(mask.astype(np.uint8), np.ones((5, 5))) != cv2.erode(mask.astype(np.uint8), np.ones((5, 5)))


def test_a_palette_s_colours_decide_not_its_order() -> None:
    colours = [(200, 30, 30), (30, 200, 30), (0, 0, 0)]
    np.testing.assert_array_equal(found(picture(palette((IDS + 2) % 3, colours))), found(picture(Image.fromarray(RGB))))


def test_a_palette_without_black_or_of_equal_colours_is_ids() -> None:
    for colours in ([(70, 1, 84), (30, 200, 30), (250, 230, 30)], [(9, 9, 9)] * 3):
        np.testing.assert_array_equal(found(picture(palette(IDS, colours))), IDS)


@pytest.mark.parametrize("colour", [(224, 224, 192), (255, 255, 255)])
@pytest.mark.parametrize("ids", [(1, 2), (9, 15)])
def test_void_outlines_belong_to_nobody(colour, ids) -> None:
    values = np.choose(IDS, (0, *ids))
    void = outline(LARGE) | outline(SMALL)
    values = np.where(void, 255, values)
    colours = [(k, 3 * k % 255, 7 * k % 255) for k in range(255)] + [colour]
    for image in (palette(values, colours), Image.fromarray(values.astype(np.uint8))):
        instances = found(picture(image))
        assert instances.max() == 2
        assert (instances[void] == 0).all()


def test_chosen_ids_and_white_on_black_are_objects() -> None:
    for ids in ((100, 255), (255, 7)):
        assert without_void(np.choose(IDS, (0, *ids)).astype(np.int32), 255).notes == ()
    assert found(picture(Image.fromarray(LARGE.astype(np.uint8) * 255))).max() == 1


def test_a_cut_out_is_one_object() -> None:
    noise = np.random.default_rng(0).integers(0, 255, (HEIGHT, WIDTH, 3)).astype(np.uint8)
    rgba = np.dstack([noise, LARGE.astype(np.uint8) * 255])
    np.testing.assert_array_equal(found(picture(Image.fromarray(rgba))) > 0, LARGE)


def test_folders_archives_and_pages_of_masks(tmp_path: Path) -> None:
    content = {"0.png": SMALL, "1.png": LARGE}
    for name, mask in content.items():
        (tmp_path / name).write_bytes(encoded(Image.fromarray(mask.astype(np.uint8) * 255)))
    (tmp_path / "metadata.csv").write_text("id,area\n")
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name in content:
            archive.write(tmp_path / name, f"masks/{name}")
    pages = [Image.fromarray(m.astype(np.uint8) * 255) for m in content.values()]
    tiff = Source(encoded(pages[0], "TIFF", save_all=True, append_images=pages[1:]), "m.tif")
    for given in (read_folder(tmp_path, "masks"), read_folder(stream.getvalue(), "masks"), tiff):
        np.testing.assert_array_equal(found(given), IDS)
    folder = read_folder(tmp_path, "masks")
    assert isinstance(folder, Folder)
    assert "smaller one is in front" in read_folder_of_masks(folder).notes[0]


@pytest.mark.parametrize(
    "array", [IDS, IDS.astype(np.int64), np.stack([LARGE, SMALL]), np.stack([LARGE, SMALL], axis=-1), IDS.astype(float)]
)
def test_arrays(array: np.ndarray) -> None:
    np.testing.assert_array_equal(found(Source(npy(array), "m.npy")), IDS)
    stream = io.BytesIO()
    np.savez(stream, masks=array, scores=np.ones(2))
    assert read_arrays(Source(stream.getvalue(), "m.npz")).values.max() == 2


def packed(runs: list[int]) -> str:
    """COCO's text, as its API writes it."""
    text = ""
    for k, run in enumerate(runs):
        value = run - runs[k - 2] if k > 2 else run
        more = True
        while more:
            bits = value & 0x1F
            value >>= 5
            more = value != -1 if bits & 0x10 else value != 0
            text += chr((bits | 0x20 if more else bits) + 48)
    return text


def runs_of(mask: np.ndarray) -> list[int]:
    flat = mask.T.ravel()
    changes = np.flatnonzero(np.diff(flat)) + 1
    runs = np.diff([0, *changes, flat.size]).tolist()
    return [0, *runs] if flat[0] else runs


@pytest.mark.parametrize("as_text", [True, False])
def test_run_lengths(as_text: bool) -> None:
    segments = [{"size": [HEIGHT, WIDTH], "counts": (packed if as_text else list)(runs_of(m))} for m in (LARGE, SMALL)]
    np.testing.assert_array_equal(decode_runs(segments[0], "m"), LARGE)
    automatic = [{"segmentation": s, "area": 1, "predicted_iou": 0.9} for s in segments]
    np.testing.assert_array_equal(found(Source(json.dumps(automatic).encode(), "m.json")), IDS)
    with pytest.raises(InputError, match="run lengths"):
        decode_runs({"size": [4, 4], "counts": [3, 2]}, "m")


POLYGON = [[10, 10], [89, 10], [89, 79], [10, 79]]
SIDES = [[x for x, _ in POLYGON], [y for _, y in POLYGON]]
DATA_SET = {
    "images": [{"id": 1, "file_name": "b.png", "width": 9, "height": 9}, {"id": 2, "file_name": "a/photo.png"}],
    "annotations": [
        {"image_id": 1, "segmentation": [[0, 0, 8, 0, 8, 8]]},
        {"image_id": 2, "segmentation": [[v for p in POLYGON for v in p]]},
    ],
}
BITMAP = {
    "origin": [10, 10],
    "data": base64.b64encode(zlib.compress(encoded(Image.fromarray(np.full((70, 80), 255, np.uint8))))).decode(),
}


@pytest.mark.parametrize(
    "document",
    [
        {"shapes": [{"label": "x", "shape_type": "polygon", "points": POLYGON}]},
        {"shapes": [{"shape_type": "polygon", "points": POLYGON}], "imageWidth": WIDTH, "imageHeight": HEIGHT},
        {"a": {"filename": "photo.png", "regions": [{"shape_attributes": dict(zip(
            ("all_points_x", "all_points_y"), SIDES, strict=True))}]}},
        {"objects": [{"geometryType": "polygon", "points": {"exterior": POLYGON, "interior": []}}]},
        {"objects": [{"geometryType": "bitmap", "bitmap": BITMAP}]},
        DATA_SET,
    ],
)  # fmt: skip
def test_polygons_and_bitmaps_of_annotation_tools(document: object) -> None:
    np.testing.assert_array_equal(found(Source(json.dumps(document).encode(), "m")) > 0, LARGE)


def test_segments_of_other_pictures_are_refused() -> None:
    with pytest.raises(InputError, match="is of 2 pictures, none of them called"):
        found(Source(json.dumps(DATA_SET).replace("photo", "c").encode(), "m"))
    broken = {"objects": [{"bitmap": {**BITMAP, "origin": [100, 10]}}]}
    with pytest.raises(InputError, match="beyond the picture"):
        found(Source(json.dumps(broken).encode(), "m"))


def test_polygons_of_yolo() -> None:
    text = "0 " + " ".join(f"{x / WIDTH:.5f} {y / HEIGHT:.5f}" for x, y in POLYGON)
    assert (found(Source(text.encode(), "m.txt")) > 0).mean() == pytest.approx(LARGE.mean(), abs=0.02)


def corners_of(mask: np.ndarray) -> list[tuple[int, int]]:
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    left, right, top, bottom = int(columns[0]), int(columns[-1]), int(rows[0]), int(rows[-1])
    return [(left, top), (right, top), (right, bottom), (left, bottom)]


def cvat(figures: str) -> Source:
    image = f'<image id="0" name="photo.jpg" width="{WIDTH}" height="{HEIGHT}">{figures}</image>'
    return Source(f'<?xml version="1.0"?><annotations><version>1.1</version>{image}</annotations>'.encode(), "a.xml")


def test_cvat_s_polygons_and_masks() -> None:
    polygons = [";".join(f"{x},{y}" for x, y in corners_of(m)) for m in (LARGE, SMALL)]
    np.testing.assert_array_equal(found(cvat("".join(f'<polygon label="a" points="{p}"/>' for p in polygons))), IDS)
    (left, top), _, (right, bottom), _ = corners_of(SMALL)
    size = f'left="{left}" top="{top}" width="{right - left + 1}" height="{bottom - top + 1}"'
    mask = f'<mask label="a" rle="0, {(right - left + 1) * (bottom - top + 1)}" {size}/>'
    np.testing.assert_array_equal(found(cvat(mask)) > 0, SMALL)
    for damaged in (mask.replace("0, ", "1, "), mask.replace('left="5', 'left="15'), '<polygon points="1,a"/>'):
        with pytest.raises(InputError, match="damaged; export it again"):
            found(cvat(damaged))
    with pytest.raises(InputError, match="this XML holds no masks"):
        found(Source(b"<annotation><object/></annotation>", "a.xml"))


def brushed(mask: np.ndarray) -> dict[str, object]:
    """Label Studio's region of a brush, all of whose runs are of 16 bits, some of them literal."""
    values = np.repeat(np.where(mask, 255, 0).astype(np.uint8).ravel(), 4)
    bits = f"{len(values):032b}{7:05b}{2:04b}{3:04b}{7:04b}{15:04b}"
    starts = np.concatenate([[0], np.flatnonzero(np.diff(values)) + 1, [len(values)]])
    for start, end in itertools.pairwise(starts):
        for first in range(start, end, 65536):
            length = min(65536, end - first)
            literal = length < 6
            words = "".join(f"{values[first]:08b}" for _ in range(length if literal else 1))
            bits += f"{0 if literal else 1}11{length - 1:016b}{words}"
    packed = [int(bits[k : k + 8].ljust(8, "0"), 2) for k in range(0, len(bits), 8)]
    return {"original_width": WIDTH, "original_height": HEIGHT, "value": {"format": "rle", "rle": packed}}


def test_brushes_of_label_studio() -> None:
    stripes = SMALL & (np.arange(WIDTH) % 3 > 0)
    for masks in ((LARGE, SMALL), (stripes,)):
        regions = [brushed(m) for m in masks]
        document = [{"data": {"image": "photo.jpg"}, "annotations": [{"result": regions}]}]
        values = found(Source(json.dumps(document).encode(), "brush.json"))
        np.testing.assert_array_equal(values > 0, np.logical_or.reduce(masks))
    del regions[0]["value"]["rle"][40:]
    with pytest.raises(InputError, match="brush are damaged"):
        found(Source(json.dumps(document).encode(), "brush.json"))


def test_outlines_of_roboflow_and_ultralytics() -> None:
    both = [corners_of(m) for m in (LARGE, SMALL)]
    roboflow = {"predictions": [{"class": "a", "points": [{"x": x, "y": y} for x, y in c]} for c in both]}
    np.testing.assert_array_equal(found(Source(json.dumps(roboflow).encode(), "r.json")), IDS)
    rows = [{"name": "a", "segments": {"x": [x for x, _ in c], "y": [y for _, y in c]}} for c in both]
    np.testing.assert_array_equal(found(Source(json.dumps(rows).encode(), "u.json")), IDS)


def test_masks_black_on_white_and_arrays_of_one_each() -> None:
    files = [
        picture(Image.fromarray(np.where(m, 0, 255).astype(np.uint8)), f"{k}.png") for k, m in enumerate((LARGE, SMALL))
    ]
    np.testing.assert_array_equal(found(Folder("f", tuple(files))), IDS)
    stream = io.BytesIO()
    np.savez(stream, sofa=LARGE, table=SMALL)
    np.testing.assert_array_equal(found(Source(stream.getvalue(), "m.npz")), IDS)
    soft = np.stack([LARGE, SMALL]) * np.float32(0.9)
    np.testing.assert_array_equal(found(Source(npy(soft), "m.npy")), IDS)
    files = tuple(Source(npy(m), f"{k}.npy") for k, m in enumerate((LARGE, SMALL)))
    np.testing.assert_array_equal(found(Folder("f", files)), IDS)


def lossy(mask: np.ndarray, name: str, quality: int = 40) -> Source:
    return Source(encoded(Image.fromarray(np.where(mask, 255, 0).astype(np.uint8)), "JPEG", quality=quality), name)


def test_lossy_masks_are_white_on_black_or_refused() -> None:
    photo = Image.fromarray(np.random.default_rng(1).integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8))
    files = (lossy(LARGE, "1.jpg"), lossy(SMALL, "2.jpeg"), lossy(SMALL & ~SMALL, "3.jpg"))
    values, _, notes = read_masks(
        Folder("f", (*files, Source(encoded(photo, "JPEG"), "photo.jpg"))), (), decoded(WIDTH, HEIGHT)
    )
    assert (values != IDS).mean() < 0.01
    assert any("photo.jpg is not white on black" in n for n in notes)
    values, _, notes = read_masks(lossy(LARGE, "m.jpg"), (), decoded(WIDTH, HEIGHT))
    assert ((values > 0) != LARGE).mean() < 0.01
    assert "lossy" in notes[0]
    for image in (Image.fromarray(RGB), Image.fromarray(IDS), photo):
        with pytest.raises(InputError, match="exact colours, which JPEG blurs"):
            found(Source(encoded(image, "JPEG"), "m.jpg"))


def test_photos_and_measurements_are_no_masks() -> None:
    noise = np.random.default_rng(1).integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8)
    with pytest.raises(InputError, match="not white on black"):
        found(Folder("f", (picture(Image.fromarray(noise)),)))
    ramp = np.tile(np.arange(WIDTH, dtype=np.uint8), (HEIGHT, 1))
    with pytest.raises(InputError, match="change evenly"):
        found(picture(Image.fromarray(ramp)))


def test_what_lies_around_all_is_no_object() -> None:
    values, _, notes = read_masks(picture(Image.fromarray((IDS + 7).astype(np.uint8))), (), decoded(WIDTH, HEIGHT))
    np.testing.assert_array_equal(values, IDS)
    assert "taken for the background" in notes[0]


def test_a_mask_of_a_kind_is_split_by_the_boxes() -> None:
    both = np.zeros((HEIGHT, WIDTH), np.uint8)
    both[10:40, 10:40], both[50:80, 60:110] = 1, 1
    boxes = tuple(LabelledBox(b, "chair", "chair") for b in ((10, 10, 40, 40), (60, 50, 110, 80)))
    values, matched, notes = read_masks(picture(Image.fromarray(both)), boxes, decoded(WIDTH, HEIGHT))
    assert values.max() == 2
    assert [b.box for _, b in matched] == [b.box for b in boxes]
    assert "1 mask of several objects" in notes[0]
    other = (boxes[0], LabelledBox(boxes[1].box, "sofa", "sofa"))
    assert read_masks(picture(Image.fromarray(both)), other, decoded(WIDTH, HEIGHT))[0].max() == 1


def test_smoothed_outlines_are_given_to_what_is_beside() -> None:
    import cv2

    soft = cv2.GaussianBlur(RGB, (3, 3), 0)
    hard = found(picture(Image.fromarray(RGB)))
    instances = found(picture(Image.fromarray(soft)))
    assert instances.max() == 2
    assert ((instances == hard).mean()) > 0.97


def test_forms_and_refusals() -> None:
    assert (
        form_of(MASK_FORMS, MaskContent(Source(b"[1]", "m"), "photo.png", (WIDTH, HEIGHT))).name == "segments in JSON"
    )
    for given in (Source(b"[1]", "m.json"), Folder("empty", ())):
        with pytest.raises(InputError, match="no mask"):
            found(given)
    with pytest.raises(InputError, match="different sizes"):
        paint_masks([np.ones((2, 2), bool), np.ones((3, 2), bool)], "m", "masks")


def test_pieces_within_an_object_are_its_own_and_others_are_specks() -> None:
    large = np.zeros((HEIGHT, WIDTH), np.uint8)
    large[10:80, 10:40], large[20:60:4, 42] = 1, 1
    large[10:80, 50:60] = 1  # seen on both sides of what is before it
    expected = large.copy()
    large[85, 115] = 1
    values, _, notes = read_masks(picture(Image.fromarray(large)), (), decoded(WIDTH, HEIGHT))
    np.testing.assert_array_equal(values, expected)
    assert notes == ("1 specks of the masks were dropped",)


def test_only_lists_of_numbers_are_whole_numbers() -> None:
    assert whole_numbers([3, 4.0]) == [3, 4]
    for other in (None, "34", 3, [3, None], [float("nan")]):
        with pytest.raises(ValueError, match=r"."):
            whole_numbers(other)
