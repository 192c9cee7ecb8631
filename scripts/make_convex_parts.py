"""Decomposes every built-in shape, and what its joints move, into convex parts: `assets/shapes/convex-parts-V.npz`.

    python scripts/make_convex_parts.py [--workers N]

To be run when a built-in shape or the decomposition changed; a test says when. What did not change is taken over.
"""

from __future__ import annotations

import argparse
import sys
from functools import cache
from io import BytesIO

import numpy as np
import trimesh

from diorama_core.geometry.convex import convex_parts
from diorama_core.io.atomic import write_atomically
from diorama_core.layout.problem.parts import BUILT_IN_PARTS, NAMES, PackedParts, Parts, pack, solids_key
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.furniture.articulation import articulation
from diorama_core.library.furniture.model import joined
from diorama_core.workers import workers


def wanted(shape_id: str) -> dict[str, trimesh.Trimesh]:
    """Meshes to decompose, by their keys: the shape, what stays of it and what each of its joints moves."""
    library = built_in_library()
    meshes = {library.shape(shape_id).content_hash: library.mesh(shape_id)}
    pieces = articulation(shape_id)
    if pieces is not None:
        groups = (pieces.of_joint(number) for number in (None, *range(len(pieces.joints))))
        for whole in (joined(solids) for solids in groups if solids):
            mesh = trimesh.Trimesh(whole.vertices, whole.faces, process=False)
            meshes[solids_key(whole.vertices, whole.faces)] = mesh
    return meshes


def decomposed(shape_id: str) -> dict[str, Parts]:
    """Parts by key; those that the file has already are left out."""
    known = already()
    return {key: convex_parts(mesh) for key, mesh in wanted(shape_id).items() if key not in known}


@cache
def already() -> dict[str, Parts]:
    """What the file holds."""
    if not BUILT_IN_PARTS.is_file():
        return {}
    with np.load(BUILT_IN_PARTS) as file:
        return dict(PackedParts(*(file[name] for name in NAMES)))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--workers", type=int, help="processes; all cores by default")
    a = parser.parse_args()
    shape_ids = sorted(shape.id for shape in built_in_library().shapes())
    made = already()
    for done, piece in enumerate(workers(count=a.workers).map(decomposed, shape_ids), 1):
        made |= piece.unwrap()
        print(f"\r{done} of {len(shape_ids)} shapes", end="", file=sys.stderr, flush=True)
    used = sorted({key for shape_id in shape_ids for key in wanted(shape_id)})
    content = BytesIO()
    arrays = pack({key: made[key] for key in used})
    np.savez_compressed(content, **arrays)  # type: ignore[arg-type]  # numpy's stub confuses them with its own option
    BUILT_IN_PARTS.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(BUILT_IN_PARTS, content.getvalue())
    print(f"\n{len(used)} entries, {len(content.getvalue()) / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
