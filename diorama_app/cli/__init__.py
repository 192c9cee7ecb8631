"""The command line: `diorama COMMAND`. Each command is one function; heavy imports happen inside it."""

from __future__ import annotations

import argparse
import io
import logging
import os
import sys
from collections.abc import Sequence
from typing import Any

from diorama_app.cli.api import add_api, add_mcp
from diorama_app.cli.bench import add_bench
from diorama_app.cli.build import add_build
from diorama_app.cli.export import add_export
from diorama_app.cli.importing import add_import
from diorama_app.cli.library import add_library
from diorama_app.cli.machine import add_doctor
from diorama_app.cli.models import add_models
from diorama_app.cli.project import add_project
from diorama_app.cli.review import add_review
from diorama_app.cli.scenes import add_optimise, add_picture, add_serve
from diorama_app.cli.words import add_edit, add_text
from diorama_core.errors import Cancelled, DioramaError
from diorama_core.io.large_libraries import load_quickly
from diorama_core.io.text import clean_strings

LOAD_MUCH = (
    *("api", "mcp", "build", "optimise", "export", "import", "picture", "text", "edit", "review", "library", "bench"),
)
"""Commands that need most libraries whatever they are told."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status: 0 done, 1 failed with one clear line, 2 bad usage, 130 stopped."""
    # Small problems run faster on one thread than on two that wait for each other.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # a file's name may hold bytes that are no text
    arguments = command_parser().parse_args(argv)
    for name, value in vars(arguments).items():
        setattr(arguments, name, clean_strings(value))  # words; paths stay the bytes that they are
    if arguments.command == "build":
        from diorama_core.pipeline.beside import prepare_processes

        prepare_processes()
    if arguments.command in LOAD_MUCH:
        load_quickly()
    logging.basicConfig(level=logging.DEBUG if arguments.verbose else logging.ERROR, stream=sys.stderr)
    try:
        return int(arguments.run(arguments) or 0)
    except KeyboardInterrupt:
        print("diorama: stopped; finished stages are cached and the next run resumes there", file=sys.stderr)
        return 130
    except Cancelled as error:
        print(f"diorama: {error}", file=sys.stderr)
        return 130
    except DioramaError as error:
        if arguments.verbose:
            logging.exception("details")
        print(f"diorama: {error}", file=sys.stderr)
        return 1
    except BrokenPipeError:
        return 1
    except Exception as error:  # a user gets a line, not a traceback
        if arguments.verbose:
            logging.exception("details")
        where = f"{type(error).__name__}: {error}"
        print(f"diorama: internal error ({where}); run again with --verbose and report it", file=sys.stderr)
        return 1


class _Version(argparse.Action):
    """Prints the installed version, which is looked up only when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from importlib.metadata import version

        print(f"diorama {version('diorama')}")
        parser.exit()


def command_parser() -> argparse.ArgumentParser:
    """The parser of all commands."""
    parser = argparse.ArgumentParser(
        prog="diorama", description="One picture of a room becomes an editable 3D scene.", allow_abbrev=False
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version and exit")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for add in (
        add_serve,
        add_build,
        add_optimise,
        add_export,
        add_import,
        add_picture,
        add_text,
        add_edit,
        add_review,
        add_library,
        add_models,
        add_bench,
        add_api,
        add_mcp,
        add_project,
        add_doctor,
    ):
        add(commands)
    return parser
