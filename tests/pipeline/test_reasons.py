"""Every object of a build has reasons, which are saved with it, come back, and say who named it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from diorama_core.arrangement.explain import strongest
from diorama_core.pipeline.run import Built
from diorama_core.project.build import build_project
from diorama_core.project.reasons import load_reasons
from diorama_core.project.storage import Project
from tests.pipeline.test_plan import LIBRARY, room_inputs


@pytest.fixture(scope="module", params=[False, True], ids=["photo", "depth"])
def built(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Built, Project]]:
    folder = tmp_path_factory.mktemp("reasons")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("DIORAMA_MODELS", str(folder / "models"))
        patch.delenv("DIORAMA_LMM_BASE_URL", raising=False)
        project = Project.create(folder / "room")
        yield build_project(project, room_inputs(depth=request.param), LIBRARY), project


def test_every_object_has_reasons_for_its_kind_place_and_support(built: tuple[Built, Project]) -> None:
    room, project = built
    by_decision = {item.id: {r.decision for r in room.reasons if r.object_id == item.id} for item in room.scene.objects}
    assert all({"kind", "place", "support"} <= decisions for decisions in by_decision.values()), by_decision
    chair = next(item for item in room.scene.objects if item.category == "chair")
    (word,) = [r for r in room.reasons if r.object_id == chair.id and r.term == "word"]
    assert word.sentence == "named “chair” by you"
    assert word.amount > 3.0
    assert len(strongest(room.reasons, chair.id)) == 2
    kept, damage = load_reasons(project)
    assert not damage
    assert {(r.object_id, r.decision, r.term) for r in kept} == {
        (r.object_id, r.decision, r.term) for r in room.reasons
    }
    measured = room.inputs.depth_m is not None
    assert any(r.term == "depth" for r in room.reasons) == measured
    assert any(r.term == "graph" for r in room.reasons) == measured
    assert any(r.term == "outline" for r in room.reasons) != measured
