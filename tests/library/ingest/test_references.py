from __future__ import annotations

import io
from pathlib import Path

import pytest
from PIL import Image

from diorama_core.errors import LibraryError
from diorama_core.library.ingest.limits import Limits
from diorama_core.library.ingest.references import GuardedResolver, References, image_problem, read_bytes


def picture(side: int = 8, kind: str = "PNG") -> bytes:
    buffer = io.BytesIO()
    Image.new("RGB", (side, side), (200, 30, 40)).save(buffer, kind)
    return buffer.getvalue()


@pytest.fixture
def references(tmp_path: Path) -> References:
    """A model two folders down; a secret outside the folder that was named."""
    folder = tmp_path / "named" / "lamp"
    (folder / "maps").mkdir(parents=True)
    (folder / "maps" / "a b.bin").write_bytes(b"below")
    (tmp_path / "named" / "shared.bin").write_bytes(b"above")
    (folder / "wood.bin").write_bytes(b"beside")
    (tmp_path / "secret.bin").write_bytes(b"secret")
    return References(folder, tmp_path / "named", Limits())


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("maps/a b.bin", b"below"),
        ("maps%5Ca%20b.bin", b"below"),
        ("..\\shared.bin", b"above"),
        ("wood.bin", b"beside"),
        ("C:\\Users\\me\\wood.bin", b"beside"),
        ("/home/me/wood.bin", b"beside"),
        ("old/place/wood.bin", b"beside"),
    ],
)
def test_names_are_found_below_above_and_beside(references: References, name: str, content: bytes) -> None:
    assert references.read(name) == content


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("../../secret.bin", "points outside the folder"),
        ("/etc/hostname", "points outside the folder"),
        ("https://example.org/wood.bin", "is a web address"),
        ("gone.bin", "is missing"),
        ("maps/..", "is no file name"),
        ("a\0b", "is no file name"),
        ("", "is no file name"),
    ],
)
def test_nothing_outside_is_read(references: References, name: str, reason: str) -> None:
    with pytest.raises(LibraryError, match=reason):
        references.read(name)


def test_links_and_circles_of_links_lead_nowhere(references: References, tmp_path: Path) -> None:
    (references.folder / "way_out.bin").symlink_to(tmp_path / "secret.bin")
    (references.folder / "round.bin").symlink_to(references.folder / "round.bin")
    for name in ("way_out.bin", "round.bin"):
        with pytest.raises(LibraryError):
            references.read(name)


def test_a_picture_that_is_missing_or_broken_is_left_out_and_said_once(references: References) -> None:
    (references.folder / "broken.png").write_bytes(b"\x89PNG nothing")
    (references.folder / "good.png").write_bytes(picture())
    assert references.image("good.png") == picture()
    assert references.image("gone.png") is references.image("gone.png") is references.image("broken.png") is None
    assert references.warnings == [
        "texture left out: 'gone.png' is missing",
        "texture left out: 'broken.png' is no picture that can be read (UnidentifiedImageError)",
    ]


def test_large_pictures_are_told_from_their_header() -> None:
    assert image_problem(picture(8), Limits(image_pixels=64)) == ""
    assert image_problem(picture(9), Limits(image_pixels=64)) == "would unpack to 9 x 9 pixels"
    assert image_problem(picture(8, "PPM"), Limits()).startswith("is no picture that can be read")


def test_files_over_the_limit_are_not_read(tmp_path: Path) -> None:
    (tmp_path / "large.bin").write_bytes(b"x" * 100)
    assert len(read_bytes(tmp_path / "large.bin", Limits(file_bytes=100))) == 100
    with pytest.raises(LibraryError, match=r"large\.bin has"):
        read_bytes(tmp_path / "large.bin", Limits(file_bytes=99))
    with pytest.raises(LibraryError, match=r"gone\.bin cannot be read"):
        read_bytes(tmp_path / "gone.bin", Limits())


def test_loaders_get_files_through_the_same_door(references: References) -> None:
    resolver = GuardedResolver(references)
    assert resolver.get(b"wood.bin") == b"beside"
    assert resolver.namespaced("x").get("maps/a b.bin") == b"below"
    for name in ("../../secret.bin", "gone.png"):
        with pytest.raises(KeyError):
            resolver.get(name)
    assert [w.split(":")[0] for w in references.warnings] == ["left out", "texture left out"]
    with pytest.raises(NotImplementedError):
        resolver.write("wood.bin", b"")
