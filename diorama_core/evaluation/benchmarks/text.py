"""Scenes from text: 64 prompts with what each asks for, as a person wrote it down; thirty are for reporting."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from importlib import resources

import cv2
import numpy as np
from jaxtyping import UInt8

from diorama_core.evaluation.metrics.text_scene import Asked, TextScene, measure
from diorama_core.evaluation.reports.tables import Column, Row, Table
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import SILENT, Progress
from diorama_core.render.picture import picture
from diorama_core.scene.types import Scene
from diorama_core.text.compose import compose_room
from diorama_core.text.scene_from_text import finish

SERIES = ("development", "reporting")
PICTURE_PX = (480, 360)
SHEET_COLUMNS = 3
CAPTION_PX = 34


@dataclass(frozen=True)
class Measured:
    """One prompt."""

    series: str
    prompt: str
    result: TextScene
    notes: tuple[str, ...]
    seconds: float

    @property
    def is_named(self) -> bool:
        """Whether everything is met, or something is named as unmet."""
        return self.result.all_met or bool(self.notes)


@dataclass(frozen=True)
class TextBench:
    """All prompts."""

    seed: int
    prompts: tuple[Measured, ...]

    def tables(self) -> tuple[Table, ...]:
        """Fidelity and plausibility, a row for each series."""
        return (fidelity_table(self.prompts), plausibility_table(self.prompts))

    def to_json(self) -> dict[str, object]:
        """Tables and every prompt."""
        return {
            "bench": "text",
            "seed": self.seed,
            "tables": [t.to_json() for t in self.tables()],
            "prompts": [asdict(p) for p in self.prompts],
        }


def prompts_of(series: str) -> tuple[Asked, ...]:
    """The prompts of a series with what each asks for."""
    text = resources.files("diorama_core.evaluation").joinpath("text_prompts.json").read_text("utf-8")
    return tuple(
        Asked(
            row["prompt"],
            row["has"],
            {name: tuple(words) for name, words in row["looks"].items()},
            tuple((r[0], r[1], tuple(r[2:])) for r in row["relations"]),
            {name: (rows, each) for name, (rows, each) in row.get("rows", {}).items()},
        )
        for row in json.loads(text)[series]
    )


def run(
    library: ShapeLibrary,
    scenes: int = 64,
    seed: int = 0,
    progress: Progress = SILENT,
    *,
    pictures: bool = False,
) -> tuple[TextBench, UInt8[np.ndarray, "_ _ 3"] | None]:
    """Compose a room for every prompt and measure it.

    Args:
        library: where shapes come from.
        scenes: how many prompts, from the first of each series on.
        seed: of the rooms.
        progress: reports and cancellation.
        pictures: whether to draw a sheet of all rooms.

    Returns:
        The measures, and the sheet where it was asked for.
    """
    series = {name: prompts_of(name) for name in SERIES}
    first = (scenes + 1) // 2 if scenes < sum(map(len, series.values())) else scenes
    wanted = [(name, asked) for name in SERIES for asked in series[name][:first]][:scenes]
    measured: list[Measured] = []
    tiles: list[np.ndarray] = []
    for k, (name, asked) in enumerate(wanted):
        progress.report(k / len(wanted), f"Composing: {asked.prompt[:50]}")
        begun = time.perf_counter()
        scene, notes = _compose(asked.prompt, library, seed)
        seconds = time.perf_counter() - begun
        measured.append(Measured(name, asked.prompt, measure(asked, scene, library), tuple(notes), seconds))
        if pictures:
            tiles.append(tile(scene, library, asked.prompt))
    return TextBench(seed, tuple(measured)), sheet(tiles) if pictures else None


def _compose(prompt: str, library: ShapeLibrary, seed: int) -> tuple[Scene, Sequence[str]]:
    made = compose_room(prompt, library, seed)
    return made.scene, made.notes


def tile(scene: Scene, library: ShapeLibrary, caption: str) -> UInt8[np.ndarray, "h w 3"]:
    """A room seen by its camera and from above, with its prompt."""
    shown, textures = finish(scene, library)
    views = [
        picture(shown, library, view=view, size=(width, PICTURE_PX[1]), textures=textures)
        for view, width in (("photo", PICTURE_PX[0]), ("top", PICTURE_PX[1]))
    ]
    both = np.concatenate(views, axis=1)
    bar = np.full((CAPTION_PX, both.shape[1], 3), 255, np.uint8)
    half = len(caption) // 2 + caption[len(caption) // 2 :].find(" ") if len(caption) > 110 else len(caption)
    for row, words in enumerate((caption[:half], caption[half:].strip())):
        cv2.putText(bar, words, (6, 14 + 15 * row), cv2.FONT_HERSHEY_SIMPLEX, 0.42, (20, 20, 20), 1, cv2.LINE_AA)
    return np.concatenate([bar, both], axis=0)


def sheet(tiles: Sequence[UInt8[np.ndarray, "h w 3"]]) -> UInt8[np.ndarray, "_ _ 3"]:
    """All tiles in a grid."""
    blank = np.full_like(tiles[0], 255)
    filled = [*tiles, *([blank] * (-len(tiles) % SHEET_COLUMNS))]
    rows = [np.concatenate(filled[k : k + SHEET_COLUMNS], axis=1) for k in range(0, len(filled), SHEET_COLUMNS)]
    return np.concatenate(rows, axis=0)


Measure = Callable[[Sequence[Measured]], float | None]
"""A figure of some prompts; None where nothing is asked."""


def _share(pairs: Sequence[tuple[int, int]]) -> float | None:
    asked = sum(total for _, total in pairs)
    return sum(met for met, _ in pairs) / asked if asked else None


def fidelity_table(prompts: Sequence[Measured]) -> Table:
    """What was asked for and is there."""
    return _table(
        "Text to scene: fidelity",
        prompts,
        (
            (Column("object count", ".3f", "↑"), lambda some: _share([p.result.counts for p in some])),
            (Column("attribute", ".3f", "↑"), lambda some: _share([p.result.looks for p in some])),
            (
                Column("object-object relation", ".3f", "↑"),
                lambda some: _share([p.result.object_relations for p in some]),
            ),
            (
                Column("object-architecture relation", ".3f", "↑"),
                lambda some: _share([p.result.room_relations for p in some]),
            ),
            (Column("prompts all met", ".3f", "↑"), lambda some: _mean([p.result.all_met for p in some])),
            (Column("all met or named", ".3f", "↑"), lambda some: _mean([p.is_named for p in some])),
            (Column("s a prompt", ".1f", "↓"), lambda some: _mean([p.seconds for p in some])),
        ),
    )


def plausibility_table(prompts: Sequence[Measured]) -> Table:
    """Whether the room is one that people could use."""
    return _table(
        "Text to scene: plausibility",
        prompts,
        (
            (Column("supported", ".3f", "↑"), lambda some: _share([p.result.supported for p in some])),
            (Column("colliding objects", ".3f", "↓"), lambda some: _share([p.result.colliding for p in some])),
            (Column("navigability", ".3f", "↑"), lambda some: _mean([p.result.navigable for p in some])),
            (Column("accessibility", ".3f", "↑"), lambda some: _mean([p.result.accessible for p in some])),
            (Column("out of bounds", ".3f", "↓"), lambda some: _share([p.result.outside for p in some])),
        ),
    )


def _table(title: str, prompts: Sequence[Measured], measures: Sequence[tuple[Column, Measure]]) -> Table:
    """One row for each series of prompts."""
    rows = [
        Row(f"{name}, {len(some)} prompts", tuple(measure(some) for _, measure in measures))
        for name in SERIES
        if (some := [p for p in prompts if p.series == name])
    ]
    return Table(title, tuple(column for column, _ in measures), tuple(rows))


def _mean(values: Sequence[float]) -> float:
    return float(np.mean(values))
