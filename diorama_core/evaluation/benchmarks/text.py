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

from diorama_core.evaluation.benchmarks.photo_build import grid
from diorama_core.evaluation.metrics.text_scene import Asked, TextScene, measure
from diorama_core.evaluation.reports.tables import Column, Figure, Table, figures_table, mean
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
        by_series = {name: [p for p in self.prompts if p.series == name] for name in SERIES}
        rows = [(f"{name}, {len(some)} prompts", some) for name, some in by_series.items() if some]
        figures = (("fidelity", FIDELITY), ("plausibility", PLAUSIBILITY))
        return tuple(figures_table(f"Text to scene: {what}", rows, of_what) for what, of_what in figures)

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
        made = compose_room(asked.prompt, library, seed)
        seconds = time.perf_counter() - begun
        result = measure(asked, made.scene, library)
        measured.append(Measured(name, asked.prompt, result, tuple(made.notes), seconds))
        if pictures:
            tiles.append(tile(made.scene, library, asked.prompt))
    return TextBench(seed, tuple(measured)), grid(tiles, SHEET_COLUMNS) if pictures else None


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


Prompts = Sequence[Measured]


def _share(of: Callable[[TextScene], tuple[int, int]]) -> Callable[[Prompts], float | None]:
    """What is met of what was asked; None where nothing is asked."""

    def share(prompts: Prompts) -> float | None:
        met, asked = np.sum([of(p.result) for p in prompts], axis=0).tolist()
        return met / asked if asked else None

    return share


FIDELITY = (
    Figure(Column("object count", ".3f", "↑"), _share(lambda found: found.counts)),
    Figure(Column("attribute", ".3f", "↑"), _share(lambda found: found.looks)),
    Figure(Column("object-object relation", ".3f", "↑"), _share(lambda found: found.object_relations)),
    Figure(Column("object-architecture relation", ".3f", "↑"), _share(lambda found: found.room_relations)),
    Figure(Column("prompts all met", ".3f", "↑"), lambda prompts: mean(p.result.all_met for p in prompts)),
    Figure(Column("all met or named", ".3f", "↑"), lambda prompts: mean(p.is_named for p in prompts)),
    Figure(Column("s a prompt", ".1f", "↓"), lambda prompts: mean(p.seconds for p in prompts)),
)
"""What was asked for and is there."""
PLAUSIBILITY = (
    Figure(Column("supported", ".3f", "↑"), _share(lambda found: found.supported)),
    Figure(Column("colliding objects", ".3f", "↓"), _share(lambda found: found.colliding)),
    Figure(Column("navigability", ".3f", "↑"), lambda prompts: mean(p.result.navigable for p in prompts)),
    Figure(Column("accessibility", ".3f", "↑"), lambda prompts: mean(p.result.accessible for p in prompts)),
    Figure(Column("out of bounds", ".3f", "↓"), _share(lambda found: found.outside)),
)
"""Whether the room is one that people could use."""
