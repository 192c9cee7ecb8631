"""Files that come with Diorama are found in a checkout; `tests/test_wheel.py` looks for them in an installation."""

from __future__ import annotations

from diorama_core.io.assets import asset


def test_the_checkout_has_them() -> None:
    assert asset("example", "photo.jpg").is_file()
    assert asset("start").is_dir()
