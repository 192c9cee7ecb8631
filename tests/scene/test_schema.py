from __future__ import annotations

import json

import pytest
from hypothesis import given, settings

from diorama_core.errors import SceneError
from diorama_core.scene.schema import VERSION, scene_from_json, scene_to_json
from diorama_core.scene.types import Scene
from tests.scene.strategies import scenes


@given(scenes())
def test_a_scene_survives_the_file_exactly(scene: Scene) -> None:
    assert scene_from_json(scene_to_json(scene)) == scene


@settings(max_examples=20)
@given(scenes())
def test_the_file_is_deterministic_and_states_its_conventions(scene: Scene) -> None:
    text = scene_to_json(scene)
    document = json.loads(text)
    assert scene_to_json(scene_from_json(text)) == text
    assert all(any(json.dumps(o) in line for line in text.splitlines()) for o in document["objects"])
    assert (document["format"], document["version"], document["units"]) == ("diorama-scene", VERSION, "metres")
    assert document["axes"]["world_up"] == "+Z"


@settings(max_examples=20)
@given(scenes())
def test_scenes_from_before_the_photos_look_still_load(scene: Scene) -> None:
    document = json.loads(scene_to_json(scene))
    del document["light"]
    for item in document["objects"]:
        del item["photo_materials"], item["material_source"]
    found = scene_from_json(json.dumps(document))
    assert found.light is None
    assert [o.id for o in found.objects] == [o.id for o in scene.objects]
    assert all(o.photo_materials == () for o in found.objects)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.update(format="something"), "not a scene file"),
        (lambda d: d.update(version=VERSION + 1), "update Diorama"),
        (lambda d: d.pop("version"), "no version"),
        (lambda d: d.update(version=-3), "no longer be read"),
        (lambda d: d.update(objects=[{"id": "x"}]), r"objects\.0"),
        (lambda d: d.update(units="feet"), "units"),
        (lambda d: d["architecture"].update(planes=[{}]), r"architecture\.planes\.0"),
    ],
)
def test_a_wrong_file_is_refused_in_one_line(change: object, message: str) -> None:
    document = json.loads(scene_to_json(Scene()))
    change(document)
    with pytest.raises(SceneError, match=message) as caught:
        scene_from_json(json.dumps(document))
    assert "\n" not in str(caught.value)


def test_text_that_is_not_json_is_refused() -> None:
    with pytest.raises(SceneError, match="not valid JSON"):
        scene_from_json("{")


def test_an_older_version_is_migrated_step_by_step() -> None:
    document = json.loads(scene_to_json(Scene()))
    document["version"] = VERSION - 1
    document["unit"] = document.pop("units")

    def upgrade(old: dict) -> dict:
        old["units"] = old.pop("unit")
        return old

    assert scene_from_json(json.dumps(document), migrations={VERSION - 1: upgrade}) == Scene()


def test_two_supporters_or_repeated_ids_are_refused() -> None:
    from tests.scene.test_edits import _stack

    document = json.loads(scene_to_json(_stack()))
    document["objects"][1]["id"] = "table_1"
    with pytest.raises(SceneError, match="unique"):
        scene_from_json(json.dumps(document))
    document = json.loads(scene_to_json(_stack()))
    document["objects"][0]["support"]["parent"] = "cup_1"
    with pytest.raises(SceneError, match="already holds up"):
        scene_from_json(json.dumps(document))
