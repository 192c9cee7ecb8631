"""Optimise the layout of a project and write it for another program; the ending of the file says for which.

python examples/03_optimise_and_export.py my-room my-room.glb
"""

from __future__ import annotations

import sys

import diorama_core as diorama


def main(folder: str, file: str) -> None:
    room = diorama.optimise(diorama.load(folder), recipe="feasible")
    for name, after in room.layout.after.items():
        print(f"{name:<24} {room.layout.before[name]:10.4f} -> {after:10.4f}")
    room.save(folder)
    diorama.export(room, file)


if __name__ == "__main__":
    main(*sys.argv[1:3])
