"""Retrieval by a joint embedding of words, pictures and shapes, where its networks are on this machine."""

from __future__ import annotations

from dataclasses import replace

from diorama_core.library.record import ShapeLibrary
from diorama_core.models.clip import DuoduoClip, OpenClip
from diorama_core.models.manifest import network
from diorama_core.models.store import ModelStore
from diorama_core.pipeline.stages import Stages
from diorama_core.retrieval import HierarchicalRetrieval
from diorama_core.retrieval.joint import ClipEmbedding, JointSimilarity


def with_joint_retrieval(base: Stages, library: ShapeLibrary, store: ModelStore) -> Stages:
    """`base` with looks compared in OpenCLIP's space, shapes by DuoduoCLIP's tower where the user converted one."""
    clip, tower = network("openclip-b32"), network("duoduoclip")
    if not store.has(clip):
        return base
    text, tokenizer, image = (store.path(clip, f.path) for f in clip.files)
    shapes = None
    if store.has(tower):
        shapes = DuoduoClip(store.path(tower, tower.files[0].path), store.identity(tower))
    embedding = ClipEmbedding(OpenClip(text, image, tokenizer, store.identity(clip)), shapes)
    return replace(base, retrieval=HierarchicalRetrieval(library, similarity=JointSimilarity(library, embedding)))
