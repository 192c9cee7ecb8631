from __future__ import annotations

from pathlib import Path

import pytest

from diorama_app.projects.options import ROOMS, BuildOptions, PhotoFiles, room_solver, with_options
from diorama_core.architecture.rac.stage import RenderAndCompareRoom
from diorama_core.errors import InputError
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.pose.discrete_turns import DiscreteTurns
from tests.pose.rooms import LIBRARY, random_room

PHOTO = Path("room.jpg")


def test_a_network_for_what_was_given_is_refused() -> None:
    with pytest.raises(InputError, match="uses no network"):
        BuildOptions(profile="embedded", detector="x").networks(PhotoFiles(PHOTO))
    with pytest.raises(InputError, match="boxes or masks"):
        BuildOptions(detector="x").networks(PhotoFiles(PHOTO, boxes=PHOTO))
    with pytest.raises(InputError, match="--depth says"):
        BuildOptions(depth_network="x").networks(PhotoFiles(PHOTO, depth=PHOTO))
    assert BuildOptions(detector="x").networks(PhotoFiles(PHOTO)).detector == "x"


def test_every_room_solver_has_a_name() -> None:
    assert len({repr(room_solver(name)) for name in ROOMS}) == len(ROOMS)


def test_baselines_that_read_depth_are_refused_without_any() -> None:
    stages = embedded_stages(random_room(0).inputs, LIBRARY)
    with pytest.raises(InputError, match="--room rac reads depth"):
        with_options(stages, PhotoFiles(PHOTO), BuildOptions(room="rac"))
    given = with_options(stages, PhotoFiles(PHOTO, depth=PHOTO), BuildOptions(room="rac"))
    assert isinstance(given.architecture, RenderAndCompareRoom)


def test_a_whole_system_has_its_own_room_and_poses() -> None:
    stages = embedded_stages(random_room(0).inputs, LIBRARY)
    with pytest.raises(InputError, match="leave out --room"):
        with_options(stages, PhotoFiles(PHOTO), BuildOptions(system="acdc", room="rac"))
    whole = with_options(stages, PhotoFiles(PHOTO, depth=PHOTO), BuildOptions(system="acdc"))
    assert isinstance(whole.pose, DiscreteTurns)
