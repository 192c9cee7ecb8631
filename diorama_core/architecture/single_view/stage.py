"""The room from one photo without depth: a chain of walls from lines, edges, colours and the objects inside it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from diorama_core.architecture.single_view.level_view import level_view
from diorama_core.architecture.single_view.room_cues import MAX_CEILING_M, RoomCues, gather_room_cues
from diorama_core.architecture.single_view.settings import SETTINGS, PhotoRoomSettings, RoomSearchSettings
from diorama_core.architecture.single_view.wall_chain import (
    Chain,
    ChainScorer,
    PhotoWalls,
    best_ceiling,
    best_chain,
    corners_of,
    refine_chain,
)
from diorama_core.architecture.supports import resolve_supports
from diorama_core.architecture.texture.colours import colour_planes, visible_planes
from diorama_core.architecture.walls.ceilings import CeilingPiece
from diorama_core.architecture.walls.closed_room import GUESS_CONFIDENCE, room_planes
from diorama_core.architecture.walls.openings import WallOpening, counts
from diorama_core.architecture.walls.passages import with_passages
from diorama_core.architecture.walls.wall_candidates import WallCandidate
from diorama_core.architecture.walls.wall_path import Run, heading
from diorama_core.architecture.walls.wall_sequence import CORNER_SLACK_RAD, WallPiece, chain_runs, meeting_point
from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, Inputs, ObjectGeometry
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod, RoomSource
from diorama_core.scene.types import Architecture, Plane

CEILINGS_M = np.geomspace(2.1, MAX_CEILING_M, 28)


@dataclass(frozen=True)
class PhotoRoom:
    """Walls by dynamic programming over headings (Flint et al. 2010).

    The floor is z = 0 of the metric camera. Boxes, L-shapes and rooms with a slanted wall are one kind of thing: a
    chain of upright planes that lines, edges, colours and the objects in the room support best.
    """

    settings: PhotoRoomSettings = SETTINGS

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """Floor, walls and ceiling, with "floor" and "wall" supports resolved.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.ArchitectureStage`.
        """
        progress.report(0.0, "Looking for the room's walls")
        cues = gather_room_cues(inputs.photo.rgb, geometry.camera, objects, geometry.cuboids, self.settings.cues)
        progress.report(0.4, "Following the walls from left to right")
        scorer = ChainScorer(cues, level_view(inputs.photo.rgb, cues, objects), self.settings)
        chain = find_chain(scorer, self.settings.search)
        sure = GUESS_CONFIDENCE + (0.9 - GUESS_CONFIDENCE) * scorer.support(chain)
        pieces = _pieces(chain, scorer, sure, self.settings.search)
        top_m = max(chain.ceiling_m, _highest(cues, self.settings.search))
        hung = any(s.parent == "ceiling" for s in geometry.supports)
        openings, pointed = with_passages(((),) * len(pieces), objects, pieces, geometry.camera, top_m)
        planes = colour_planes(
            _planes(pieces, top_m, geometry, hung, openings, self.settings.search),
            inputs.photo.rgb,
            geometry.camera,
            objects,
        )
        architecture = Architecture(planes)
        progress.report(1.0, "The room is closed")
        walls = architecture.by_role("wall")
        return ArchitectureEstimate(
            architecture=architecture,
            supports=resolve_supports(geometry, architecture),
            confidence=float(np.mean([w.confidence for w in walls])),
            source=_source(pieces, top_m, float(sure.max()), openings),
            openings=pointed,
        )


def find_chain(scorer: ChainScorer, settings: RoomSearchSettings) -> Chain:
    """The cheapest chain of walls, begun below several ceilings: which walls are best depends on how high they are."""
    walls = candidate_walls(scorer.cues, settings)
    above_camera_m = float(scorer.cues.camera.position[2]) + settings.above_camera_m
    begun = (best_chain(scorer, walls, max(height, above_camera_m)) for height in settings.first_ceilings_m)
    ceilings_m = dict.fromkeys(best_ceiling(scorer, chain, CEILINGS_M) for chain in begun)
    chains = [best_chain(scorer, walls, ceiling_m) for ceiling_m in ceilings_m]
    return refine_chain(scorer, min(chains, key=lambda chain: chain.cost), CEILINGS_M)


def candidate_walls(cues: RoomCues, settings: RoomSearchSettings) -> PhotoWalls:
    """Walls across the room's axes and the slanted direction, at many distances and at those of lines."""
    eye = cues.camera.position[:2]
    away = np.geomspace(settings.nearest_m, settings.farthest_m, settings.distances)
    facing = [(np.array([1.0, 0.0]), 0), (np.array([-1.0, 0.0]), 0), (np.array([0.0, -1.0]), 1)]
    for number, angle in enumerate(cues.slants_rad):
        square = np.array([-np.sin(angle), np.cos(angle)])
        facing += [(sign * square, 2 + number) for sign in (1.0, -1.0)]
    normals, offsets, directions = [], [], []
    for normal, direction in facing:
        seen = _distances_of_lines(cues, normal, 1 - direction, settings) if direction < 2 else np.zeros(0)
        distances = np.unique(np.concatenate([away, seen]))
        normals.append(np.repeat(normal[None], len(distances), axis=0))
        offsets.append(float(normal @ eye) - distances)
        directions.append(np.full(len(distances), direction))
    return PhotoWalls(np.concatenate(normals), np.concatenate(offsets), np.concatenate(directions))


def _distances_of_lines(
    cues: RoomCues, normal: Float[np.ndarray, "2"], axis: int, settings: RoomSearchSettings
) -> Float[np.ndarray, "n"]:
    """Distances of walls whose foot is one of the longest lines along an axis."""
    rays = cues.segment_rays[cues.segment_axes == axis]
    rays = rays[rays[:, 2] < -1e-3][: settings.lines]
    reach = cues.camera.position[2] / -rays[:, 2]
    distances = -reach * (rays[:, :2] @ normal)
    return np.asarray(distances[(distances > settings.nearest_m) & (distances < settings.farthest_m)])


def _pieces(
    chain: Chain, scorer: ChainScorer, sure: Float[np.ndarray, "r"], settings: RoomSearchSettings
) -> tuple[WallPiece, ...]:
    """The chain's walls as pieces that meet, with room for the objects that stand before them."""
    edges, eye = scorer.view.edges_rad, scorer.cues.camera.position[:2]
    seen = _runs(chain.walls, edges[chain.borders], settings.measured - sure)
    runs = _runs(_with_room(chain, seen, scorer, sure, settings), edges[chain.borders], settings.measured - sure)
    for k, joined in enumerate(_joints(seen, eye)):
        corner = meeting_point(runs[k].wall, runs[k + 1].wall)
        if corner is not None and joined:
            at = float(heading(corner, eye))
            runs[k], runs[k + 1] = replace(runs[k], last=at), replace(runs[k + 1], first=at)
    return chain_runs(runs, (float(edges[0]), float(edges[-1])), eye)


def _runs(walls: PhotoWalls, ends: Float[np.ndarray, "r1"], seen_through: Float[np.ndarray, "r"]) -> list[Run]:
    known = zip(walls.normals, walls.offsets.tolist(), seen_through.tolist(), pairwise(ends.tolist()), strict=True)
    nothing = np.zeros(0, dtype=bool)
    return [Run(WallCandidate(normal, at, nothing, through, 1.0), *span) for normal, at, through, span in known]


def _with_room(
    chain: Chain, runs: list[Run], scorer: ChainScorer, sure: Float[np.ndarray, "r"], settings: RoomSearchSettings
) -> PhotoWalls:
    """The chain's walls, moved outward where the objects that protrude through them weigh more than what was seen.

    A wall that moves alone takes its corners out of the line of sight in which they were seen; moved as far in
    proportion, its neighbours retain them. That is done unless it contradicts the photo by more than a corner is worth.
    """
    eye = scorer.cues.camera.position[:2]
    out = [_push(run, scorer.cues, certainty, settings) for run, certainty in zip(runs, sure.tolist(), strict=True)]
    apart = replace(chain.walls, offsets=chain.walls.offsets - np.array(out))
    if not any(out):
        return apart
    at_eye = chain.walls.normals @ eye
    farther = (apart.offsets - at_eye) / (chain.walls.offsets - at_eye)
    groups = np.cumsum([0, *(not joined for joined in _joints(runs, eye))])
    most = np.array([farther[groups == group].max() for group in groups])
    together = replace(chain.walls, offsets=at_eye + (chain.walls.offsets - at_eye) * most)
    cost = [best_chain(scorer, walls, chain.ceiling_m).cost for walls in (apart, together)]
    return together if cost[1] < cost[0] + settings.corner_cost else apart


def _joints(runs: list[Run], eye: Float[np.ndarray, "2"]) -> list[bool]:
    """Whether each wall and the next one meet where the one ends."""
    corners = [(meeting_point(run.wall, following.wall), run.last) for run, following in pairwise(runs)]
    return [c is not None and bool(abs(heading(c, eye) - end) <= CORNER_SLACK_RAD) for c, end in corners]


def _push(run: Run, cues: RoomCues, sure: float, settings: RoomSearchSettings = SETTINGS.search) -> float:
    """How far, in metres, a wall gives way to the objects within its headings.

    Every object pulls by its confidence as far as it protrudes, and by the share of it that does, since where it ends
    behind is a guess; the wall resists by how sure it is. Either may be wholly wrong, so that much farther says little
    more. What could stand on furniture and would be wholly behind the wall is not where it seems to be.
    """
    eye = cues.camera.position[:2]
    outs, weights = [0.0], [0.0]
    known = zip(cues.object_low, cues.object_high, cues.object_weights, cues.object_portable, strict=True)
    for low, high, weight, portable in known:
        corners = corners_of(low, high)
        towards = heading(corners, eye)
        through = run.wall.offset - corners @ run.wall.normal
        beside = towards.max() < run.first or towards.min() > run.last or np.ptp(towards) > np.pi
        elsewhere = portable and through.min() > 0.0
        if not beside and not elsewhere and 0.0 < through.max() < settings.max_push_m:
            outs.append(float(through.max()) + settings.clearance_m)
            weights.append(float(weight * min(1.0, through.max() / np.ptp(through))))
    out = np.array(outs)
    left = np.clip(out - out[:, None], 0.0, settings.enough_out_m)
    resistance = settings.push_weight * sure**2 * settings.enough_out_m * np.log1p(out / settings.enough_out_m)
    return outs[int(np.argmin(left @ np.array(weights) + resistance))]


def _highest(cues: RoomCues, settings: RoomSearchSettings) -> float:
    """Top of the highest object, which is below the ceiling."""
    tops = cues.object_high[:, 2]
    return float(tops.max()) + settings.clearance_m if len(tops) else 0.0


def _planes(
    pieces: tuple[WallPiece, ...],
    top_m: float,
    geometry: ObjectGeometry,
    hung: bool,
    openings: tuple[tuple[WallOpening, ...], ...],
    settings: RoomSearchSettings,
) -> tuple[Plane, ...]:
    """The closed room; without a ceiling where none shows and nothing hangs from it."""
    ceiling = CeilingPiece(np.array([0.0, 0.0, -1.0]), -top_m, np.inf)
    planes = room_planes(pieces, (ceiling,), geometry.camera, top_m, settings.floor_confidence, openings)
    seen = visible_planes(planes, geometry.camera, settings.ceiling_step)
    shown = [hung or float((seen == index).mean()) >= settings.min_visible_share for index in range(len(planes))]
    known = [None if p.candidate is None else settings.measured - p.candidate.seen_through for p in pieces]
    mean = float(np.mean([c for c in known if c is not None]))
    sure = {f"wall_{k}": GUESS_CONFIDENCE if c is None else c for k, c in enumerate(known, 1)} | {"ceiling": mean}
    return tuple(
        replace(p, confidence=sure.get(p.id, p.confidence))
        for p, is_shown in zip(planes, shown, strict=True)
        if p.role != "ceiling" or is_shown
    )


def _source(
    pieces: tuple[WallPiece, ...], top_m: float, sure: float, openings: tuple[tuple[WallOpening, ...], ...]
) -> RoomSource:
    seen = sum(p.candidate is not None for p in pieces)
    doorways, windows = counts(openings)
    return RoomSource(
        RoomMethod.USUAL_SIZES if sure <= 2 * GUESS_CONFIDENCE else RoomMethod.PHOTO_CUES,
        walls_found=seen,
        walls_assumed=len(pieces) - seen,
        wall_height_m=float(top_m),
        doorways=doorways,
        windows=windows,
    )
