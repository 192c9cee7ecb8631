"""A file is the old one or the new one, whatever fails."""

from __future__ import annotations

import errno
import os
import stat
import time
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from diorama_core.errors import DioramaError, ProjectError
from diorama_core.io.atomic import open_atomically, remove_leftovers, write_atomically, write_document, write_json
from diorama_core.io.bounded import read_json
from tests.io.test_text import ANY_TEXT


def no_space(*_: Any, **__: Any) -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(contents=st.lists(st.binary(max_size=2000), min_size=1, max_size=4), name=st.sampled_from(["a", "ä b.json"]))
def test_the_last_written_content_is_there_and_nothing_else(tmp_path: Path, contents: list[bytes], name: str) -> None:
    path = tmp_path / "new" / "folder" / name
    for content in contents:
        write_atomically(path, content)
    assert path.read_bytes() == contents[-1]
    assert {p.name for p in path.parent.iterdir()} <= {"a", "ä b.json"}


def test_a_name_as_long_as_the_file_system_allows_can_be_written(tmp_path: Path) -> None:
    path = tmp_path / ("n" * 255)
    write_atomically(path, b"x")
    assert path.read_bytes() == b"x"


def test_streams_may_seek_and_appear_only_when_closed(tmp_path: Path) -> None:
    path = tmp_path / "big"
    write_atomically(path, b"old")
    with open_atomically(path) as stream:
        stream.write(b"0" * 100_000)
        stream.seek(0)
        stream.write(b"1")
        stream.flush()
        assert path.read_bytes() == b"old"
    assert path.read_bytes() == b"1" + b"0" * 99_999


@pytest.mark.parametrize("umask", [0o022, 0o077, 0o002])
def test_the_mode_is_what_the_umask_says(tmp_path: Path, umask: int) -> None:
    private = tmp_path / "file"
    private.touch(0o600)
    before = os.umask(umask)
    try:
        write_atomically(private, b"")
    finally:
        os.umask(before)
    assert stat.S_IMODE(private.stat().st_mode) == 0o666 & ~umask


@pytest.mark.parametrize("call", ["fsync", "replace", "open"])
def test_a_full_disk_keeps_the_old_file_and_leaves_no_part(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    path = tmp_path / "scene.json"
    write_atomically(path, b"old")
    with monkeypatch.context() as broken:
        broken.setattr(os, call, no_space)
        with pytest.raises(OSError, match="No space left"):
            write_atomically(path, b"new")
        with pytest.raises(ProjectError, match=r"cannot write .*\(No space left on device\); .* folder"):
            write_atomically(path, b"new", error=ProjectError)
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["scene.json"]


@pytest.mark.parametrize("failure", [KeyboardInterrupt, ValueError, GeneratorExit])
def test_an_interrupted_writer_keeps_the_old_file_and_leaves_no_part(
    tmp_path: Path, failure: type[BaseException]
) -> None:
    path = tmp_path / "scene.json"
    write_atomically(path, b"old")

    def interrupted() -> None:
        with open_atomically(path, error=ProjectError) as stream:
            stream.write(b"half of")
            raise failure

    with pytest.raises(failure):
        interrupted()
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["scene.json"]


def test_what_was_written_reaches_the_disk_before_the_name_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[str] = []
    sync, move = os.fsync, os.replace
    monkeypatch.setattr(os, "fsync", lambda fd: (calls.append(f"sync {os.fstat(fd).st_size}"), sync(fd)))
    monkeypatch.setattr(os, "replace", lambda a, b: (calls.append("rename"), move(a, b)))
    write_atomically(tmp_path / "file", b"12345")
    assert calls == ["sync 5", "rename"]


def test_a_folder_that_is_a_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file")
    with pytest.raises(ProjectError, match=r"cannot write in .*taken .*choose a folder"):
        write_atomically(tmp_path / "taken" / "scene.json", b"", error=ProjectError)
    with pytest.raises(OSError, match="taken"):
        write_atomically(tmp_path / "taken" / "scene.json", b"")
    assert (tmp_path / "taken").read_text() == "a file"


def test_a_folder_in_the_way_of_the_file_is_an_error_and_stays(tmp_path: Path) -> None:
    (tmp_path / "scene.json" / "inside").mkdir(parents=True)
    with pytest.raises(ProjectError, match="cannot write"):
        write_atomically(tmp_path / "scene.json", b"", error=ProjectError)
    assert [p.name for p in tmp_path.iterdir()] == ["scene.json"]


def test_parts_that_killed_programs_left_are_removed_when_they_are_old(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "stages").mkdir()
    for name in (".old.part", "stages/.old.part", ".young.part", "old.part", ".old"):
        (tmp_path / name).write_bytes(b"half")
        os.utime(tmp_path / name, (1000.0, 1060.0 if "young" in name else 1000.0))
    monkeypatch.setattr(time, "time", lambda: 1120.0)
    assert remove_leftovers(tmp_path, 60.0) == 2
    assert {p.name for p in tmp_path.iterdir()} == {"stages", ".young.part", "old.part", ".old"}
    assert remove_leftovers(tmp_path, 60.0) == 0


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | ANY_TEXT,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(ANY_TEXT, inner, max_size=3),
    max_leaves=8,
)


@given(VALUES)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_whatever_is_written_can_be_read_or_the_older_file_stays(tmp_path: Path, value: object) -> None:
    path = tmp_path / "a.json"
    write_json(path, "older", ProjectError)
    refused = False
    try:
        write_json(path, value, ProjectError, most=2000)
    except ProjectError:
        refused = True
    known = read_json(path, ProjectError, most=2000)
    assert not refused or known == "older"
    assert [p.name for p in tmp_path.iterdir()] == ["a.json"]


def test_a_document_that_its_reader_refuses_replaces_nothing(tmp_path: Path) -> None:
    def read(data: bytes) -> object:
        raise DioramaError("it is not the time")

    path = tmp_path / "a"
    path.write_bytes(b"older")
    with pytest.raises(ProjectError, match=r"a stays as it was.*it is not the time"):
        write_document(path, b"newer", read, ProjectError)
    with pytest.raises(ProjectError, match="more than the"):
        write_document(path, b"newer", lambda data: None, ProjectError, most=4)
    assert path.read_bytes() == b"older"
    write_document(path, b"newer", lambda data: None, ProjectError, most=5)
    assert path.read_bytes() == b"newer"


def test_what_contains_itself_replaces_nothing(tmp_path: Path) -> None:
    path, endless = tmp_path / "a.json", []
    write_json(path, "older", ProjectError)
    endless.append(endless)
    with pytest.raises(ProjectError, match=r"a\.json stays as it was: a value cannot be written"):
        write_json(path, endless, ProjectError)
    assert read_json(path, ProjectError) == "older"
