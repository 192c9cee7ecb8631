from __future__ import annotations

import json
from pathlib import Path

import onnxruntime
import pytest

from diorama_app.cli import machine, main
from diorama_app.cli.machine import Finding, add_doctor, examine


@pytest.fixture
def findings(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    """What is found with only a few packages looked for."""
    monkeypatch.setenv("DIORAMA_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(machine, "PACKAGES", {"numpy": "numpy", "nobody-has-this": "nobody_has_this"})
    monkeypatch.setattr(machine, "OPTIONAL_PACKAGES", {"nor-this": "nor_this"})
    return lambda: {f.name: f for f in examine()}


def test_packages_are_present_or_named_with_the_reason(findings) -> None:
    import numpy

    found = findings()
    assert (found["numpy"].ok, found["numpy"].detail) == (True, numpy.__version__)
    assert not found["nobody-has-this"].ok
    assert found["nobody-has-this"].needed
    assert "does not load" in found["nobody-has-this"].detail
    assert (found["nor-this"].ok, found["nor-this"].needed) == (False, False)


def test_the_library_and_the_cache_are_looked_at(findings, tmp_path: Path) -> None:
    found = findings()
    assert found["shape library"].ok
    assert "categories" in found["shape library"].detail
    assert found["cache folder"].ok
    assert (tmp_path / "cache").is_dir()


def test_a_cache_folder_that_cannot_be_written_says_what_to_do(findings, tmp_path: Path, monkeypatch) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("DIORAMA_CACHE", str(tmp_path / "file" / "cache"))
    found = findings()["cache folder"]
    assert not found.ok
    assert "set DIORAMA_CACHE" in found.detail


def test_without_accelerator_or_browser_it_still_runs(findings, monkeypatch) -> None:
    monkeypatch.setattr(machine.shutil, "which", lambda name: None)
    found = findings()
    assert (found["browser"].ok, found["browser"].needed) == (False, False)
    assert not found["accelerator"].needed


@pytest.mark.parametrize(
    ("offered", "card", "words"),
    [
        (["CUDAExecutionProvider", "CPUExecutionProvider"], True, "cuda for networks"),
        (["DmlExecutionProvider", "CPUExecutionProvider"], False, "directml for networks"),
        (["CoreMLExecutionProvider", "CPUExecutionProvider"], False, "coreml for networks"),
        (["CPUExecutionProvider"], True, "pip install 'diorama[gpu]'"),
        (["CPUExecutionProvider"], False, "networks run on the processor; optional"),
    ],
    ids=["CUDA", "DirectML", "CoreML", "a card that onnxruntime does not use", "no card"],
)
def test_the_accelerator_is_what_onnxruntime_offers(
    findings, monkeypatch: pytest.MonkeyPatch, offered: list[str], card: bool, words: str
) -> None:
    monkeypatch.setattr(onnxruntime, "get_available_providers", lambda: offered)
    monkeypatch.setattr(machine.shutil, "which", lambda name: "/usr/bin/nvidia-smi" if card else None)
    found = findings()["accelerator"]
    assert words in found.detail
    assert found.ok is (len(offered) > 1)


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
