"""Photos that are more than a picture: camera raw, panoramas, frames, few bits, HEIC, turned ones."""

from __future__ import annotations

import io
import struct

import cv2
import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import InputError, SphericalPhotoError
from diorama_core.perception.inputs import read_inputs
from diorama_core.perception.inputs.photos.decoding import eight_bits, raw_kind
from diorama_core.perception.inputs.photos.frame import PhotoFrame, plain_borders
from diorama_core.perception.inputs.photos.reading import PHOTO_FORMS, check_perspective
from diorama_core.perception.inputs.source import Source, form_of
from tests.perception.inputs.files import box, boxes_json, depth_png, encoded, npy

WIDTH, HEIGHT = 160, 120
NOISE = np.random.default_rng(5).integers(60, 200, (HEIGHT, WIDTH, 3)).astype(np.uint8)


def notes_of(data: bytes, **more) -> str:
    return " | ".join(read_inputs(data, **more).warnings)


@pytest.mark.parametrize("colour", [(255, 255, 255), (0, 0, 0), (30, 60, 120)])
@pytest.mark.parametrize("margins", [(10, 10, 10, 30), (0, 20, 0, 20), (12, 0, 12, 0), (8, 5, 6, 4)])
def test_frames_and_letterboxes_of_any_colour_are_found(colour, margins) -> None:
    left, top, right, bottom = margins
    framed = np.empty((HEIGHT + top + bottom, WIDTH + left + right, 3), np.uint8)
    framed[:] = colour
    framed[top : top + HEIGHT, left : left + WIDTH] = NOISE
    assert plain_borders(framed) == margins


def test_what_is_no_frame_stays() -> None:
    gradient = np.linspace(0, 255, WIDTH).astype(np.uint8)[None, :, None] * np.ones((HEIGHT, 1, 3), np.uint8)
    plain = np.full((HEIGHT, WIDTH, 3), 255, np.uint8)
    alone = plain.copy()
    alone[40:80, 50:60] = alone[50:70, 30:90] = 0  # a thing before a plain background
    for rgb in (NOISE, gradient, plain, alone):
        assert plain_borders(rgb) is None


def test_everything_given_moves_with_the_cut_frame() -> None:
    framed = np.full((HEIGHT + 40, WIDTH + 20, 3), 255, np.uint8)
    framed[10 : 10 + HEIGHT, 10 : 10 + WIDTH] = NOISE
    depth = np.full((HEIGHT + 40, WIDTH + 20), 2000)
    depth[10 : 10 + HEIGHT, 10 : 10 + WIDTH] = 3000
    ids = np.zeros((HEIGHT + 40, WIDTH + 20), np.uint8)
    ids[30:60, 40:90] = 1
    inputs = read_inputs(
        encoded(Image.fromarray(framed)),
        boxes=boxes_json(box(40, 30, 90, 60)),
        depth=depth_png(depth),
        masks=encoded(Image.fromarray(ids)),
        intrinsics=(150.0, 150.0, 90.0, 70.0),
    ).inputs
    np.testing.assert_array_equal(inputs.photo.rgb, NOISE)
    assert inputs.photo.offset == (10, 10)
    assert inputs.boxes[0].box == (30, 20, 80, 50)
    assert (inputs.depth_m == 3.0).all()
    assert inputs.instances[20:50, 30:80].all()
    assert (inputs.intrinsics.cx, inputs.intrinsics.cy) == (80.0, 60.0)


@pytest.mark.parametrize("bits", [8, 10, 12, 14])
def test_few_bits_are_stretched(bits: int) -> None:
    full = (1 << bits) - 1
    values = np.linspace(0, full, WIDTH).astype(np.uint16)[None].repeat(HEIGHT, 0)
    photo = read_inputs(encoded(Image.fromarray(values)))
    assert photo.inputs.photo.rgb.max() == 255
    assert photo.inputs.photo.rgb.mean() == pytest.approx(127.5, abs=1.5)
    assert f"use {bits} of 16 bits" in photo.warnings[0]


def test_dark_colours_of_sixteen_bits_keep_what_is_transparent() -> None:
    values = np.full((HEIGHT, WIDTH, 4), 60, np.uint16)
    values[:, : WIDTH // 2, 3] = 0
    values[:, WIDTH // 2 :, 3] = 65535
    data = cv2.imencode(".png", values)[1].tobytes()
    photo = read_inputs(data).inputs.photo
    assert photo.rgb[:, : WIDTH // 2].min() == 255


def test_sixteen_bits_are_divided() -> None:
    eight, notes = eight_bits(np.array([[0, 65535, 30000]], np.uint16))
    assert eight.tolist() == [[0, 255, 116]]
    assert notes == ()


def test_a_black_photo_is_remarked() -> None:
    assert "nearly black" in notes_of(encoded(Image.fromarray(NOISE // 30)))


def raw_file(thumbnail: Image.Image, photo: Image.Image) -> bytes:
    """A TIFF with a thumbnail first and the photo in a SubIFD, as DNG has them."""
    pixels = [np.asarray(thumbnail).tobytes(), np.asarray(photo).tobytes()]
    sizes = [thumbnail.size, photo.size]
    first, second = 8, 8 + 2 + 12 * 10 + 4
    data = second + 2 + 12 * 8 + 4

    def directory(k: int, at: int, more: list[tuple[int, int, int]]) -> bytes:
        width, height = sizes[k]
        entries = [(254, 4, 1 - k), (256, 4, width), (257, 4, height), (258, 3, 8), (259, 3, 1), (262, 3, 2)]
        entries += [(273, 4, at), (277, 3, 3), *more]
        packed = b"".join(struct.pack("<HHI", t, kind, 1) + struct.pack("<I", v) for t, kind, v in sorted(entries))
        return struct.pack("<H", len(entries)) + packed + struct.pack("<I", 0)

    head = b"II*\0" + struct.pack("<I", first)
    version = struct.unpack("<I", bytes([1, 4, 0, 0]))[0]
    one = directory(0, data, [(330, 4, second), (50706, 4, version)])
    two = directory(1, data + len(pixels[0]), [])
    return head + one + two + pixels[0] + pixels[1]


def test_the_largest_picture_of_a_raw_file_is_the_photo() -> None:
    photo = Image.fromarray(np.tile(NOISE, (10, 10, 1)))
    data = raw_file(Image.fromarray(NOISE[::4, ::4].copy()), photo)
    assert raw_kind(data) == "DNG"
    read = read_inputs(data, name="a.dng")
    assert read.inputs.photo.original_size == photo.size
    assert "camera's raw file (DNG)" in read.warnings[0]
    assert raw_kind(encoded(Image.fromarray(NOISE), "TIFF")) is None
    assert raw_kind(b"II*\0") is None
    assert form_of(PHOTO_FORMS, Source(data, "a")).name.startswith("camera raw")
    assert form_of(PHOTO_FORMS, Source(encoded(Image.fromarray(NOISE)), "a")).name.startswith("JPEG")


def test_heic_is_read() -> None:
    pillow_heif = pytest.importorskip("pillow_heif")
    pillow_heif.register_heif_opener()
    stream = io.BytesIO()
    Image.fromarray(np.full((HEIGHT, WIDTH, 3), 120, np.uint8)).save(stream, "HEIF")
    assert read_inputs(stream.getvalue()).inputs.photo.original_size == (WIDTH, HEIGHT)


def panorama(width: int, height: int) -> Image.Image:
    """A closed picture whose upper and lower ends have one colour, as a sphere's have."""
    x, y = np.meshgrid(np.arange(width) / width, np.arange(height) / height)
    grey = 128 + 90 * np.sin(6 * np.pi * x) * np.sin(np.pi * y)
    return Image.fromarray(np.stack([grey] * 3, axis=-1).astype(np.uint8))


def test_spheres_and_sweeps_are_refused_and_long_crops_remarked() -> None:
    stated = panorama(400, 200)
    stated.info["xmp"] = b'<x GPano:ProjectionType="equirectangular"/>'
    for picture in (stated, panorama(400, 200)):
        with pytest.raises(InputError, match="360 degree"):
            check_perspective("p", picture, {}, has_focal=False)
    long = Image.fromarray(np.tile(NOISE, (1, 2, 1))[: HEIGHT - 10])
    with pytest.raises(InputError, match="sweep panorama"):
        check_perspective("p", long, {}, has_focal=True)
    assert "shape of a panorama" in check_perspective("p", long, {}, has_focal=False)[0]
    assert check_perspective("p", Image.fromarray(NOISE), {}, has_focal=True) == ()
    assert check_perspective("p", Image.fromarray(NOISE[:80]), {}, has_focal=False) == ()


def test_a_sphere_is_read_whole_where_one_is_asked_for() -> None:
    black = panorama(400, 200)
    black.paste((0, 0, 0), (0, 180, 400, 200))  # the tripod is often covered
    assert read_inputs(encoded(black), sphere=True).inputs.photo.original_size == (400, 200)
    with pytest.raises(SphericalPhotoError):
        read_inputs(encoded(black))
    assert read_inputs(encoded(panorama(400, 200)), flat=True).inputs.photo.original_size == (400, 200)
    for no_sphere, why in (
        (Image.fromarray(NOISE), "2 : 1"),
        (panorama(400, 200).crop((0, 0, 200, 100)), "do not meet"),
    ):
        with pytest.raises(InputError, match=why):
            read_inputs(encoded(no_sphere), sphere=True)


@pytest.mark.parametrize("orientation", range(1, 9))
def test_maps_of_unturned_pixels_are_turned(orientation: int) -> None:
    exif = Image.Exif()
    exif[0x0112] = orientation
    data = encoded(Image.fromarray(NOISE), "PNG", exif=exif)
    upright = read_inputs(data).inputs.photo.rgb
    frame = PhotoFrame((upright.shape[1], upright.shape[0]), orientation=orientation)
    np.testing.assert_array_equal(frame.upright(NOISE), upright)
    if orientation >= 5:
        stored = np.linspace(2, 3, HEIGHT * WIDTH).reshape(HEIGHT, WIDTH).astype(np.float32)
        read = read_inputs(data, depth=npy(stored), depth_kind="depth", depth_scale=1.0)
        np.testing.assert_array_equal(read.inputs.depth_m, frame.upright(stored))
        assert any(f"orientation {orientation}" in note for note in read.warnings)
