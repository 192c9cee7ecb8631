from __future__ import annotations

from collections.abc import Iterator

import pytest
import viser

from diorama_app.web.viser_adapter import create_server, stop_server
from diorama_app.web.visitors import Visitors


@pytest.fixture
def guarded() -> Iterator[viser.ViserServer]:
    """A server that only those can use who bring its token."""
    made = create_server(host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1", "s3cret"))
    yield made
    stop_server(made)
