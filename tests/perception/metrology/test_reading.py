"""What holds places and sizes: the box in the photo, the kind's usual size, what is below."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.artefacts import Reason
from diorama_core.library.taxonomy import UNKNOWN, category
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.placement import FLOOR, WALL, Placement
from diorama_core.perception.metrology.problem import Cuboids
from diorama_core.perception.metrology.reading import confidence_of, foot_seen, heading_and_size
from diorama_core.pipeline import codec
from tests.perception.metrology.test_metrology import ROOM, detected, measure, rotation, seen
from tests.perception.metrology.test_problem import problem

SIZE = np.array([0.5, 1.2, 0.8])


def placement(yaw: float, supporter: int = FLOOR, centre=(0.5, 3.0, 0.4), cost: float = 0.0) -> Placement:
    box = Cuboids(np.array([centre], dtype=float), np.array([yaw]), SIZE[None])
    return Placement(0, supporter, problem(), box, cost)


@given(yaw=st.floats(-3.1, 3.1), x=st.floats(-3, 3), y=st.floats(0.5, 5))
def test_fronts_face_the_camera_and_the_cuboid_stays_itself(yaw, x, y) -> None:
    for name in ("sofa", UNKNOWN.name):
        turned, size = heading_and_size(placement(yaw, centre=(x, y, 0.4)), category(name))
        front = np.array([np.cos(turned), np.sin(turned)])
        toward = -np.array([x, y]) / np.hypot(x, y)
        assert front @ toward >= (np.cos(np.pi / 4) if name == UNKNOWN.name else 0.0) - 1e-9
        quarter = round((turned - yaw) / (np.pi / 2))
        assert (turned - yaw) / (np.pi / 2) == pytest.approx(quarter)
        assert size == pytest.approx(SIZE[[1, 0, 2]] if quarter % 2 else SIZE)
        assert name == UNKNOWN.name or quarter % 2 == 0
        assert -np.pi <= turned <= np.pi


def test_what_hangs_on_a_wall_faces_away_from_it() -> None:
    yaw, size = heading_and_size(placement(0.3, WALL), category("picture"))
    assert yaw == 0.3
    np.testing.assert_array_equal(size, SIZE)


def confidence(placed: Placement, box=(100, 100, 200, 300), log_sigma: float = 0.0, **front) -> float:
    items = [detected("o", "sofa", box)] + [detected("f", "chair", b) for b in front.values()]
    return confidence_of(placed, gather(tuple(items), 640, 480), log_sigma)


def test_confidence_falls_with_cost_hidden_edges_and_an_unsure_height() -> None:
    assert confidence(placement(0.0)) == 1.0
    assert confidence(placement(0.0, cost=18.0)) == pytest.approx(np.exp(-1))
    assert confidence(placement(0.0), log_sigma=0.5) == pytest.approx(np.exp(-0.5))
    assert confidence(placement(0.0), box=(0, 100, 200, 480)) == pytest.approx(0.85**2)
    assert confidence(placement(0.0), chair=(90, 250, 210, 400)) == pytest.approx(0.85)
    assert confidence(placement(0.0, cost=1e6)) == 0.02


def test_a_foot_is_seen_unless_the_picture_ends_there_or_others_hide_it() -> None:
    def seen(box, *before, supporter: int = FLOOR) -> bool:
        front = [replace(detected("f", "table", b), mask=_filled(b)) for b in before]
        return foot_seen(placement(0.0, supporter), gather((detected("o", "sofa", box), *front), 640, 480))

    whole, before = (100, 100, 200, 300), (90, 250, 210, 400)
    assert seen(whole)
    assert not seen(whole, before)
    assert seen(whole, (90, 310, 210, 400))
    assert not seen((100, 100, 200, 480))
    # Where it hangs or lies on something its own foot tells nothing.
    assert seen(whole, before, supporter=WALL)


def _filled(box: tuple[int, int, int, int]) -> np.ndarray:
    mask = np.zeros((480, 640), dtype=bool)
    mask[box[1] : box[3], box[0] : box[2]] = True
    return mask


@pytest.fixture(scope="module")
def reasons() -> tuple[Reason, ...]:
    R = rotation(12.0)
    geometry = measure(seen(ROOM, R, 1.5), R)
    assert geometry.reasons is not None
    assert codec.load(codec.dump(geometry)).reasons == geometry.reasons
    return geometry.reasons


def of(reasons: tuple[Reason, ...], object_id: str, decision: str) -> dict[str, Reason]:
    return {r.term: r for r in reasons if r.object_id == object_id and r.decision == decision}


def test_the_photo_places_a_sofa_and_its_kind_gives_its_size(reasons: tuple[Reason, ...]) -> None:
    place = of(reasons, "sofa_0", "place")
    assert place["outline"].amount > 1.0
    assert place["foot"].amount > 1.0
    assert "usual size" not in place, "where it is does not change how large it is"
    size = of(reasons, "sofa_0", "size")
    assert size["outline"].amount > 0.0
    assert size["usual size"].amount > 0.0


def test_a_support_is_told_by_what_is_seen_of_the_foot_and_by_the_kind(reasons: tuple[Reason, ...]) -> None:
    assert of(reasons, "sofa_0", "support")["foot"].sentence.endswith("on the floor")
    assert of(reasons, "lamp_4", "support")["foot"].sentence.endswith("on the night stand")
    assert of(reasons, "picture_6", "support")["kind"].sentence == "its kind hangs on walls"
