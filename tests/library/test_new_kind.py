"""A new kind is one row of the table: words, sizes, supports, rooms, stand-ins and company follow from it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from diorama_core.library.kind_rows import PATH

PAGE = Path(__file__).parents[2] / "docs" / "adding.md"
AQUARIUM = PAGE.read_text("utf-8").split("```toml\n")[1].split("```")[0]
ASKED = """
import json, sys
from pathlib import Path
import diorama_core.library.kind_rows as rows
rows.PATH = Path(sys.argv[1])
import numpy as np
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.taxonomy import ROOMS, often_carried, usual_carriers
from diorama_core.library.labels import meanings
from diorama_core.library.kinds import sizes_of_kind
from diorama_core.library.labels import understand_label
from diorama_core.library.taxonomy import having, lies_on_furniture, resolve
from diorama_core.retrieval.pools import RetrievalQuery, pool_for
pool = pool_for(built_in_library(), RetrievalQuery("aquarium", np.array((0.4, 0.8, 0.5)), False, {"aquarium": 1.0}))
print(json.dumps({
    "words": [resolve(word).category.name for word in ("aquarium", "fish tanks", "old terrarium")],
    "label": understand_label("Fish_Tank").category.name,
    "meant by": list(meanings("tank", "aquarium")),
    "size": np.exp(sizes_of_kind("aquarium")[0].log_size).round(3).tolist(),
    "lies": lies_on_furniture("aquarium"),
    "on": usual_carriers("aquarium")[:1],
    "rather than": often_carried("aquarium", "bed"),
    "rooms": sorted(room for room, kinds in ROOMS.items() if "aquarium" in kinds),
    "solid": "aquarium" in having("solid"),
    "shapes": len(pool.members) > 3,
}))
"""


def asked_of(table: str, folder: Path) -> dict[str, object]:
    """What a fresh process knows of aquariums with a table."""
    (folder / "kinds.toml").write_text(table)
    done = subprocess.run(
        [sys.executable, "-c", ASKED, str(folder / "kinds.toml")], capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)


@pytest.mark.unchecked
def test_a_new_kind_is_one_row(tmp_path: Path) -> None:
    known, unknown = PATH.read_text("utf-8").split("\n[object]")
    assert asked_of(f"{known}{AQUARIUM}\n[object]{unknown}", tmp_path) == {
        "words": ["aquarium"] * 3,
        "label": "aquarium",
        "meant by": ["aquarium"],
        "size": [0.4, 0.8, 0.5],
        "lies": True,
        "on": ["sideboard"],
        "rather than": 0.3,
        "rooms": ["bedroom", "living"],
        "solid": True,
        "shapes": True,
    }
