from __future__ import annotations

import json

import pytest

from diorama_core.errors import Cancelled
from diorama_core.evaluation.benchmarks import layout
from diorama_core.progress import CancelToken, Progress
from diorama_core.synthesis.layout_rooms import GeneratedRoom, Noise, generate_room


def test_tables_are_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    def small_room(seed: int, count: int, noise: Noise | None = None) -> GeneratedRoom:
        return generate_room(seed, min(count, 10), noise or Noise())

    monkeypatch.setattr(layout, "ROOM", 5)
    monkeypatch.setattr(layout, "generate_room", small_room)
    result = layout.run(scenes=1, seed=3)
    feasible = result.ablation[-1]
    assert feasible.name == "feasible"
    assert feasible.structure == 1.0
    assert feasible.part_overlap_mm < 1.0
    assert [r.name for r in result.ablation][:2] == ["observed", "O"]
    assert json.loads(json.dumps(result.to_json()))["seed"] == 3
    text = result.to_markdown()
    assert text.count("| feasible |") >= 6
    assert "nan" not in text


def test_cancels() -> None:
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        layout.run(scenes=1, progress=Progress(token=token))
