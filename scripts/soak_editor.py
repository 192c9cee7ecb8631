"""Thousands of random edits through the editor's own room: is the document valid, does memory stay flat?

    python scripts/soak_editor.py [--edits 5000] [--seed 0]

Prints memory after warming up and at the end, their growth, and how many edits were refused.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tests.app.soaking import Soak

WARM_UP = 0.2


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--edits", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        soak = Soak(Path(folder), seed=options.seed)
        begun = time.monotonic()
        first = int(WARM_UP * options.edits)
        soak.run(first)
        before = soak.memory_mb()
        soak.run(options.edits - first)
        after = soak.memory_mb()
        soak.check()
        growth = 100 * (after - before) / before
        print(f"{options.edits} edits in {time.monotonic() - begun:.0f} s, {soak.refused} refused")
        print(f"memory {before:.0f} MB after {first} edits, {after:.0f} MB at the end: {growth:+.1f} % (asked < 10 %)")
        print(f"messages kept for late joiners {soak.retained_messages()}, objects {len(soak.session.scene.objects)}")
        soak.close()


if __name__ == "__main__":
    main()
