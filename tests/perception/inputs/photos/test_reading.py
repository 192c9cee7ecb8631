"""Decoding photos: each step by itself, then whole files as people hand them in."""

from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.perception.inputs import read_inputs
from diorama_core.perception.inputs.photos.reading import read_photo
from diorama_core.perception.inputs.source import Source
from tests.perception.inputs.files import HEIGHT, WIDTH, box, boxes_json, claiming, depth_png, encoded, picture, refusal

ORIENTATION = 0x0112


def photo(image: Image.Image):
    read = read_photo(Source(encoded(image), "room.png"), 1000)
    return read.photo, read.notes


def test_transparency_is_laid_on_white_and_said() -> None:
    rgba = picture(mode="RGBA")
    clear = np.array(rgba)
    clear[:, :48, 3] = 0
    found, notes = photo(Image.fromarray(clear))
    assert (found.rgb[:, :48] == 255).all()
    assert "laid on white" in notes[0]
    opaque, silent = photo(rgba)
    assert silent == ()
    np.testing.assert_array_equal(opaque.rgb, np.array(rgba)[..., :3])


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
        assert (camera.width, camera.fx, camera.cx, camera.cy) == (1600, 1200, 800, 500)
        assert read.warnings == ("the photo was reduced from 3200 x 2000 to 1600 x 1000 pixels",)
        assert not photo.rgb.flags.writeable

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
            (b"", "the uploaded photo: the file is empty (0 bytes)"),
            (b"hello, this is no picture at all", "not a picture"),
            (b"\0\0\0\x18ftypmp42" + b"\0" * 20, "video"),
            (b"\x76\x2f\x31\x01rest", "EXR"),
            (b"<svg xmlns='http://www.w3.org/2000/svg'/>", "SVG"),
            (b"<?xml version='1.0'?><svg/>", "SVG"),
            (b"\0\0\0\x18ftypheic\0\0\0\0mif1heic", "HEIC"),
            (b"%PDF-1.7 ...", "PDF"),
            (b"<!DOCTYPE html><html>", "web page"),
            (encoded(picture())[:150], "truncated"),
            (encoded(picture(400, 300), "JPEG")[:2500], "truncated"),
            (encoded(picture(20, 200)), "20 x 200 pixels are too few"),
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
        assert "is a folder" in refusal(tmp_path)

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
        # 1600 is the default limit
        assert half / 1000 == pytest.approx(whole / 1600)
