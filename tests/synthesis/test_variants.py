"""Variants of a room are at rest, differ, and follow from their seed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.scene import edits
from diorama_core.scene.schema import scene_to_json
from diorama_core.synthesis.variants import (
    VariantMaker,
    VariantSettings,
    differences,
    lock_restless,
    stability_report,
)
from tests.export.scenes import scene_of

pytest.importorskip("mujoco", reason="MuJoCo is not installed (optional extra 'sim')")


def test_a_seed_gives_one_room_at_rest_and_another_seed_another() -> None:
    scene, library = scene_of("fittings")
    first, again, other = (VariantMaker(scene, library).draw(seed) for seed in (3, 3, 4))
    assert first is not None
    assert again is not None
    assert other is not None
    assert scene_to_json(first.scene) == scene_to_json(again.scene)
    assert scene_to_json(first.scene) != scene_to_json(other.scene)
    assert not stability_report(other.scene, library).unstable
    assert first.max_moved_m < 0.01
    assert dict(first.changes) == differences(scene, first.scene)
    assert {"floor", "light"} <= set(first.changes)


@pytest.mark.parametrize("aspect", ["shapes", "textures", "poses", "light", "clutter"])
def test_only_what_is_asked_for_varies(aspect: str) -> None:
    scene, library = scene_of("fittings")
    variants = [VariantMaker(scene, library, (aspect,)).draw(seed) for seed in range(2)]
    said = {text.split(" ")[0] for v in variants if v for about in v.changes.values() for text in about}
    planes = {p.id for v in variants if v for p in v.scene.architecture.planes if p.id in v.changes}
    assert said
    assert bool(planes) == (aspect == "textures")
    assert ("moved" in said) <= (aspect in ("poses", "shapes"))  # what stands on another shape stands elsewhere
    assert ("added" in said or "removed" in said) <= (aspect == "clutter")
    assert any(t == "shape" for t in said) == (aspect == "shapes")


def test_what_falls_goes_back_to_its_place() -> None:
    """Things thrown about by metres do not stay there; those of the room do."""
    scene, library = scene_of("fittings")
    maker = VariantMaker(scene, library, ("poses",), VariantSettings(turn_rad=0.0, shift_m=0.5))
    lifted = edits.move(scene, "lamp_1", scene.object("lamp_1").pose.move(np.array([0.0, 0.0, 0.4])))
    calmed = maker._calm(lifted, {"lamp_1"})
    np.testing.assert_allclose(calmed.object("lamp_1").pose.position, scene.object("lamp_1").pose.position)
    added = replace(scene.object("lamp_1"), id="extra", pose=lifted.object("lamp_1").pose)
    assert not maker._calm(edits.insert(scene, added), {"extra"}).has_object("extra")


def test_what_does_not_rest_in_the_room_is_locked() -> None:
    scene, library = scene_of("fittings")
    lifted = edits.move(scene, "lamp_1", scene.object("lamp_1").pose.move(np.array([0.0, 0.0, 0.1])))
    calm, locked = lock_restless(lifted, library)
    assert locked == ("lamp_1",)
    assert not stability_report(calm, library).unstable
