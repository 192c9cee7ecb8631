"""What company kinds keep."""

from __future__ import annotations

from diorama_core.library.company import CARRIED, ROOMS, often_carried
from diorama_core.library.taxonomy import CATEGORIES, category

NAMES = {c.name for c in CATEGORIES}


def test_tables_name_kinds_of_the_taxonomy() -> None:
    assert set().union(*ROOMS.values()) <= NAMES
    for row in CARRIED:
        assert row.carriers <= NAMES
        assert set(row.kinds) <= NAMES
        assert min(row.kinds.values()) > 0


def test_a_kind_is_a_carrier_once() -> None:
    carriers = [name for row in CARRIED for name in row.carriers]
    assert len(carriers) == len(set(carriers))


def test_what_lies_on_objects_is_small_or_hangs_nowhere() -> None:
    lying = {kind for row in CARRIED for kind in row.kinds}
    assert {category(kind).mount for kind in lying} <= {"surface", "floor", "wall"}
    assert sum(category(kind).mount == "surface" for kind in lying) > 0.8 * len(lying)


def test_how_often_kinds_lie_on_carriers() -> None:
    assert often_carried("keyboard", "desk") > often_carried("keyboard", "table") > often_carried("wardrobe", "table")
    assert often_carried("vase", "night stand") > 1 > often_carried("vase", "bed")
    assert often_carried("heater", "bed") > often_carried("sofa", "bed")
    assert often_carried("vase", "door") == often_carried("object", "bed") == 1.0
