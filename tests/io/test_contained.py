"""Names from elsewhere stay in their folder: no way out by paths, links or things that are no files."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from diorama_core.errors import InputError
from diorama_core.io.contained import ContainedFiles, quote


@pytest.fixture
def files(tmp_path: Path) -> ContainedFiles:
    """A folder with a file, a secret beside the folder, and links and other things that lead to it."""
    root = tmp_path / "received"
    (root / "deep").mkdir(parents=True)
    (root / "deep" / "a b.bin").write_bytes(b"inside")
    (tmp_path / "secret.bin").write_bytes(b"secret")
    (root / "link.bin").symlink_to(tmp_path / "secret.bin")
    (root / "round.bin").symlink_to(root / "round.bin")
    (root / "friendly.bin").symlink_to(root / "deep" / "a b.bin")
    (root / "way").symlink_to(tmp_path)
    os.mkfifo(root / "pipe.bin")
    return ContainedFiles(root, InputError)


@pytest.mark.parametrize(
    "name", ["deep/a b.bin", "deep\\a%20b.bin", "./deep/../deep/a b.bin", "nowhere/../deep/a b.bin"]
)
def test_names_within_the_folder_are_read(files: ContainedFiles, name: str) -> None:
    assert files.read(name, 100) == b"inside"


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("../secret.bin", "points outside"),
        ("deep/../../secret.bin", "points outside"),
        ("..%2Fsecret.bin", "points outside"),
        ("..\\secret.bin", "points outside"),
        ("/etc/hostname", "points outside"),
        ("C:\\secret.bin", "points outside"),
        ("file:/etc/hostname", "points outside"),
        ("file:///etc/hostname", "web address"),
        ("link.bin", "behind a link"),
        ("round.bin", "behind a link"),
        ("friendly.bin", "behind a link"),
        ("way/secret.bin", "behind a link"),
        ("pipe.bin", "no regular file"),
        ("deep", "no regular file"),
        ("gone.bin", "is missing"),
        ("deep/a b.bin/more", "is missing"),
        ("x" * 5000, "is missing"),
        ("", "no file name"),
        ("deep/..", "no file name"),
        ("a\0b", "no file name"),
    ],
)
def test_no_name_leads_anywhere_else(files: ContainedFiles, name: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        files.read(name, 100)
    if "\0" not in name:
        assert not files.holds(files.root / name)


def test_a_path_of_the_authors_own_disk_leads_to_the_file_beside(files: ContainedFiles) -> None:
    deep = files.root / "deep"
    assert files.path_or_beside("a b.bin", deep) == deep / "a b.bin"
    assert files.path_or_beside("deep/a b.bin", files.root) == deep / "a b.bin"
    assert files.path_or_beside("C:\\models\\a%20b.bin", deep) == deep / "a b.bin"
    for name, reason in (("/home/them/pipe.bin", "points outside"), ("elsewhere/gone.bin", "is missing")):
        with pytest.raises(InputError, match=reason):
            files.path_or_beside(name, files.root)


def test_a_file_larger_than_asked_for_is_refused(files: ContainedFiles) -> None:
    with pytest.raises(InputError, match="more than"):
        files.read("deep/a b.bin", 3)


def test_a_root_that_is_a_link_was_named_by_a_person(files: ContainedFiles, tmp_path: Path) -> None:
    (tmp_path / "shortcut").symlink_to(files.root)
    assert ContainedFiles(tmp_path / "shortcut", InputError).read("deep/a b.bin", 100) == b"inside"


def test_foreign_names_are_shown_short_and_printable() -> None:
    assert quote("a\x1b[31m\nb") == "'a?[31m?b'"
    assert len(quote("x" * 500)) == 82
