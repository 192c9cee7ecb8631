"""What the commands share: how a command is declared, how its arguments are read, and a progress bar on stderr, which
is plain lines where stderr is not a terminal.
"""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from diorama_core.errors import UnavailableError
from diorama_core.progress import CancelToken, Progress, ProgressEvent

RECIPES = ("feasible", "paper", "all-in-one")
WITHOUT_PHOTO = "orbit:35"
"""View of a scene that no photo was taken of."""
PROFILES = ("auto", "embedded", "foundation")


def command(commands: Any, name: str, run: Any, example: str, summary: str = "") -> argparse.ArgumentParser:
    """A subcommand that runs `run`, with a summary and an example.

    Args:
        commands: the parser's subcommands.
        name: as it is typed.
        run: takes the parsed arguments.
        example: of its use.
        summary: one line; what `run` says of itself when empty.
    """
    summary = summary or run.__doc__
    parser: argparse.ArgumentParser = commands.add_parser(
        name,
        help=summary,
        description=summary,
        epilog=f"example:\n  {example}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("--verbose", action="store_true", help="log what happens and show tracebacks")
    parser.set_defaults(run=run)
    return parser


def print_note(note: str) -> None:
    """A remark on stderr."""
    print(f"diorama: note: {note}", file=sys.stderr)


def need(words: str, extra: str, *modules: str) -> None:
    """Refuse a command whose optional libraries, which an extra has, are missing."""
    for module in modules:
        if find_spec(module) is None:
            raise UnavailableError(f"'{words}' needs {module}, which is not installed: pip install 'diorama[{extra}]'")


PROJECTS_HELP = "where projects are kept (default: Diorama among your documents, or ~/Diorama where that exists)"


def projects_folder(given: Path | None) -> Path:
    """Where projects are kept: the given folder, the one of earlier versions, or one among the person's documents."""
    earlier = Path.home() / "Diorama"
    if given is not None or earlier.is_dir():
        return given or earlier
    import platformdirs

    return platformdirs.user_documents_path() / "Diorama"


UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "inch": 0.0254, "ft": 0.3048, "foot": 0.3048}


def unit(text: str) -> float:
    """Metres in a unit: a name, or a number of metres."""
    return UNITS[text.lower()] if text.lower() in UNITS else positive(text)


def positive(text: str) -> float:
    """A positive number."""
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return value


def field_of_view(text: str) -> float:
    """Degrees, horizontal, 5 to 150."""
    value = positive(text)
    if not 5 <= value <= 150:
        raise argparse.ArgumentTypeError(f"{text} degrees; give a horizontal field of view between 5 and 150")
    return value


def intrinsics(text: str) -> tuple[float, float, float, float]:
    """fx, fy, cx, cy in pixels."""
    try:
        fx, fy, cx, cy = (float(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}; give four numbers in pixels: fx,fy,cx,cy") from None
    if not (fx > 0 and fy > 0):
        raise argparse.ArgumentTypeError(f"{text!r}; focal lengths must be positive")
    return fx, fy, cx, cy


def coefficients(text: str) -> tuple[float, ...]:
    """Numbers with commas between them."""
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}; give numbers: k1,k2,p1,p2,k3") from None


def view(text: str) -> str:
    """photo, planes, top, front, orbit:DEG or turntable."""
    kind, _, angle = text.partition(":")
    try:
        known = text in ("photo", "planes", "top", "front", "turntable") or (
            kind == "orbit" and abs(float(angle)) < 1e6
        )
    except ValueError:
        known = False
    if not known:
        raise argparse.ArgumentTypeError(f"{text!r}; choose photo, planes, top, front, turntable or orbit:30")
    return text


def size(text: str) -> tuple[int, int]:
    """Width and height in pixels."""
    try:
        width, height = (int(part) for part in text.lower().split("x"))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}; give width x height, such as 1024x768") from None
    if not (16 <= width <= 8192 and 16 <= height <= 8192):
        raise argparse.ArgumentTypeError(f"{text!r}; each side must be between 16 and 8192")
    return width, height


@contextmanager
def progress_bar() -> Iterator[Progress]:
    """A `Progress` drawn on stderr; Ctrl+C asks the work to stop at its next check, a second one stops at once."""
    token = CancelToken()
    previous = signal.getsignal(signal.SIGINT)

    def stop(number: int, frame: object) -> None:
        if token.is_cancelled:
            raise KeyboardInterrupt
        token.cancel()

    signal.signal(signal.SIGINT, stop)
    try:
        if sys.stderr.isatty():
            from rich.console import Console  # a tenth of a second to load
            from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn
            from rich.progress import Progress as Bar

            columns = (TextColumn("{task.description:<28}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
            with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
                task = bar.add_task("", total=1.0)
                yield Progress(lambda e: bar.update(task, completed=e.fraction, description=e.message), token)
        else:
            yield Progress(_Lines(), token)
    finally:
        signal.signal(signal.SIGINT, previous)


class _Lines:
    """One line for each new message."""

    def __init__(self) -> None:
        self._last = ""

    def __call__(self, event: ProgressEvent) -> None:
        if event.message != self._last:
            self._last = event.message
            print(f"{event.fraction:4.0%} {event.message}", file=sys.stderr)
