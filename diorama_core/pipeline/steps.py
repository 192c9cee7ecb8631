"""The kinds of steps that the plan consists of."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from diorama_core.arrangement.explain import reasons_of_change
from diorama_core.artefacts import Inputs, LayoutReport, Reason
from diorama_core.errors import UnavailableError
from diorama_core.pipeline.runner import Runner
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene

log = logging.getLogger(__name__)

Artefacts = Mapping[str, Any]
"""Artefacts by the names that the plan uses, with `stages`: the implementations (`Stages` or `ProposalStages`)."""


@dataclass(frozen=True)
class StageStep:
    """A method of one stage; its result is cached, and None where the optional stage is absent or not needed."""

    name: str
    """Field of `Stages`, name in progress reports and stem of the cached file."""
    method: str
    takes: tuple[str, ...]
    gives: str
    share: float
    """Share of the time that a build takes, roughly."""
    needed: Callable[[Inputs], bool] = lambda given: True
    """Whether it runs for what the user gave."""
    dispensable: bool = False
    """Whether the others go on without its result when it is not available."""
    beside: bool = False

    def evaluate(self, known: Artefacts, runner: Runner, progress: Progress) -> Any:
        """The stage's result for the artefacts that are known."""
        stage = getattr(known["stages"], self.name)
        if stage is None or not self.needed(known["given"]):
            return None
        artefacts = tuple(known[name] for name in self.takes)
        try:
            return runner.run(self.name, stage, getattr(stage, self.method), artefacts, progress)
        except UnavailableError as error:
            if not self.dispensable:
                raise
            runner.lost.append(f"{self.name}: left out ({error})")
            log.warning("%s", runner.lost[-1])
            return None


@dataclass(frozen=True)
class Derivation:
    """A pure function between stages; its result is not cached."""

    function: Callable[..., Any]
    takes: tuple[str, ...]
    gives: str
    share: float = 0.0
    beside: bool = False

    def evaluate(self, known: Artefacts, runner: Runner, progress: Progress) -> Any:
        """The function's value for the artefacts that are known."""
        return self.function(*(known[name] for name in self.takes))


@dataclass(frozen=True)
class LaidOut:
    """A scene in the course of its layout."""

    scene: Scene
    report: LayoutReport | None = None
    """None before the layout, and of a scene without objects."""


@dataclass(frozen=True)
class LayoutStep:
    """One stage's part of the layout. It is not cached, because its result is saved as the scene; nothing happens where
    the optional stage is absent or the scene has no objects."""

    name: str
    """Field of `Stages` and name in progress reports."""
    function: Callable[..., tuple[Scene, LayoutReport]]
    """Takes the stage, the artefacts and the progress."""
    takes: tuple[str, ...]
    """The first is the scene so far, a `LaidOut`."""
    gives: str
    share: float
    beside: bool = False

    def evaluate(self, known: Artefacts, runner: Runner, progress: Progress) -> LaidOut:
        """The scene after this part of the layout."""
        stage, artefacts = getattr(known["stages"], self.name), tuple(known[name] for name in self.takes)
        before: LaidOut = artefacts[0]
        if stage is None or not before.scene.objects:
            return before

        def call(*given: Any) -> LaidOut:
            return LaidOut(*self.function(stage, *given))

        return runner.run(self.name, stage, call, artefacts, progress, saved=False)


@dataclass(frozen=True)
class Corrected:
    """A scene before its layout, and how it was corrected."""

    scene: Scene
    notes: tuple[str, ...] = ()
    """What was changed, in plain words."""
    reasons: tuple[Reason, ...] = ()
    """What each rule changed about which object."""


@dataclass(frozen=True)
class Correction:
    """A rule by which supports, shapes and the room come to agree with the objects, before the layout."""

    function: Callable[..., Scene | tuple[Scene, tuple[str, ...]]]
    """Takes the scene and the other artefacts; returns the corrected scene, or it and what was changed in words."""
    takes: tuple[str, ...]
    """The first are the scene so far (a `Corrected`), the library, and the noise of observed positions."""
    gives: str
    why: str
    """Why it changes what it changes, in plain words."""
    measured: bool | None = None
    """Whether it is for measured distances alone, or for those reasoned from a photo alone; None for both."""
    share: float = 0.0
    beside: bool = False

    def evaluate(self, known: Artefacts, runner: Runner, progress: Progress) -> Corrected:
        """The scene with what the rule corrects."""
        before, library, noise, *rest = (known[name] for name in self.takes)
        if self.measured not in (None, noise.measured):
            return before
        result = self.function(before.scene, library, noise, *rest)
        scene, notes = result if isinstance(result, tuple) else (result, ())
        changes = reasons_of_change(before.scene, scene, self.gives.replace("_", " "), self.why)
        return Corrected(scene, (*before.notes, *notes), (*before.reasons, *changes))


Step = StageStep | Derivation | LayoutStep | Correction
"""One step of the plan: what it takes and gives, its share of the time that a build takes, and whether it is started on
a thread of its own while the steps go on that do not take its result (`beside`)."""
