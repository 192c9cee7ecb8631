"""What the manifest says of networks."""

from __future__ import annotations

from diorama_core.models.manifest import NETWORKS, half_precision_networks, network, networks_of


def test_a_side_is_a_whole_number_of_patches() -> None:
    sides = {n.id: n.side for n in NETWORKS if n.side is not None}
    assert sides == {"owlv2-large": 1008}
    assert sides["owlv2-large"] % 14 == 0, "as its repository's name says: patch14"


def test_files_in_half_precision_stand_for_the_full_ones() -> None:
    halves = [n for n in NETWORKS if n.half_of]
    assert "owlv2-base-fp16" in [n.id for n in halves]
    for half in halves:
        full = network(half.half_of)
        assert all(getattr(half, name) == getattr(full, name) for name in ("role", "repo", "revision", "licence"))
        assert half.size_bytes < full.size_bytes
        assert not half.tiers, "sets name the full ones"
    ids = [n.id for n in half_precision_networks(networks_of("default"))]
    assert {"owlv2-base-fp16", "sam2.1-base-plus-fp16", "moge-2-vitb"} <= set(ids)
    assert not {"owlv2-base", "sam2.1-base-plus"} & set(ids)


def test_a_network_under_a_licence_of_its_own_is_pulled_by_name_only() -> None:
    """All others may be used by anybody for anything."""
    permissive = {"Apache-2.0", "MIT", "BSD-2-Clause"}
    own = [n for n in NETWORKS if n.licence not in permissive]
    assert [n.id for n in own] == ["sam3-tracker"]
    assert all(not n.tiers and n.pullable for n in own)
