"""Objects in metres from measured depth."""

from diorama_core.perception.measured.stage import MeasuredGeometry

__all__ = ["MeasuredGeometry"]
