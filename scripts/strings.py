"""Makes the table of the page's texts, `diorama_app/strings/diorama.pot`, from the code.

    python scripts/strings.py

It holds what is marked (`_`, `N_`, `plural`, `_("...")` in scripts), the constant messages of errors and progress, the
commands, and the words of the library that the page shows. `docs/translating.md` says how a translation is made.
"""

from __future__ import annotations

import ast
import io
import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from pathlib import Path
from typing import get_args

from babel.messages.catalog import Catalog
from babel.messages.pofile import write_po

from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_app.session.problem_checker import COLLIDES, FLOATS, OUTSIDE
from diorama_app.strings import script_texts
from diorama_core import errors
from diorama_core.appearance.patterns import COLOURS
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.taxonomy import CATEGORIES, ROOMS
from diorama_core.review.questions import TURNS
from diorama_core.scene.types import Finish, PlaneRole, SurfacePattern

ROOT = Path(__file__).resolve().parents[1]
TABLE = ROOT / "diorama_app" / "strings" / "diorama.pot"
NO_PAGE = {"cli", "http_api", "agents", "evaluation", "training"}
"""Folders whose messages no page shows."""
ERRORS = [name for name, kind in vars(errors).items() if isinstance(kind, type) and issubclass(kind, Exception)]
WHERE: Mapping[str, tuple[int, ...]] = {
    **dict.fromkeys(("_", "N_", *ERRORS), (0,)),
    "report": (1,),
    "Command": (1, 5),
    "Guide": (0, 1),
    "Reading": (1,),
    "PatternKind": (0,),
    "ExampleRoom": (0,),
    "DepthAnswer": (0,),
    "Choice": (1,),
    "StageStatus": (0, 1, 6),
    "_status": (1, 3),
}
"""Which arguments of a call are texts of the page where they are constant."""
MARKED = re.compile(rf"\b(plural|{'|'.join(WHERE)})\(")
Text = str | tuple[str, str]
"""A text, or its singular and plural."""
HEADER = b"""# Texts of the page of Diorama; made by scripts/strings.py.
msgid ""
msgstr "Content-Type: text/plain; charset=utf-8\\n"

"""


def main() -> None:
    TABLE.write_bytes(table())


def table() -> bytes:
    """The table as a file, sorted, with the modules of each text."""
    catalogue = Catalog()
    for text, place in chain(_marked(), _in_scripts(), _of_the_library()):
        catalogue.add(text, locations=[(place, 0)])
    file = io.BytesIO()
    write_po(file, catalogue, sort_output=True, include_lineno=False, omit_header=True, width=0)
    return HEADER + file.getvalue()


def _marked() -> Iterator[tuple[Text, str]]:
    for path in sorted(chain((ROOT / "diorama_app").rglob("*.py"), (ROOT / "diorama_core").rglob("*.py"))):
        if NO_PAGE.isdisjoint(path.parts):
            for text in texts_in(path.read_text("utf-8")):
                yield text, path.relative_to(ROOT).as_posix()


def texts_in(code: str) -> Iterator[Text]:
    """The texts of a module of Python."""
    tree = ast.parse(code if MARKED.search(code) else "")  # most have none, and parsing takes long
    named = {
        target.id: node.value
        for node in tree.body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    for call in ast.walk(tree):
        if isinstance(call, ast.Call):
            function = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
            first = call.args[0] if call.args else None
            if function == "plural":
                pair = named[first.value.id].elts if isinstance(first, ast.Starred) else call.args[:2]
                one, many = (ast.literal_eval(text) for text in pair)
                yield one, many
            for number in WHERE.get(function, ()):
                yield from _constants(call.args[number]) if number < len(call.args) else ()
            for word in call.keywords:
                yield from _constants(word.value) if (function, word.arg) == ("Command", "hint") else ()


def _constants(value: ast.expr) -> Iterator[str]:
    if isinstance(value, ast.IfExp):
        yield from chain(_constants(value.body), _constants(value.orelse))
    elif isinstance(value, ast.Constant) and isinstance(value.value, str) and value.value:
        yield value.value


def _in_scripts() -> Iterator[tuple[Text, str]]:
    for path in sorted((ROOT / "diorama_app" / "static").iterdir()):
        if path.suffix in (".js", ".html"):
            for text in script_texts(path.read_text("utf-8")):
                yield text, path.relative_to(ROOT).as_posix()


def _of_the_library() -> Iterator[tuple[Text, str]]:
    """Words that the page takes from tables of the library."""
    styles = {shape.style for shape in built_in_library().shapes() if shape.style}
    formats = [words for one in EXPORT_FORMATS.values() for words in (one.title, one.keeps)]
    tables: dict[str, Iterable[str]] = {
        "diorama_core/library/kinds.toml": [*(kind.name for kind in CATEGORIES), *ROOMS],
        "diorama_core/library/furniture": styles,
        "diorama_core/appearance/patterns.py": COLOURS,
        "diorama_core/scene/types.py": [*get_args(PlaneRole), *get_args(Finish), *get_args(SurfacePattern)],
        "diorama_core/review/questions.py": TURNS,
        "diorama_core/export/formats.py": formats,
        "diorama_app/session/problem_checker.py": [COLLIDES, FLOATS, OUTSIDE],
    }
    for place, words in tables.items():
        for text in words:
            yield text, place


if __name__ == "__main__":
    main()
