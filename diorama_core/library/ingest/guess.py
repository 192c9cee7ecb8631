"""Which way is up, where is the front, how large is a unit, and what is it: the most probable answer to all at once.

Every combination of a category, one of the 24 orientations and a unit is scored by what the format promises, by how
well the size fits the category, and by how much the model then looks like known shapes of that category. What the user
or a data set knows is taken as it is. A category is out where the model cannot be so large (`kind_sizes.is_possible`);
a format that promises metres and +Y up keeps its promise, and what speaks against it makes the answer unsure.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np
import trimesh
from jaxtyping import Bool, Float, Int
from scipy.special import logsumexp

from diorama_core.library import taxonomy
from diorama_core.library.ingest.frames import Convention
from diorama_core.library.ingest.given import AXES, UNITS, Given, axis_name
from diorama_core.library.ingest.known_shapes import KnownShapes, relief_features
from diorama_core.library.ingest.names import NameEvidence
from diorama_core.library.ingest.relief import Relief, quarter_turns, turn
from diorama_core.library.kinds import is_possible
from diorama_core.library.labels import meanings
from diorama_core.library.record import Assumption, Guess

PROMISED_UP = "+y"
"""Up axis of formats that specify one (glTF)."""
SIMILARITY = 60.0
"""Log-probability lost per unit of mean relief difference to the likest known shapes."""
MIRRORED = 6.0
"""Lost per unit of difference between left and right: most objects are the same on both sides."""
PROPORTION = 1.5
"""Lost per unit of difference in the logarithms of proportions to the known shapes."""
NOTHING_ALIKE = 0.16
"""Relief difference taken for categories without known shapes."""
WORST_SIZE, WORSE_BY = -6.0, 3.0
"""An odd size costs at most the first, and the second for each unit of its logarithm: some tables are just large."""
ANY_SCALE = 1e-4
"""Prior of a unit that is none of the usual ones."""
LIKELY_OTHER, LIKELY_KNOWN = 0.0, -4.0
"""Log prior of an unknown, and of a known category, for a model whose name matches none."""
UNNAMED_OTHER, UNNAMED_KNOWN = -2.5, -1.5
"""Log prior of an unknown, and of a known category, for a model without a name."""
OTHER_WORD = 0.7
"""How sure a kind can be by looks, of a model whose name is a word for none."""
UNTRUE_NAME = -300.0
"""Log prior of a kind other than those of its name: taken only where none of those is possible."""
MIN_METRES, MAX_METRES = 0.01, 18.0
"""Longest sides between which a promise of metres is kept: beyond, every kind is off by a factor above 3."""
ALIKE, LIKEST = 1, 8
"""How many of the likest known shapes of a category are asked, and how many of the likest categories are compared."""


@dataclass(frozen=True)
class Frame:
    """How a file's frame becomes the canonical one."""

    R_shape_file: Int[np.ndarray, "3 3"]
    unit_m: float
    category: str
    guess: Guess


def guess_frame(
    mesh: trimesh.Trimesh,
    pictures: Relief,
    convention: Convention,
    named: NameEvidence,
    known: KnownShapes,
    given: Given,
) -> Frame:
    """The most probable frame, unit and category of a model.

    Args:
        mesh: In the file's frame and unit.
        pictures: Its relief.
        convention: What its format promises.
        named: Categories its names speak of.
        known: Shapes to compare it with.
        given: What need not be guessed.

    """
    units = _unit_prior(convention, given, float(mesh.extents.max()))
    table, log_extents = _table(mesh, pictures, convention, named, known, given, units)
    return _choose(table, quarter_turns(), list(units), log_extents, convention, given, named)


def frame_evidence(
    mesh: trimesh.Trimesh, pictures: Relief, named: NameEvidence, known: KnownShapes, given: Given
) -> Float[np.ndarray, "24 u"]:
    """How likely each turn and usual unit is by the model alone, whatever its format promises; logarithms.

    Args:
        mesh: In the file's frame and unit.
        pictures: Its relief.
        named: Categories its names speak of.
        known: Shapes to compare it with.
        given: What need not be guessed.
    """
    nothing = Convention("no", {}, {}, {})
    table, _ = _table(mesh, pictures, nothing, named, known, given, dict.fromkeys(UNITS, 1.0))
    return logsumexp(np.stack([rows[:, :-1] for rows in table.values()]), axis=0)


def convention_prior(convention: Convention, units: Sequence[float]) -> Float[np.ndarray, "24 u"]:
    """What a format promises of turns and units; logarithms."""
    turns, nothing = quarter_turns(), Given()
    frame = _frame_prior([axis_name(R[2]) for R in turns], [axis_name(R[0]) for R in turns], convention, nothing)
    return frame[:, None] + np.log([convention.unit.get(u, 0.02) for u in units])


def _table(
    mesh: trimesh.Trimesh,
    pictures: Relief,
    convention: Convention,
    named: NameEvidence,
    known: KnownShapes,
    given: Given,
    units: Mapping[float, float],
) -> tuple[dict[str, Float[np.ndarray, "24 _"]], Float[np.ndarray, "24 3"]]:
    """Logarithmic scores by category, for each turn and unit and the unit that fits best; and extents by turn."""
    turns = quarter_turns()
    ups = [axis_name(R[2]) for R in turns]
    fronts = [axis_name(R[0]) for R in turns]
    features = np.stack([relief_features(turn(pictures, R)) for R in turns])
    log_extents = np.log(np.maximum(mesh.extents, 1e-9))[np.abs(turns).argmax(axis=2)]
    frame = _frame_prior(ups, fronts, convention, given) - MIRRORED * _asymmetry(pictures, turns)
    table: dict[str, np.ndarray] = {}
    sizes = [log_extents + np.log(unit) for unit in units]
    allowed = np.concatenate([size[np.isfinite(frame)] for size in sizes])
    for name, weight in _candidates(features, named.weights, known, given, allowed).items():
        rows = table[name] = np.full((len(turns), len(units) + 1), -np.inf)
        alike = -SIMILARITY * _unlike(features, log_extents, name, known)
        for column, (log_sizes, prior) in enumerate(zip(sizes, units.values(), strict=True)):
            rows[:, column] = weight + alike + frame + np.log(prior) + _size_fit(log_sizes, name)
            if given.category is None:
                rows[~_possible(name, log_sizes, is_given=name in (named.weights or ())), column] = -np.inf
        if given.unit_m is None and len(units) > 1 and name != taxonomy.UNKNOWN.name:  # which has no usual size
            free = _best_scale(log_extents, name)
            fit = _size_fit(log_extents + free[:, None], name)
            rows[:, -1] = weight + alike + frame + np.log(ANY_SCALE) + fit
    return table, log_extents


def _possible(name: str, log_sizes: Float[np.ndarray, "n 3"], *, is_given: bool) -> Bool[np.ndarray, " n"]:
    """For each size, whether a thing of the kind can be so large; only which axis is up matters."""
    possible: dict[float, bool] = {}
    for size in log_sizes:
        if size[2] not in possible:
            possible[size[2]] = is_possible(name, np.exp(size), is_given=is_given)
    return np.array([possible[size[2]] for size in log_sizes])


def _choose(
    scores: Mapping[str, Float[np.ndarray, "24 u"]],
    turns: Int[np.ndarray, "24 3 3"],
    units: list[float],
    log_extents: Float[np.ndarray, "24 3"],
    convention: Convention,
    given: Given,
    named: NameEvidence,
) -> Frame:
    """The best entry of the table, and how sure each of its answers is."""
    categories, table = list(scores), np.stack(list(scores.values()))
    posterior = np.exp(table - table.max())
    posterior /= posterior.sum()
    kept = given.up is None and convention.promises
    allowed = [axis_name(R[2]) == PROMISED_UP for R in turns] if kept else [True] * len(turns)
    best = np.unravel_index(int(np.where(np.array(allowed)[None, :, None], table, -np.inf).argmax()), table.shape)
    c, q, u = (int(i) for i in best)
    same_up = (turns[:, 2] == turns[q, 2]).all(axis=1)
    up, front = axis_name(turns[q, 2]), axis_name(turns[q, 0])
    unit = units[u] if u < len(units) else float(np.exp(_best_scale(log_extents[q : q + 1], categories[c])[0]))
    promised = f"the {convention.name} convention" if convention.up.get(up, 0) > 0.3 else "its shape"
    usual = u < len(units) and convention.unit.get(unit, 0) > 0.3
    size_says = "its size" if u < len(units) else f"no usual unit fits: scaled to the usual size of a {categories[c]}"
    strange = named.weights is not None and not named.weights and categories[c] != taxonomy.UNKNOWN.name
    guess = Guess(
        up=_assume(up, posterior[:, same_up].sum(), promised, given.up, given),
        front=_assume(
            front, posterior[:, q].sum() / max(posterior[:, same_up].sum(), 1e-300), "its shape", given.front, given
        ),
        unit=_assume(f"{unit:.6g}", posterior[..., u].sum(), promised if usual else size_says, given.unit_m, given),
        category=_assume(
            categories[c],
            min(posterior[c].sum(), OTHER_WORD if strange else named.certainty),
            "its name" if named.weights else "its looks",
            given.category,
            given,
        ),
    )
    return Frame(turns[q], unit, categories[c], guess)


def _assume(value: str, confidence: float, reason: str, stated: object, given: Given) -> Assumption:
    if stated is not None:
        return Assumption(value, 1.0, given.reason)
    return Assumption(value, round(float(min(confidence, 0.99)), 3), reason)


def _frame_prior(ups: list[str], fronts: list[str], convention: Convention, given: Given) -> Float[np.ndarray, "24"]:
    up = _axis_prior(convention.up, given.up)
    front = _axis_prior(convention.front, given.front)
    return np.array([up[a] + front[b] for a, b in zip(ups, fronts, strict=True)])


def _axis_prior(promised: Mapping[str, float], stated: str | None) -> dict[str, float]:
    """Logarithmic weights of the six axes; what is stated excludes the rest."""
    if stated is not None:
        return {a: 0.0 if a == stated else -np.inf for a in AXES}
    rest = (1.0 - sum(promised.values())) / max(len(AXES) - len(promised), 1)
    return {a: float(np.log(promised.get(a, rest))) for a in AXES}


def _unit_prior(convention: Convention, given: Given, longest: float) -> dict[float, float]:
    if given.unit_m is not None:
        return {given.unit_m: 1.0}
    if convention.promises and (MIN_METRES <= longest <= MAX_METRES or convention.kept):
        return {1.0: 1.0}
    return {u: convention.unit.get(u, 0.02) for u in (*UNITS, *(u for u in convention.unit if u not in UNITS))}


def _candidates(
    features: Float[np.ndarray, "24 f"],
    named: Mapping[str, float] | None,
    known: KnownShapes,
    given: Given,
    log_sizes: Float[np.ndarray, "n 3"],
) -> dict[str, float]:
    """Categories worth scoring with their prior: the given one, those named, or those that it looks like and may be.

    Args:
        features: Of the model's relief in each orientation.
        named: Categories its names speak of; none of those we know when empty, None without a name.
        known: Shapes to compare it with.
        given: What need not be guessed.
        log_sizes: What its size may be, in every orientation and unit that is allowed.
    """
    if given.category is not None:
        return {taxonomy.resolve(given.category).category.name: 0.0}
    if named:
        return {taxonomy.UNKNOWN.name: UNTRUE_NAME, **named}
    other, likely = (UNNAMED_OTHER, UNNAMED_KNOWN) if named is None else (LIKELY_OTHER, LIKELY_KNOWN)
    unlike = np.min([np.abs(known.features - f).mean(axis=1) for f in features], axis=0)
    frequent = meanings(taxonomy.UNKNOWN.name, taxonomy.UNKNOWN.name)
    prior = {kind: likely + float(np.log(share * len(frequent))) for kind, share in frequent.items()}
    alike = {kind: -SIMILARITY * float(unlike[rows].min()) for kind in prior if len(rows := known.rows_of(kind))}
    score = {kind: prior[kind] + value + float(_size_fit(log_sizes, kind).max()) for kind, value in alike.items()}
    possible = (
        kind for kind in sorted(score, key=lambda k: -score[k]) if _possible(kind, log_sizes, is_given=False).any()
    )
    return {taxonomy.UNKNOWN.name: other, **{kind: prior[kind] for kind in islice(possible, LIKEST)}}


def _unlike(
    features: Float[np.ndarray, "24 f"], log_extents: Float[np.ndarray, "24 3"], category: str, known: KnownShapes
) -> Float[np.ndarray, "24"]:
    """Mean difference to the likest known shapes of a category, in each orientation."""
    rows = known.rows_of(category) if category != taxonomy.UNKNOWN.name else np.zeros(0, int)
    if len(rows) == 0:
        return np.full(len(features), NOTHING_ALIKE)
    difference = np.stack([np.abs(known.features[rows] - f).mean(axis=1) for f in features])
    proportions = log_extents - log_extents.mean(axis=1, keepdims=True)
    theirs = known.log_extents[rows] - known.log_extents[rows].mean(axis=1, keepdims=True)
    difference += PROPORTION / SIMILARITY * np.abs(proportions[:, None] - theirs[None]).mean(axis=2)
    return np.sort(difference, axis=1)[:, :ALIKE].mean(axis=1)


def _asymmetry(pictures: Relief, turns: Int[np.ndarray, "24 3 3"]) -> Float[np.ndarray, "24"]:
    """How much left and right differ in each orientation."""
    mirrors = [np.diag([-1 if k == axis else 1 for k in range(3)]) for axis in range(3)]
    along = np.array([np.abs(relief_features(pictures) - relief_features(turn(pictures, m))).mean() for m in mirrors])
    return along[np.abs(turns[:, 1]).argmax(axis=1)]


def _size_fit(log_sizes: Float[np.ndarray, "n 3"], category: str) -> Float[np.ndarray, " n"]:
    """Log-likelihood of sizes (x, y, z) under a category's priors, up to a constant; the best of its modes."""
    priors = taxonomy.category(category).priors
    off = np.stack([log_sizes - p.log_median_xyz for p in priors])
    sigma = np.stack([np.maximum(p.log_sigma_xyz, 0.12) for p in priors])[:, None]
    usual = -0.5 * ((off / sigma) ** 2).sum(axis=2)
    fit = np.maximum(usual, WORST_SIZE - WORSE_BY * np.abs(off).max(axis=2)).max(axis=0)
    return fit - np.log(sigma).sum(axis=2).min()


def _best_scale(log_extents: Float[np.ndarray, "n 3"], category: str) -> Float[np.ndarray, " n"]:
    """Logarithm of the scale that brings extents nearest to a category's usual size."""
    prior = taxonomy.category(category).priors[0]
    weight = 1.0 / np.maximum(prior.log_sigma_xyz, 0.12) ** 2
    return ((prior.log_median_xyz - log_extents) * weight).sum(axis=1) / weight.sum()
