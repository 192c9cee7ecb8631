"""German, French and Spanish descriptions and commands in English, word by word.

The names of all kinds and the grammar's main words are known (`foreign_words.toml`); word order is left as it is, which
commands and lists of furniture survive. Words that are not known stay as they are, and are named as such later.
"""

from __future__ import annotations

import re
import tomllib
import unicodedata
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

from diorama_core.library.taxonomy import category

LANGUAGES = ("de", "fr", "es")
MAX_PHRASE = 5
"""Words of the longest phrase in the table."""
MIN_WORDS = 2
"""A text is of another language when so many of its words say so, and more than say that it is English."""
_TOKEN = re.compile(r"[a-z]'(?=\w)|[\w-]+|[^\w\s]")
_ENGLISH = frozenset(
    {
        *("the", "a", "an", "and", "with", "of", "in", "on", "to", "it", "is", "are", "for", "by", "at", "from", "all"),
        *("make", "put", "move", "turn", "add", "remove", "paint", "hang", "my", "want", "i", "two", "three", "room"),
        *("under", "above", "beside", "behind", "near", "between", "against", "next", "walls", "wall", "floor"),
    }
)  # fmt: skip

Phrase = tuple[str, ...]


def to_english(text: str) -> str:
    """A text in English where it is German, French or Spanish; any other as it is."""
    tokens = _TOKEN.findall(_plain(text))
    scores = {name: _own_words(tokens, name) for name in LANGUAGES}
    best = max(LANGUAGES, key=lambda name: scores[name])
    english = sum(word in _ENGLISH for word in tokens)
    if scores[best] < MIN_WORDS or scores[best] <= english:
        return text
    return re.sub(r"\s+([,.;:!?])", r"\1", " ".join(word for word in _translate(tokens, _phrases(best)) if word))


def _translate(tokens: list[str], phrases: Mapping[Phrase, str]) -> Iterator[str]:
    at = 0
    while at < len(tokens):
        for length in range(min(MAX_PHRASE, len(tokens) - at), 0, -1):
            known = phrases.get(tuple(tokens[at : at + length]))
            if known is not None:
                yield known
                at += length
                break
        else:
            yield tokens[at]
            at += 1


def _own_words(tokens: list[str], language: str) -> int:
    """How many words of a text are of a language and not English."""
    return sum((word,) in _phrases(language) and word not in _ENGLISH for word in tokens)


@cache
def _phrases(language: str) -> Mapping[Phrase, str]:
    """What every phrase of a language is in English."""
    table = tomllib.loads((Path(__file__).parent / "foreign_words.toml").read_text(encoding="utf-8"))
    column = LANGUAGES.index(language)
    phrases: dict[Phrase, str] = {}
    for name, columns in table["kinds"].items():
        for words in columns[column].split(","):
            single, _, plural = words.strip().partition("/")
            singles, plurals = _forms(single, plural, language)
            phrases |= dict.fromkeys(map(_words, plurals), _plural(name))
            phrases |= dict.fromkeys(map(_words, singles), name)
    for english, words in table[language].items():
        phrases |= {_words(w): english for w in words.split(",") if w.strip()}
    return phrases


def _forms(single: str, plural: str, language: str) -> tuple[set[str], set[str]]:
    """The forms of a noun in the singular and in the plural."""
    if language == "de":
        singles = {single, f"{single}s", f"{single}es"}
        plurals = {plural, plural if plural.endswith(("n", "s")) else f"{plural}n"}
        return singles, plurals - singles
    first, *rest = single.split()
    many = _many(first, language)
    agreeing = " ".join([many, *(w if w in ("de", "a", "à", "d'angle") else _many(w, language) for w in rest)])
    return {single}, {" ".join([many, *rest]), agreeing} - {single}


def _many(word: str, language: str) -> str:
    if word.endswith(("s", "x")):
        return word
    if language == "fr":
        return f"{word}x" if word.endswith(("eau", "eu")) else f"{word}s"
    if word.endswith("z"):
        return f"{word[:-1]}ces"
    return f"{word}s" if _plain(word)[-1] in "aeiou" else f"{word}es"


def _plural(name: str) -> str:
    """The English plural of a kind, as the grammar reads it."""
    if name.endswith("s") or category(name).name != name:
        return name
    if name.endswith("f"):
        return f"{name[:-1]}ves"
    return f"{name}es" if name.endswith(("x", "ch", "sh")) else f"{name}s"


def _words(phrase: str) -> Phrase:
    return tuple(_TOKEN.findall(_plain(phrase)))


def _plain(text: str) -> str:
    """Lower case, without accents, in plain apostrophes."""
    lower = text.lower().replace("ß", "ss").replace("’", "'")
    return "".join(c for c in unicodedata.normalize("NFKD", lower) if not unicodedata.combining(c))
