"""What an object is called tells shapes of one kind apart, and says nothing where it names the kind alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import Shape
from diorama_core.progress import Progress
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval
from diorama_core.retrieval.words import description_share, nouns_of_few, words_factor
from tests.pose.rooms import BlockLibrary, Room, camera_at, standing

LIBRARY = built_in_library()
ARMCHAIRS = LIBRARY.in_category("armchair")


def share(label: str) -> dict[str, float]:
    found = description_share(LIBRARY, label, "armchair", ARMCHAIRS)
    return dict(zip((s.id for s in ARMCHAIRS), found, strict=True))


@pytest.mark.parametrize("label", ["armchair", "armchair 2", "arm chair", "an armchair", "zzyzx armchair", ""])
def test_a_label_that_names_the_kind_says_no_more(label: str) -> None:
    assert set(share(label).values()) == {1.0}


def test_words_fit_some_shapes_and_not_others() -> None:
    leather = share("leather armchair")
    assert leather["armchair-club-leather"] == 1.0
    assert leather["armchair-wicker"] == 0.0
    both = share("green leather armchair 3")
    assert 0.0 < both["armchair-club-leather"] < 1.0
    assert all(0.0 <= v <= 1.0 for v in both.values())


def test_a_name_of_some_of_a_kind_finds_those() -> None:
    wing = share("wing chair")
    assert wing["armchair-wing-blue"] == 1.0 > wing["armchair-sling-black"]


def test_a_synonym_that_names_some_of_a_kind_finds_those() -> None:
    plants = LIBRARY.in_category("plant")
    found = dict(zip((s.id for s in plants), description_share(LIBRARY, "flowers", "plant", plants), strict=True))
    assert found["plant-cut-flowers"] == 1.0
    assert found["plant-orchid"] > found["plant-spider"] == 0.0
    assert set(description_share(LIBRARY, "houseplant", "plant", plants)) == {1.0}
    assert nouns_of_few(LIBRARY, "flowers", "plant") == ("flower",)
    assert nouns_of_few(LIBRARY, "houseplant", "plant") == ()


@pytest.mark.parametrize(
    ("label", "category", "found"),
    [("ball", "toy", "toy-ball"), ("teddy bear", "toy", "toy-teddy"), ("kettlebell 2", "dumbbells", "kettlebell")],
)
def test_a_noun_of_a_few_rules_out_the_others(label: str, category: str, found: str) -> None:
    shapes = LIBRARY.in_category(category)
    factor, share = words_factor(LIBRARY, label, category, shapes)
    named = np.array([found in s.id for s in shapes])
    assert named.any()
    assert set(factor[named]) == {1.0}
    assert factor[~named].max() < 0.2
    np.testing.assert_array_equal(share == 1.0, factor == 1.0)


@pytest.mark.parametrize(
    ("label", "category"), [("light", "floor lamp"), ("cupboard", "cabinet"), ("toy", "toy"), ("cushion", "pillow")]
)
def test_what_is_said_of_many_rules_nothing_out(label: str, category: str) -> None:
    assert nouns_of_few(LIBRARY, label, category) == ()
    assert set(words_factor(LIBRARY, label, category, LIBRARY.in_category(category))[0]) == {1.0}


def test_no_shapes_no_shares() -> None:
    assert description_share(LIBRARY, "leather armchair", "armchair", []).shape == (0,)


def test_between_shapes_that_look_alike_the_word_decides() -> None:
    class Named(BlockLibrary):
        def shape(self, shape_id: str) -> Shape:
            shape = super().shape(shape_id)
            return replace(shape, caption="rounded") if shape_id == "round table" else shape

    library = Named()
    room = Room(camera_at(), (standing("table", 0.0, 3.2, 20.0),), (0,))
    stage = HierarchicalRetrieval(library)
    scores = []
    for label in ("table", "rounded table"):
        objects = tuple(replace(o, label=label) for o in room.objects)
        (found,) = stage.retrieve(room.inputs, objects, room.geometry, Progress())
        scores.append(dict(found.ranked))
    plain, said = scores
    assert said["round table"] == pytest.approx(plain["round table"])
    assert said["table"] < plain["table"]
    assert np.isfinite(list(said.values())).all()
