"""Finds the planes of many random rooms of known geometry from their depth and reports what was missed or made up.

    python scripts/eval_rooms.py --rooms 5 --objects 20 [--kinds box alcove] [--no-masks]

Per kind of room, without noise and with 2 % noise and a structured-light sensor's steps: share of the planes found and
share of the found ones that are true (within 1 degree and 3 cm; 3 degrees and 8 cm with noise), largest errors, and the
processor time a room takes.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.evaluation.metrics.architecture import match_planes
from diorama_core.progress import Progress
from tests.architecture.known_rooms import KINDS, photographed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rooms", type=int, default=5, help="of each kind")
    parser.add_argument("--objects", type=int, default=20, help="that stand in each room")
    parser.add_argument("--kinds", nargs="*", default=KINDS, choices=KINDS)
    parser.add_argument("--no-masks", action="store_true", help="do not tell which pixels show furniture")
    a = parser.parse_args()
    for noise, angle, offset in ((0.0, 1.0, 0.03), (0.02, 3.0, 0.08)):
        total = [0, 0, 0]
        for kind in a.kinds:
            counts = evaluate(kind, a.rooms, a.objects, not a.no_masks, noise, angle, offset)
            total = [x + y for x, y in zip(total, counts, strict=True)]
        print(f"noise {noise:.2f} all: {shares(total)}")


def evaluate(
    kind: str, rooms: int, items: int, masks: bool, noise: float, angle: float, offset: float
) -> tuple[int, int, int]:
    found = missed = spurious = 0
    seconds, worst_angle, worst_offset = 0.0, 0.0, 0.0
    for seed in range(rooms):
        shot = photographed(kind, seed, items=items, noise=noise)
        started = time.process_time()
        room = PlanarRoom().reconstruct(shot.inputs, shot.objects if masks else (), shot.geometry, Progress())
        seconds += time.process_time() - started
        planes = match_planes(room.architecture.planes, shot.planes, shot.camera, angle_deg=angle, offset_m=offset)
        found, missed = found + len(planes.matches), missed + len(planes.missed)
        spurious += len(planes.spurious)
        worst_angle = max([worst_angle, *(m.angle_deg for m in planes.matches)])
        worst_offset = max([worst_offset, *(m.offset_m for m in planes.matches)])
    text = f"noise {noise:.2f} {kind:<11} {shares((found, missed, spurious))}"
    print(f"{text}  at most {worst_angle:.2f} deg {100 * worst_offset:.1f} cm  {seconds / rooms:.2f} s", flush=True)
    return found, missed, spurious


def shares(counts: list[int] | tuple[int, int, int]) -> str:
    found, missed, spurious = counts
    return f"recall {found / max(found + missed, 1):.3f} precision {found / max(found + spurious, 1):.3f}"


if __name__ == "__main__":
    main()
