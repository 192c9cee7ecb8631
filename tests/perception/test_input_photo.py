"""Decoding photos. What people hand in is in `test_inputs`; here each step by itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.perception import input_photo
from diorama_core.perception.input_photo import Source, load_pixels, open_picture, read_photo, read_source
from tests.perception.test_inputs import claiming, encoded, picture


def photo(image: Image.Image, fmt: str = "PNG", max_side: int = 1000, **options):
    return read_photo(Source(encoded(image, fmt, **options), "room.png"), max_side)


def test_paths_and_uploads_are_called_by_name(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(b"abc")
    assert read_source(tmp_path / "a.png", "photo") == Source(b"abc", "a.png")
    assert read_source(b"abc", "depth") == Source(b"abc", "the uploaded depth")
    assert read_source(b"abc", "depth", "d.npy").name == "d.npy"


def test_missing_empty_and_huge_files_are_refused_by_name(tmp_path: Path, monkeypatch) -> None:
    (tmp_path / "empty.png").touch()
    monkeypatch.setattr(input_photo, "MAX_FILE_MB", 0.001)
    for given, reason in (
        (tmp_path / "gone.png", "cannot be read"),
        (tmp_path, "is a folder"),
        (tmp_path / "empty.png", "is empty"),
        (b"x" * 1001, "is more than"),
    ):
        with pytest.raises(InputError, match=reason):
            read_source(given, "photo")


def test_a_picture_is_judged_by_its_header_before_it_is_decoded() -> None:
    with pytest.raises(InputError, match="megapixels"):
        open_picture(Source(claiming(20_000, 20_000), "bomb.png"))
    opened = open_picture(Source(encoded(picture())[:200], "cut.png"))
    with pytest.raises(InputError, match="truncated or damaged"):
        load_pixels(opened, Source(b"", "cut.png"))


@pytest.mark.parametrize(
    ("data", "what"),
    [
        (b"\0\0\0\x18ftypheic" + b"\0" * 20, "HEIC"),
        (b"\0\0\0\x18ftypmp42" + b"\0" * 20, "video"),
        (b"<?xml version='1.0'?><svg xmlns='x'/>", "SVG"),
        (b"%PDF-1.4", "PDF"),
        (b"<!DOCTYPE html>", "web page"),
        (b"\x76\x2f\x31\x01rest", "EXR"),
        (b"hello", "not a picture"),
    ],
)
def test_what_is_no_picture_is_called_by_its_kind(data: bytes, what: str) -> None:
    with pytest.raises(InputError, match=what):
        open_picture(Source(data, "room"))


def test_large_photos_are_reduced_and_their_focal_length_with_them() -> None:
    image = picture(400, 300)
    exif = Image.Exif()
    exif[0xA405] = 36
    found, notes = photo(image, "JPEG", 100, exif=exif)
    assert found.rgb.shape == (75, 100, 3)
    assert found.original_size == (400, 300)
    assert notes == ("the photo was reduced from 400 x 300 to 100 x 75 pixels",)
    whole, _ = photo(image, "JPEG", 1000, exif=exif)
    assert found.exif_focal_px == pytest.approx(whole.exif_focal_px / 4)
    assert not found.rgb.flags.writeable


@pytest.mark.parametrize("mode", ["L", "P", "CMYK", "1", "LA", "RGBA", "I;16"])
def test_every_mode_becomes_rgb(mode: str) -> None:
    made = picture(mode="L").convert("I;16") if mode == "I;16" else picture(mode=mode)
    found, _ = photo(made, "TIFF")
    assert found.rgb.dtype == np.uint8
    assert found.rgb.shape == (64, 96, 3)


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


@pytest.mark.parametrize(("size", "reason"), [((20, 200), "too few"), ((900, 100), "a strip")])
def test_shapes_that_are_no_photo_are_refused(size, reason) -> None:
    with pytest.raises(InputError, match=reason):
        photo(picture(*size))
