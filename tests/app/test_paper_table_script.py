"""The script that writes the paper's table says what a machine lacks, and runs one command after the other."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from types import ModuleType

import pytest

from diorama_core.evaluation.benchmarks.system import WAYS

SCRIPT = Path(__file__).parents[2] / "scripts/paper_table.py"


@pytest.fixture
def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("paper_table", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_machine_without_a_card_is_one_clear_line(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(script, "providers", lambda: ["CPUExecutionProvider"])
    assert script.main([]) == 1
    assert "no CUDA card" in capsys.readouterr().err


def test_networks_are_fetched_and_the_table_names_the_machine(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    asked: list[list[str]] = []

    def diorama(words: list[str]) -> int:
        asked.append(words)
        if words[0] == "bench":
            Path(words[words.index("--json") + 1]).write_text(json.dumps({"bench": "system"}))
            Path(words[words.index("--markdown") + 1]).write_text("| table |")
        return 0

    monkeypatch.setattr(script, "cuda_card", lambda: "Card 9")
    monkeypatch.setattr(script, "diorama", diorama)
    monkeypatch.setenv("DIORAMA_MODELS", str(tmp_path / "models"))
    assert script.main(["--scenes", "2", "--out", str(tmp_path / "out"), "--yes"]) == 0
    assert asked[0] == ["models", "pull", "paper", "--yes"]
    assert asked[1][:2] == ["bench", "system"]
    assert "Card 9" in (tmp_path / "out/paper-table.md").read_text()
    assert json.loads((tmp_path / "out/paper-table.json").read_text())["machine"].startswith("Card 9")


def test_the_rows_that_it_asks_for_exist(script: ModuleType) -> None:
    assert set(script.GIVEN.split(",")) <= set(WAYS)
