from __future__ import annotations

import json

import pytest

from diorama_app.cli import machine, main
from diorama_app.cli.doctor import add_doctor
from diorama_app.cli.machine import Finding

FOUND = (
    Finding("python", True, "3.12"),
    Finding("open3d", False, "does not load"),
    Finding("browser", False, "none", needed=False),
)


def test_it_is_declared_with_its_options() -> None:
    import argparse

    parser = argparse.ArgumentParser()
    add_doctor(parser.add_subparsers())
    assert parser.parse_args(["doctor", "--json"]).json


def test_what_is_missing_fails_and_is_named(monkeypatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(machine, "examine", lambda: FOUND)
    assert main(["doctor"]) == 1
    captured = capsys.readouterr()
    assert [line[:4] for line in captured.out.splitlines()] == ["ok  ", "FAIL", "none"]
    assert "this machine lacks open3d;" in captured.err
    monkeypatch.setattr(machine, "examine", lambda: (FOUND[0], FOUND[2]))
    assert main(["doctor"]) == 0


def test_findings_as_json(monkeypatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(machine, "examine", lambda: FOUND)
    main(["doctor", "--json"])
    rows = json.loads(capsys.readouterr().out)
    assert rows[1] == {"name": "open3d", "ok": False, "detail": "does not load", "needed": True}
