"""Normalisation of words for objects: spelling, plurals and synonyms."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from functools import cache

IGNORED = frozenset({
    "a", "an", "the", "some", "any", "my", "our", "your", "their", "his", "her", "this", "that", "these", "those",
    "i", "we", "want", "need", "looking", "look", "like", "something", "please", "find", "show", "me", "very",
    "really", "quite", "nice", "good", "is", "are", "be", "it", "its"
})  # fmt: skip
"""Words without information about an object."""
JOINTS = frozenset({
    "with", "without", "for", "of", "in", "on", "from", "by", "to", "at", "near", "under", "over", "beside",
    "behind", "against", "into"
})  # fmt: skip
"""Words after which something else is named than the object itself."""

_AMERICAN = {
    "grey": "gray", "centre": "center", "metre": "meter", "litre": "liter", "fibre": "fiber", "theatre": "theater",
    "aluminium": "aluminum", "cosy": "cozy", "draught": "draft", "tyre": "tire", "jewellery": "jewelry",
    "mould": "mold", "storey": "story", "pyjama": "pajama", "cheque": "check", "drier": "dryer", "timber": "wood",
}  # fmt: skip
_IRREGULAR = {
    "shelves": "shelf", "knives": "knife", "leaves": "leaf", "loaves": "loaf", "wolves": "wolf", "halves": "half",
    "scarves": "scarf", "children": "child", "men": "man", "women": "woman", "feet": "foot", "teeth": "tooth",
    "mice": "mouse", "people": "person", "chaises": "chaise", "vases": "vase", "cases": "case", "houses": "house",
    "shoes": "shoe", "canoes": "canoe", "toes": "toe", "horses": "horse", "purses": "purse", "nurseries": "nursery",
    "bookcases": "bookcase", "suitcases": "suitcase", "briefcases": "briefcase", "axes": "axe", "pies": "pie",
    "ties": "tie", "movies": "movie", "cookies": "cookie",
}  # fmt: skip
_UNCHANGED = frozenset({
    "glass", "brass", "gas", "canvas", "chess", "dress", "mattress", "glassware", "bus", "cactus", "ficus",
    "hibiscus", "chaos", "iris", "tennis", "tripod", "chassis", "lens", "trellis", "class", "cross", "grass",
    "press", "moss", "address", "boss", "hummus", "campus"
})  # fmt: skip

_CONCEPTS = {
    "wood": "wooden oak walnut pine birch beech ash mahogany cherry teak maple bamboo plywood rosewood elm cedar",
    "metal": "metallic steel iron brass chrome copper aluminum stainless bronze tin pewter wire zinc",
    "fabric": "cloth textile upholstered linen velvet wool woolen boucle tweed cotton corduroy canvas felt",
    "stone": "marble slate granite travertine terrazzo concrete limestone quartz",
    "ceramic": "pottery stoneware porcelain terracotta earthenware china",
    "wicker": "rattan cane seagrass woven",
    "blue": "navy teal cobalt indigo azure turquoise denim",
    "green": "sage olive forest emerald mint moss",
    "red": "oxblood burgundy crimson rust scarlet maroon",
    "brown": "cognac tan walnut chocolate chestnut caramel mahogany",
    "white": "ivory cream chalk pale",
    "beige": "oatmeal cream sand tan ecru linen taupe",
    "gray": "charcoal slate graphite silver ash",
    "yellow": "ochre mustard gold golden lemon",
    "pink": "blush rose coral salmon",
    "orange": "rust terracotta amber apricot",
    "purple": "plum lilac lavender aubergine violet mauve",
    "black": "ebony charcoal jet",
    "dark": "black charcoal walnut ebony mahogany oxblood navy",
    "light": "pale white cream ivory birch",
    "round": "circular drum oval",
    "flower": "flowering blossom bouquet orchid",
    "padded": "upholstered cushioned cushion",
    "modern": "contemporary minimal scandinavian scandi sleek",
    "classic": "traditional antique vintage old georgian victorian period",
    "rustic": "farmhouse country reclaimed cottage",
    "industrial": "loft factory workshop",
    "minimal": "minimalist simple plain scandinavian scandi",
    "foldable": "folding collapsible",
}
"""Each word with what is a kind of it; words of one row also find each other's head word."""

_SIZES = {
    "small": (-1, "volume"), "little": (-1, "volume"), "tiny": (-1, "volume"), "compact": (-1, "volume"),
    "mini": (-1, "volume"), "large": (1, "volume"), "big": (1, "volume"), "huge": (1, "volume"), "great": (1, "volume"),
    "tall": (1, "height"), "high": (1, "height"), "low": (-1, "height"), "short": (-1, "height"),
    "wide": (1, "width"), "long": (1, "width"), "broad": (1, "width"), "narrow": (-1, "width"), "slim": (-1, "width"),
    "deep": (1, "depth"), "shallow": (-1, "depth"),
}  # fmt: skip

_WORD = re.compile(r"[a-z0-9]+")
_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "": 0.0}
_NUMBER = r"(\d+(?:\.\d+)?)"
_DIMENSIONS = re.compile(rf"{_NUMBER}\s*(?:x|×|by)\s*{_NUMBER}\s*(?:x|×|by)\s*{_NUMBER}\s*(mm|cm|m)?\b")


_LIMIT = re.compile(
    rf"\b(?P<word>under|below|less than|at most|up to|no more than|maximum|over|above|more than|at least|minimum)\s+"
    rf"{_NUMBER}\s*(?P<unit>mm|cm|m)\b(?:\s+(?:in\s+)?(?P<of>wide|width|high|tall|height|deep|depth|long))?"
)
_LOWER_LIMITS = frozenset({"over", "above", "more than", "at least", "minimum"})
_MEASURES = {"high": "height", "tall": "height", "height": "height", "deep": "depth", "depth": "depth"}
"""What a number is of; of the width by default."""


@dataclass(frozen=True)
class SizeLimit:
    """A size that a thing must not exceed, or must reach."""

    of: str
    """`height`, `width` or `depth`."""
    metres: float
    most: bool
    """Whether it must not be larger; otherwise, not smaller."""


@dataclass(frozen=True)
class SizeRequest:
    """A word such as "tall": more or less of something than others of the kind have."""

    sign: int
    of: str
    """`volume`, `height`, `width` or `depth`."""


@cache
def normal(word: str) -> str:
    """One spelling of a lower-case word: no accents, American, singular."""
    plain = unicodedata.normalize("NFKD", word).encode("ascii", "ignore").decode()
    single = _singular(plain)
    if single in _AMERICAN:
        return _AMERICAN[single]
    single = re.sub(r"^([a-z]{3,})our(ed|less|ful)?$", r"\1or\2", single)  # colour, coloured
    return re.sub(r"([a-z]{3,})lled$", r"\1led", single)  # panelled


def tokens(text: str) -> tuple[str, ...]:
    """All words of a text in their normal form, in order; numbers too."""
    plain = text.lower()
    if not plain.isascii():
        plain = unicodedata.normalize("NFKD", plain).encode("ascii", "ignore").decode()
    return tuple(map(normal, _WORD.findall(plain.replace("'s", ""))))


def broader(word: str) -> tuple[str, ...]:
    """Words that a word is a kind of: `oak` is `wood`."""
    return _broader().get(word, ())


def narrower(word: str) -> tuple[str, ...]:
    """Words that are a kind of a word, itself not included: `wood` has `oak`; also other words for the same."""
    return _narrower().get(word, ())


def size_request(word: str) -> SizeRequest | None:
    """What a word asks of the size, if it does."""
    request = _SIZES.get(word)
    return None if request is None else SizeRequest(*request)


def size_in(text: str) -> tuple[str, tuple[float, float, float] | None]:
    """A size such as `60 x 50 x 110 cm` (width, depth, height) in a text.

    Returns:
        The text without it, and the extents in metres in object order: x (depth), y (width), z (height). Without a unit
        numbers above 10 are centimetres. None when no size is given.
    """
    match = _DIMENSIONS.search(text.lower())
    if match is None:
        return text, None
    width, depth, height = (float(match.group(i)) for i in (1, 2, 3))
    unit = _METRES[match.group(4) or ""] or (0.01 if max(width, depth, height) > 10 else 1.0)
    rest = f"{text[: match.start()]} {text[match.end() :]}"
    return rest, (depth * unit, width * unit, height * unit)


def size_limits(text: str) -> tuple[str, tuple[SizeLimit, ...]]:
    """Limits such as `under 50 cm` or `at least 2 m high` in a text: the text without them, and the limits."""
    limits = []
    for match in _LIMIT.finditer(text.lower()):
        metres = float(match.group(2)) * _METRES[match.group("unit")]
        of = _MEASURES.get(match.group("of") or "", "width")
        limits.append(SizeLimit(of, metres, match.group("word") not in _LOWER_LIMITS))
    return (_LIMIT.sub(" ", text.lower()) if limits else text), tuple(limits)


def _singular(word: str) -> str:
    if word in _IRREGULAR:
        return _IRREGULAR[word]
    if len(word) < 3 or word in _UNCHANGED or not word.endswith("s") or word.endswith(("ss", "us", "is")):
        return word
    if word.endswith("ies"):
        return word[:-3] + "y"
    return word[:-2] if word.endswith(("ches", "shes", "xes", "sses", "zes")) else word[:-1]


@cache
def _rows() -> tuple[tuple[str, tuple[str, ...]], ...]:
    return tuple((normal(head), tuple(map(normal, kinds.split()))) for head, kinds in _CONCEPTS.items())


@cache
def _narrower() -> dict[str, tuple[str, ...]]:
    table = dict(_rows())
    alike = {"wooden": "wood", "metallic": "metal", "cloth": "fabric", "textile": "fabric", "upholstered": "fabric"}
    alike |= {"contemporary": "modern", "traditional": "classic", "antique": "classic", "vintage": "classic"}
    alike |= {"country": "rustic", "farmhouse": "rustic", "pottery": "ceramic", "circular": "round", "rattan": "wicker"}
    alike |= {"scandinavian": "minimal", "scandi": "minimal", "minimalist": "minimal", "cushioned": "padded"}
    for word, head in alike.items():
        table[word] = tuple(w for w in (head, *table[head]) if w != word)
    return table


@cache
def _broader() -> dict[str, tuple[str, ...]]:
    table: dict[str, tuple[str, ...]] = {}
    for head, kinds in _rows():
        for kind in kinds:
            table[kind] = (*table.get(kind, ()), head)
    return table
