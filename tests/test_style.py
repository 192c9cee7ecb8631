"""What a program can check of `docs/style.md`: docstrings, what the program prints and shows, and the docs."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FOLDERS = ("diorama_core", "diorama_app", "addons", "scripts", "tests", "examples")
DOCSTRING = re.compile(r'(?:\A(?:#.*\n)*|:(?:  #.*)?\n *)r?"""(.+)')
"""The first line of a docstring: to parse all modules takes ten seconds."""
ODD_STARTS = re.compile(r"(Of|And|Nor|But|Or|The same)\b")
QUESTIONS = re.compile(r"(What|How|Where|When)\b")
MAX_QUESTIONS = 0.12
"""Share of docstrings that begin with a question word; it may only fall."""
PREPOSITIONS = re.compile(
    r"def _*(of|in|at|on|by|within|inside|beside|over|outside|near|below|along|between|about|towards?|before|behind"
    r"|through|around|under|where|above|for|into|onto|after|among)(?=_|\()"
)
MAX_PREPOSITIONS = 76
"""Functions of core and app whose names begin with one, constructors `of` and handlers `on_*` mostly; it may only fall.
Conversions (`with_`, `without_`, `to_`, `from_`, `as_`) are usual."""
PARTICIPLES = re.compile(
    r"def _*((?!(?:speed|need|feed|seed|bed|embed|proceed|exceed|red)(?:_|\())[a-z]{2,}ed|begun|bent|bound|bought"
    r"|brought|built|burnt|caught|chosen|done|drawn|dealt|driven|fallen|felt|found|forgotten|frozen|given|gone|grown|held"
    r"|hidden|hung|kept|known|laid|learnt|led|left|lent|lit|lost|made|meant|met|overridden|paid|relit|said|seen|sent"
    r"|shown|shrunk|shut|slid|sold|spent|spoken|stood|stuck|sunk|taken|taught|thought|thrown|told|torn|undone|understood"
    r"|won|worn|written)(?=_|\()"
)
MAX_PARTICIPLES = 25
"""Functions of core and app, without furniture, whose names begin with one; it may only fall. A value is a noun, an
action a verb, and a predicate begins with `is_`; some nouns have one (`signed_area`, `cached_picture`)."""
MANY_PARAMETERS = 4
EXPLAINED_ELSEWHERE = ("diorama_core/library/furniture/", "diorama_app/agents/tools.py", "diorama_app/http_api/")
"""Designs' parameters are the words of their tables; those of HTTP and MCP have descriptions in their annotations."""
ODD_WORDS = re.compile(r"\b(things?|anew|alike|upon|whoever|hitherto|(is|are|was) (told|said))\b", re.IGNORECASE)
VOCABULARIES = ("diorama_core/text/", "diorama_core/library/search.py", "diorama_core/evaluation/adapters/")
"""Modules with words that people and data sets use."""
PAGES = [
    *sorted((ROOT / "docs").glob("*.md")),
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")),
]


def modules(*folders: str) -> list[Path]:
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]


@cache
def reading(path: Path) -> tuple[list[str], list[tuple[str, str]]]:
    """Places of public functions of many parameters without `Args:`; place and text of strings of several words that
    are no docstrings. A module's tree is dropped at once: trees of all slow every later search for garbage.
    """
    name, nodes = path.relative_to(ROOT).as_posix(), list(ast.walk(ast.parse(path.read_text("utf-8"))))
    docstrings = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    texts = [n for n in nodes if isinstance(n, ast.Constant) and isinstance(n.value, str) and id(n) not in docstrings]
    functions = [n for n in nodes if isinstance(n, ast.FunctionDef) and not n.name.startswith("_")]
    return (
        [f"{name}:{f.lineno}" for f in functions if is_unexplained(f)],
        [(f"{name}:{node.lineno}", str(node.value)) for node in texts if " " in str(node.value).strip()],
    )


def is_unexplained(function: ast.FunctionDef) -> bool:
    """Whether it has a docstring and many parameters, and does not explain them."""
    text, given = ast.get_docstring(function), function.args
    names = {a.arg for a in (*given.posonlyargs, *given.args, *given.kwonlyargs)}
    return bool(text) and len(names - {"self", "cls"}) >= MANY_PARAMETERS and "Args:" not in str(text)


def test_docstrings_begin_with_their_subject() -> None:
    paths = modules(*FOLDERS)
    docstrings = [(path, text) for path in paths for text in DOCSTRING.findall(path.read_text("utf-8"))]
    assert len(docstrings) > 2 * len(paths)
    assert [(path, text) for path, text in docstrings if ODD_STARTS.match(text)] == []
    questions = sum(QUESTIONS.match(text) is not None for _, text in docstrings)
    assert questions <= MAX_QUESTIONS * len(docstrings), f"{questions} of {len(docstrings)} begin with a question word"


def test_functions_are_named_for_what_they_return_or_do() -> None:
    found = [path for path in modules("diorama_core", "diorama_app") for _ in PREPOSITIONS.findall(path.read_text())]
    assert len(found) <= MAX_PREPOSITIONS, "a noun for a value, a verb for an action (docs/style.md)"


def test_functions_do_not_begin_with_a_participle() -> None:
    paths = [p for p in modules("diorama_core", "diorama_app") if "/furniture/" not in p.as_posix()]
    matches = [(p, word) for p in paths for word in PARTICIPLES.findall(p.read_text("utf-8"))]
    assert len(matches) <= MAX_PARTICIPLES, "a noun for a value, a verb for an action (docs/style.md)"


def test_functions_of_many_parameters_explain_them() -> None:
    missing = [where for path in modules("diorama_core", "diorama_app") for where in reading(path)[0]]
    assert [where for where in missing if not where.startswith(EXPLAINED_ELSEWHERE)] == []


def test_messages_are_in_plain_words() -> None:
    code = [path for path in modules("diorama_core", "diorama_app") if "/furniture/" not in path.as_posix()]
    read = [row for path in code for row in reading(path)[1] if not row[0].startswith(VOCABULARIES)]
    assert len(read) > len(code)
    assert [row for row in read if ODD_WORDS.search(row[1])] == []


@pytest.mark.parametrize("page", PAGES, ids=[page.name for page in PAGES])
def test_docs_are_in_plain_words(page: Path) -> None:
    text = page.read_text("utf-8").split("| before | after |")[0]
    assert [(n, line) for n, line in enumerate(text.splitlines(), 1) if ODD_WORDS.search(line)] == []
