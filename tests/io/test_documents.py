from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from diorama_core.errors import DioramaError, ProjectError
from diorama_core.io.bounded import read_json
from diorama_core.io.documents import write_document, write_json
from tests.io.test_text import ANY_TEXT

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
