"""Names what a module does by its source and that of the modules it imports, so that saved results age with the code.

Only modules of this package count, and only those that a module imports, directly or through others, at its top or
within a function. Imports are found in the text: parsing every module would take seconds. The designs of furniture are
left out, since shapes are keyed by their own geometry.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

PACKAGE = __name__.partition(".")[0]
SHAPES = f"{PACKAGE}.library.furniture."
_IMPORT = re.compile(rf"(?:from ({PACKAGE}[.\w]*) import (?:\(([^)]*)\)|([^\n#]*))|import ({PACKAGE}[.\w]*))")
_NAME = re.compile(r"\w+")


def code_key(*modules: str) -> str:
    """A hash of the source of modules and of all that they import, the same in every process.

    A module outside of the package is named by itself: its source is not this package's to follow.
    """
    return package_sources().key(modules)


@cache
def package_sources() -> Sources:
    """The sources of the package that runs, read once."""
    return Sources(Path(__file__).parents[2])


class Sources:
    """The modules of the package below a folder, read when they are asked for.

    Args:
        root: The folder that holds the package's own.
    """

    def __init__(self, root: Path) -> None:
        self._root = root
        self._files: dict[str, Path | None] = {}
        self._texts: dict[str, str] = {}
        self._imports: dict[str, frozenset[str]] = {}
        self._keys: dict[tuple[str, ...], str] = {}

    def key(self, modules: Iterable[str]) -> str:
        """A hash of the source of modules and of all that they import."""
        named = tuple(sorted(set(modules)))
        if named not in self._keys:
            texts = (f"{name} {self.digest(name)}" for name in sorted(self.closure(*named)))
            self._keys[named] = hashlib.sha256("\n".join((*named, *texts)).encode()).hexdigest()[:24]
        return self._keys[named]

    def closure(self, *modules: str) -> frozenset[str]:
        """The modules and all modules that they import, directly or not; those elsewhere are left out."""
        modules_met, waiting = set[str](), list(modules)
        while waiting:
            name = waiting.pop()
            if name not in modules_met and not name.startswith(SHAPES) and self._file(name) is not None:
                modules_met.add(name)
                waiting += self.imports(name)
        return frozenset(modules_met)

    def digest(self, module: str) -> str:
        """A hash of a module's own source."""
        return hashlib.sha256(self._text(module).encode()).hexdigest()

    def imports(self, module: str) -> frozenset[str]:
        """The modules of the package that a module's text imports."""
        if module not in self._imports:
            self._imports[module] = frozenset(self._imports_in(self._text(module)))
        return self._imports[module]

    def _imports_in(self, text: str) -> Iterator[str]:
        for source, listed, line, whole in _IMPORT.findall(text):
            yield whole or source
            for name in _NAME.findall(listed or line):
                inner = f"{source}.{name}"
                if self._file(inner) is not None:
                    yield inner

    def _text(self, module: str) -> str:
        if module not in self._texts:
            path = self._file(module)
            self._texts[module] = "" if path is None else path.read_text(encoding="utf-8") + _data_beside(path)
        return self._texts[module]

    def _file(self, module: str) -> Path | None:
        if module not in self._files:
            folder = self._root.joinpath(*module.split("."))
            places = (folder.with_suffix(".py"), folder / "__init__.py")
            self._files[module] = next((p for p in places if p.is_file()), None)
        return self._files[module]


def _data_beside(module: Path) -> str:
    """The text of the data file that is a module's own by its name: fitted weights."""
    data = module.with_suffix(".json")
    return data.read_text(encoding="utf-8") if data.is_file() else ""
