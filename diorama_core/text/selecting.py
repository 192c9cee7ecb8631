"""Which objects of a scene a phrase means: by noun, attributes and what they stand on or beside."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

import numpy as np

from diorama_core.editing.relations import Relation, is_met
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.errors import EditRefused
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.library.taxonomy import broad, category, is_furniture, with_kin
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Scene, SceneObject
from diorama_core.text.looks import has_look
from diorama_core.text.phrases import APPEARANCES, NUMBERS, NounPhrase, PlacePhrase, noun_phrase, split_places

LISTED = 12
_ORDINALS = {"first": 1, "second": 2, "third": 3, "fourth": 4, "fifth": 5, "sixth": 6, "last": 0}
_ALL_BUT = re.compile(r"^all (?:of )?(?:but|except) (\w+)(?: of)? (?:the |my |these |those )?(.+)$")
_EXCEPT = re.compile(r"\b(?:other than|apart from|but not|but keep|but leave|but)\b")
_LARGER = frozenset({"larger", "bigger", "largest", "biggest", "large", "big"})
_SMALLER = frozenset({"smaller", "smallest", "small", "little", "tiny"})


class Selector:
    """Finds what phrases mean in one scene.

    Args:
        scene: where.
        library: what its shapes look like.
        last: ids that "it" and "them" mean.
        selected: ids that a person has selected: they decide between several of a kind.
    """

    def __init__(
        self, scene: Scene, library: ShapeLibrary, last: Sequence[str] = (), selected: Sequence[str] = ()
    ) -> None:
        self.scene, self.library = scene, library
        self.last, self.selected = tuple(last), tuple(selected)
        self._frame = RoomFrame.of(scene)

    def objects(self, words: str, places: Sequence[PlacePhrase] = (), *, movable: bool = False) -> tuple[str, ...]:
        """Ids of the objects that a phrase means, with the phrases of place that tell them apart.

        Args:
            words: the phrase; "the second chair" is that of its label or order.
            places: where it is.
            movable: it is to go somewhere: of several, those on a ceiling are not meant.

        Raises:
            EditRefused: it means none, or one of several without saying which.
        """
        phrase, unknown = noun_phrase(words)
        if phrase is None:
            raise EditRefused(
                f"nothing in a room is called “{unknown or words.strip()}”; this scene has: {self.inventory()}"
            )
        if phrase.pronoun:
            return self._referents(words)
        exact = [o.id for o in self.scene.objects if o.label.lower() == _plain(words)]
        if len(exact) == 1:
            return (exact[0],)
        if phrase.beyond and not any(set(phrase.beyond) <= set(o.label.lower().split()) for o in self.scene.objects):
            raise EditRefused(f"“{words.strip()}”: “{' '.join(phrase.beyond)}” is not understood")
        objects = self._filter(self._matches(phrase, words), places)
        if movable and not phrase.label:  # "everything" that is moved is what stands on the floor, with what it carries
            objects = [o for o in objects if self._stands_free(o)] or objects
        elif movable and not phrase.every:
            objects = [o for o in objects if category(o.category).mount != "ceiling"] or objects
        number = next((k for w, k in _ORDINALS.items() if w in words.lower().split()), None)
        if number is not None and not phrase.plural:
            if number > len(objects):
                raise EditRefused(f"there are only {len(objects)} of these: {_names(objects)}")
            return (objects[number - 1 if number else -1].id,)
        return self._select(objects, phrase, words)

    def subject(self, text: str) -> list[str]:
        """Ids of the objects that words mean with everything that is said of where they are; several joined by "and".

        Raises:
            EditRefused: as `objects`, or there are too few of them.
        """
        if (spared := all_but(text)) is not None:
            number, noun = spared
            ids = self.subject(f"all {noun}")
            if len(ids) <= number:
                raise EditRefused(f"there {'is' if len(ids) == 1 else 'are'} only {len(ids)} of these")
            return ids[number:]
        if (share := re.match(r"half (?:of )?(?:the |my |all )*(.+)", text)) is not None:
            ids = self.subject(f"all {share[1]}")
            return ids[: max(len(ids) // 2, 1)]
        kept, _, left = (part.strip() for part in _EXCEPT.sub("except", text).partition("except"))
        if left:
            whose = noun_phrase(kept)[0] if set(left.split()) <= {*APPEARANCES, "the", "one"} else None
            left_out = self.subject(left if whose is None else f"{left} {whose.label}")  # "all but the largest"
            return [i for i in self.subject(kept) if i not in left_out]
        parts = [text] if re.search(r"\bbetween\b", text) else re.split(r",\s*|\band\b", text)
        ids = []
        for part in parts:
            if part.strip():
                part = part if part is parts[0] else re.sub(r"\b(?:it|them)$", parts[0], part.strip())
                head, places = split_places(part)
                ids += [i for i in self.objects(head, places) if i not in ids]
        return ids

    def targets(self, words: str) -> tuple[str, ...]:
        """Ids of what a phrase of place refers to; one object, or two joined by "and"."""
        parts = [p for p in words.replace("&", " and ").split(" and ") if p.strip()]
        if len(parts) > 1:
            return tuple(i for part in parts for i in self.objects(part))
        return self.objects(words)

    def inventory(self) -> str:
        """What the scene has, in a few words."""
        counts = Counter(o.category for o in self.scene.objects)
        listed = [name if n == 1 else f"{name} ({n})" for name, n in counts.most_common(LISTED)]
        return ", ".join(listed) + (", ..." if len(counts) > LISTED else "") if listed else "nothing yet"

    def _referents(self, words: str) -> tuple[str, ...]:
        known = tuple(i for i in (self.last or self.selected) if self.scene.has_object(i))
        if not known:
            raise EditRefused(f"“{words.strip()}” is not clear here; name the object")
        return known

    def _matches(self, phrase: NounPhrase, words: str) -> list[SceneObject]:
        if not phrase.label:
            inside = [o for o in self.scene.objects if o.category not in OPENING_CATEGORIES]
            furniture = [o for o in inside if "furniture" not in words or is_furniture(o.category)]
            return self._looking(furniture, phrase.appearance)
        objects = self.scene.objects
        kin = with_kin(phrase.category)
        matches = [o for o in objects if o.category == phrase.category] or [o for o in objects if o.category in kin]
        noun = phrase.label.split()[-1].removesuffix("s")
        labelled = [o for o in objects if noun in (w.removesuffix("s") for w in o.label.lower().split())]
        of_all_sorts = [o for o in objects if o.category.split()[-1] == noun == phrase.category]
        if phrase.every or (phrase.plural and len(matches) < 2):
            matches = of_all_sorts or matches  # "every lamp" is also those that stand on the floor and hang
        # An armchair is a chair, too.
        matches = matches or [o for o in objects if o.category.endswith(noun)] or labelled
        if not matches:
            raise EditRefused(f"there is no {phrase.category} in this scene; it has: {self.inventory()}")
        return self._looking(matches, phrase.appearance)

    def _stands_free(self, item: SceneObject) -> bool:
        edge = self.scene.support_of(item.id)
        if edge is None:
            return False
        on_rug = self.scene.has_object(edge.parent) and broad(self.scene.object(edge.parent).category) == "rug"
        on_floor = self.scene.has_plane(edge.parent) and edge.relation == "placed on"
        return (on_floor or on_rug) and category(item.category).mount == "floor" and broad(item.category) != "rug"

    def _looking(self, objects: list[SceneObject], appearance: Sequence[str]) -> list[SceneObject]:
        for word in appearance:
            if word in _LARGER | _SMALLER and len(objects) > 1:
                pick = max if word in _LARGER else min
                objects = [pick(objects, key=lambda o: float(np.prod(o.size_m)))]
                continue
            like = [
                o for o in objects if has_look(record_of(self.library, o.shape_id), word) or word in o.label.lower()
            ]
            if like:
                objects = like
            elif len(objects) > 1:
                kind = objects[0].category if len({o.category for o in objects}) == 1 else "object"
                raise EditRefused(f"no {kind} here is {word}; there are {len(objects)}: {_names(objects)}")
        return objects

    def _filter(self, objects: list[SceneObject], places: Sequence[PlacePhrase]) -> list[SceneObject]:
        for place in places:
            targets = self.targets(place.words) if place.words else ()
            if place.kind == "on" and targets:
                carried = {d for t in targets for d in descendants(self.scene, t)}
                here = [o for o in objects if o.id in carried]
            else:
                relation = Relation(place.kind, targets)
                here = [o for o in objects if o.id not in targets and is_met(self.scene, o.id, relation, self._frame)]
            if not here:
                where = Relation(place.kind, targets).words(self.scene)
                what = "nothing" if len({o.category for o in objects}) > 1 else f"no {objects[0].category}"
                raise EditRefused(f"{what} is {where} in this scene")
            objects = here
        return objects

    def _select(self, objects: list[SceneObject], phrase: NounPhrase, words: str) -> tuple[str, ...]:
        ids = tuple(o.id for o in objects)
        if phrase.every or not phrase.label or len(ids) == 1:
            return ids
        chosen = tuple(i for i in ids if i in self.selected)
        if phrase.plural:
            if not any(w.isdigit() or w in ("two", "three", "four", "five", "six") for w in words.split()):
                return ids
            if phrase.count > len(ids):
                raise EditRefused(f"there are only {len(ids)} of {phrase.count} {phrase.label}: {_names(objects)}")
            return (chosen or ids)[: phrase.count]
        if len(chosen) == 1:
            return chosen
        if not phrase.definite:
            return ids[:1]
        alike = len({o.label for o in objects}) < len(objects)
        which = f"the second {phrase.label}" if alike else objects[0].label
        raise EditRefused(f"there are {len(ids)} of these: {_names(objects)}; say which (“{which}”), or “all”")


def all_but(text: str) -> tuple[int, str] | None:
    """How many of what are spared: "all but one of the pillows"; None where a phrase says something else."""
    match = _ALL_BUT.match(text.strip())
    if match is None or not (match[1].isdigit() or NUMBERS.get(match[1], 0)) or match[1] in ("the", "a", "an"):
        return None
    return (int(match[1]) if match[1].isdigit() else NUMBERS[match[1]]), match[2]


def _plain(words: str) -> str:
    return " ".join(w for w in words.lower().split() if w not in ("the", "a", "my"))


def _names(objects: Sequence[SceneObject]) -> str:
    return ", ".join(o.label for o in objects[:6]) + (", ..." if len(objects) > 6 else "")
