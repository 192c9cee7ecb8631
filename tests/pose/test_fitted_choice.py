"""Which candidate comes first once all were fitted."""

from __future__ import annotations

import numpy as np

from diorama_core.artefacts import PosedCandidates
from diorama_core.library.catalogue import built_in_library
from diorama_core.pose.details import InnerEdges
from diorama_core.pose.fitted_choice import FittedChoice
from diorama_core.pose.seen_objects import SeenObject
from diorama_core.scene.types import Candidate
from tests.pose.test_turned_profile import as_large, seen

LIBRARY = built_in_library()
CHOICE = FittedChoice(LIBRARY)


def order(true_id: str, ids: tuple[str, ...], outlined: bool = True) -> tuple[str, ...]:
    """The shapes of candidates in the place of a vase, best first, of falling ranks before."""
    evidence, pose = seen(true_id)
    found = (
        Candidate(i, LIBRARY.shape(i).size_m, 0.9 - 0.1 * k, as_large(i, pose, true_id)) for k, i in enumerate(ids)
    )
    k = evidence.camera.intrinsics
    edges = InnerEdges.of(np.full((k.height, k.width, 3), 90, np.uint8), evidence.seen)
    one = SeenObject(evidence, evidence, edges, pose, 5000, 1.0 if outlined else 0.8, "vase")
    out = CHOICE.best_first(PosedCandidates("o", tuple(found), 0.9), one)
    assert all(np.isfinite(c.score) for c in out.candidates)
    return tuple(c.shape_id for c in out.candidates)


def test_a_body_of_revolution_comes_first_where_its_profile_is_that_of_the_picture() -> None:
    ids = ("night-stand-cane", "dresser-white-four", "vase-cylinder-glass")
    assert order("vase-moon-stone", ids) == ("vase-cylinder-glass", "night-stand-cane", "dresser-white-four")


def test_an_outline_that_is_not_sure_tells_no_profile() -> None:
    ids = ("vase-amphora", "vase-cylinder-glass")
    assert order("vase-moon-stone", ids, outlined=False) == ids


def test_what_fits_well_stays_first() -> None:
    assert order("vase-moon-stone", ("vase-moon-stone", "vase-urn-blue"))[0] == "vase-moon-stone"
