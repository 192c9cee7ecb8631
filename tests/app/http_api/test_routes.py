from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("fastapi", reason="needs FastAPI (pip install 'diorama[api]')")

from diorama_app.http_api import answers  # after the check for its library
from diorama_app.http_api.jobs import JobQueue  # after the check for its library
from diorama_app.http_api.open_projects import OpenProjects
from diorama_app.http_api.routes import create_app
from diorama_app.web.visitors import Visitors
from tests.app.small_room import PlainLibrary

DOCS = Path(__file__).parents[3] / "docs" / "api.md"


def test_the_manual_names_every_address(tmp_path: Path) -> None:
    queue, opened = JobQueue(tmp_path, PlainLibrary(), "built-in"), OpenProjects(pytest.fail)
    document = create_app(queue, Visitors("127.0.0.1"), opened).openapi()
    text = DOCS.read_text()
    for path, methods in document["paths"].items():
        for method in methods:
            assert f"| `{method.upper()} {path}` |" in text, f"{method} {path} is not in docs/api.md"


def test_what_a_build_had_to_say_is_told_and_anything_else_is_left_out() -> None:
    assert answers._notes({"notes": ["a", 5]}) == ["a", "5"]
    assert answers._notes({"warnings": ["b"]}) == ["b"]
    assert answers._notes({"notes": "no list"}) == []
