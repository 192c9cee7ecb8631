"""Commands about networks: `diorama models ...`."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from diorama_app.cli.arguments import command, progress_bar
from diorama_core.errors import UnavailableError

if TYPE_CHECKING:
    from diorama_core.models.network import Network
    from diorama_core.models.store import ModelStore


def add_models(commands: Any) -> None:
    """Declare `diorama models`."""
    p: argparse.ArgumentParser = commands.add_parser("models", help="Networks that Diorama can use, all optional.")
    actions = p.add_subparsers(dest="action", required=True, metavar="list|pull|verify|check|path")
    lists = command(actions, "list", _list, "diorama models list")
    lists.add_argument("--json", action="store_true")
    pulls = command(actions, "pull", _pull, "diorama models pull tiny")
    pulls.add_argument(
        "what",
        nargs="*",
        default=None,
        metavar="micro|tiny|lite|default|paper|ID",
        help="sets or single networks (default: tiny)",
    )
    pulls.add_argument("--yes", action="store_true", help="accept the licences without asking")
    pulls.add_argument(
        "--from", dest="source", type=Path, metavar="FOLDER", help="use files downloaded elsewhere; works offline"
    )
    verify = command(actions, "verify", _verify, "diorama models verify")
    verify.add_argument("--json", action="store_true")
    checks = command(actions, "check", _check, "diorama models check")
    checks.add_argument("--json", action="store_true")
    command(actions, "path", _path, "diorama models path")


def _list(a: argparse.Namespace) -> None:
    """List the networks and which are installed."""

    from diorama_core.models.manifest import NETWORKS
    from diorama_core.models.store import ModelStore

    store = ModelStore.default()
    rows: list[dict[str, Any]] = [
        {
            "id": n.id,
            "role": n.role,
            "title": n.title,
            "size_mb": round(n.size_bytes / 1e6),
            "licence": n.licence,
            "sets": list(n.tiers),
            "checked_by": n.check_words,
            "here": store.has(n),
        }
        for n in NETWORKS
    ]
    if a.json:
        print(json.dumps(rows))
        return
    for row in rows:
        mark = "here" if row["here"] else "-"
        unsure = "" if row["checked_by"].startswith("published") else " *"
        print(
            f"{mark:<5} {row['id']:<22} {row['role']:<15} {row['size_mb']:>5} MB  {row['licence']:<13}"
            f" {', '.join(row['sets']):<22} {row['title']}{unsure}"
        )
    print("* unverified: no published checksum; tried on a photo when it arrives, later downloads must match the first")


def _pull(a: argparse.Namespace) -> None:
    """Download networks."""

    from diorama_core.models.pull import pull
    from diorama_core.models.store import ModelStore

    store = ModelStore.default()
    if a.source is not None:
        added = store.add_folder(a.source)
        _try(store, added)
        for name in added:
            print(f"{name}: ready in {store.folder / name}")
        return
    chosen: dict[str, Network] = {}
    for what in a.what or ["tiny"]:
        chosen.update({n.id: n for n in _members(what)})
    with progress_bar() as progress:
        fetched = pull(store, tuple(chosen.values()), accept=_asker(a.yes), progress=progress)
    _try(store, fetched)
    count = "1 network" if len(fetched) == 1 else f"{len(fetched)} networks"
    print(f"{count} fetched, {len(chosen) - len(fetched)} already here: {store.folder}")


def _try(store: ModelStore, network_ids: Sequence[str]) -> None:
    """Let networks without published checksums look at the example; those that do not work are deleted."""
    from diorama_core.models.manifest import network

    if all(network(n).has_checksums for n in network_ids):
        return
    from diorama_app.projects.example import example_inputs
    from diorama_core.pipeline.network_check import delete_failing_networks

    with progress_bar() as progress:
        failed = delete_failing_networks(store, network_ids, example_inputs().inputs, progress)
    if failed:
        damaged = "; ".join(f"{c.network.title}: {c.words}" for c in failed)
        raise UnavailableError(f"these files were damaged or changed, so they were deleted: {damaged}")


def _members(what: str) -> tuple[Network, ...]:
    """The networks of a set, in half precision where a card calculates with it, or the one that is named."""
    from diorama_core.models.manifest import half_precision_networks, network, networks_of
    from diorama_core.models.network import TIERS
    from diorama_core.models.runtime import calculates_in_half

    if what not in TIERS:
        return (network(what),)
    return half_precision_networks(networks_of(what)) if calculates_in_half() else networks_of(what)


def _asker(yes: bool) -> Any:
    def accept(networks: Sequence[Network]) -> bool:
        for n in networks:
            source = n.repo or n.url
            print(
                f"{n.title}: {n.licence}, {n.size_bytes / 1e6:.0f} MB, from {source} ({n.check_words})", file=sys.stderr
            )
        if yes:
            return True
        if not sys.stdin.isatty():
            return False
        print("Accept these licences and fetch? [y/N] ", end="", file=sys.stderr, flush=True)
        return sys.stdin.readline().strip().lower() in ("y", "yes")

    return accept


def _verify(a: argparse.Namespace) -> None:
    """Verify the checksums of installed networks."""

    from diorama_core.models.manifest import NETWORKS
    from diorama_core.models.store import ModelStore

    store = ModelStore.default()
    checks = [store.check(n) for n in NETWORKS]
    if a.json:
        print(json.dumps([{"id": c.network.id, "state": c.state} for c in checks]))
    else:
        for c in checks:
            if c.state != "absent":
                print(f"{c.network.id:<22} {c.state}")
        if all(c.state == "absent" for c in checks):
            print("no networks are here; fetch some with: diorama models pull tiny")
    wrong = [c.network.id for c in checks if c.state not in ("ok", "absent")]
    if wrong:
        listed = ", ".join(wrong)
        raise UnavailableError(f"{store.folder}: {listed} cannot be used; run: diorama models pull {wrong[0]}")


def _check(a: argparse.Namespace) -> None:
    """Let every installed network look at a photo it should do well."""

    from diorama_app.projects.example import example_inputs
    from diorama_core.models.store import ModelStore
    from diorama_core.pipeline.network_check import check_networks

    store = ModelStore.default()
    with progress_bar() as progress:
        checks = check_networks(store, example_inputs().inputs, progress)
    if a.json:
        rows = [
            {"id": c.network.id, "ok": c.ok, "found": c.words, "device": c.device, "seconds": round(c.seconds, 2)}
            for c in checks
        ]
        print(json.dumps(rows))
    else:
        for c in checks:
            mark = "ok" if c.ok else "FAIL"
            print(f"{mark:<5} {c.network.id:<22} {c.seconds:6.1f} s {c.device or '-':<6} {c.words}")
        if not checks:
            print("no networks are here; fetch some with: diorama models pull tiny")
    wrong = [c.network.id for c in checks if not c.ok]
    if wrong:
        raise UnavailableError(f"{store.folder}: {', '.join(wrong)} does not work here; run: diorama models verify")


def _path(a: argparse.Namespace) -> None:
    """Print the folder of the networks."""

    from diorama_core.models.store import default_folder

    print(default_folder())
