"""Retrieval by joint embeddings of words, pictures and shapes, where their networks are on this machine."""

from __future__ import annotations

from dataclasses import replace

from diorama_core.library.record import ShapeLibrary
from diorama_core.models.manifest import network
from diorama_core.models.store import ModelStore
from diorama_core.pipeline import network_stages
from diorama_core.pipeline.stages import Stages
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval
from diorama_core.retrieval.joint import ClipEmbedding, JointEmbedding, JointSimilarity, PointEmbedding


def with_joint_retrieval(base: Stages, library: ShapeLibrary, store: ModelStore) -> Stages:
    """`base` with looks compared in OpenCLIP's space, shapes by DuoduoCLIP's tower where the user converted one."""
    clip, tower = network("openclip-b32"), network("duoduoclip")
    if not store.has(clip):
        return base
    shapes = network_stages.shape_tower(store, tower) if store.has(tower) else None
    embedding = ClipEmbedding(network_stages.open_clip(store, clip), shapes)
    return replace(base, retrieval=HierarchicalRetrieval(library, similarity=JointSimilarity(library, embedding)))


def published_embeddings(store: ModelStore) -> dict[str, JointEmbedding]:
    """The embeddings of the publication's retrieval table whose networks are here, by their names there."""
    found: dict[str, JointEmbedding] = {}
    large, points = network("openclip-bigg14"), network("openshape")
    small, tower = network("openclip-b32"), network("duoduoclip")
    if store.has(large):
        clip = network_stages.open_clip(store, large)
        found["CLIP"] = ClipEmbedding(clip)
        if store.has(points):
            found["OS"] = PointEmbedding(clip, network_stages.point_tower(store, points))
    if store.has(small) and store.has(tower):
        found["DD"] = ClipEmbedding(network_stages.open_clip(store, small), network_stages.shape_tower(store, tower))
    return found
