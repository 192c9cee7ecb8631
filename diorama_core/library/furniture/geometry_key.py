"""Names the geometry of a design without building it, so that what is derived from a shape is renewed with that shape.

Building all shapes to hash them takes many seconds; what they are built from is known at once: the row's own numbers
and materials, and the text of every definition that its builder uses. A definition is a function, a class or a
constant at the top of a module of this package. It uses those whose names stand in its text, and what they use: too
many rather than too few. Another builder of the same lamp changes the keys of that lamp's rows, another `box` nearly
all. Comments and docstrings do not count, and texts, unlike compiled code, are the same in every Python.
"""

from __future__ import annotations

import hashlib
import inspect
import re
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np

from diorama_core.errors import LibraryError
from diorama_core.library.furniture.model import Design, built, mesh_of, scene_of

_PACKAGE = __name__.rpartition(".")[0]
_FINISH = (built, mesh_of, scene_of)
"""What every design goes through after its builder."""

_NOISE = re.compile(
    r"""(?:^[ \t]*\"{3}[\s\S]*?\"{3}|[ \t]*\#.*)|(?P<kept>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')""", re.MULTILINE
)
"""Docstrings and comments; other strings, in which neither begins, are kept."""
_BLANK = re.compile(r"\n[ \t]*(?=\n)")
_STATEMENT = re.compile(r"\n(?=[A-Za-z_@])")
_DEFINED = re.compile(r"(?:@.*\n)*(?:def |class )(\w+)|(\w+(?:, \w+)*)(?:: [^=\n]+)? = ")
_IMPORT = re.compile(r"from ([\w.]+) import \(?([^)]*)\)?")
_WORD = re.compile(r"\.?[A-Za-z_]\w*(?:\.\w+)?")

Place = tuple[str, str]
"""Module, without the package's name, and definition."""


def geometry_key(design: Design) -> str:
    """Names the geometry and materials of a design: equal keys, equal shapes.

    Id, category and caption do not count, nor does the order of the options.

    Raises:
        LibraryError: when an option is of a kind whose value cannot be told (an object without a `repr` of its own).
    """
    options = sorted((name, _told(value)) for name, value in design.options.items())
    text = f"{design.size_m} {options} {_code_of(design.builder)} {[_code_of(f) for f in _FINISH]}"
    return hashlib.sha256(text.encode()).hexdigest()[:24]


def _told(value: Any) -> str:
    """The value as text, the same in every process."""
    if inspect.isfunction(value):
        return _code_of(value)
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.tolist()}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_told(v) for v in value)}]"
    text = repr(value)
    if " at 0x" in text or isinstance(value, Mapping):
        raise LibraryError(f"an option of a design is {text}; give numbers, words, materials, styles or functions")
    return text


def code_key(function: Callable[..., Any]) -> str:
    """Names what a function of this package does: its text and that of everything that it uses.

    Raises:
        LibraryError: it is no function at the top of a module of this package.
    """
    return _code_of(inspect.unwrap(function))


@cache
def _code_of(function: Callable[..., Any]) -> str:
    if not inspect.isfunction(function):
        raise LibraryError(f"{function!r} is no function; a design's builder is one, and the rest are its options")
    with _READING:
        return _sources().digest((function.__module__.removeprefix(f"{_PACKAGE}."), function.__qualname__))


_READING = Lock()
"""What one thread has read of the names of a module is not all of them until it is done."""


@cache
def _sources() -> Sources:
    return Sources(Path(__file__).parent, _PACKAGE)


class Sources:
    """The texts of a package's modules and which definitions use which.

    Args:
        folder: Of the package.
        package: Its whole name.
    """

    def __init__(self, folder: Path, package: str) -> None:
        self._folder, self._package = folder, package
        self._modules: dict[str, Module | None] = {}
        self._names: dict[str, dict[str, Place]] = {}
        self._uses: dict[Place, frozenset[Place]] = {}

    def digest(self, place: Place) -> str:
        """A hash of a definition's text and of all that it uses.

        Raises:
            LibraryError: when the module has no such definition (a builder made inside another function).
        """
        module = self._module(place[0])
        if module is None or place[1] not in module.definitions:
            raise LibraryError(f"{place[0]} has no {place[1]} at its top, so shapes built by it cannot be told apart")
        texts = (f"{used} {self._text(used)}" for used in sorted(self.closure(place)))
        return hashlib.sha256("".join(texts).encode()).hexdigest()

    def closure(self, place: Place) -> frozenset[Place]:
        """A definition with everything that it uses, directly or not."""
        found, waiting = {place}, [place]
        while waiting:
            new = self._used(waiting.pop()) - found
            found |= new
            waiting += new
        return frozenset(found)

    def _used(self, place: Place) -> frozenset[Place]:
        """The definitions whose names stand in a definition's text."""
        if place not in self._uses:
            names, used = self._namespace(place[0]), set[Place]()
            for word in set(_WORD.findall(self._text(place))):
                root, _, attribute = word.partition(".")
                meant = names.get(root)
                if meant is not None and not meant[1]:  # a module: one of its definitions is meant
                    meant = self._namespace(meant[0]).get(attribute)
                if meant is not None and meant[1]:
                    used.add(meant)
            self._uses[place] = frozenset(used)
        return self._uses[place]

    def _text(self, place: Place) -> str:
        module = self._module(place[0])
        return "" if module is None else module.definitions[place[1]] + module.loose

    def _namespace(self, name: str) -> dict[str, Place]:
        """What the words of a module mean: definitions, and modules as places without a definition."""
        if name not in self._names:
            self._names[name] = names = {}  # at once, so that a circle of imports ends
            module = self._module(name)
            if module is not None:
                for star in module.stars:
                    names.update(self._namespace(star))
                for word, (source, original) in module.imports.items():
                    inner = f"{source}.{original}".lstrip(".")
                    known = (inner, "") if self._module(inner) else self._namespace(source).get(original)
                    names.update({word: known} if known else {})
                names.update({word: (name, word) for word in module.definitions})
        return self._names[name]

    def _module(self, name: str) -> Module | None:
        if name not in self._modules:
            path = self._folder.joinpath(*name.split(".")).with_suffix(".py") if name else None
            text = path.read_text(encoding="utf-8") if path is not None and path.is_file() else None
            self._modules[name] = None if text is None else Module(text, self._package)
        return self._modules[name]


class Module:
    """One module's text in pieces.

    Args:
        text: As formatted by ruff: what belongs to a statement is indented or closes a bracket.
        package: Imports from it are followed.
    """

    def __init__(self, text: str, package: str) -> None:
        self.definitions: dict[str, str] = {}
        """Text by name."""
        self.imports: dict[str, Place] = {}
        """Where imported names come from."""
        self.stars: list[str] = []
        """Modules of which all names are imported."""
        self.loose = ""
        """Other statements, which may change any definition."""
        for piece in _pieces(text):
            imported, defined = _IMPORT.match(piece), _DEFINED.match(piece)
            if imported:
                self._import(imported, package)
            elif defined:
                names = defined[1] or defined[2]
                self.definitions.update(dict.fromkeys(names.split(", "), piece))
            elif not piece.startswith("import "):
                self.loose += piece

    def _import(self, found: re.Match[str], package: str) -> None:
        source = found[1].removeprefix(package).lstrip(".")
        if not found[1].startswith(package):
            return
        for name in filter(None, (part.strip() for part in found[2].split(","))):
            original, _, alias = name.partition(" as ")
            if original == "*":
                self.stars.append(source)
            else:
                self.imports[alias or original] = (source, original)


def _pieces(text: str) -> Iterator[str]:
    """Statements at the top of a module, decorators with what they decorate."""
    decorators = ""
    for piece in _STATEMENT.split(_BLANK.sub("", _NOISE.sub(r"\g<kept>", "\n" + text))):
        piece = piece.strip() + "\n"
        if piece.startswith("@"):
            decorators += piece
        elif piece.strip():
            yield decorators + piece
            decorators = ""
