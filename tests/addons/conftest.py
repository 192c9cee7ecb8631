"""The editor of the application's tests."""

from tests.app.conftest import running

__all__ = ["running"]
