"""Which shapes could stand for each object, best first."""

from diorama_core.retrieval.hierarchical import HierarchicalRetrieval

__all__ = ["HierarchicalRetrieval"]
