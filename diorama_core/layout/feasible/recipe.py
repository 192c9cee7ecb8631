"""The default recipe: exact structure first, then the least move that takes collisions away.

A retrieved shape differs from the object: its arms do not pass under a desk, its frame is too wide for a gap. Moving it
out of the way can take it farther from where the photo shows it than a slightly smaller size does; both are costed
alike.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import LayoutReport
from diorama_core.geometry.sat import place_bodies
from diorama_core.layout.feasible.heights import joint_heights
from diorama_core.layout.feasible.photo_observations import PhotoObservations, disagreements, photo_observations
from diorama_core.layout.feasible.reach import reaching_ceilings, reaching_loads
from diorama_core.layout.feasible.relocate import cheapest_spot, relocate
from diorama_core.layout.feasible.separate import Program, Separation, base, build_program, overlaps, relax, separate
from diorama_core.layout.feasible.structure import Structure, exact_structure
from diorama_core.layout.feasible.visible_points import VisiblePoints, visible_points
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.report import measure
from diorama_core.layout.settings import AS_IT_IS, LAYOUT, LayoutSettings, Weights
from diorama_core.layout.what_got_worse import disagreement_in_words
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.protocols import Preview
from diorama_core.scene import edits
from diorama_core.scene.types import Camera, Scene

_AXES = np.array([[1, 1, 1], [1, 1, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0]], dtype=bool)
"""Which extents are reduced together: all, the footprint, the height, depth and width alone."""


@dataclass(frozen=True)
class FeasibleRecipe:
    """Support is exact by construction; the remaining freedom is used for minimal moves until nothing overlaps.

    With a camera, moves visible in the photo cost more than moves along the viewing ray.
    """

    library: ShapeLibrary
    only: frozenset[str] | None = None
    """Ids free to move (with what they hold up); all when None."""
    rounds: int = 12
    """Most rounds of choosing axes."""
    attempts: int = 5
    """How often stuck objects are made a little smaller before giving up."""
    observations: float = 4.0
    """Cost of moving across the viewing ray relative to along it, when the scene has a camera; 1 is indifferent."""
    depth_measured: bool = False
    """Whether the observed distances were measured: an object then reaches its support by its size, not its place."""
    depth_weight: float = 0.3
    """How much leaving the observed distance counts against leaving the observed outline, for the objects that their
    support or wall moved, when the scene has a camera: 0.3 of a distance that was reasoned from a photo alone."""
    sizes_reasoned: bool = False
    """Whether sizes follow distances, because a photo alone gave both: an object that its support moves toward the
    camera then becomes smaller by as much."""
    weights: Weights = AS_IT_IS
    """Factors on the costs in `weights.DEFAULT_COSTS`."""
    settings: LayoutSettings = LAYOUT

    def optimise(self, scene: Scene, progress: Progress, preview: Preview | None = None) -> tuple[Scene, LayoutReport]:
        """Returns the scene with every free object's pose made feasible, and what was achieved.

        Raises:
            Cancelled: when asked to stop; nothing was changed then.
        """
        begun = time.perf_counter()
        progress.report(0.0, "reading the layout")
        problem = build_problem(scene, self.library, only=self.only, adherence_m=0.0, settings=self.settings)
        before = measure(problem, problem)
        watched = scene.camera is not None and self._across > 1.0
        visible = visible_points(scene, self.library, self.settings) if watched else {}
        wanted, observations = self._infer_unseen(problem, scene.camera, visible)
        best: tuple[Problem, Program, Separation] | None = None
        for _ in range(self.attempts):
            seen = None if observations is None else observations.limit_sizes(wanted.scale)
            eye = scene.camera.position if scene.camera is not None and self.sizes_reasoned else None
            structure = exact_structure(wanted, self._rays(wanted, scene.camera), seen, eye=eye)
            program = build_program(wanted, structure, *self._costs(wanted, scene.camera))
            if seen is not None:
                structure = fit_sizes(program, self._outline_cost(wanted))
                program = build_program(wanted, structure, *self._costs(wanted, scene.camera))
            check = self._watcher(scene, program, progress, preview)
            separation = _apart(program, self.rounds, check)
            if best is not None and len(separation.stuck) >= len(best[2].stuck):
                break  # smaller objects that overlap as much as before have become smaller in vain
            best = (wanted, program, separation)
            if not separation.stuck:
                break
            wanted = _smaller(wanted, structure, separation)
        assert best is not None, "there is at least one attempt"
        wanted, program, separation = best
        structure = program.structure
        now = program.layout(separation.y)
        after = measure(problem, replace(now, surface=structure.surface))
        apart = () if scene.camera is None else disagreements(problem, now, scene.camera)
        reasons = (
            *(problem.reasons + structure.reasons + _explain_smaller(problem, wanted, structure)),
            *(f"no room: {problem.labels[i]} and {problem.labels[j]} still overlap" for i, j in separation.stuck),
            *map(disagreement_in_words, apart),
        )
        report = LayoutReport("feasible", before, after, time.perf_counter() - begun, reasons, apart)
        return edits.set_metrics(edits.place(scene, now.free_poses), after), report

    def _infer_unseen(
        self, problem: Problem, camera: Camera | None, visible: VisiblePoints
    ) -> tuple[Problem, PhotoObservations | None]:
        """The problem with what was not seen of objects as their neighbours, walls and loads say, and what was seen."""
        observations = self._observations(problem, camera, visible)
        if observations is None or camera is None:
            return problem, None
        wanted = problem
        if not self.sizes_reasoned:
            wanted = reaching_ceilings(wanted, observations)
            observations = self._observations(wanted, camera, visible) or observations
        if self.depth_measured:
            wanted, observations = joint_heights(wanted, observations)
        eye = camera.position if self.sizes_reasoned else None
        wider = reaching_loads(wanted, exact_structure(wanted, self._rays(wanted, camera), observations, eye=eye), eye)
        grown = np.flatnonzero((wider.scale != wanted.scale).any(axis=1))
        anew = self._observations(wider, camera, visible) if len(grown) else None
        if anew is not None:
            observations = observations.replace_objects(grown, anew).no_smaller(wider.scale, wider.scale > wanted.scale)
        return wider, observations

    @property
    def _across(self) -> float:
        """Cost of moving across the viewing ray relative to along it, as weighted; 1 is indifferent."""
        return 1.0 + (self.observations - 1.0) * self.weights.outline

    def _watcher(
        self, scene: Scene, program: Program, progress: Progress, preview: Preview | None
    ) -> Callable[[np.ndarray, float], None]:
        turn = 0

        def check(y: np.ndarray, depth: float) -> None:
            nonlocal turn
            turn += 1
            progress.report(turn / (self.rounds + 1), "taking collisions away")
            if preview is not None:
                now = program.layout(y)
                moved = np.linalg.norm(now.p - program.problem.p, axis=1)
                costs = (("overlap_m", max(depth, 0.0)), ("moved_m", float(moved.mean())))
                preview(edits.place(scene, now.free_poses), costs)

        return check

    def _rays(self, problem: Problem, camera: Camera | None) -> Float[np.ndarray, "n 3"] | None:
        if camera is None or self._across <= 1.0:
            return None
        away = problem.p - camera.position
        return away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-9)

    def _observations(
        self, problem: Problem, camera: Camera | None, visible: VisiblePoints
    ) -> PhotoObservations | None:
        if camera is None or self._across <= 1.0:
            return None
        weight = self.depth_weight * self.weights.distance
        return photo_observations(
            problem,
            camera,
            depth_weight=weight,
            measured=self.depth_measured,
            boxes=self.sizes_reasoned,
            visible=visible,
        )

    def _outline_cost(self, problem: Problem) -> Float[np.ndarray, " n"]:
        """What a metre of outline counts, by object: moving it across the viewing ray."""
        return np.sqrt(self._across * _certainty(problem))

    def _costs(
        self, problem: Problem, camera: Camera | None
    ) -> tuple[Float[np.ndarray, "n 2 2"], Float[np.ndarray, "n 3 3"] | None]:
        """What moves cost: relative to the supporter and, with a photo, away from where each object was seen.

        Without a photo what carries much moves less, and its load rides along. With one, the load stays where it was
        seen while its supporter moves below it, and what is surely seen moves less.
        """
        rays = self._rays(problem, camera)
        if rays is None:
            load = np.array([float(len(problem.rides(i))) for i in range(problem.count)])
            return load[:, None, None] * np.eye(2), None
        along = rays[:, :, None] * rays[:, None, :]
        seen = self._across * np.eye(3) - (self._across - 1.0) * along
        certainty = _certainty(problem)
        return np.tile(self.settings.riding * np.eye(2), (problem.count, 1, 1)), certainty[:, None, None] * seen


def _certainty(problem: Problem) -> Float[np.ndarray, " n"]:
    """How surely it is known where each object is: by itself or by anything that was seen on it."""
    doubt = 1.0 - np.clip(problem.certainty, 0.0, 1.0)
    known = np.array([1.0 - np.prod(doubt[problem.rides(i)]) for i in range(problem.count)]).reshape(-1)
    return np.maximum(known, problem.settings.min_certainty)


def _apart(program: Program, rounds: int, check: Callable[[np.ndarray, float], None]) -> Separation:
    """The cheaper of two ways to take overlaps away: all at once, and one after another."""
    together = separate(program, rounds=rounds, check=check)
    if not program.tried:
        return together
    ways = [relax(program, way) for way in (together, relocate(program, base(program)))]
    left = program.problem.settings.left_overlap
    best = min(ways, key=lambda way: left * len(way.stuck) + float(program.cost(way.y)))
    check(best.y, best.depth_m)
    return best


def _smaller(problem: Problem, structure: Structure, separation: Separation) -> Problem:
    """The lighter object of each stuck pair a little smaller across, and both free to leave their walls."""
    stuck = {k for pair in separation.stuck for k in pair}
    scale = problem.scale.copy()
    for pair in separation.stuck:
        free = [k for k in pair if problem.free[k]]
        volume = {k: float(np.prod(problem.shape_size[k] * structure.scale[k])) for k in free}
        if free:
            k = min(free, key=lambda k: (volume[k], k))
            scale[k] *= np.where(np.abs(problem.contact[k]) > 0.5, 1.0, problem.settings.shrink)
    return replace(problem, scale=scale, adheres=tuple(a for a in problem.adheres if a[0] not in stuck))


def _explain_smaller(problem: Problem, wanted: Problem, structure: Structure) -> tuple[str, ...]:
    shrunk = np.flatnonzero((wanted.scale < problem.scale - 1e-12).any(axis=1))
    smaller = [
        i
        for i in sorted({int(i) for i in shrunk} | set(structure.reduced))
        if structure.scale[i].prod() < problem.scale[i].prod()  # fitting it to the photo may have made it larger
    ]
    return tuple(f"{problem.labels[i]} was made smaller to fit between its neighbours" for i in smaller)


def fit_sizes(program: Program, outline_cost: Float[np.ndarray, " n"]) -> Structure:
    """The structure with colliding objects smaller where that costs less than the moves it saves.

    Objects that hold up others keep their sizes.

    Args:
        program: the moves that are possible, and what they cost.
        outline_cost: what a metre of outline counts, by object, in the unit of `Program.cost`.
    """
    problem = program.problem
    factors = np.ones((problem.count, 3))
    y = base(program)
    pairs = overlaps(program, y)[1]
    for pair in pairs if len(pairs) <= problem.settings.max_pairs else ():
        options = [
            (cost, k, factor)
            for k in pair
            if problem.free[k] and len(problem.rides(k)) == 1 and (factors[k] == 1.0).all()
            for cost, factor in _options(program, y, k, factors, float(outline_cost[k]))
        ]
        moved = min((cost for cost, _, factor in options if (factor == 1.0).all()), default=np.inf)
        cost, k, factor = min(options, key=lambda option: option[0], default=(np.inf, -1, np.ones(3)))
        if cost < problem.settings.worth * moved:
            factors[k] = factor
    scale, p = _resting(program, factors)
    smaller = np.flatnonzero((factors < 1.0).any(axis=1))
    reduced = tuple(sorted({*program.structure.reduced, *map(int, smaller)}))
    return replace(program.structure, scale=scale, p=p, reduced=reduced)


def _options(
    program: Program, y: Float[np.ndarray, " v"], k: int, factors: Float[np.ndarray, "n 3"], outline_cost: float
) -> list[tuple[float, Float[np.ndarray, "3"]]]:
    """What each size of one object costs, with the move that it still needs."""
    problem, structure = program.problem, program.structure
    extents = problem.shape_size[k] * structure.scale[k]
    options: list[tuple[float, Float[np.ndarray, "3"]]] = []
    steps = (*problem.settings.shrinks, problem.settings.smallest_shrink)
    for factor in np.vstack([np.ones(3), *(np.where(_AXES, step, 1.0) for step in steps)]):
        shrunk = 0.5 * float(np.linalg.norm((1.0 - factor) * extents)) * outline_cost
        if options and shrunk >= min(cost for cost, _ in options):
            continue
        # A smaller size that still has to go far away is no help, and looking far takes long.
        reaches_m = problem.settings.reaches_m if (factor == 1.0).all() else problem.settings.reaches_m[:1]
        spot = cheapest_spot(_resize(program, k, factors, factor), y, k, reaches_m)
        if spot is not None:
            options.append((float(np.hypot(spot.cost, shrunk)), factor))
    return options


def _resize(program: Program, k: int, factors: Float[np.ndarray, "n 3"], factor: Float[np.ndarray, "3"]) -> Program:
    """The program with some objects smaller, each resting where it rests."""
    sizes = factors.copy()
    sizes[k] = factor
    scale, p = _resting(program, sizes)
    return replace(program, bodies=place_bodies(program.problem.packed, program.structure.R, p, scale))


def _resting(
    program: Program, factors: Float[np.ndarray, "n 3"]
) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3"]]:
    """Scales and centres of objects in other sizes, their contact faces where they were."""
    problem, structure = program.problem, program.structure
    scale = structure.scale * factors
    toward = problem.contact * problem.shape_size / 2 * (structure.scale - scale)
    return scale, structure.p + np.matmul(structure.R, toward[..., None])[..., 0]
