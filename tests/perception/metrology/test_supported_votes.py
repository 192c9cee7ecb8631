from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.perception.metrology.box_observations import BoxObservations, gather
from diorama_core.perception.metrology.floor import HEIGHTS_M, scan_heights
from diorama_core.perception.metrology.placement import Placement, place_all
from diorama_core.perception.metrology.problem import View
from diorama_core.perception.metrology.supported_votes import with_votes_of_supported
from tests.perception.metrology.test_metrology import K, RequestedObject, rotation, seen

R = rotation(14.0)
VIEW = View(K, R)
TABLE = RequestedObject("table", (0.2, 2.8, 0.36), (0.85, 1.4, 0.72))
ON_IT = (
    RequestedObject("keyboard", (0.3, 2.65, 0.735), (0.14, 0.44, 0.03)),
    RequestedObject("monitor", (0.2, 2.9, 0.95), (0.2, 0.56, 0.46)),
    RequestedObject("laptop", (-0.25, 2.75, 0.84), (0.24, 0.34, 0.24)),
)


def observed(larger: float, height_m: float = 1.5) -> BoxObservations:
    """A table `larger` times as large as usual with things of usual size on it."""
    table = replace(TABLE, size=tuple(larger * np.array(TABLE.size)), centre=(0.2, 2.8, 0.36 * larger))
    rise = np.array([0.0, 0.0, 0.72 * (larger - 1.0)])
    on_it = tuple(replace(o, centre=tuple(np.array(o.centre) + rise)) for o in ON_IT)
    return gather(seen((table, *on_it), R, height_m), K.width, K.height)


def placed(observations: BoxObservations, height_m: float) -> tuple[Placement, ...]:
    return place_all(observations, VIEW, height_m)


def test_things_on_an_unusually_large_table_mend_the_cameras_height() -> None:
    observations = observed(1.4)
    scan = scan_heights(observations, VIEW)
    voted = with_votes_of_supported(scan, placed(observations, scan.height_m), observations, VIEW)
    off = [abs(np.log(s.height_m / 1.5)) for s in (scan, voted)]
    assert off[1] < off[0] - 0.02


def test_votes_that_agree_make_the_height_surer_and_leave_it() -> None:
    observations = observed(1.0)
    scan = scan_heights(observations, VIEW)
    voted = with_votes_of_supported(scan, placed(observations, scan.height_m), observations, VIEW)
    assert voted.log_sigma < scan.log_sigma
    assert voted.height_m == pytest.approx(1.5, rel=0.08)
    assert voted.costs.shape == HEIGHTS_M.shape
    assert (voted.costs >= scan.costs - 1e-9).all()


def test_where_nothing_stands_on_others_the_scan_stays() -> None:
    observations = gather(seen((TABLE,), R, 1.5), K.width, K.height)
    scan = scan_heights(observations, VIEW)
    assert with_votes_of_supported(scan, placed(observations, scan.height_m), observations, VIEW) is scan
