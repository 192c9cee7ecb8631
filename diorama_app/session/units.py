"""Lengths as people write them: metres, centimetres, feet and inches."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Literal

from diorama_app.strings import N_, _
from diorama_core.errors import InputError

Unit = Literal["m", "cm", "ft-in"]
UNITS: tuple[Unit, ...] = ("m", "cm", "ft-in")
METRES_PER_INCH = 0.0254
METRES_PER = {"m": 1.0, "cm": 0.01, "mm": 0.001, "ft": 0.3048, "'": 0.3048, "in": METRES_PER_INCH, '"': METRES_PER_INCH}
_NUMBER = r"\d+(?:[.,]\d+)?(?:\s+\d+/\d+)?|\d+/\d+"
_TERM = r"\s*([+-]?)([^+-]+)"
_PART = re.compile(rf"\s*({_NUMBER})\s*(mm|cm|m|ft|in|'|\")?", re.IGNORECASE)

NOT_A_LENGTH = N_("“{words}” is not a length; write for example 1.2 m, 85 cm, 5' 3\" or 0.5+0.25")


def parse_length(words: str, unit: Unit) -> float:
    """Metres of a length such as "1.2", "85 cm", "5' 3 1/2\\"" or "6ft 2in", or of a sum such as "0.5+25 cm".

    Bare numbers are in the unit.

    Args:
        words: as they were written.
        unit: of bare numbers.

    Raises:
        InputError: it is not a length.
    """
    rest = words.strip().replace("′", "'").replace("″", '"').replace("’", "'").replace("”", '"').replace("−", "-")
    rest = re.sub(r"'\s*-\s*(?=\d)", "' ", rest)  # 5'-3" is one length
    if not rest.strip("+- "):
        raise InputError("the length is missing; write for example 1.2 m, 85 cm, 5' 3\" or 0.5+0.25")
    if not re.fullmatch(f"(?:{_TERM})+", rest):
        raise InputError(_(NOT_A_LENGTH).format(words=words[:30]))
    return sum(-_metres(term, unit) if sign == "-" else _metres(term, unit) for sign, term in re.findall(_TERM, rest))


def _metres(words: str, unit: Unit) -> float:
    """Metres of one length without a sign."""
    rest = re.sub(r"^(?=[.,]\d)", "0", words.strip())  # .95 is 0.95
    total, previous = 0.0, ""
    while rest:
        match = _PART.match(rest)
        if match is None:
            raise InputError(_(NOT_A_LENGTH).format(words=words[:30].strip()))
        name = (match.group(2) or "").lower() or _infer(unit, previous)
        total += _number(match.group(1)) * METRES_PER[name]
        previous, rest = name, rest[match.end() :].strip()
    return total


def format_length(metres: float, unit: Unit) -> str:
    """A length to about a millimetre: "1.25 m", "125 cm", "4' 1 1/4\\""."""
    if unit == "m":
        return f"{metres:.3f}".rstrip("0").rstrip(".") + " m"
    if unit == "cm":
        return f"{100 * metres:.1f}".removesuffix(".0") + " cm"
    sixteenths = round(abs(metres) / METRES_PER_INCH * 16)
    feet, rest = divmod(sixteenths, 12 * 16)
    inches, fraction = divmod(rest, 16)
    sign = "-" if metres < 0 and sixteenths else ""
    return f"{sign}{feet}' {inches}{_fraction(fraction)}\"" if feet else f'{sign}{inches}{_fraction(fraction)}"'


def to_unit(metres: float, unit: Unit) -> float:
    """The number that a field in metres or centimetres shows."""
    return round(metres, 3) if unit == "m" else round(100 * metres, 1)


def format_size(width: float, depth: float, height: float, unit: Unit) -> str:
    """Width, depth and height in short.

    Args:
        width: metres.
        depth: metres.
        height: metres.
        unit: to show.
    """
    if unit == "ft-in":
        return " × ".join(format_length(v, unit) for v in (width, depth, height))
    if unit == "cm":
        return f"{100 * width:.0f} × {100 * depth:.0f} × {100 * height:.0f}"
    return f"{width:.2f}×{depth:.2f}×{height:.2f}"


def _infer(unit: Unit, previous: str) -> str:
    if previous in ("'", "ft"):
        return "in"
    return "ft" if unit == "ft-in" else unit


def _number(words: str) -> float:
    try:
        return float(sum(Fraction(part) for part in words.replace(",", ".").split()))
    except ZeroDivisionError:
        raise InputError(_("“{words}” divides by zero; write a length").format(words=words)) from None


def _fraction(sixteenths: int) -> str:
    return f" {Fraction(sixteenths, 16)}" if sixteenths else ""
