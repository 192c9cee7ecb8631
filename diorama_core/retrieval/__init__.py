"""Which shapes could stand for each object, best first."""

from diorama_core.retrieval.embedded import EmbeddedRetrieval

__all__ = ["EmbeddedRetrieval"]
