"""What the first build or optimisation needs, loaded beside everything else once the page has come up."""

from __future__ import annotations

import threading

WARM_UP_AFTER_S = 10.0
"""Loading takes two seconds of one core, which the browser needs while the page opens."""

OPEN3D_TRIES = 5


def warm_up(stopped: threading.Event) -> None:
    """Wait until pages have come up, then load; not at all when stopped before."""
    if stopped.wait(WARM_UP_AFTER_S):
        return
    load_open3d()
    import diorama_core.project.build
    import diorama_core.text.pictures  # noqa: F401  # loading it is the whole work


def load_open3d() -> None:
    """Load Open3D: it looks through the loaded modules, and fails where another thread loads one at that moment."""
    for remaining in reversed(range(OPEN3D_TRIES)):
        try:
            import open3d  # noqa: F401
        except RuntimeError as error:
            if "changed size during iteration" not in str(error) or not remaining:
                raise
        else:
            return
