from __future__ import annotations

import argparse
import sys

import pytest

from diorama_app.cli.api import add_api
from tests.cli.running import refused


def test_what_is_missing_is_named(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "fastapi", None)
    assert "pip install 'diorama[api]'" in refused(capsys, ["api"])


def test_it_listens_on_this_machine_only_by_default() -> None:
    parser = argparse.ArgumentParser()
    add_api(parser.add_subparsers())
    assert parser.parse_args(["api"]).host == "127.0.0.1"
