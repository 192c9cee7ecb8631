"""The paper's system table on a machine with a CUDA card, in one command.

python scripts/paper_table.py [--scenes 20] [--seeds reporting] [--out DIR] [--yes] [--cpu] [--given ROW,ROW]

It checks that onnxruntime sees the card, fetches the networks of the set `paper` that are missing (6.5 GB; licences are
shown and asked for, unless --yes), builds every rendered room by Diorama without networks, by the paper's system and
by ACDC on the same networks, and writes `paper-table.md` and `paper-table.json` with the card's name and all times.
Where DIORAMA_LMM_BASE_URL and DIORAMA_LMM_MODEL name a language model, the networks' rows ask it for the graph.

`--cpu` is a trial before a card is paid for: no card is looked for, nothing is fetched, and whichever networks lie here
are used. `--cpu --scenes 1 --given depth,acdc` needs none and takes a minute.
"""

from __future__ import annotations

import argparse
import json
import platform
import subprocess
import sys
from pathlib import Path

from diorama_app.cli import main as diorama
from diorama_core.errors import DioramaError, UnavailableError
from diorama_core.models.manifest import NETWORKS
from diorama_core.models.runtime import providers
from diorama_core.models.store import ModelStore

GIVEN = "depth,acdc,published,published-acdc"


def main(words: list[str] | None = None) -> int:
    """Write the table; 1 where something that it needs is missing, with one line that says what."""
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--scenes", type=int, default=20, metavar="N", help="rooms of every series (default: %(default)s)")
    p.add_argument("--seeds", default="reporting", metavar="S,S", help="series of rooms (default: %(default)s)")
    p.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="where the table goes (default: here)")
    p.add_argument("--yes", action="store_true", help="accept the networks' licences without asking")
    p.add_argument("--cpu", action="store_true", help="a trial without a card, on the networks that are here")
    p.add_argument("--given", default=GIVEN, metavar="ROW,ROW", help="rows of the table (default: %(default)s)")
    a = p.parse_args(words)
    try:
        card = "no card, a trial" if a.cpu else cuda_card()
    except DioramaError as error:
        print(error, file=sys.stderr)
        return 1
    if not a.cpu and not _fetched(a.yes):
        return 1
    a.out.mkdir(parents=True, exist_ok=True)
    table, figures = a.out / "paper-table.md", a.out / "paper-table.json"
    bench = ["bench", "system", "--given", a.given, "--scenes", str(a.scenes), "--seeds", a.seeds]
    status = diorama([*bench, "--json", str(figures), "--markdown", str(table)])
    if figures.is_file():
        told = json.loads(figures.read_text("utf-8")) | {
            "machine": f"{card}, {platform.processor() or platform.machine()}"
        }
        figures.write_text(json.dumps(told, indent=1), "utf-8")
        table.write_text(f"{table.read_text('utf-8').rstrip()}\n\nMeasured on {told['machine']}.\n", "utf-8")
    return status


def _fetched(agreed: bool) -> bool:
    """Whether all networks of the set `paper` are here; those that are missing are fetched."""
    store = ModelStore.default()
    missing = [n.id for n in NETWORKS if "paper" in n.tiers and not store.has(n)]
    return not missing or diorama(["models", "pull", "paper", *(["--yes"] if agreed else [])]) == 0


def cuda_card() -> str:
    """The name of the CUDA card that onnxruntime uses.

    Raises:
        UnavailableError: it sees none.
    """
    if providers()[0] != "CUDAExecutionProvider":
        raise UnavailableError(
            "onnxruntime sees no CUDA card here; install diorama[gpu] in the place of onnxruntime (docs/models.md)"
        )
    try:
        asked = ["nvidia-smi", "--query-gpu=name", "--format=csv,noheader"]
        return subprocess.run(asked, capture_output=True, text=True, check=True, timeout=30).stdout.splitlines()[0]
    except (OSError, subprocess.SubprocessError, IndexError):
        return "a CUDA card"


if __name__ == "__main__":
    sys.exit(main())
