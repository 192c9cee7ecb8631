"""The processes beside this one that share the work of a build."""

from __future__ import annotations

from diorama_core.processes import prepare


def prepare_processes() -> None:
    """Start them, unless they are there: what they need loads while the first stages leave a processor idle."""
    prepare(_load)


def _load() -> None:
    """Load what the work given to them needs."""
    import diorama_core.appearance.photo_appearance
    import diorama_core.pose.made_to_measure  # noqa: F401
    from diorama_core.geometry.open3d_import import load_open3d

    load_open3d()
