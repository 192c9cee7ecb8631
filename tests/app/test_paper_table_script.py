"""The script that writes the paper's table says what a machine lacks, and runs to its end, here on tiny networks."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
import torch

from diorama_core.artefacts import Inputs
from diorama_core.evaluation.benchmarks import system
from diorama_core.evaluation.benchmarks.system import WAYS
from diorama_core.models.store import ModelStore
from diorama_core.synthesis.truth import TruthView
from scripts import paper_table as script
from tests.few_marked import few_marked
from tests.few_shapes import few_shapes
from tests.models import tiny_networks, tiny_sams


def test_a_machine_without_a_card_is_one_clear_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(script, "providers", lambda: ["CPUExecutionProvider"])
    assert script.main([]) == 1
    assert "no CUDA card" in capsys.readouterr().err


def test_networks_are_fetched_and_the_table_names_the_machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
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


def test_the_rows_that_it_asks_for_exist() -> None:
    assert set(script.GIVEN.split(",")) <= set(WAYS)


class _Moge(torch.nn.Module):
    """MoGe-2's signature; whatever the picture, it shows a floor 1.4 m below and a wall 4 m ahead."""

    def forward(self, image: torch.Tensor, num_tokens: torch.Tensor) -> tuple[torch.Tensor, ...]:
        height, width = image.shape[2], image.shape[3]
        x = (torch.arange(width) + 0.5 - width / 2) / (0.9 * width)
        y = (torch.arange(height) + 0.5 - height / 2) / (0.9 * width)
        nothing = 0.0 * image.mean(dim=1) + 0.0 * num_tokens.float()
        rays = torch.stack([x[None, None, :] + nothing, y[None, :, None] + nothing, 1.0 + nothing], dim=-1)
        floor = 1.4 / rays[..., 1:2].clamp(min=1e-3)
        on_floor = (floor < 4.0).float()
        down, toward = torch.tensor([0.0, -1.0, 0.0]), torch.tensor([0.0, 0.0, -1.0])
        normals = on_floor * down + (1.0 - on_floor) * toward
        return rays * floor.clamp(max=4.0), normals, 1.0 + nothing, torch.ones(1) + 0.0 * nothing.sum()


MARKED = ("sofa", "coffee table", "picture", "cup")
"""Of the trial's room: one thing on the floor that is large and one before it, one at a wall and one on another."""


def few_of(view: TruthView) -> Inputs:
    """True masks of few things."""
    inputs = system.masks_only(view)
    return few_marked(inputs, [b.box for _, b in inputs.instance_boxes if b.category in MARKED])


@pytest.mark.slow
@pytest.mark.unchecked
def test_a_trial_on_a_processor_runs_to_its_end(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("DIORAMA_MODELS", str(tmp_path / "models"))
    for name in ("DIORAMA_LMM_BASE_URL", "DIORAMA_LMM_MODEL"):
        monkeypatch.delenv(name, raising=False)
    store, folder = ModelStore.default(), tmp_path / "graphs"
    names = ["points", "normal", "mask", "metric_scale"]
    any_size = {name: {k: "h", k + 1: "w"} for name, k in (("image", 2), ("points", 1), ("normal", 1), ("mask", 1))}
    moge = (torch.zeros(1, 3, 60, 80), torch.tensor(1800))
    graph = tiny_networks.export(_Moge(), moge, folder / "m.onnx", ["image", "num_tokens"], names, any_size)
    tiny_networks.install(store, "moge-2-vits", [graph])
    tiny_networks.install(store, "slimsam", tiny_sams.slimsam(folder)[1:])
    tiny_networks.install(store, "migan", [tiny_networks.migan(folder / "p.onnx")])
    parts = system.split_library
    monkeypatch.setattr(system, "split_library", lambda whole, *of: few_shapes() if len(of) > 1 else parts(whole, *of))
    monkeypatch.setattr(system, "WAYS", {**WAYS, "published": replace(WAYS["published"], inputs=few_of)})
    rows = "published"  # without patch features, which see forty views of every shape
    assert script.main(["--cpu", "--scenes", "1", "--seeds", "0", "--given", rows, "--out", str(tmp_path)]) == 0
    told = json.loads((tmp_path / "paper-table.json").read_text())
    assert told["machine"].startswith("no card, a trial")
    assert set(told["cases"]) == {WAYS[row].name for row in rows.split(",")}
    for name, cases in told["cases"].items():
        assert [case["failure"] for case in cases] == [""], name
    assert "no card" in (tmp_path / "paper-table.md").read_text()
