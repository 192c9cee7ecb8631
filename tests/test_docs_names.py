"""Paths, links, modules, commands and options that the docs name exist; commands that take a second are run."""

from __future__ import annotations

import argparse
import re
import shlex
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest

from diorama_app.cli import command_parser, main

ROOT = Path(__file__).parents[1]
PAGES = [
    *sorted((ROOT / "docs").glob("*.md")),
    *(ROOT / f"{name}.md" for name in ("README", "CONTRIBUTING", "SECURITY")),
]
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`([^`\n]+)`")
LINK = re.compile(r"\]\((?!\w+:)([^)#\s]*)(?:#([^)\s]+))?\)")
PATH = re.compile(r"(?:\./)?[\w.-]+(?:/[\w.*-]+)+/?|[\w-]+\.(?:py|toml|yml)")
PARSER = command_parser()
TOP = (
    "addons/",
    "assets/",
    "diorama_app/",
    "diorama_core/",
    "docs/",
    "examples/",
    "scripts/",
    "tests/",
    ".github/",
    "./scripts",
)
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")
FOREIGN = re.compile(r"(pip|pipx|uv|python -m (?!diorama)|--extra-index-url|--require-hashes|--with)")
"""Commands and options of other programs."""
RUN = ("library list", "library search", "models list", "models path", "project list")
NOT_RUN = {
    "api": "serves until it is stopped; tests/app/http_api",
    "bench": "minutes; tests/evaluation/test_bench_command.py runs small ones",
    "build": "builds a room; tests/cli",
    "doctor": "measures the machine for seconds; tests/cli/test_machine.py",
    "edit": "needs a project; tests/cli/test_words.py",
    "export": "needs a project; tests/cli/test_cli.py",
    "import": "needs a scan; tests/cli/test_import.py",
    "library add": "needs models; tests/cli/test_library_add.py",
    "library build": "prepares all shapes; tests/cli/test_libraries.py",
    "library info": "needs a shape of one's own; tests/cli/test_library_add.py",
    "library show": "--watch does not end; tests/cli/test_sheet.py",
    "mcp": "serves until it is stopped; tests/app/agents/test_server.py",
    "models check": "needs networks; tests/cli/test_models_and_text.py",
    "models pull": "downloads; tests/models",
    "models verify": "needs networks; tests/cli/test_models_and_text.py",
    "optimise": "needs a project; tests/cli/test_cli.py",
    "picture": "needs a project; tests/cli/test_cli.py",
    "project rooms": "needs a project; tests/cli/test_project.py",
    "project join": "needs two projects; tests/cli/test_project.py",
    "project zip": "needs a project; tests/cli/test_project.py",
    "review": "asks a person; tests/cli/test_review.py",
    "serve": "serves until it is stopped; tests/e2e",
    "text": "composes a room; tests/cli/test_models_and_text.py",
}
"""Why a command of the docs is parsed only, and what runs it."""


def fenced(page: Path) -> Iterator[tuple[str, str]]:
    """Language and text of a page's blocks of code."""
    yield from ((m[1], m[2]) for m in FENCE.finditer(page.read_text("utf-8")))


def spans(page: Path) -> list[str]:
    """Code within a page's sentences and tables."""
    return [m[1] for m in CODE.finditer(FENCE.sub("", page.read_text("utf-8")))]


def command_lines(page: Path) -> list[str]:
    """Whole commands from a page's blocks, without comments and placeholders of choices."""
    text = "\n".join(block for language, block in fenced(page) if language in ("", "sh", "bash"))
    lines = [line.partition("  #")[0].strip() for line in text.replace("\\\n", " ").split("\n")]
    return [
        line for line in lines if re.match(r"(\.venv/bin/)?diorama ", line) and " | " not in line and "..." not in line
    ]


def words_of(parser: argparse.ArgumentParser, words: list[str]) -> tuple[str, set[str]]:
    """The command that words name, and the options of its parser; a `ValueError` names a word that is no command."""
    name, options = [], set(parser._option_string_actions)
    while action := next((a for a in parser._actions if isinstance(a, argparse._SubParsersAction)), None):
        if not words or words[0].startswith(("-", "[", "{")) or words[0].isupper() or words[0] == "...":
            break
        if words[0] not in action.choices:
            raise ValueError(f"{words[0]} is no command")
        name.append(words[0])
        parser, words = action.choices[words[0]], words[1:]
        options |= set(parser._option_string_actions)
    return " ".join(name), options


def documented_commands() -> set[str]:
    """The commands that any page shows or mentions."""
    found = set()
    for page in PAGES:
        for text in [*command_lines(page), *(span for span in spans(page) if span.startswith("diorama "))]:
            found.add(words_of(PARSER, text.split("diorama ", 1)[1].split())[0])
    return found - {""}


@pytest.fixture(scope="module")
def repository() -> list[str]:
    """Every file and folder that docs may name, as `/a/b`."""
    folders = [ROOT / top.removeprefix("./") for top in (*TOP, ".github/")]
    inside = [path for folder in folders for path in folder.rglob("*") if "__pycache__" not in path.parts]
    return ["/" + path.relative_to(ROOT).as_posix() for path in (*inside, *ROOT.glob("*"))]


@pytest.mark.parametrize("page", PAGES, ids=[page.name for page in PAGES])
def test_links_lead_somewhere(page: Path) -> None:
    for target, anchor in LINK.findall(FENCE.sub("", page.read_text("utf-8"))):
        path = (page.parent / target) if target else page
        assert path.exists(), f"{target} is not there"
        if anchor:
            headings = re.findall(r"^#+ (.*)$", FENCE.sub("", path.read_text("utf-8")), re.MULTILINE)
            anchors = [re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings]
            assert anchor in anchors, f"{target}#{anchor}: no such heading"


@pytest.mark.parametrize("page", PAGES, ids=[page.name for page in PAGES])
def test_paths_and_modules_exist(page: Path, repository: list[str]) -> None:
    blocks = [text for language, text in fenced(page) if language in ("", "sh", "bash")]
    for text in (*spans(page), *blocks):
        for word in text.split():
            name = word.removeprefix("./").rstrip("/,.:")
            if re.fullmatch(r"diorama_(core|app)(\.\w+)+", name):
                importable(name)
            elif PATH.fullmatch(word) and "*" in name and word.startswith(TOP):
                assert list(ROOT.glob(name)), f"{word} matches nothing"
            elif PATH.fullmatch(word) and (word.startswith(TOP) or name.endswith((".py", ".toml", ".yml"))):
                assert any(path.endswith("/" + name) for path in repository), f"{word} is not there"


def importable(name: str) -> None:
    """Import a module, or a name from one."""
    try:
        import_module(name)
    except ModuleNotFoundError:
        module, _, attribute = name.rpartition(".")
        assert hasattr(import_module(module), attribute), f"{name} is not there"


@pytest.mark.parametrize("page", PAGES, ids=[page.name for page in PAGES])
def test_commands_and_options_exist(page: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for line in command_lines(page):
        try:
            PARSER.parse_args(shlex.split(line.split("diorama ", 1)[1]))
        except SystemExit:
            pytest.fail(f"{line}: {capsys.readouterr().err.splitlines()[-1]}")
    for span in spans(page):
        if re.match(r"(\.venv/bin/)?diorama ", span):
            _, options = words_of(PARSER, span.split("diorama ", 1)[1].split())
            assert set(OPTION.findall(span)) <= options, f"`{span}` has another option"
        elif not FOREIGN.match(span):
            assert set(OPTION.findall(span)) <= every_option(), f"`{span}` has an option of no command"


@cache
def every_option() -> set[str]:
    """Options of all commands and of the scripts."""
    found, parsers = set[str](), [PARSER]
    while parsers:
        parser = parsers.pop()
        found |= set(parser._option_string_actions)
        parsers += [p for a in parser._actions if isinstance(a, argparse._SubParsersAction) for p in a.choices.values()]
    scripts = [path for path in (ROOT / "scripts").iterdir() if path.is_file()]
    texts = (path.read_text("utf-8") for path in (*scripts, ROOT / "diorama_core/models/onnx_export.py"))
    return found | {option for text in texts for option in OPTION.findall(text)}


def test_every_documented_command_is_run_or_says_why_not() -> None:
    commands = documented_commands()
    known = {name for name in commands if name.startswith((*RUN, *NOT_RUN))}
    assert commands == known | {"library", "models", "project"} & commands
    assert {name for name in NOT_RUN if not any(command.startswith(name) for command in commands)} == set()


def test_documented_commands_of_a_second_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("DIORAMA_MODELS", str(tmp_path / "models"))
    run = 0
    for line in {line for page in PAGES for line in command_lines(page)}:
        words = shlex.split(line.split("diorama ", 1)[1])
        if not " ".join(words).startswith(RUN) or {"--image", "--library"} & set(words):
            continue
        assert main(words) == 0, f"{line}: {capsys.readouterr().err}"
        assert capsys.readouterr().out.strip()
        run += 1
    assert run >= 3
