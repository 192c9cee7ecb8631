"""Every network Diorama can use: where its files come from, how large they are, under which licence.

`networks.toml` is the table. Files are pinned by revision and sha256 where both are known; the rest is resolved at the
first pull, recorded, and held to that record from then on (`store.py`).
"""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from diorama_core.errors import InputError
from diorama_core.models.network import TIERS, ModelFile, Network, Tier


def _row(files: list[list[Any]], tiers: Sequence[Tier] = (), **columns: Any) -> Network:
    """A row of `networks.toml`, which says what its columns are."""
    read = (ModelFile(**dict(zip(("path", "bytes", "sha256"), known)), also_sha256=tuple(known[3:])) for known in files)
    return Network(files=tuple(read), tiers=tuple(tiers), **columns)


NETWORKS: tuple[Network, ...] = tuple(
    _row(**row)
    for row in tomllib.loads(Path(__file__).with_name("networks.toml").read_text(encoding="utf-8"))["network"]
)


def network(network_id: str) -> Network:
    """The network of this id.

    Raises:
        InputError: when there is none.
    """
    for known in NETWORKS:
        if known.id == network_id:
            return known
    raise InputError(f"there is no network {network_id!r}; `diorama models list` names them")


def half_precision_networks(networks: tuple[Network, ...]) -> tuple[Network, ...]:
    """The networks in half precision, where such files are published."""
    halves = {n.half_of: n for n in NETWORKS if n.half_of}
    return tuple(halves.get(n.id, n) for n in networks)


def networks_of(tier: str) -> tuple[Network, ...]:
    """The networks that a tier pulls.

    Raises:
        InputError: when there is no such tier.
    """
    if tier not in TIERS:
        raise InputError(f"there is no set {tier!r} of networks; choose {', '.join(TIERS)}")
    return tuple(n for n in NETWORKS if tier in n.tiers)
