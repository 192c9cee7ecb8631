"""Anyone's own models become shapes: files are read with care, put upright, measured, and handed to a store."""

from diorama_core.library.ingest.sink import Ingested, ShapeSink

__all__ = ["Ingested", "ShapeSink"]
