"""What the names in and around a model say it is: `chairDesk_02.glb`, `SM_Sofa_Leather`, `night stands/a.obj`.

Words are read as those of boxes are (`labels`), after the compounds that model packs write either way round. A name
that is only near a kind, and the name of a part, leave it unsure.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from diorama_core.library.labels import understand_label
from diorama_core.library.taxonomy import UNKNOWN, categories_by_word

_SAME = {"television": ("tv",), "bed": ("bedside",), "tv": ("television",), "fridge": ("refrigerator",)}
"""Words that stand for one another inside compound names."""
_EMPTY = frozenset({
    "the", "a", "an", "of", "and", "with", "model", "models", "mesh", "object", "obj", "default", "normalized",
    "untitled", "scene", "root", "node", "group", "geometry", "sm", "mat", "material", "lod", "low", "high", "poly",
    "final", "new", "copy", "export", "asset", "assets", "glb", "gltf", "fbx", "set",
})  # fmt: skip
_SOLIDS = frozenset({
    "cube", "cylinder", "sphere", "icosphere", "plane", "cone", "torus", "circle", "capsule", "prim", "primitive",
    "polysurface", "pcube", "pcylinder", "psphere", "pplane", "nurbs", "curve", "extrude", "loft", "chamferbox",
    "rectangle", "line", "solid", "shape", "xform", "instance", "component", "world", "empty", "null", "transform",
})  # fmt: skip
"""What programs call a thing that nobody named: `Cube.003`, `Cylinder12`."""
_NUMBERED_BOX = re.compile(r"^box[_.]?\d{2,}$", re.IGNORECASE)
MANY_WORDS, ONE_WORD, ELSEWHERE = 0.0, -1.2, -1.0
"""Logarithms of how much less a single word says than a compound, and a folder or a part than the file's own name."""
SURE, NEARLY, OF_A_PART = 0.99, 0.75, 0.5
"""How sure names make a kind at most: a known name of the file or its folder, one that is only near, one of a part."""
NOTHING = frozenset({
    "mannequin", "figure", "figurine", "person", "people", "human", "man", "woman", "boy", "girl", "child", "character",
    "body", "torso", "skeleton", "avatar", "soldier", "zombie", "animal", "horse", "tree", "car", "truck", "weapon",
    "staircase", "stairs", "stair", "steps", "railing", "banister", "handrail", "balustrade", "column", "pillar",
})  # fmt: skip
"""Whoever is called so furnishes no room, whatever its other words are: a mannequin's chest is no furniture."""


def words_of(name: str) -> tuple[str, ...]:
    """Plain lower-case words of a name in any usual spelling; numbers and fillers are dropped."""
    if _NUMBERED_BOX.match(name):  # 3ds Max's own name for a box
        return ()
    spaced = re.sub(
        r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])|(?<=[A-Za-z])(?=\d)|(?<=\d)(?=[A-Za-z])", " ", name
    )
    words = re.findall(r"[^\W\d_]+", spaced.lower())
    return tuple(w for w in words if w not in _EMPTY and w not in _SOLIDS and len(w) > 1)


@dataclass(frozen=True)
class NameEvidence:
    """What names say."""

    weights: Mapping[str, float] | None
    """Categories with logarithmic weights (0 is strongest). Empty when the file's name is made of words, but none of
    them is known; None when it has no such name."""
    certainty: float = SURE
    """How sure a kind can be by them."""


def name_evidence(stem: str, folders: Iterable[str] = (), parts: Iterable[str] = ()) -> NameEvidence:
    """Categories that names speak of.

    The file's own name is asked first; then the folders from the innermost outwards; then the names of its parts.
    """
    for names, less, certainty in (([stem], 0.0, SURE), (list(folders), ELSEWHERE, SURE)):
        for name in names:
            exact = _kinds_in(words_of(name))
            near = {} if exact else _label_of(words_of(name))
            if exact or near:
                weights = {category: weight + less for category, weight in (exact or near).items()}
                return NameEvidence(weights, certainty if exact else NEARLY)
    for name in parts:
        spoken = _kinds_in(words_of(name))
        if spoken:
            weights = {category: weight + ELSEWHERE for category, weight in spoken.items()}
            return NameEvidence({UNKNOWN.name: ONE_WORD + ELSEWHERE, **weights}, OF_A_PART)
    return NameEvidence({} if words_of(stem) else None)


def kind_in(name: str) -> str | None:
    """The one kind that a name speaks of, read as a file's name is; None where it says nothing."""
    words = words_of(name)
    kinds = _kinds_in(words) or _label_of(words)
    return max(kinds, key=lambda kind: kinds[kind]) if kinds else None


def _label_of(words: tuple[str, ...]) -> dict[str, float]:
    """The kind that boxes of this name would be of; the head noun may come first: `cactus_small`."""
    for end in range(len(words), 0, -1):
        kind = understand_label(" ".join(words[:end])).category
        if kind is not UNKNOWN:
            return {kind.name: ONE_WORD}
    return {}


def _kinds_in(words: tuple[str, ...]) -> dict[str, float]:
    words = words[:8]
    if NOTHING.intersection(words):
        return {UNKNOWN.name: MANY_WORDS}
    kinds_of = {p: categories_by_word().get(p, UNKNOWN) for p in _phrases(words)}
    known = {phrase: kind.name for phrase, kind in kinds_of.items() if kind is not UNKNOWN}
    used = {word for phrase in known if " " in phrase for word in phrase.split()}
    kinds: dict[str, float] = {}
    for phrase, category in known.items():
        if " " in phrase or not used.intersection(_singulars(phrase)):
            weight = MANY_WORDS if " " in phrase else ONE_WORD
            kinds[category] = max(kinds.get(category, weight), weight)
    return kinds


def _phrases(words: tuple[str, ...]) -> Iterator[str]:
    """Runs of words, and any two of them either way round: furniture is named head first as often as head last."""
    for start in range(len(words)):
        for end in range(start + 1, min(start + 4, len(words)) + 1):
            yield from _singulars(" ".join(words[start:end]))
    for a in words:
        for b in words:
            if a != b:
                for first in (a, *_SAME.get(a, ())):
                    yield from _singulars(f"{first} {b}")


def _singulars(phrase: str) -> Iterator[str]:
    yield phrase
    if phrase.endswith("s"):
        yield phrase[:-1]
    if phrase.endswith("es"):
        yield phrase[:-2]
    if phrase.endswith("ves"):
        yield phrase[:-3] + "f"
