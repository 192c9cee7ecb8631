"""What people write: descriptions of rooms, and commands that change one."""

from __future__ import annotations

from functools import cache

import numpy as np

from diorama_core.scene.schema import scene_to_json
from diorama_core.text.editing_by_words import propose_edits
from diorama_core.text.prompt import read_prompt
from tests.app.small_room import PlainLibrary, furnished_scene
from tests.fuzzing.mutate import Random, damaged

JOINTS = (
    " and ",
    ", ",
    "; ",
    " the ",
    " of ",
    " by ",
    " 10 ",
    " two ",
    " it ",
    " not ",
    " -1 ",
    " 1e999 ",
    " ° ",
    "\u2019",
)


def room_samples() -> tuple[bytes, ...]:
    return (
        b"a cosy living room with two red armchairs facing each other, a table between them, a lamp by the window",
        b"bedroom: a double bed against the wall, a wardrobe opposite the bed, a rug under it, 3 books on the desk",
    )


def read_room_words(data: bytes) -> object:
    return read_prompt(data.decode("utf-8", "replace"))


def command_samples() -> tuple[bytes, ...]:
    commands = (
        "move the chair beside the table and turn it by 45 degrees",
        "remove everything on the table; make the lamp twice as large",
        "paint the walls light blue, then add a chair at the table",
        "replace the chair with another chair. move the lamp 20 cm to the left",
        "turn the chairs towards the table and make all chairs red",
    )
    return tuple(c.encode() for c in commands)


def strange_words(data: bytes, random: Random) -> bytes:
    """Words left out, doubled, exchanged and joined otherwise; sometimes damaged letters."""
    words = data.decode().split()
    for _ in range(int(random.integers(1, 6))):
        at, other = (int(random.integers(0, len(words))) for _ in range(2))
        kind = int(random.integers(0, 4))
        if kind == 0 and len(words) > 1:
            del words[at]
        elif kind == 1:
            words.insert(at, words[other])
        elif kind == 2:
            words[at], words[other] = words[other], words[at]
        else:
            words[at] += JOINTS[int(random.integers(0, len(JOINTS)))]
    text = " ".join(words).encode()
    return damaged(text, random) if random.integers(0, 4) == 0 else text


@cache
def _library() -> PlainLibrary:
    return PlainLibrary()


def read_command(data: bytes) -> object:
    """Whatever is understood is a scene that can be written."""
    proposed = propose_edits(data.decode("utf-8", "replace"), furnished_scene(), _library(), selected=("chair_1",))
    assert all(np.isfinite(o.pose.position).all() for o in proposed.scene.objects)
    return scene_to_json(proposed.scene).encode()
