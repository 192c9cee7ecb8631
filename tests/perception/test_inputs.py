"""Every kind of file that a person can hand in: used, used with a remark, or refused in one clear line."""

from __future__ import annotations

import contextlib
import io
import json
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.perception.inputs import read_inputs

WIDTH, HEIGHT = 96, 64
ORIENTATION = 0x0112


def picture(width: int = WIDTH, height: int = HEIGHT, mode: str = "RGB") -> Image.Image:
    """A gradient to the right in red and downward in green, so that turns and flips show."""
    x, y = np.meshgrid(np.linspace(0, 255, width), np.linspace(0, 255, height))
    return Image.fromarray(np.stack([x, y, 0 * x + 40], axis=-1).astype(np.uint8)).convert(mode)


def encoded(image: Image.Image, fmt: str = "PNG", **options: object) -> bytes:
    stream = io.BytesIO()
    image.save(stream, fmt, **options)
    return stream.getvalue()


def claiming(width: int, height: int) -> bytes:
    """A small PNG whose header promises other dimensions."""
    data = encoded(picture())
    header = data[12:16] + struct.pack(">II", width, height) + data[24:29]
    return data[:12] + header + struct.pack(">I", zlib.crc32(header)) + data[33:]


def boxes_json(*records: object) -> bytes:
    return json.dumps(list(records)).encode()


def box(*bbox: float, word: str = "chair") -> dict[str, object]:
    return {"bbox": list(bbox), "class": word}


def depth_png(values: np.ndarray) -> bytes:
    return encoded(Image.fromarray(values.astype(np.uint16)))


def npy(array: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.save(stream, array)
    return stream.getvalue()


def refusal(*args: object, **kwargs: object) -> str:
    """The one line with which the input is refused."""
    with pytest.raises(InputError) as caught:
        read_inputs(*args, **kwargs)  # type: ignore[arg-type]
    line = str(caught.value)
    assert "\n" not in line
    assert 15 < len(line) < 240
    return line


class TestPhoto:
    @pytest.mark.parametrize("fmt", ["PNG", "JPEG", "WEBP", "BMP", "TIFF", "GIF", "PPM", "JPEG2000"])
    def test_common_formats(self, fmt: str) -> None:
        rgb = read_inputs(encoded(picture(), fmt)).inputs.photo.rgb
        assert rgb.shape == (HEIGHT, WIDTH, 3)
        assert np.abs(rgb.astype(int) - np.asarray(picture())).mean() < 12

    @pytest.mark.parametrize("mode", ["L", "CMYK", "P", "1", "RGBA", "LA", "YCbCr", "HSV", "LAB"])
    def test_modes_become_rgb(self, mode: str) -> None:
        fmt = "TIFF" if mode in ("CMYK", "LAB", "YCbCr") else "PNG"
        source = picture().convert(mode) if mode not in ("HSV", "LAB") else picture()
        rgb = read_inputs(encoded(source, fmt)).inputs.photo.rgb
        assert rgb.dtype == np.uint8
        assert rgb.shape == (HEIGHT, WIDTH, 3)

    def test_cmyk_jpeg(self) -> None:
        rgb = read_inputs(encoded(picture(mode="CMYK"), "JPEG")).inputs.photo.rgb
        assert np.abs(rgb.astype(int) - np.asarray(picture())).mean() < 12

    def test_sixteen_bits_of_grey_keep_their_tones(self) -> None:
        ramp = np.linspace(0, 65535, WIDTH)[None].repeat(HEIGHT, 0).astype(np.uint16)
        rgb = read_inputs(depth_png(ramp)).inputs.photo.rgb
        assert rgb[0, 0, 0] == 0
        assert rgb[0, -1, 0] == 255
        assert (np.diff(rgb[0, :, 0].astype(int)) >= 0).all()

    def test_transparent_is_laid_on_white_and_said(self) -> None:
        image = picture(mode="RGBA")
        image.putalpha(0)
        read = read_inputs(encoded(image))
        assert (read.inputs.photo.rgb == 255).all()
        assert any("transparent" in w for w in read.warnings)

    @pytest.mark.parametrize("orientation", range(1, 9))
    def test_turned_upright_by_its_header(self, orientation: int) -> None:
        upright = picture()
        stored = {
            2: Image.Transpose.FLIP_LEFT_RIGHT,
            3: Image.Transpose.ROTATE_180,
            4: Image.Transpose.FLIP_TOP_BOTTOM,
            5: Image.Transpose.TRANSPOSE,
            6: Image.Transpose.ROTATE_90,
            7: Image.Transpose.TRANSVERSE,
            8: Image.Transpose.ROTATE_270,
        }
        image = upright if orientation == 1 else upright.transpose(stored[orientation])
        exif = Image.Exif()
        exif[ORIENTATION] = orientation
        data = encoded(image, "PNG", exif=exif)
        read = read_inputs(data, boxes=boxes_json(box(80, 2, 94, 60)))
        np.testing.assert_array_equal(read.inputs.photo.rgb, np.asarray(upright))
        assert read.inputs.photo.original_size == (WIDTH, HEIGHT)
        assert read.inputs.boxes[0].box == (80, 2, 94, 60)

    def test_large_photos_are_reduced_with_everything_on_them(self) -> None:
        read = read_inputs(
            encoded(picture(3200, 2000), "JPEG"),
            boxes=boxes_json(box(400, 200, 800, 1000)),
            intrinsics=(2400.0, 2400.0, 1600.0, 1000.0),
            max_side=1600,
        )
        photo, camera = read.inputs.photo, read.inputs.intrinsics
        assert (photo.width, photo.height, photo.original_size) == (1600, 1000, (3200, 2000))
        assert read.inputs.boxes[0].box == (200, 100, 400, 500)
        assert camera is not None
        assert (camera.width, camera.fx, camera.cx, camera.cy) == (1600, 1200, 800, 500)
        assert any("reduced" in w for w in read.warnings)

    def test_name_is_the_files_name_or_the_given_one(self, tmp_path: Path) -> None:
        path = tmp_path / "kitchen.png"
        path.write_bytes(encoded(picture()))
        assert read_inputs(path).inputs.photo.name == "kitchen.png"
        assert read_inputs(path.read_bytes(), name="hall.png").inputs.photo.name == "hall.png"

    def test_a_large_file_that_decodes_is_used(self) -> None:
        padded = encoded(picture(), "JPEG") + b"\0" * 50_000_000
        assert read_inputs(padded).inputs.photo.width == WIDTH

    @pytest.mark.parametrize(
        ("data", "word"),
        [
            (b"", "0 bytes"),
            (b"hello, this is no picture at all", "not a picture"),
            (b"<svg xmlns='http://www.w3.org/2000/svg'/>", "SVG"),
            (b"<?xml version='1.0'?><svg/>", "SVG"),
            (b"\0\0\0\x18ftypheic\0\0\0\0mif1heic", "HEIC"),
            (b"%PDF-1.7 ...", "PDF"),
            (b"<!DOCTYPE html><html>", "web page"),
            (encoded(picture())[:150], "truncated"),
            (encoded(picture(400, 300), "JPEG")[:2500], "truncated"),
            (encoded(picture(1, 1)), "1 x 1"),
            (encoded(picture(400, 33)), "strip"),
        ],
    )
    def test_refused_in_one_line(self, data: bytes, word: str) -> None:
        assert word in refusal(data)

    def test_refuses_enormous_pictures_before_decoding(self) -> None:
        for width, height in ((20000, 20000), (12000, 11000)):
            assert "megapixels" in refusal(claiming(width, height))

    def test_refuses_enormous_files_before_reading(self, tmp_path: Path) -> None:
        path = tmp_path / "huge.jpg"
        with path.open("wb") as file:
            file.truncate(300_000_000)
        assert "MB" in refusal(path)

    def test_missing_file_and_folder(self, tmp_path: Path) -> None:
        assert "cannot be read" in refusal(tmp_path / "nothing.jpg")
        assert "folder" in refusal(tmp_path)

    @settings(max_examples=60, deadline=None)
    @given(st.data())
    def test_damaged_bytes_never_escape_as_another_error(self, data: st.DataObject) -> None:
        fmt = data.draw(st.sampled_from(["PNG", "JPEG", "GIF", "TIFF", "WEBP", "BMP"]))
        good = bytearray(encoded(picture(), fmt))
        for _ in range(data.draw(st.integers(1, 6))):
            good[data.draw(st.integers(0, len(good) - 1))] = data.draw(st.integers(0, 255))
        damaged = bytes(good[: data.draw(st.integers(1, len(good)))])
        with contextlib.suppress(InputError):
            assert read_inputs(damaged).inputs.photo.rgb.dtype == np.uint8


class TestHeader:
    def focal(self, width: int = 400, height: int = 300, **tags: object) -> float | None:
        exif = Image.Exif()
        names = {"f35": 0xA405, "mm": 0x920A, "res": 0xA20E, "unit": 0xA210, "px": 0xA002, "py": 0xA003}
        directory = exif.get_ifd(0x8769)
        for key, value in tags.items():
            directory[names[key]] = value
        return read_inputs(encoded(picture(width, height), "JPEG", exif=exif)).inputs.photo.exif_focal_px

    def test_full_frame_equivalent(self) -> None:
        focal = self.focal(f35=26)
        assert focal == pytest.approx(26 / np.hypot(36, 24) * 500, rel=1e-6)

    def test_millimetres_and_sensor_pitch(self) -> None:
        # 4 mm behind a sensor of 400 pixels per 5 mm
        assert self.focal(mm=4.0, res=800.0, unit=3, px=400, py=300) == pytest.approx(320, rel=1e-3)

    @pytest.mark.parametrize("tags", [{"f35": 0}, {"f35": 9000}, {"mm": 4.0}, {"f35": 26, "px": 4000, "py": 2000}])
    def test_implausible_or_cropped_is_not_trusted(self, tags: dict[str, object]) -> None:
        assert self.focal(**tags) is None

    def test_reduced_with_the_photo(self) -> None:
        whole = self.focal(2000, 1500, f35=26)
        exif = Image.Exif()
        exif.get_ifd(0x8769)[0xA405] = 26
        half = read_inputs(encoded(picture(2000, 1500), "JPEG", exif=exif), max_side=1000).inputs.photo.exif_focal_px
        assert whole is not None
        assert half is not None
        # 1600 is the default limit
        assert half / 1000 == pytest.approx(whole / 1600)


class TestIntrinsics:
    def test_field_of_view(self) -> None:
        camera = read_inputs(encoded(picture()), fov_deg=90.0).inputs.intrinsics
        assert camera is not None
        assert camera.fx == pytest.approx(WIDTH / 2)
        assert camera.horizontal_fov_rad == pytest.approx(np.pi / 2)

    @pytest.mark.parametrize(
        "given",
        [(0.0, 50.0, 48.0, 32.0), (float("nan"), 50.0, 48.0, 32.0), (50.0, 50.0, 480.0, 32.0), (5e4, 5e4, 48.0, 32.0)],
    )
    def test_refused(self, given: tuple[float, float, float, float]) -> None:
        assert "--intrinsics" in refusal(encoded(picture()), intrinsics=given)

    def test_refuses_two_statements_and_odd_angles(self) -> None:
        assert "one of them" in refusal(encoded(picture()), intrinsics=(80, 80, 48, 32), fov_deg=60.0)
        assert "--fov" in refusal(encoded(picture()), fov_deg=190.0)


class TestDepth:
    photo = encoded(picture())

    def read(self, data: bytes, **options: object) -> np.ndarray:
        depth = read_inputs(self.photo, depth=data, **options).inputs.depth_m  # type: ignore[arg-type]
        assert depth is not None
        assert depth.dtype == np.float32
        assert depth.shape == (HEIGHT, WIDTH)
        return depth

    def test_millimetres_and_other_units(self) -> None:
        values = np.full((HEIGHT, WIDTH), 2500)
        values[0, 0] = 0
        depth = self.read(depth_png(values))
        assert depth[0, 0] == 0
        assert depth[5, 5] == pytest.approx(2.5)
        assert self.read(depth_png(values), depth_scale=5000.0)[5, 5] == pytest.approx(0.5)

    def test_metres_with_everything_that_means_missing(self) -> None:
        values = np.full((HEIGHT, WIDTH), 3.0)
        values[0, :5] = [np.nan, np.inf, -np.inf, -1.0, 0.0]
        depth = self.read(npy(values))
        assert (depth[0, :5] == 0).all()
        assert (depth[1] == 3).all()

    @pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
    def test_float_sizes(self, dtype: type) -> None:
        assert self.read(npy(np.full((HEIGHT, WIDTH, 1), 1.5, dtype)))[0, 0] == 1.5

    def test_exr_in_metres(self) -> None:
        photo = encoded(picture(24 * 4, 20 * 4))
        depth = read_inputs(photo, depth=Path(__file__).parent / "exr" / "zip.exr").inputs.depth_m
        assert depth is not None
        assert (depth[2, 2], depth[-2, 2]) == (1.0, 2.0)

    def test_a_renderers_sky_is_missing(self) -> None:
        values = np.full((HEIGHT, WIDTH), 1e10, np.float32)
        values[: HEIGHT // 3] = 3.0
        assert set(np.unique(self.read(npy(values)))) == {0.0, 3.0}

    def test_other_size_is_met_by_nearest_values(self) -> None:
        values = np.where(np.arange(WIDTH * 2) < WIDTH, 1000, 3000)[None].repeat(HEIGHT * 2, 0)
        depth = self.read(depth_png(values))
        assert set(np.unique(depth)) == {1.0, 3.0}
        assert (depth[:, : WIDTH // 2] == 1).all()

    def test_other_proportions_are_refused(self) -> None:
        square = depth_png(np.full((HEIGHT, HEIGHT), 1000))
        assert "64 x 64" in refusal(self.photo, depth=square)
        lying = depth_png(np.full((WIDTH, HEIGHT), 1000))
        assert "upright" in refusal(self.photo, depth=lying)

    def test_rotated_bits_are_recognised_but_not_guessed(self) -> None:
        millimetres = np.full((HEIGHT, WIDTH), 2659, dtype=np.uint16)
        rotated = (millimetres << 3) | (millimetres >> 13)
        assert "--depth-encoding sunrgbd" in refusal(self.photo, depth=depth_png(rotated))
        depth = self.read(depth_png(rotated), depth_encoding="sunrgbd")
        np.testing.assert_allclose(depth, 2.659, rtol=1e-6)

    @pytest.mark.parametrize(
        ("data", "word"),
        [
            (b"", "0 bytes"),
            (b"not depth", "not a picture"),
            (encoded(picture()), "16 bits"),
            (encoded(picture(mode="L")), "16 bits"),
            (depth_png(np.zeros((HEIGHT, WIDTH))), "empty"),
            (npy(np.full((HEIGHT, WIDTH), np.nan)), "empty"),
            (npy(np.full((HEIGHT, WIDTH), 2500.0)), "metres"),
            (npy(np.full((HEIGHT, WIDTH), 2500)), "metres"),
            (npy(np.full((HEIGHT, WIDTH, 3), 2.5)), "two-dimensional"),
            (npy(np.full((HEIGHT, WIDTH), 2.5))[:500], "truncated"),
            (npy(np.array([{"a": 1}], dtype=object)), "metres"),
            (depth_png(np.full((HEIGHT, WIDTH), 20)), "--depth-scale"),
            (depth_png(np.full((HEIGHT, WIDTH), 1500))[:60], "damaged"),
            (b"\x76\x2f\x31\x01" + b"\0" * 64, "EXR"),
            (b"\x76\x2f\x31\x01\x02\x02\0\0", "damaged"),
            ((Path(__file__).parent / "exr" / "piz.exr").read_bytes()[:200], "damaged"),
        ],
    )
    def test_refused_in_one_line(self, data: bytes, word: str) -> None:
        assert word in refusal(self.photo, depth=data)

    def test_a_header_that_promises_too_much_allocates_nothing(self) -> None:
        header = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000, 1000000), }"
        data = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header
        assert "1000000 megapixels" in refusal(self.photo, depth=data)
        data = data.replace(b"(1000000, 1000000), ", b"(1000000, 30), 0000 ".replace(b"0000", b"    "))
        assert "truncated" in refusal(self.photo, depth=data)

    def test_scale_must_be_positive(self) -> None:
        assert "--depth-scale" in refusal(self.photo, depth=npy(np.ones((HEIGHT, WIDTH))), depth_scale=0.0)

    def test_sparse_depth_is_used_with_a_remark(self) -> None:
        values = np.zeros((HEIGHT, WIDTH))
        values[:6] = 2.0
        assert any("measured" in w for w in read_inputs(self.photo, depth=npy(values)).warnings)


class TestBoxes:
    photo = encoded(picture())

    def test_classes_are_understood_and_words_retained(self) -> None:
        given = boxes_json(
            box(1, 1, 20, 20, word="night_stand"),
            box(1, 1, 20, 20, word="couches"),
            box(1, 1, 20, 20, word="void"),
            box(1, 1, 20, 20, word="zorgblatt"),
        )
        read = read_inputs(self.photo, boxes=given)
        assert [b.category for b in read.inputs.boxes] == ["night stand", "sofa", "object", "object"]
        assert [b.label for b in read.inputs.boxes] == ["night stand", "couches", "object", "zorgblatt"]
        assert any("zorgblatt" in w for w in read.warnings)

    def test_the_room_itself_is_no_object(self) -> None:
        read = read_inputs(self.photo, boxes=boxes_json(box(1, 1, 20, 20, word="Wall"), box(1, 1, 20, 20)))
        assert len(read.inputs.boxes) == 1
        assert any("Wall" in w for w in read.warnings)

    def test_partly_outside_is_clipped_and_said(self) -> None:
        read = read_inputs(self.photo, boxes=boxes_json(box(-30, 10, 40, 200)))
        assert read.inputs.boxes[0].box == (0, 10, 40, HEIGHT)
        assert any("clipped" in w for w in read.warnings)

    def test_a_pixel_over_the_edge_is_not_worth_a_word(self) -> None:
        assert read_inputs(self.photo, boxes=boxes_json(box(0, 0, WIDTH + 1, 20))).warnings == ()

    @pytest.mark.parametrize(
        ("data", "word"),
        [
            (boxes_json(box(1, 1, 20, 20), box(200, 10, 300, 40)), "box 1"),
            (boxes_json(box(20, 1, 5, 20)), "box 0"),
            (boxes_json(box(5, 5, 5, 5)), "no area"),
            (b"[{", "not valid JSON"),
            (b"", "0 bytes"),
            (b"\xff\xfe\x00", "no text"),
            (b'{"bbox": [1, 2, 3, 4]}', "list"),
            (boxes_json({"bbox": [1, 2, 3]}), "entry 0"),
            (boxes_json({"bbox": [1, 2, 3, "x"]}), "entry 0"),
            (boxes_json({"class": "chair"}), "entry 0"),
            (b'[{"bbox": [NaN, 1, 20, 20]}]', "NaN is no number"),
            (b'[{"bbox": [1e999, 1, 20, 20]}]', "too large"),
            (b'[{"bbox": [1e30, 1, 20, 20]}]', "entry 0"),
            (b'[{"bbox": [1, 1, 20, 20], "class": "\\ud800"}]', "no text"),
            (b"[" * 100_000, "nested"),
            (b"[" + b"1," * 3_000_000 + b"1]", "more than 500 boxes take"),
            (b'[{"bbox": [1, 1, 20, 20], "class": 7}]', "entry 0"),
            (boxes_json(*[box(1, 1, 20, 20)] * 501), "501"),
        ],
    )
    def test_refused_in_one_line(self, data: bytes, word: str) -> None:
        assert word in refusal(self.photo, boxes=data)

    def test_words_cannot_break_a_line(self) -> None:
        read = read_inputs(self.photo, boxes=boxes_json(box(1, 1, 20, 20, word="  big\n\tred\x00 chair ")))
        assert read.inputs.boxes[0].label == "big red chair"

    @given(st.lists(st.floats(-500, 500), min_size=4, max_size=4))
    def test_every_box_is_inside_or_refused(self, bbox: list[float]) -> None:
        try:
            boxes = read_inputs(self.photo, boxes=boxes_json(box(*bbox))).inputs.boxes
        except InputError:
            return
        x1, y1, x2, y2 = boxes[0].box
        assert 0 <= x1 < x2 <= WIDTH
        assert 0 <= y1 < y2 <= HEIGHT


class TestMasks:
    photo = encoded(picture())

    def colours(self, *, speck: bool = False) -> Image.Image:
        pixels = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
        pixels[10:50, 5:60] = (200, 30, 30)
        pixels[20:30, 20:35] = (30, 200, 30)
        if speck:
            pixels[60, 90] = (1, 2, 3)
            pixels[2, 2] = (200, 30, 30)
        return Image.fromarray(pixels)

    def test_colours_are_numbered_from_the_top_left(self) -> None:
        inputs = read_inputs(self.photo, masks=encoded(self.colours())).inputs
        assert inputs.instances is not None
        assert inputs.instances[12, 10] == 1
        assert inputs.instances[25, 25] == 2
        assert inputs.instances[0, 0] == 0
        assert [(k, b.category) for k, b in inputs.instance_boxes] == [(1, "object"), (2, "object")]
        assert inputs.instance_boxes[1][1].box == (20, 20, 35, 30)

    def test_ids_palettes_and_colours_agree(self) -> None:
        ids = np.zeros((HEIGHT, WIDTH), np.uint8)
        ids[10:50, 5:60], ids[20:30, 20:35] = 7, 9
        palette = Image.fromarray(ids)
        palette.putpalette([*range(256)] * 3)
        expected = read_inputs(self.photo, masks=encoded(self.colours())).inputs.instances
        for image in (Image.fromarray(ids), palette, Image.fromarray(ids.astype(np.uint16) * 257)):
            np.testing.assert_array_equal(read_inputs(self.photo, masks=encoded(image)).inputs.instances, expected)

    def test_class_of_the_box_that_fits_best(self) -> None:
        given = boxes_json(box(20, 19, 36, 31, word="pillow"), box(4, 9, 61, 51, word="sofa"))
        inputs = read_inputs(self.photo, masks=encoded(self.colours()), boxes=given).inputs
        assert [(k, b.category) for k, b in inputs.instance_boxes] == [(1, "sofa"), (2, "pillow")]
        assert inputs.instance_boxes[0][1] is inputs.boxes[1]

    def test_two_masks_of_one_box_keep_their_own_extents(self) -> None:
        inputs = read_inputs(
            self.photo, masks=encoded(self.colours()), boxes=boxes_json(box(4, 9, 61, 51, word="sofa"))
        ).inputs
        assert [b.category for _, b in inputs.instance_boxes] == ["sofa", "sofa"]
        assert inputs.instance_boxes[0][1].box == (4, 9, 61, 51)
        assert inputs.instance_boxes[1][1].box == (20, 20, 35, 30)

    def test_specks_are_dropped_and_said(self) -> None:
        read = read_inputs(self.photo, masks=encoded(self.colours(speck=True)))
        clean = read_inputs(self.photo, masks=encoded(self.colours()))
        np.testing.assert_array_equal(read.inputs.instances, clean.inputs.instances)
        assert any("specks" in w for w in read.warnings)

    def test_reduced_with_the_photo(self) -> None:
        large = encoded(picture(WIDTH * 4, HEIGHT * 4))
        mask = encoded(self.colours().resize((WIDTH * 4, HEIGHT * 4), Image.Resampling.NEAREST))
        small = read_inputs(large, masks=mask, max_side=WIDTH).inputs.instances
        expected = read_inputs(self.photo, masks=encoded(self.colours())).inputs.instances
        np.testing.assert_array_equal(small, expected)

    @pytest.mark.parametrize(
        ("data", "word"),
        [
            (encoded(Image.new("RGB", (WIDTH, HEIGHT))), "no object"),
            (encoded(picture()), "instance mask"),
            (encoded(picture(), "JPEG"), "PNG"),
            (encoded(picture(64, 64)), "64 x 64"),
            (b"nothing", "not a picture"),
        ],
    )
    def test_refused_in_one_line(self, data: bytes, word: str) -> None:
        assert word in refusal(self.photo, masks=data)


def test_every_shared_photo_is_read_with_all_that_came_with_it(photos: list) -> None:
    assert len(photos) == 21
    for entry in photos:
        inputs = entry.inputs
        assert (entry.depth is None) == (inputs.depth_m is None)
        if entry.boxes:
            assert len(inputs.boxes) == len(json.loads(entry.boxes.read_text()))
        if entry.masks:
            assert 3 <= len(inputs.instance_boxes) <= 9


def test_the_corridors_depth_needs_its_encoding(photos: list) -> None:
    corridor = next(p for p in photos if p.id == "sunrgbd_corridor")
    assert "sunrgbd" in refusal(corridor.path, depth=corridor.depth)
