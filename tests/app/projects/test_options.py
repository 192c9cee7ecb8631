from __future__ import annotations

from pathlib import Path

import pytest

from diorama_app.projects.options import BuildOptions, PhotoFiles
from diorama_core.errors import InputError

PHOTO = Path("room.jpg")


def test_a_network_for_what_was_given_is_refused() -> None:
    with pytest.raises(InputError, match="uses no network"):
        BuildOptions(profile="embedded", detector="x").networks(PhotoFiles(PHOTO))
    with pytest.raises(InputError, match="boxes or masks"):
        BuildOptions(detector="x").networks(PhotoFiles(PHOTO, boxes=PHOTO))
    with pytest.raises(InputError, match="--depth says"):
        BuildOptions(depth_network="x").networks(PhotoFiles(PHOTO, depth=PHOTO))
    assert BuildOptions(detector="x").networks(PhotoFiles(PHOTO)).detector == "x"
