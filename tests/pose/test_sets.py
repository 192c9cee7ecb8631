"""Things of a kind agree on their shape. Things of one set share their scale."""

from __future__ import annotations

import numpy as np

from diorama_core.pose.sets import equalise_scales, mix_ranks

ANY = float("inf")


def best(ranks: dict[str, float]) -> str:
    return max(ranks, key=lambda key: ranks[key])


def test_a_badly_seen_chair_follows_the_well_seen_ones() -> None:
    clear = {"a": 0.0, "b": -0.8}
    doubtful = {"a": -0.1, "b": 0.0}
    agreed = mix_ranks(["chair"] * 3, [clear, clear, doubtful], [0.9, 0.9, 0.2], [ANY] * 3)
    assert [best(r) for r in agreed] == ["a", "a", "a"]


def test_between_shapes_that_are_as_good_a_set_takes_the_same() -> None:
    chairs = [{"a": 0.0, "b": -0.2}, {"a": 0.0, "b": -0.2}, {"a": -0.3, "b": 0.0}, {"a": 0.0, "b": -0.05}]
    trust = [0.4, 0.4, 0.9, 0.3]
    agreed = mix_ranks(["chair"] * 4, chairs, trust, [ANY] * 4)
    assert {best(r) for r in agreed} == {"b"}
    apart = mix_ranks(["chair"] * 2, [{"a": 0.0, "b": -2.0}, {"a": -2.0, "b": 0.0}], [0.5, 0.45], [1.0] * 2)
    assert [best(r) for r in apart] == ["a", "b"]  # measured depth says that they differ


def test_other_kinds_unnamed_objects_and_other_choices_stand_alone() -> None:
    a, b = {"a": 0.0, "b": -1.0}, {"a": -1.0, "b": 0.0}
    for categories in (["chair", "stool"], ["object", "object"]):
        assert [best(r) for r in mix_ranks(categories, [a, b], [1.0, 0.1], [ANY] * 2)] == ["a", "b"]
    far = {"c": 0.0, "d": -0.2, "a": -0.1}
    assert best(mix_ranks(["chair", "chair"], [a, far], [1.0, 0.1], [ANY] * 2)[1]) == "c"


def test_one_alone_keeps_its_order() -> None:
    (ranks,) = mix_ranks(["sofa"], [{"a": -2.0, "b": -1.0, "c": -3.0}], [0.0], [ANY])
    assert sorted(ranks, key=lambda key: -ranks[key]) == ["b", "a", "c"]
    assert ranks["b"] == 0.0


def test_clear_evidence_of_depth_is_not_overruled_and_pictures_are_no_set() -> None:
    a, almost, other = {"a": 0.0, "b": -4.0}, {"a": -0.4, "b": 0.0}, {"a": -2.0, "b": 0.0}
    agreed = mix_ranks(["chair"] * 3, [a, almost, other], [1.0] * 3, [1.0] * 3)
    assert [best(r) for r in agreed] == ["a", "a", "b"]
    pictures = mix_ranks(["picture"] * 2, [a, almost], [1.0] * 2, [1.0] * 2)
    assert [best(r) for r in pictures] == ["a", "b"]


def test_the_well_seen_ones_tell_the_size() -> None:
    scales = np.array([[1.0, 1.0, 1.0], [1.02, 1.0, 1.0], [0.85, 0.9, 1.1]])
    shared = equalise_scales(["chair"] * 3, ["a"] * 3, scales, [0.9, 0.8, 0.1])
    assert np.allclose(shared, shared[0])
    assert np.allclose(shared[0], [1.0, 1.0, 1.0])


def test_other_shapes_other_kinds_and_other_sizes_keep_their_own() -> None:
    scales = np.array([[1.0, 1.0, 1.0], [1.2, 1.2, 1.2]])
    assert np.array_equal(equalise_scales(["chair"] * 2, ["a", "b"], scales, [1.0, 1.0]), scales)
    assert np.array_equal(equalise_scales(["books"] * 2, ["a", "a"], scales, [1.0, 1.0]), scales)
    far = np.array([[1.0, 1.0, 1.0], [1.0, 1.0, 1.9]])
    assert np.array_equal(equalise_scales(["chair"] * 2, ["a", "a"], far, [1.0, 0.5]), far)
