"""Damaged inputs for every reader: does each end in a value or in one clear line?

    python scripts/fuzz.py [--seconds 60] [--seed 0] [--only scene,stage] [--keep FOLDER]

Needs pytest, hypothesis and usd-core. Samples and damage are in `tests/fuzzing`; a short round with a fixed seed is
among the tests. Prints a line a parser: how many inputs, how many were read, refused, and refused wrongly, the longest
time and message. Inputs that are refused wrongly are written to --keep; the smallest belongs into
`tests/fuzzing/corpus`.
"""

from __future__ import annotations

import argparse
import logging
import sys
import traceback
import warnings
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import scripts.needs  # noqa: F401  # ends with a line where a package is missing
from tests.fuzzing.parsers import PARSERS
from tests.fuzzing.rounds import Round


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--seconds", type=float, default=60.0, help="for each parser")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default=",".join(PARSERS))
    parser.add_argument("--keep", type=Path)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    logging.disable(logging.CRITICAL)
    wrong = 0
    for name in options.only.split(","):
        done = Round(PARSERS[name], options.seed).run(seconds=options.seconds)
        wrong += len(done.findings)
        print(f"{name:10} {done.summary}", flush=True)
        for kind, (data, error) in done.kinds.items():
            print(f"  {kind}", flush=True)
            traceback.print_exception(error, limit=-3)
            if options.keep is not None:
                options.keep.mkdir(parents=True, exist_ok=True)
                (options.keep / f"{name}-{abs(hash(kind)) % 10**8}").write_bytes(data)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
