"""What the files of a folder say together, and when it outweighs what their format promises."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.ingest.frames import GLTF, OBJ
from diorama_core.library.ingest.given import UNITS, axis_name
from diorama_core.library.ingest.joint import Evidence, joint_convention
from diorama_core.library.ingest.relief import quarter_turns

UPS = [axis_name(R[2]) for R in quarter_turns()]


def saying(up: str, nats: float) -> Evidence:
    """Evidence of a file that stands on one axis, by so many nats, in metres."""
    stands = np.where([u == up for u in UPS], nats, 0.0)
    metres = np.where(np.array(list(UNITS)) == 1.0, 2.0, 0.0)
    return stands[:, None] + metres[None, :]


@pytest.mark.parametrize("files", [3, 4, 12])
def test_a_folder_of_gltf_that_all_stand_on_z_breaks_the_promise(files: int) -> None:
    joint = joint_convention(GLTF, [saying("+z", 12.0)] * files)
    assert not joint.promises
    assert joint.up["+z"] > 0.9
    assert joint.name == "folder's"


@pytest.mark.parametrize(
    "evidence",
    [
        [saying("+z", 12.0)] * 2,
        [saying("+z", 2.0)] * 3,
        [saying("+z", 12.0), saying("+z", 12.0), saying("+y", 12.0)],
        [saying("+z", 12.0)] * 3 + [saying("+y", 12.0)] * 3,
        [saying("+y", 12.0)] * 12,
    ],
)
def test_few_or_divided_files_keep_it(evidence: list[Evidence]) -> None:
    joint = joint_convention(GLTF, evidence)
    assert joint.promises
    assert joint.name == "glTF"


def test_a_pack_has_one_convention_and_exceptions_must_be_far_likelier() -> None:
    joint = joint_convention(OBJ, [saying("+y", 4.0)] * 3 + [saying("+z", 2.0)])
    assert joint.up["+y"] > 0.9
    assert max(joint.unit, key=lambda unit: joint.unit[unit]) == 1.0


def test_formats_without_a_promise_have_none_to_break() -> None:
    assert joint_convention(OBJ, [saying("-x", 12.0)] * 5).name == "OBJ"
