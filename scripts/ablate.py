"""What settings and optional stages are worth, measured on annotated photos and rendered rooms; kept as certificates.

    python scripts/ablate.py refinement layout.weights.outline --annotations A.json --photos DIR [--rooms 12]
    python scripts/ablate.py --names            # what there is to leave out

Each is left out, halved and doubled (a stage only left out), and every figure's change with its paired interval goes
into `docs/log/certificates.json` under the name. Stage results of builds without a change are kept with `--stages`.
"""

from __future__ import annotations

import argparse
import json
import shlex
import sys
from pathlib import Path

import numpy as np

from diorama_core.artefacts import Inputs, Photo
from diorama_core.evaluation.benchmarks.ablation import FACTORS, build, certificate
from diorama_core.evaluation.benchmarks.photos import PhotoSource, plan
from diorama_core.io.atomic import write_atomically
from diorama_core.library.catalogue import built_in_library
from diorama_core.pipeline.settings import settings_of
from diorama_core.pipeline.stages import embedded_stages

CERTIFICATES = Path(__file__).resolve().parents[1] / "docs/log/certificates.json"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*", metavar="SETTING")
    parser.add_argument("--names", action="store_true", dest="listed", help="print all names with their values")
    parser.add_argument("--annotations", type=Path, nargs="+", default=[], metavar="FILE")
    parser.add_argument("--photos", type=Path, nargs="+", default=[], metavar="DIR")
    parser.add_argument("--only", nargs="+", default=(), metavar="ID")
    parser.add_argument(
        "--rooms", type=int, default=0, metavar="N", help="rendered rooms besides, from the photo alone"
    )
    parser.add_argument("--workers", type=int, default=1, metavar="N")
    parser.add_argument("--stages", type=Path, metavar="DIR")
    parser.add_argument("--json", type=Path, default=CERTIFICATES, metavar="FILE")
    a = parser.parse_args()
    library = built_in_library()
    usual = settings_of(embedded_stages(Inputs(Photo(np.zeros((48, 64, 3), np.uint8), "", (64, 48))), library))
    if a.listed:
        print("\n".join(f"{name} = {value:g}" for name, value in usual.items()))
        return 0
    unknown = [name for name in a.names if name not in usual]
    if unknown or not a.names or len(a.annotations) != len(a.photos) or not a.photos:
        parser.error(f"unknown: {unknown}" if unknown else "give names (see --names), and a folder for each annotation")
    asked = plan(
        [PhotoSource(*pair) for pair in zip(a.annotations, a.photos, strict=True)], only=a.only, cache=a.stages
    )
    before = build({}, asked, library, rooms=a.rooms, processes=a.workers)
    for name in a.names:
        after = {}
        for how, factor in FACTORS.items():
            value = usual[name] * factor
            if "." in name or factor == 0:
                after[how] = build({name: value}, asked, library, rooms=a.rooms, processes=a.workers)
        kept = json.loads(a.json.read_text()) if a.json.exists() else {}
        kept[name] = certificate(usual[name], before, after, shlex.join(["python", *sys.argv]))
        write_atomically(a.json, (json.dumps(dict(sorted(kept.items())), indent=1) + "\n").encode())
        print(json.dumps({name: kept[name]["changes"]}, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
