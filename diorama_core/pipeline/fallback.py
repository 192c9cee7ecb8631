"""Builds go on without networks that are damaged, fail, or are others than their names say, and tell so."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from diorama_core.errors import UnavailableError
from diorama_core.models.runtime import NetworkError
from diorama_core.models.store import ModelStore
from diorama_core.pipeline.stages import Stages

log = logging.getLogger(__name__)

T = TypeVar("T")
ChooseStages = Callable[[ModelStore], Stages]
"""The stages for the networks of a store; see `diorama_core.pipeline.presets.stages_for`."""


def with_usable_networks(
    choose: ChooseStages, work: Callable[[Stages], T], *, store: ModelStore | None = None
) -> tuple[T, tuple[str, ...]]:
    """`work` of the chosen stages; after a network failed, of those chosen without it.

    Args:
        choose: Asked again after each failure.
        work: Started again then; stages that finished should be cached.
        store: Where networks lie; this machine's by default.

    Returns:
        What `work` returned, and a line for each network that was left out.

    Raises:
        NetworkError: no stages can be chosen without the network, or it lies in no store.
        DioramaError: what `choose` and `work` raise else.
    """
    store, lines = store or ModelStore.default(), tuple[str, ...]()
    failed: NetworkError | None = None
    while True:
        try:
            return work(_choose_stages(choose, store, failed)), lines
        except NetworkError as error:
            network = store.network_of(error.graph)
            if error is failed or network is None or network.id in store.without:
                raise
            failed, store = error, replace(store, without=store.without | {network.id})
            lines = (*lines, f"{network.title} was left out: {error}")
            log.warning("%s", lines[-1])


def _choose_stages(choose: ChooseStages, store: ModelStore, failed: NetworkError | None) -> Stages:
    try:
        return choose(store)
    except NetworkError:
        raise
    except UnavailableError:
        if failed is None:
            raise
        raise failed from None  # a profile insists on the network: why it cannot be used is what people need to know
